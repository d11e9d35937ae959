//! The kinds of files that are not read, with their endings and first bytes.

/// A kind of file that is not read.
#[derive(Debug, Eq, PartialEq)]
pub(crate) struct Foreign {
    /// Its name, with its article.
    pub(crate) kind: &'static str,
    /// A program that makes a table of it, and how.
    pub(crate) remedy: &'static str,
    /// The endings of the names of such files.
    pub(super) endings: &'static [&'static str],
    /// Bytes with which one starts, each at its place.
    pub(super) magic: &'static [(usize, &'static [u8])],
}

const TRAJECTORY: &str =
    "save it as extended XYZ, PDB or a LAMMPS dump, with MDAnalysis, MDTraj or ASE";
const MOLECULE: &str =
    "save the atoms as XYZ or PDB, with Open Babel (`obabel FILE -O atoms.xyz`) or ASE";
const CELL: &str = "save it as XYZ with ASE (`ase convert FILE atoms.extxyz`), or with OVITO";
const GRID: &str = "save the data as CSV, VTU or legacy VTK, in ParaView by File > Save Data";
const COLUMNS: &str = "save the columns as NPY, NPZ or CSV, with Python (h5py, pandas or astropy)";
const SHEET: &str = "save the sheet as CSV, with LibreOffice (`soffice --convert-to csv FILE`)";
const POINTS: &str = "save the points as PLY or CSV, with CloudCompare or MeshLab";

/// Kinds that the endings of names tell, or the first bytes.
pub(super) const KINDS: &[Foreign] = &[
    of(
        "an LZ4 file",
        "decompress it (`unlz4 FILE`), or compress the table by gzip",
        &["lz4"],
        &[(0, b"\x04\x22\x4d\x18")],
    ),
    of(
        "an archive",
        "unpack it",
        &["tar", "tgz", "zip", "7z", "rar"],
        &[(257, b"ustar"), (0, b"7z\xbc\xaf\x27\x1c"), (0, b"Rar!")],
    ),
    of(
        "a trajectory of GROMACS (TRR)",
        TRAJECTORY,
        &["trr"],
        &[(0, b"\0\0\x07\xc9")],
    ),
    of("a trajectory of GROMACS (TNG)", TRAJECTORY, &["tng"], &[]),
    of(
        "a trajectory of Amber, or other data in NetCDF",
        TRAJECTORY,
        &["nc", "ncdf", "cdf"],
        &[(0, b"CDF\x01"), (0, b"CDF\x02"), (0, b"CDF\x05")],
    ),
    of(
        "a trajectory of ASE",
        TRAJECTORY,
        &["traj"],
        &[(0, b"- of Ulm")],
    ),
    of("a trajectory in HDF5 (H5MD)", TRAJECTORY, &["h5md"], &[]),
    of(
        "a structure in MMTF",
        "fetch it as mmCIF (https://files.rcsb.org/download/ID.cif), or save it as PDB with PyMOL or Biopython",
        &["mmtf"],
        &[],
    ),
    of(
        "a structure in BinaryCIF",
        "fetch it as mmCIF (https://files.rcsb.org/download/ID.cif)",
        &["bcif"],
        &[],
    ),
    of("a molecule in CML", MOLECULE, &["cml"], &[]),
    of("a cube file of Gaussian", MOLECULE, &["cube", "cub"], &[]),
    of(
        "coordinates of GROMOS",
        TRAJECTORY,
        &["g96", "cnf", "trc", "trj", "omd"],
        &[(0, b"TITLE\n"), (0, b"TITLE\r\n")],
    ),
    of(
        "a structure of DL_POLY",
        TRAJECTORY,
        &["config", "revcon", "history"],
        &[],
    ),
    of("a structure of Tinker", TRAJECTORY, &["arc", "txyz"], &[]),
    of(
        "coordinates of Amber, CHARMM or NAMD",
        TRAJECTORY,
        &["crd", "inpcrd", "rst7", "ncrst", "rst", "coor", "mdcrd"],
        &[],
    ),
    of(
        "a molecule of Schrodinger or Materials Studio",
        MOLECULE,
        &["mae", "maegz", "car", "msi", "bgf"],
        &[],
    ),
    of(
        "an input or an output of quantum chemistry",
        MOLECULE,
        &[
            "gjf", "com", "inp", "log", "out", "nwi", "nwo", "coord", "molden", "fchk", "chk",
        ],
        &[(0, b"$coord")],
    ),
    of(
        "a structure of another program for crystals",
        CELL,
        &["cell", "res", "pwi", "pwo", "gen", "cfg", "castep", "cssr"],
        &[],
    ),
    of("a structure in XSF", CELL, &["xsf", "axsf"], &[]),
    of(
        "a charge density of VASP",
        CELL,
        &["chgcar", "parchg", "locpot"],
        &[],
    ),
    of(
        "a topology without positions",
        "name the file of the positions, or save both as PDB with MDAnalysis",
        &["psf", "prmtop", "parm7", "top", "itp"],
        &[(0, b"%VERSION")],
    ),
    of(
        "an input of GROMACS (TPR)",
        "save its positions as GRO (`gmx editconf -f FILE -o atoms.gro`)",
        &["tpr"],
        &[],
    ),
    of(
        "an XML file of VTK",
        GRID,
        &["vti", "vts", "vtr", "vtm", "pvtu", "pvtp"],
        &[],
    ),
    of(
        "a grid of another program",
        GRID,
        &[
            "exo", "cgns", "silo", "med", "msh", "case", "foam", "vtkhdf", "bp", "vdb",
        ],
        &[],
    ),
    of(
        "a scene of a program for animations",
        "save its points as PLY, with Blender or Houdini",
        &["abc", "usd", "usda", "usdc", "usdz", "blend", "bgeo"],
        &[
            (0, b"Ogawa"),
            (0, b"PXR-USDC"),
            (0, b"#usda"),
            (0, b"BLENDER"),
        ],
    ),
    of(
        "data in HDF5",
        COLUMNS,
        &["h5", "hdf5", "hdf", "he5"],
        &[(0, b"\x89HDF\r\n\x1a\n")],
    ),
    of("a table in Parquet", COLUMNS, &["parquet"], &[(0, b"PAR1")]),
    of(
        "a table of Arrow or Feather",
        COLUMNS,
        &["feather", "arrow"],
        &[(0, b"ARROW1"), (0, b"FEA1")],
    ),
    of("data of MATLAB", COLUMNS, &["mat"], &[(0, b"MATLAB 5.0")]),
    of(
        "a table in FITS",
        COLUMNS,
        &["fits", "fit"],
        &[(0, b"SIMPLE  =")],
    ),
    of("a pickle of Python", COLUMNS, &["pkl", "pickle"], &[]),
    of(
        "a database of SQLite",
        COLUMNS,
        &["sqlite", "db"],
        &[(0, b"SQLite format 3\0")],
    ),
    of(
        "a sheet",
        SHEET,
        &["xlsx", "xls", "ods"],
        &[(0, b"\xd0\xcf\x11\xe0")],
    ),
    of(
        "a cloud of points in LAS",
        POINTS,
        &["las", "laz"],
        &[(0, b"LASF")],
    ),
    of(
        "a cloud of points in PCD",
        POINTS,
        &["pcd"],
        &[(0, b"# .PCD")],
    ),
    of(
        "a cloud of points in E57",
        POINTS,
        &["e57"],
        &[(0, b"ASTM-E57")],
    ),
    of(
        "a mesh",
        POINTS,
        &["obj", "stl", "off", "gltf", "glb", "dae", "fbx"],
        &[(0, b"glTF")],
    ),
    of(
        "a picture",
        "name the table of the spheres",
        &["png", "jpg", "jpeg", "tif", "tiff", "exr", "gif"],
        &[
            (0, b"\x89PNG"),
            (0, b"\xff\xd8\xff"),
            (0, b"II*\0"),
            (0, b"MM\0*"),
            (0, b"v/1\x01"),
            (0, b"GIF8"),
        ],
    ),
    of(
        "a document in PDF",
        "name the table of the spheres",
        &["pdf"],
        &[(0, b"%PDF")],
    ),
    of(
        "a pointer of Git LFS",
        "fetch the file that it stands for (`git lfs pull`)",
        &[],
        &[(0, b"version https://git-lfs")],
    ),
    of(
        "a page in HTML",
        "a download may have failed: fetch the file again",
        &["html", "htm"],
        &[],
    ),
    of("data in JSON", COLUMNS, &["json"], &[]),
    of("an XML file", "save the spheres as CSV", &["xml"], &[]),
];

const fn of(
    kind: &'static str,
    remedy: &'static str,
    endings: &'static [&'static str],
    magic: &'static [(usize, &'static [u8])],
) -> Foreign {
    Foreign {
        kind,
        remedy,
        endings,
        magic,
    }
}
