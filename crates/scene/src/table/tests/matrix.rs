//! Every format by the ending of its name: cut within its last frame, and with another checksum. `hands` has the matrix of
//! their axes.

use super::super::{ENDINGS, Format};
use super::compressed::{gzip, xz, zstandard};
use super::hands::{CORNERS, table};
use super::*;
use super::{atoms, collections, cut, gsd, trajectories};

/// The ways in which a format tells that its last frame is cut.
enum Ends {
    /// At every byte: it is refused or said, or what is shown are whole frames.
    AtBytes,
    /// At the end of every line: numbers in its last line may be cut unsaid.
    AtLines,
    /// Not at all, as `docs/particles.md` says.
    Untold,
}

/// Two frames of a format that has frames, or one table of another one, and the place at which the last frame begins.
fn frames(ending: &str, format: Format) -> (Vec<u8>, usize, Ends) {
    let (whole, _) = table(ending);
    let model = |number: u32, rows: &str| format!("MODEL     {number:4}\n{rows}ENDMDL\n");
    let twice = |text: &[u8]| ([text, text].concat(), text.len(), Ends::AtBytes);
    let text = String::from_utf8_lossy(&whole).into_owned();
    match format {
        Format::Csv | Format::Text => (whole, 0, Ends::Untold),
        Format::Xyz | Format::Lammps | Format::Gro | Format::Mol2 | Format::Sdf => twice(&whole),
        Format::LammpsData => (whole, 0, Ends::AtBytes),
        Format::Pdb | Format::Pqr => {
            let first = model(1, &text);
            let start = first.len();
            (
                (first + &model(2, &text) + "END\n").into_bytes(),
                start,
                Ends::AtBytes,
            )
        }
        Format::MmCif => {
            let (header, rows) = text.split_at(text.find("\n5 ").unwrap() + 1);
            let of_model = |model: u32| -> String {
                let rows = rows.lines().filter(|row| *row != "#");
                rows.map(|row| format!("{row} {model}\n")).collect()
            };
            let first = format!("{header}_atom_site.pdbx_PDB_model_num\n{}", of_model(1));
            let start = first.len();
            let all = first + &of_model(2) + "#\n";
            (all.into_bytes(), start, Ends::AtBytes)
        }
        Format::Npy => {
            let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 4, 3)}";
            let rows: Vec<f64> = (0..24).map(f64::from).collect();
            let all = npy(header, &doubles(&rows));
            let start = all.len() - 96;
            (all, start, Ends::AtBytes)
        }
        Format::Vasp => {
            let first = text.replace("Cartesian", "Direct configuration= 1");
            let (header, _) = text.split_at(text.find("Cartesian").unwrap());
            let second = first[header.len()..].replace("= 1", "= 2");
            let start = first.len();
            ((first + &second).into_bytes(), start, Ends::AtBytes)
        }
        Format::Gsd => {
            let all = gsd::file(&CORNERS, 2);
            let start = all.len() - 96;
            (all, start, Ends::AtBytes)
        }
        Format::Xtc => {
            let all = trajectories::xtc(&CORNERS, 2);
            let start = all.len() / 2;
            (all, start, Ends::AtBytes)
        }
        Format::Pvd => {
            let [first, second] = ["0", "1"].map(|time| (time, collections::CORNERS_VTU));
            let all = collections::collection(&[first, second]);
            let start = all.rfind("<DataSet").unwrap();
            (all.into_bytes(), start, Ends::AtBytes)
        }
        Format::Dcd => {
            let all = trajectories::dcd(&CORNERS, 2);
            let start = all.len() - 72;
            (all, start, Ends::AtBytes)
        }
        Format::Npz | Format::VtkXml => (whole, 0, Ends::AtBytes),
        Format::Ply | Format::Vtk => (whole, 0, Ends::AtLines),
    }
}

#[test]
fn every_format_is_cut() {
    let mut last = None;
    for (ending, format) in ENDINGS {
        if last.replace(format) == Some(format) {
            // Another ending of the same format.
            continue;
        }
        let name = format!("a.{ending}");
        let (bytes, start, ends) = frames(ending, format);
        let has_frames = start > 0;
        let fields = match has_frames {
            true => "radius: 1, frames: All",
            false => "radius: 1",
        };
        match ends {
            Ends::AtBytes => cut::check(&name, &bytes, start, fields),
            Ends::AtLines => {
                let (whole, is_doubted) = cut::shown(&name, &bytes, fields).unwrap();
                assert!(!is_doubted, "{name} is whole");
                let ends = (1..bytes.len()).filter(|end| bytes[end - 1] == b'\n');
                for end in ends {
                    if let Ok((found, false)) = cut::shown(&name, &bytes[..end], fields) {
                        assert_eq!(found, whole, "{name} cut at byte {end}");
                    }
                }
            }
            Ends::Untold => {
                let page = include_str!("../../../../../docs/particles.md");
                let row = page
                    .lines()
                    .find(|line| line.starts_with("| CSV and other text | none |"));
                assert!(
                    row.is_some_and(|row| row.contains("not detectable")),
                    "{name}"
                );
            }
        }
    }
    // Of several frames the first alone is read, unless the scene asks for all: what is cut behind it is said, too.
    let (bytes, _) = table("xyz");
    let cut = [&bytes[..], b"4\n"].concat();
    let scene = load("a.xyz", cut, "").unwrap();
    assert!(!scene.warnings().is_empty());
    let cut = &atoms::LAMMPS[..atoms::LAMMPS.len() - 20];
    assert!(
        load("a.dump", [atoms::LAMMPS, cut].concat(), "")
            .is_ok_and(|scene| !scene.warnings().is_empty())
    );
}

/// A file with a single frame, in every format that has frames, can be read any number of times.
#[test]
fn one_frame_is_a_step() {
    for (ending, _) in ENDINGS {
        let name = format!("a.{ending}");
        let (mut bytes, _) = table(ending);
        if ending == "npy" {
            let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 4, 3)}";
            bytes = npy(header, &doubles(&[1.5; 12]));
        }
        match cut::shown(&name, &bytes, "radius: 1, frames: All") {
            Ok((steps, _)) => assert!(steps.len() == 1 && steps[0].len() == 4, "{name}"),
            Err(message) => assert!(message.contains("has no frames"), "{message}"),
        }
    }
}

/// A bit of every byte of every checksum, of every format, however it is compressed.
#[test]
fn every_checksum_is_compared() {
    let mut last = None;
    for (ending, format) in ENDINGS {
        if last.replace(format) == Some(format) {
            // Another ending of the same format.
            continue;
        }
        let (bytes, _) = table(ending);
        if !format.may_be_compressed() {
            // They are not compressed. An NPZ has checksums of its own, which `checksums_of_archives_are_compared` looks at.
            continue;
        }
        // Of gzip a checksum and a size.
        // Of xz the whole end of the stream.
        for (compression, whole, sums) in [
            ("gz", gzip(&bytes), 8),
            ("xz", xz(&bytes), 12),
            ("zst", zstandard(&bytes), 4),
        ] {
            let name = format!("a.{ending}.{compression}");
            assert!(load(&name, &whole, "radius: 1").is_ok(), "{name} is whole");
            for place in whole.len() - sums..whole.len() {
                let mut damaged = whole.clone();
                damaged[place] ^= 1 << (place % 8);
                let refused = load(&name, &damaged, "radius: 1").err();
                let refused =
                    refused.unwrap_or_else(|| panic!("{name}: byte {place} is not looked at"));
                assert!(refused.contains("damaged"), "{refused}");
            }
        }
    }
}
