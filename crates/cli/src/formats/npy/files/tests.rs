use std::fs::{self, File};
use std::io::Read;

use marbles_core::{Image, Window};

use super::*;
use crate::base::region::Region;
use crate::base::size::Size;
use crate::formats::encoder::{Encoder, Piece};
use crate::formats::encoding::Encoding;
use crate::formats::load;
use crate::formats::npy::array::Array;
use crate::formats::npy::npz;
use crate::formats::npy::rows::Rows;
use crate::formats::tests::{DIGEST, Scene, facts, render, size};
use crate::tests::temporary;

/// Writes a picture, and returns the paths of its files.
fn write(image: &Image, region: Region, error: bool, name: &str) -> Vec<(PathBuf, Hash)> {
    let options = NpyOptions {
        error,
        archive: false,
        evidence: false,
    };
    write_as(image, region, options, name)
}

fn write_as(
    image: &Image,
    region: Region,
    options: NpyOptions,
    name: &str,
) -> Vec<(PathBuf, Hash)> {
    let form = Form {
        region,
        channels: image.channels(),
        alpha: image.has_alpha(),
        centers: None,
    };
    let encoder = Encoder::new(Encoding::Npy(options), form, &[]);
    let path = temporary(name);
    let mut pieces = (0..encoder.pieces()).map(|index| {
        let first = index * encoder.rows();
        let rows = first..image.height().min(first + encoder.rows());
        let mut samples = vec![0; encoder.sample_bytes(index)];
        assert_eq!(encoder.encode(0, &mut samples, 0, image, rows), 0);
        encoder.piece(index, samples)
    });
    let file = save::begin(&path).unwrap();
    let written = encoder.write(&facts(), &path, file, || pieces.next(), || None, || Ok(()));
    assert!(written.is_ok());
    encoder.files(&path, &DIGEST)
}

/// The region of a larger picture that an image is.
fn part_of_a_picture(image: &Image) -> Region {
    let window = Window {
        col: 5,
        row: 7,
        width: image.width(),
        height: image.height(),
    };
    let whole = Size {
        width: 100,
        height: 200,
    };
    Region::new(window, whole).unwrap()
}

/// The numbers of a file, and its array.
fn read(path: &Path) -> (Array, Vec<f64>) {
    let mut rows = Rows::begin(File::open(path).unwrap()).unwrap();
    let mut numbers = Vec::new();
    while let Some(row) = rows.next().unwrap() {
        let (row, _) = row.as_chunks();
        numbers.extend(row.iter().map(|number| f64::from_le_bytes(*number)));
    }
    (rows.array(), numbers)
}

#[test]
fn doubles_come_back_to_the_bit() {
    for scene in [Scene::Grey, Scene::Color, Scene::Bright] {
        for (alpha, error) in [(false, true), (true, true), (true, false)] {
            let image = render(scene, alpha);
            let name = format!("bits_{scene:?}_{alpha}_{error}.npy");
            let files = write(&image, Region::all(size(&image)), error, &name);
            assert_eq!(files.len(), if error { 2 } else { 1 });

            let (array, numbers) = read(&files[0].0);
            let count = if alpha { 4 } else { 3 };
            assert_eq!((array.size, array.channels), (size(&image), Some(count)));
            let places = size(&image).places();
            let count = count as usize;
            let light = places.flat_map(|(col, row)| image.rgba(col, row).into_iter().take(count));
            assert!(numbers.into_iter().eq(light));

            if error {
                let name = files[1].0.file_name().unwrap().to_str().unwrap();
                assert!(name.ends_with("_true_error.npy"), "{name}");
                let (array, numbers) = read(&files[1].0);
                assert_eq!((array.size, array.channels), (size(&image), None));
                let errors = size(&image).places();
                let errors = errors.map(|(col, row)| image.error(col, row));
                assert!(numbers.into_iter().eq(errors));
            }
            for (path, _) in files {
                fs::remove_file(path).unwrap();
            }
        }
    }
}

#[test]
fn every_file_tells_its_digest_and_its_region() {
    let image = render(Scene::Color, false);
    let region = part_of_a_picture(&image);
    let files = write(&image, region, true, "told.npy");
    assert!(files[0].1 == DIGEST && files[1].1 != DIGEST);
    for (path, digest) in files {
        assert_eq!(load::contents(&path), Ok((digest, region)));
        let mut bytes = Vec::new();
        File::open(&path).unwrap().read_to_end(&mut bytes).unwrap();
        for wrong in [
            &bytes[..bytes.len() - 1],
            &bytes[..40],
            &[&bytes[..], b"x"].concat(),
        ] {
            fs::write(&path, wrong).unwrap();
            assert!(load::contents(&path).is_err());
        }
        fs::remove_file(path).unwrap();
    }
}

#[test]
fn nothing_is_left_of_a_picture_that_is_not_complete() {
    let image = render(Scene::Color, false);
    let form = Form {
        region: Region::all(size(&image)),
        channels: image.channels(),
        alpha: false,
        centers: None,
    };
    let encoder = Encoder::new(
        Encoding::Npy(NpyOptions {
            error: true,
            archive: false,
            evidence: false,
        }),
        form,
        &[],
    );
    let path = temporary("cut.npy");
    let file = save::begin(&path).unwrap();
    let mut pieces = [Piece::Samples(vec![0; encoder.sample_bytes(0)])].into_iter();
    assert!(
        encoder
            .write(&facts(), &path, file, || pieces.next(), || None, || Ok(()))
            .is_err()
    );
    for (path, _) in encoder.files(&path, &DIGEST) {
        assert!(!path.exists());
        let mut temporary = path.into_os_string();
        temporary.push(".tmp");
        assert!(!Path::new(&temporary).exists());
    }
}

#[test]
fn files_beside_the_light_have_its_name_and_more() {
    for (name, expected) in [
        ("a.npy", "a_error.npy"),
        ("out/a.0001.NPY", "out/a.0001_error.NPY"),
        (".npy", ".npy_error"),
    ] {
        assert_eq!(beside(Path::new(name), ERROR), Path::new(expected));
        assert_eq!(beside(Path::new(name), ""), Path::new(name));
    }
}

/// Writes a picture and its errors as an archive.
fn write_archive(image: &Image, region: Region, name: &str) -> PathBuf {
    let options = NpyOptions {
        error: true,
        archive: true,
        evidence: false,
    };
    let files = write_as(image, region, options, name);
    assert!(matches!(&files[..], [(_, digest)] if *digest == DIGEST));
    files[0].0.clone()
}

#[test]
fn an_archive_has_the_light_to_the_bit() {
    let image = render(Scene::Color, true);
    let path = write_archive(&image, Region::all(size(&image)), "light.npz");
    assert!(load::is_picture(&path));
    let mut picture = load::picture(&path).unwrap();
    assert_eq!((picture.size, picture.format), (size(&image), "NPZ"));
    for row in 0..image.height() {
        picture.row.advance().unwrap();
        for col in 0..image.width() {
            assert_eq!(picture.row.rgba(col), image.rgba(col, row));
        }
    }
    // Columns of particles have other names.
    let numbers = [0.5; 6];
    let size = Size {
        width: 3,
        height: 2,
    };
    let mut file = File::create(&path).unwrap();
    npz::write(&mut file, size, &[("position", &numbers)]).unwrap();
    assert!(!load::is_picture(&path));
    fs::remove_file(path).unwrap();
}

#[test]
fn every_damage_of_an_archive_is_found() {
    /// Bytes between two that are changed, within arrays.
    const STEP: usize = 997;
    let image = render(Scene::Color, false);
    let region = part_of_a_picture(&image);
    let path = write_archive(&image, region, "damaged.npz");
    assert_eq!(load::contents(&path), Ok((DIGEST, region)));
    let bytes = fs::read(&path).unwrap();
    // The first headers, with the stamp, and the list at the end; between them some bytes of every array.
    let (start, end) = (700, bytes.len() - 300);
    let places = (0..start).chain((start..end).step_by(STEP));
    for place in places.chain(end..bytes.len()) {
        let mut wrong = bytes.clone();
        wrong[place] ^= 1;
        fs::write(&path, &wrong).unwrap();
        assert!(load::contents(&path).is_err(), "byte {place}");
    }
    for wrong in [
        &bytes[..bytes.len() - 1],
        &bytes[..40],
        &[&bytes[..], b"x"].concat(),
    ] {
        fs::write(&path, wrong).unwrap();
        assert!(load::contents(&path).is_err(), "{}", wrong.len());
    }
    fs::remove_file(path).unwrap();
}
