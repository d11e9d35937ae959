//! Formats of programs that simulate atoms.

use super::*;

pub(super) const LAMMPS: &str = "ITEM: TIMESTEP
0
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS xy xz yz pp pp pp
-1 11 2
0 5 0
0 4 1
ITEM: ATOMS id type xs ys zs radius
1 1 0 0 0 0.5
2 2 1 1 1 0.25
";

#[test]
fn dumps_of_lammps_are_read() {
    // The bounds -1..11 contain the tilt of 2, and 0..5 that of 1: the edges are (10, 0, 0), (2, 4, 0), (0, 1, 4).
    let found = spheres(&scene("a.dump", LAMMPS, ""));
    assert_eq!(found, [[-1.0, 0.0, 0.0, 0.5], [11.0, 5.0, 4.0, 0.25]]);
    let unwrapped = LAMMPS.replace("xs ys zs", "xu yu zu");
    let found = spheres(&scene("a.lammpstrj", &unwrapped, ""));
    assert_eq!(found, [[0.0, 0.0, 0.0, 0.5], [1.0, 1.0, 1.0, 0.25]]);
    let general = LAMMPS
        .replace("xy xz yz pp pp pp", "abc origin pp pp pp")
        .replace("-1 11 2\n0 5 0\n0 4 1", "1 2 0 5\n0 1 0 6\n0 0 1 7");
    let found = spheres(&scene("a.dump", &general, ""));
    assert_eq!(found, [[5.0, 6.0, 7.0, 0.5], [6.0, 9.0, 8.0, 0.25]]);
    let kept = spheres(&scene("a.txt", LAMMPS, "keep: [(\"type\", Is(2))]"));
    assert_eq!(kept, [[11.0, 5.0, 4.0, 0.25]]);
    for (text, expected) in [
        (
            LAMMPS.replace("\n2\n", "\n3\n"),
            "a.dump:12:1: expected 3 atoms, according to `ITEM: NUMBER OF ATOMS` (2 read), \
             found the end of the file",
        ),
        (
            LAMMPS.replace("0 4 1", "0 4"),
            "a.dump:8:1: expected 3 numbers of the box, found 0 4",
        ),
        (
            LAMMPS.replace("ITEM: NUMBER OF ATOMS\n2\n", ""),
            "a.dump:7:1: expected `ITEM: NUMBER OF ATOMS` before, found `ITEM: ATOMS id type xs ys zs radius`",
        ),
        (
            LAMMPS.replace("1 1 0 0 0 0.5", "1 1 0 x 0 0.5"),
            "a.dump:10:7: expected a number for `ys`, found `x`",
        ),
        (
            LAMMPS.replace(" radius", " q"),
            "a.dump:9:1: expected a column `radius`, or else `radius: …` in the scene, found `id`, `type`, `xs`, `ys`, `zs`, `q`",
        ),
    ] {
        assert_eq!(refusal("a.dump", text, ""), expected);
    }
}

#[test]
fn gro_is_in_nanometers_and_names_tell_elements() {
    let text = "Water and an ion
    4
    1SOL     OW    1   0.100   0.200   0.300  0.1000  0.2000  0.3000
    1SOL    HW1    2   0.150   0.200   0.300
    2ALA     CA    3   1.000   1.000   1.000
    3CL      CL    4  -1.000   0.000   0.000
   2.0 2.0 2.0
";
    let scene = scene("a.gro", text, "");
    let expected = [
        [0.1, 0.2, 0.3, 0.152],
        [0.15, 0.2, 0.3, 0.11],
        [1.0, 1.0, 1.0, 0.17],
        [-1.0, 0.0, 0.0, 0.175],
    ];
    for (found, expected) in spheres(&scene).iter().zip(expected) {
        assert!(
            (0..4).all(|index| (found[index] - expected[index]).abs() < 1e-12),
            "{found:?}"
        );
    }
    let wide = "t\n1\n    1SOL     OW    1   0.10001   0.20002   0.30003\n 1 1 1\n";
    let found = spheres(&self::scene("a.gro", wide, "radius: 1"));
    assert_eq!(found, [[0.10001, 0.20002, 0.30003, 1.0]]);
}

pub(super) const PDB: &str = "HEADER    A SMALL THING
MODEL        1
ATOM      1  N   ALA A   1      11.104   6.134  -6.504  1.00 10.00           N
ATOM      2  CA  ALA A   1      11.639   6.071  -5.147  1.00 20.00           C
HETATM    3 CA    CA B   2       0.000   0.000   0.000  1.00 30.00
ENDMDL
MODEL        2
ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00 10.00           N
ENDMDL
END
";

#[test]
fn pdb_is_read_model_by_model() {
    let first = scene("a.pdb", PDB, "");
    let found = spheres(&first);
    assert_eq!(found.len(), 3);
    assert_eq!(found[1][..3], [11.639, 6.071, -5.147]);
    // Nitrogen, the alpha carbon, and calcium by the place of its name.
    let radii: Vec<f64> = found.iter().map(|sphere| sphere[3]).collect();
    assert_eq!(radii, [1.55, 1.7, 2.31]);
    assert_eq!(
        first.warnings(),
        ["a.pdb: the first frame of several is shown (`frames: All` shows them one after another)"]
    );
    let kept = spheres(&scene("a.pdb", PDB, "keep: [(\"chain\", Is(\"B\"))]"));
    assert_eq!(kept.len(), 1);
    let kept = spheres(&scene(
        "a.ent",
        PDB,
        "keep: [(\"b_factor\", Between(15, 25))]",
    ));
    assert_eq!(kept.len(), 1);
    let folder = Folder::new();
    fs::write(folder.0.join("a.pdb"), PDB).unwrap();
    let text = "(image: (width: 6, height: 4), lens: Fov(90), camera: Free(),
        clouds: [(file: \"a.pdb\", frames: All)])";
    let series = Scene::parse(text, &folder.0.join("scene.ron")).unwrap();
    let count = |frame| series.world_at(frame).unwrap().spheres().len();
    assert_eq!(
        (series.frames(), count(1), count(2), count(3)),
        (Some(1..=2), 3, 1, 1)
    );
}

#[test]
fn mmcif_is_read_model_by_model() {
    let row = |model: u32, x: f64| format!("ATOM {x} 2 3 C 'C A' \"x 'y\" {model}\n");
    let text = format!(
        "data_1ABC\n_entry.id 1ABC\n_text\n;\nloop_\n_atom_site.Cartn_x\n;\nloop_\n_atom_site.group_PDB\n\
         _atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.type_symbol\n\
         _atom_site.label_comp_id\n_atom_site.note\n_atom_site.pdbx_PDB_model_num\n{}{}{}#\nloop_\n_x.y\n1\n",
        row(1, 1.5),
        row(1, 2.5),
        row(2, 3.5)
    );
    let expected = [[1.5, 2.0, 3.0, 1.7], [2.5, 2.0, 3.0, 1.7]];
    assert_eq!(spheres(&scene("a.cif", &text, "")), expected);
    let residue = "keep: [(\"residue\", Is(\"C A\"))]";
    assert_eq!(spheres(&scene("a.cif", &text, residue)), expected);
}

/// Dictionaries of components have coordinates of a model and, behind these, ideal ones.
#[test]
fn chemical_components_are_molecules() {
    let component = "data_HOH\n_chem_comp.id HOH\nloop_\n_chem_comp_atom.comp_id\n_chem_comp_atom.atom_id\n\
        _chem_comp_atom.type_symbol\n_chem_comp_atom.model_Cartn_x\n_chem_comp_atom.model_Cartn_y\n\
        _chem_comp_atom.model_Cartn_z\n_chem_comp_atom.pdbx_model_Cartn_x_ideal\nHOH O O -23.107 18.401 -21.626 -0.064\n\
        HOH H1 H -22.157 18.401 -21.626 0.512\n#\n";
    let water = scene("a.cif", component, "");
    let expected = [
        [-23.107, 18.401, -21.626, 1.52],
        [-22.157, 18.401, -21.626, 1.1],
    ];
    assert_eq!(spheres(&water), expected);
    assert_eq!(warnings(&water), "");
    // The libraries of refinement programs name the coordinates so.
    let names = component
        .replace("pdbx_model_Cartn_x_ideal", "charge")
        .replace("model_Cartn_", "");
    assert_eq!(spheres(&scene("a.cif", names, "")), expected);
    // A structure may have components before and behind it, and components need no coordinates.
    let structure = "loop_\n_atom_site.type_symbol\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\nC 1 2 3\n#\n";
    for text in [
        format!("{component}{structure}"),
        format!("data_a\n{structure}{component}"),
        format!("{}{structure}", component.replace("artn_x", "artn_u")),
    ] {
        let structure = scene("a.cif", &text, "");
        assert_eq!(spheres(&structure), [[1.0, 2.0, 3.0, 1.7]]);
        assert_eq!(warnings(&structure), "");
    }
    let nothing = component.replace("artn_x", "artn_u");
    assert!(
        refusal("a.cif", nothing, "").contains("or of `_chem_comp_atom.model_Cartn_x` and others")
    );
}
