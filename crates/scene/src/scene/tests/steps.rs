//! The steps of clouds: files that are some or nearly, tables that have none, and tables that change meanwhile.

use std::fs;

use super::series::{Folder, places, steps};
use crate::Scene;

#[test]
fn numbers_that_are_not_filled_up_are_steps() {
    let folder = Folder::new("unpadded");
    for number in [0, 500, 1000, 12500] {
        let text = format!("x,y,z,r\n{number},0,10,1\n");
        folder.write(&format!("dump{number}.csv"), &text);
    }
    let scene = folder.scene("(file: \"dump####.csv\")");
    let all: Vec<f64> = (1..=4).map(|frame| places(&scene, frame)[0]).collect();
    assert_eq!(all, [0.0, 500.0, 1000.0, 12500.0]);
    let gap = "dump####.csv: files are missing between the numbers 1000 and 12500 (most numbers are 500 apart): the \
               steps on both sides are shown one after the other";
    assert_eq!(scene.warnings(), [gap]);
    // Of steps that are not asked for nothing is said.
    let few = folder.scene("(file: \"dump####.csv\", steps: (0, 1000))");
    assert!(few.warnings().is_empty());
}

#[test]
fn files_that_are_nearly_steps_are_named() {
    let folder = Folder::new("near");
    steps(&folder);
    let row = "x,y,z,r\n0,0,10,1\n";
    for name in [
        "run.5.csv",
        "run.00030.csv",
        "run.0.5.csv",
        "Run.0040.CSV",
        "run.0050.csv.gz",
        "run.99999999999999999999.csv",
        "rerun.0001.csv",
    ] {
        folder.write(name, row);
    }
    let scene = folder.scene("(file: \"run.####.csv\")");
    assert_eq!(scene.clouds()[0].steps, Some(3));
    assert_eq!(
        scene.warnings(),
        [
            "run.####.csv: 5 files with similar names, not shown: \"Run.0040.CSV\", \"run.0.5.csv\", \
             \"run.00030.csv\", \"run.0050.csv.gz\" and 1 more",
            "run.####.csv: 1 file with numbers of more than 64 bits, not shown: \"run.99999999999999999999.csv\"",
        ]
    );
    let message = folder.load("(file: \"run.#####.csv.gz\")", "Free()", "");
    let message = message.unwrap_err();
    assert!(
        message.contains("found none (9 files with similar names: "),
        "{message}"
    );
}

/// The last file may be one that a program still writes.
#[test]
fn a_last_file_that_is_cut_is_in_doubt() {
    let folder = Folder::new("last");
    steps(&folder);
    let of = |text: &str| {
        folder.write("run.0020.csv", text);
        let warnings = folder
            .scene("(file: \"run.####.csv\")")
            .warnings()
            .join("; ");
        warnings
            .rsplit(['/', '\\'])
            .next()
            .unwrap_or_default()
            .to_owned()
    };
    assert_eq!(of("x,y,z,r,value\n0,0,10,1,5\n"), "");
    assert_eq!(
        of("x,y,z,r,value\n0,0,10,1,5\n4,0,10,1,4"),
        "run.0020.csv: the file ends within a line, unlike the first file: its last number may have been cut off"
    );
    let atom = "ATOM      1  N   ALA A   1      11.104   6.134  -6.504  1.00 10.00           N\n";
    for index in 0..3 {
        let end = if index < 2 { "END\n" } else { "" };
        folder.write(&format!("a{index}.pdb"), &format!("{atom}{end}"));
    }
    let warnings = folder.scene("(file: \"a#.pdb\")").warnings().join("; ");
    assert!(
        warnings.contains("a2.pdb:1: the file ends with an atom"),
        "{warnings}"
    );
}

/// Doubts in files that are read when their frames are shown are told then, once each.
#[test]
fn doubts_in_later_files_are_told_when_they_are_read() {
    let folder = Folder::new("later");
    let atom = "ATOM      1  N   ALA A   1      11.104   6.134  -6.504  1.00 10.00           N\n";
    for number in 1..=40 {
        let text = match number {
            2 => atom.to_owned(),
            3 => format!("{atom}END\n{atom}END\n"),
            _ => format!("{atom}END\n"),
        };
        folder.write(&format!("a{number:02}.pdb"), &text);
    }
    let scene = folder.scene("(file: \"a##.pdb\")");
    assert!(scene.warnings().is_empty() && scene.take_late_warnings().is_empty());
    for frame in [1, 2, 3, 2, 4] {
        scene.world_at(frame).unwrap();
    }
    let late = scene.take_late_warnings();
    assert_eq!(late.len(), 2, "{late:?}");
    let cut = "a02.pdb:1: the file ends with an atom";
    let several = "a03.pdb: the first frame of several is shown";
    assert!(
        late[0].contains(cut) && late[1].contains(several),
        "{late:?}"
    );
    scene.world_at(2).unwrap();
    assert!(scene.take_late_warnings().is_empty());
    // Of many the first, and how many there are.
    for number in 2..40 {
        folder.write(&format!("a{number:02}.pdb"), atom);
    }
    let scene = folder.scene("(file: \"a##.pdb\")");
    (1..=40).for_each(|frame| drop(scene.world_at(frame).unwrap()));
    let late = scene.take_late_warnings();
    assert_eq!(
        (late.len(), &*late[20]),
        (21, "18 more warnings about later steps")
    );
}

#[test]
fn tables_without_frames_say_so() {
    let folder = Folder::new("frameless");
    folder.write("a.csv", "frame,x,y,z,r\n0,0,0,0,1\n1,0,0,1,1\n");
    folder.write("a.vtk", "# vtk DataFile Version 3.0\n");
    for (name, format) in [("a.csv", "CSV"), ("a.vtk", "legacy VTK")] {
        let message = folder.load(&format!("(file: \"{name}\", frames: All)"), "Free()", "");
        let message = message.unwrap_err();
        let expected = format!(
            "expected a table with frames for `frames: All`, found \"{name}\", whose format ({format}) has no frames"
        );
        assert!(message.contains(&expected), "{message}");
    }
}

#[test]
fn models_of_mmcif_are_frames() {
    let folder = Folder::new("models");
    let row = |x: u32, model: u32| format!("C {x} 0 0 {model}\n");
    let start = "data_x\nloop_\n_atom_site.type_symbol\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n\
                 _atom_site.pdbx_PDB_model_num\n";
    let all = [row(1, 1), row(2, 1), row(3, 2), row(4, 2), row(5, 3)].concat();
    folder.write("a.cif", &format!("{start}{all}#\n"));
    folder.write("one.cif", &format!("{start}{}#\n", row(7, 1)));
    let scene = folder.scene("(file: \"a.cif\", frames: All)");
    let expected = [&[1.0, 2.0][..], &[3.0, 4.0], &[5.0]];
    for frame in [1, 3, 2, 1, 1, 2, 3] {
        assert_eq!(places(&scene, frame), expected[frame as usize - 1]);
    }
    let one = folder.scene("(file: \"one.cif\", frames: All)");
    assert_eq!(
        (one.clouds()[0].steps, places(&one, 1)),
        (Some(1), vec![7.0])
    );
}

/// A table that another program writes meanwhile is refused: its steps would be those of two tables.
#[test]
fn tables_that_change_are_refused() {
    let folder = Folder::new("changed");
    let frame = |x: u32| format!("1\n\nC {x} 0 0\n");
    let run = [1, 2, 3].map(frame).concat();
    let refused = |scene: &Scene, frame: i32| {
        let error = scene.world_at(frame).unwrap_err();
        assert!(error.is_of_changed_table(), "{error}");
        let message = error.to_string();
        assert!(
            message.contains("to stay the same while its frames are rendered, found a change"),
            "{message}"
        );
    };
    let later = |name: &str| {
        let file = fs::File::options()
            .append(true)
            .open(folder.0.join(name))
            .unwrap();
        let time = file.metadata().unwrap().modified().unwrap();
        file.set_modified(time + std::time::Duration::from_secs(1))
            .unwrap();
    };
    folder.write("run.xyz", &run);
    let cloud = "(file: \"run.xyz\", frames: All)";
    let scene = folder.scene(cloud);
    assert_eq!(places(&scene, 1), [1.0]);
    // In place, with a size that is the same.
    folder.write("run.xyz", &run.replace("C 2", "C 9"));
    later("run.xyz");
    refused(&scene, 2);
    refused(&scene, 1);
    let again = folder.scene(cloud);
    assert_eq!(places(&again, 2), [9.0]);
    folder.write("run.xyz", &(run.clone() + "1\n"));
    refused(&again, 3);
    // Another file of that name.
    folder.write("run.xyz", &run);
    let again = folder.scene(cloud);
    folder.write("new.xyz", &run);
    fs::rename(folder.0.join("new.xyz"), folder.0.join("run.xyz")).unwrap();
    refused(&again, 1);
    // A file for each step, one of which was read for its numbers.
    steps(&folder);
    let series = folder.scene("(file: \"run.####.csv\", value: \"value\")");
    folder.write("run.0010.csv", "x,y,z,r,value\n0,0,10,1,5\n");
    refused(&series, 2);
    assert_eq!(places(&series, 3), [0.0, 4.0]);
}
