//! Files of kinds that are not read: each is called by its name, with a program that makes a table of it.

use super::*;

/// The message without the list of endings.
fn found(name: &str, bytes: impl AsRef<[u8]>) -> String {
    let message = refusal(name, bytes, "radius: 1");
    let start = message.find("found ").unwrap_or(0);
    message[start..].to_owned()
}

#[test]
fn kinds_are_told_by_contents_or_endings_before_columns_are_looked_for() {
    let cube = "title\nmade\n1 0.0 0.0 0.0\n2 1.0 0.0 0.0\n2 0.0 1.0 0.0\n2 0.0 0.0 1.0\n8 0.0 0.1 0.2 0.3\n1 2 3\n";
    let xsf = "# by hand\nCRYSTAL\nPRIMVEC\n1 0 0\n0 1 0\n0 0 1\nPRIMCOORD\n1 1\n8 0 0 0\n";
    let vtu = "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\">\n<Points>1 2 3</Points>\n";
    let html = "<!DOCTYPE html>\n<html><body>404</body></html>\n";
    let psf = "PSF CMAP\n\n 1 !NTITLE\n REMARKS\n\n 3 !NATOM\n1 A 1 ALA N NH3 -0.3 14.0 0\n";
    for (names, bytes, kind, tool) in [
        (
            &["CONFIG"][..],
            &b"DL_POLY: salt\n2 1 4\n1.0 0.0 0.0\n0.0 1.0 0.0\n0.0 0.0 1.0\nNa 1\n0.1 0.2 0.3\n"[..],
            "a structure of DL_POLY",
            "ASE",
        ),
        (
            &["a.g96", "a"],
            b"TITLE\nmade by hand\nEND\nPOSITION\n",
            "coordinates of GROMOS",
            "MDTraj",
        ),
        (
            &["a.inpcrd", "a.rst7"],
            b"ACE\n2\n  1.0  2.0  3.0  4.0  5.0  6.0\n",
            "coordinates of Amber",
            "MDTraj",
        ),
        (
            &["a.cube", "a"],
            cube.as_bytes(),
            "a cube file of Gaussian",
            "Open Babel",
        ),
        (
            &["a.xsf", "a.txt"],
            xsf.as_bytes(),
            "a structure in XSF",
            "ASE",
        ),
        (
            &["a.vti", "a.vtu", "a.csv", "a"],
            vtu.as_bytes(),
            "an XML file of VTK",
            "ParaView",
        ),
        (
            &["a.csv", "a.pdb"],
            html.as_bytes(),
            "a page in HTML",
            "fetch the file again",
        ),
        (
            &["a.psf", "a"],
            psf.as_bytes(),
            "a topology without positions",
            "MDAnalysis",
        ),
        (
            &["a.mmtf"],
            b"\x86\xabmmtfVersion",
            "a structure in MMTF",
            "PyMOL",
        ),
        (
            &["a.xlsx", "a.npz"],
            b"PK\x03\x04aaaaaaaaaaaaaaaaaaaaaaaaaa[Content_Types].xml",
            "a sheet",
            "CSV",
        ),
        (
            &["a.h5", "a"],
            b"\x89HDF\r\n\x1a\n\0",
            "data in HDF5",
            "h5py",
        ),
        (
            &["a.csv"],
            b"version https://git-lfs.github.com/spec/v1\noid sha256:1\nsize 12\n",
            "a pointer of Git LFS",
            "git lfs pull",
        ),
    ] {
        for name in names {
            let message = found(name, bytes);
            let start = format!("found \"{name}\", {kind}");
            assert!(
                message.starts_with(&start) && message.contains(tool),
                "{name}: {message}"
            );
        }
    }
}

/// A file with the ending of another kind and rows of numbers is read all the same.
#[test]
fn tables_with_other_endings_are_tables() {
    for (name, text) in [
        ("a.data", "x y z\n1 2 3\n4 5 6\n"),
        ("a.out", "# by hand\nelement;x;y;z\nC;1;2;3\nC;4;5;6\n"),
        ("a.top", "1,2,3\n4,5,6\n"),
        ("a.out", "# by hand\nelement;x;y;z\nC;1;2;3\nC;4;5;6\n"),
        ("a.mol", "2\n\nC 1 2 3\nC 4 5 6\n"),
        ("a", "# solid argon\n1 2 3\n4 5 6\n"),
        (
            "a.pdbx",
            "# by hand\n\ndata_a\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n1 2 3\n4 5 6\n#\n",
        ),
        (
            "a",
            "# by hand\ndata_a\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n1 2 3\n4 5 6\n#\n",
        ),
    ] {
        let found = spheres(&scene(name, text, "radius: 1"));
        assert_eq!(
            found,
            [[1.0, 2.0, 3.0, 1.0], [4.0, 5.0, 6.0, 1.0]],
            "{name}"
        );
    }
}

#[test]
fn sections_of_dumps_that_say_nothing_of_spheres_are_passed_over() {
    let dump = "ITEM: TIMESTEP\n1000\nITEM: LABEL\nrun1\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n\
                ITEM: NOTES\na\nb\nITEM: ATOMS id x y z radius\n1 1 2 3 0.5\n";
    let found = spheres(&scene("a.liggghts", dump, ""));
    assert_eq!(found, [[1.0, 2.0, 3.0, 0.5]]);
}
