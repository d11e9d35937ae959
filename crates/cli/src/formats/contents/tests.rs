use std::io::Cursor;

use super::*;
use crate::formats::tests::{DIGEST, Scene, exr, png, render};
use crate::formats::{ExrOptions, PngOptions};

fn of(bytes: &[u8]) -> Option<Content> {
    let mut file = Cursor::new(bytes);
    if bytes.starts_with(EXR_MAGIC) {
        of_exr(&mut file)
    } else {
        of_png(&mut file)
    }
}

fn files() -> Vec<Vec<u8>> {
    let image = render(Scene::Color, true);
    let each = [false, true];
    let pngs = each.map(|deep| png(&image, PngOptions { deep, rgb: false }));
    let exrs = each.map(|float| exr(&image, ExrOptions { float, error: true }));
    pngs.into_iter().chain(exrs).collect()
}

#[test]
fn whole_pictures_tell_their_digest() {
    for file in files() {
        assert_eq!(of(&file), Some((DIGEST, None)));
    }
    let name = format!("marbles-{}-undigested.png", std::process::id());
    let path = std::env::temp_dir().join(name);
    crate::formats::write_codes(2, 1, &[0, 1], &path).unwrap();
    assert_eq!(content(&path), None);
    std::fs::remove_file(&path).unwrap();
    assert_eq!(content(&path), None);
    assert_eq!(content(&std::env::temp_dir()), None);
}

#[test]
fn pictures_that_end_early_or_late_are_not_whole() {
    for mut file in files() {
        for length in 0..file.len() {
            assert_eq!(of(&file[..length]), None, "{length} of {}", file.len());
        }
        file.push(0);
        assert_eq!(of(&file), None);
    }
}

#[test]
fn a_wrong_byte_in_a_png_is_found() {
    for file in &files()[..2] {
        for place in 0..file.len() {
            let mut file = file.clone();
            file[place] ^= 0x10;
            assert_eq!(of(&file), None, "{place}");
        }
    }
}

#[test]
fn an_exr_without_the_places_of_its_blocks_is_not_whole() {
    for file in &files()[2..] {
        let meta = MetaData::read_from_buffered(Cursor::new(&file), false).unwrap();
        let blocks = meta.headers[0].chunk_count;
        assert_eq!(blocks, 2);
        let mut rest = Cursor::new(&file);
        MetaData::read_from_buffered(&mut rest, false).unwrap();
        let table = rest.position() as usize;
        for place in [table, table + 8] {
            let mut file = file.clone();
            file[place..place + 8].fill(0);
            assert_eq!(of(&file), None);
        }
    }
}

#[test]
fn an_exr_whose_blocks_say_other_rows_is_not_whole() {
    for file in &files()[2..] {
        let mut rest = Cursor::new(file);
        MetaData::read_from_buffered(&mut rest, false).unwrap();
        let table = rest.position() as usize;
        let (offsets, _) = file[table..table + 16].as_chunks();
        for block in offsets.iter().copied().map(u64::from_le_bytes) {
            let mut file = file.clone();
            // A block begins with the number of its first row.
            file[block as usize] ^= 1;
            assert_eq!(of(&file), None);
        }
    }
}
