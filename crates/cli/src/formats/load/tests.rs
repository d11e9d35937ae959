use std::io::Cursor;

use ::exr::meta::MetaData;

use super::*;
use crate::base::size::Size;
use crate::formats::encoding::{ExrOptions, PngOptions};
use crate::formats::png::write::write_grey;
use crate::formats::tests::{DIGEST, PNG, Scene, exr_bytes, png_bytes, render, size};
use crate::tests::temporary;

#[test]
fn refuses_what_is_no_picture() {
    let refusal = |bytes: &[u8]| decode(bytes).err().unwrap();
    assert_eq!(
        refusal(b""),
        "expected a PNG, EXR or NPY picture, found an empty file"
    );
    assert_eq!(
        refusal(b"\xff\xd8\xff\xe0JFIF"),
        "expected a PNG, EXR or NPY picture, found a file that begins with `\\xff\\xd8\\xff\\xe0`"
    );
}

fn of(bytes: &[u8]) -> Option<(Hash, Region)> {
    contents_of(&mut Cursor::new(bytes))
}

fn files() -> Vec<Vec<u8>> {
    let image = render(Scene::Color, true);
    let each = [false, true];
    let pngs = each.map(|deep| png_bytes(&image, PngOptions { deep, ..PNG }));
    let exrs = each.map(|float| exr_bytes(&image, ExrOptions { float, error: true }));
    pngs.into_iter().chain(exrs).collect()
}

#[test]
fn whole_pictures_tell_their_digest() {
    let whole = Region::all(size(&render(Scene::Color, true)));
    for file in files() {
        assert_eq!(of(&file), Some((DIGEST, whole)));
    }
    let path = temporary("undigested.png");
    let (width, height) = (2, 1);
    write_grey(Size { width, height }, &path, |codes| {
        codes.extend([0, 1]);
        Ok(())
    })
    .unwrap();
    assert_eq!(contents(&path), None);
    std::fs::remove_file(&path).unwrap();
    assert_eq!(contents(&path), None);
    assert_eq!(contents(&std::env::temp_dir()), None);
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
fn an_exr_without_the_place_of_its_last_block_is_not_whole() {
    for file in &files()[2..] {
        let meta = MetaData::read_from_buffered(Cursor::new(&file), false).unwrap();
        let blocks = meta.headers[0].chunk_count;
        assert_eq!(blocks, 2);
        let mut rest = Cursor::new(&file);
        MetaData::read_from_buffered(&mut rest, false).unwrap();
        let place = rest.position() as usize + 8;
        let mut file = file.clone();
        file[place..place + 8].fill(0);
        assert_eq!(of(&file), None);
    }
}
