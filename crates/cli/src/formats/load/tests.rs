use std::io::Cursor;
use std::ops::Range;

use ::exr::meta::MetaData;
use ::exr::meta::header::Header;

use super::*;
use crate::base::size::Size;
use crate::formats::encoding::{ExrOptions, PngOptions};
use crate::formats::png::write::write_grey;
use crate::formats::tests::{DIGEST, PNG, Scene, exr_bytes, png_bytes, render, size, tiff_bytes};
use crate::tests::temporary;

#[test]
fn refuses_what_is_no_picture() {
    let refusal = |bytes: &[u8]| decode(bytes).err().unwrap();
    const EXPECTED: &str = "expected a picture (PNG, EXR, NPY, NPZ, TIFF, JPEG, WebP, GIF, HDR, PNM, TGA, BMP \
                            or QOI), found";
    assert_eq!(refusal(b""), format!("{EXPECTED} an empty file"));
    assert_eq!(
        refusal(b"%PDF-1.7"),
        format!("{EXPECTED} a file that begins with `%PDF`")
    );
}

fn of(bytes: &[u8]) -> Option<(Hash, Region)> {
    contents_of(&Source::Memory(bytes.into())).ok()
}

fn files() -> Vec<Vec<u8>> {
    let image = render(Scene::Color, true);
    let each = [false, true];
    let pngs = each.map(|deep| png_bytes(&image, PngOptions { deep, ..PNG }));
    let exrs = each.map(|float| exr_bytes(&image, ExrOptions { float, error: true }));
    let tiffs = each.map(|float| tiff_bytes(&image, float));
    pngs.into_iter().chain(exrs).chain(tiffs).collect()
}

#[test]
fn whole_pictures_tell_their_digest() {
    let whole = Region::all(size(&render(Scene::Color, true)));
    for file in files() {
        assert_eq!(of(&file), Some((DIGEST, whole)));
    }
    let path = temporary("undigested.png");
    let (width, height) = (2, 1);
    write_grey(Size { width, height }, &path, &[], |codes| {
        codes.extend([0, 1]);
        Ok(())
    })
    .unwrap();
    assert!(contents(&path).is_err());
    std::fs::remove_file(&path).unwrap();
    assert!(contents(&path).is_err());
    assert!(contents(&std::env::temp_dir()).is_err());
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
    for file in &files()[2..4] {
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

/// Every byte of a PNG is protected by a checksum, including texts that decoders can ignore.
#[test]
fn no_byte_of_a_png_is_wrong_unnoticed() {
    for file in &files()[..2] {
        for place in 0..file.len() {
            let mut damaged = file.clone();
            damaged[place] ^= 0x10;
            assert_eq!(of(&damaged), None, "byte {place}");
        }
    }
}

/// The checksum of the pixels is checked on the decoded data: a chunk may be correct and contain wrong pixels.
#[test]
fn pixels_of_a_png_have_a_checksum_of_their_own() {
    const TYPE: &[u8] = b"IDAT";
    for mut file in files().into_iter().take(2) {
        let start = file.windows(4).position(|bytes| bytes == TYPE).unwrap();
        let length = u32::from_be_bytes(file[start - 4..start].try_into().unwrap()) as usize;
        let end = start + TYPE.len() + length;
        assert!(of(&file).is_some());
        file[end - 1] ^= 1;
        let sum = crc32fast::hash(&file[start..end]).to_be_bytes();
        file[end..end + 4].copy_from_slice(&sum);
        assert_eq!(of(&file), None);
    }
}

/// Compressed samples of an EXR have a checksum. Its header, its table of blocks, and blocks that compression would not
/// make shorter have none.
#[test]
fn samples_of_an_exr_are_as_good_as_their_checksum() {
    for file in &files()[2..4] {
        let samples = |file: &[u8]| {
            let mut rows = decode(file).unwrap();
            let size = rows.size;
            let mut values = Vec::new();
            for _ in 0..size.height {
                rows.row.advance().unwrap();
                values.extend((0..size.width).flat_map(|col| rows.row.rgba(col).map(f64::to_bits)));
            }
            values
        };
        let mut rest = Cursor::new(&file);
        let meta = MetaData::read_from_buffered(&mut rest, false).unwrap();
        let start = rest.position() as usize;
        let plain = plain_blocks(file, start, &meta.headers[0]);
        let (whole, mut found, mut wrong) = (samples(file), 0, 0);
        for place in start..file.len() {
            let mut damaged = file.clone();
            damaged[place] ^= 0x10;
            match of(&damaged) {
                None => found += 1,
                Some(_) if plain.iter().any(|block| block.contains(&place)) => {}
                Some(_) => wrong += usize::from(samples(&damaged) != whole),
            }
        }
        // Some bits of what deflate writes have no meaning.
        let all = file.len() - start - plain.iter().map(Range::len).sum::<usize>();
        assert!(100 * found >= 99 * all, "{found} of {all}");
        // Adler-32 is weak on so few bytes: zlib itself reads byte 3328 of the first file, damaged, with the right sum.
        assert!(1000 * wrong <= all, "{wrong} of {all}");
    }
}

/// The ranges of samples in uncompressed blocks, in a file whose header ends at `start`.
fn plain_blocks(file: &[u8], start: usize, header: &Header) -> Vec<Range<usize>> {
    const BEFORE_SAMPLES: usize = 8;
    let row_bytes = header.layer_size.width() * header.channels.bytes_per_pixel;
    let rows = header.compression.scan_lines_per_block();
    let mut place = start + BEFORE_SAMPLES * header.chunk_count;
    let mut plain = Vec::new();
    for block in 0..header.chunk_count {
        let size = file[place + 4..place + BEFORE_SAMPLES].try_into().unwrap();
        let samples = place + BEFORE_SAMPLES;
        let end = samples + u32::from_le_bytes(size) as usize;
        let rows = rows.min(header.layer_size.height() - rows * block);
        if end - samples == rows * row_bytes {
            plain.push(samples..end);
        }
        place = end;
    }
    plain
}

/// The strips of a TIFF have checksums, and the tags that say where they are have to be right.
#[test]
fn samples_of_a_tiff_are_as_good_as_their_checksum() {
    for file in &files()[4..] {
        let samples = |file: &[u8]| {
            let picture = decode(file).unwrap().whole().unwrap();
            picture.rgba.concat()
        };
        let description = file.windows(8).position(|bytes| bytes == b"Digest: ");
        // Strips lie between the header and what the directory refers to, the kinds of the four samples first.
        let end = description.unwrap() - 8;
        let whole = samples(file);
        let mut unnoticed = 0;
        for place in 0..end {
            let mut damaged = file.clone();
            damaged[place] ^= 0x10;
            if of(&damaged).is_some() {
                // What deflate copies may come from several places.
                assert_eq!(samples(&damaged), whole, "byte {place}");
                unnoticed += 1;
            }
        }
        assert!(100 * unnoticed <= end, "{unnoticed} of {end}");
    }
}
