//! Pictures in memory become files.

use std::cell::Cell;
use std::ffi::OsString;
use std::io::Cursor;
use std::path::Path;

use marbles_core::Image;

use super::error::Error;
use super::picture::{Picture, checksum};
use crate::base::failure::Failure;
use crate::commands::args::{Arguments, Command, RenderArguments};
use crate::commands::format_options::encoding;
use crate::files::save::{Fault, begin, write_bytes};
use crate::formats::center_channels::CenterChannels;
use crate::formats::encoder::{Encoder, Piece};
use crate::formats::encoding::{Encoding, Format, PngOptions};
use crate::formats::facts::Facts;
use crate::formats::form::Form;
use crate::formats::npy::given::{GivenCenters, GivenNumbers, image};
use crate::formats::png::shape::Shape;
use crate::formats::png::write::{compress, texts};
use crate::formats::sidecar;
use crate::sequence::digest::Shot;

/// How to save a picture: options of `marbles render` with these names.
#[derive(Clone, Copy, Debug, Default)]
pub struct SaveOptions {
    /// Bits per channel of a PNG.
    pub bits: Option<u8>,
    /// Whether the codes of a PNG are linear.
    pub linear: bool,
    /// The power of two by which light is multiplied before it is converted to codes.
    pub exposure: Option<f64>,
    /// Whether a gray picture has three channels.
    pub rgb: bool,
    /// Whether an EXR or a TIFF has single precision.
    pub float: bool,
    /// Whether the errors are stored.
    pub error: bool,
    /// Whether there is a sidecar.
    pub sidecar: bool,
}

/// Arrays of a picture, by their names.
type Given<'a> = [(&'a str, GivenNumbers<'a>)];

impl Picture {
    /// Saves the picture with these arrays, its own or changed ones, to `path`, whose ending decides the format. EXR, NPY and
    /// NPZ files get all channels that are given.
    ///
    /// The file is the one that `marbles render` writes, to the byte, except that the channels of an EXR are those in double
    /// precision, rounded. If light or errors were changed, its digest is another one.
    ///
    /// # Errors
    /// Refuses options and endings that `marbles render` refuses, and fails if the file cannot be written.
    pub fn save(&self, path: &Path, options: &SaveOptions, given: &Given<'_>) -> Result<(), Error> {
        let format = match Format::of_file(path) {
            Some(Format::Animation(_)) | None => {
                let expected =
                    "expected a file name that ends in .png, .exr, .npy, .npz, .tif or .tiff";
                return Err(Error::Value(format!("path: {expected}, found {path:?}")));
            }
            Some(format) => format,
        };
        let has_files = matches!(format, Format::Exr | Format::Npy | Format::Npz);
        let centers = self.form.centers.filter(|_| has_files);
        let arguments = arguments(path, options, centers.is_some())?;
        let encoding = encoding(&arguments, format)?;
        let form = Form {
            centers,
            ..self.form
        };
        let image = image(&form, given).map_err(Error::Value)?;
        let facts = self.facts_for(encoding, centers.as_ref(), given);
        let encoder = Encoder::new(encoding, form, &[]);
        let index = Cell::new(0);
        let next = || {
            let piece = piece(&encoder, index.get(), &image, given);
            index.set(index.get() + 1);
            Some(piece)
        };
        let complete = || match options.sidecar {
            true => self.save_sidecar(&facts, path).map_err(Fault::Failed),
            false => Ok(()),
        };
        let of_file = |failure: Failure| Error::File(failure.to_string());
        let file = begin(path).map_err(of_file)?;
        let written = encoder.write(&facts, path, file, next, || Some(self.summary), complete);
        written.map_err(|unwritten| of_file(unwritten.into()))
    }

    /// The codes of the 8-bit PNG: red, green and blue of each pixel, and alpha if the picture has it.
    ///
    /// # Errors
    /// Refuses arrays that are not as long as the picture's.
    pub fn to_srgb(&self, given: &Given<'_>) -> Result<Vec<u8>, Error> {
        let image = image(&self.form, given).map_err(Error::Value)?;
        let codes = image.to_srgb8();
        if self.form.alpha {
            return Ok(codes);
        }
        let (pixels, _) = codes.as_chunks::<4>();
        Ok(pixels
            .iter()
            .flat_map(|[red, green, blue, _]| [*red, *green, *blue])
            .collect())
    }

    /// The bytes of the 8-bit PNG.
    ///
    /// # Errors
    /// Refuses arrays that are not as long as the picture's.
    pub fn png(&self, given: &Given<'_>) -> Result<Vec<u8>, Error> {
        let options = PngOptions {
            deep: false,
            rgb: false,
            linear: false,
            gain: 1.0,
        };
        let encoding = Encoding::Png(options);
        let image = image(&self.form, given).map_err(Error::Value)?;
        let facts = self.facts_for(encoding, None, given);
        let shape = Shape::of(&self.form, options);
        let mut samples = vec![0; shape.row_bytes() * image.height() as usize];
        shape.encode(&mut samples, 0, &image, 0..image.height(), options.gain);
        let mut file = Cursor::new(Vec::new());
        let texts = texts(&facts.digest, &self.form.region);
        let written = compress(&mut file, shape, &texts, |stream| {
            Ok(stream.write_all(&samples)?)
        });
        match written {
            Ok(_has_grown) => Ok(file.into_inner()),
            Err(_) => Err(Error::Work("cannot encode the picture".to_owned())),
        }
    }

    fn save_sidecar(&self, facts: &Facts, path: &Path) -> Result<(), Failure> {
        let path = sidecar::beside(path);
        let text = self.sidecar_of(facts);
        let text = text.map_err(|error| Failure::at(&path, &error.to_string()))?;
        write_bytes(text.as_bytes(), &path)
    }

    /// The facts about the picture in this format.
    fn facts_for(
        &self,
        encoding: Encoding,
        centers: Option<&CenterChannels>,
        given: &Given<'_>,
    ) -> Facts {
        let Facts {
            view,
            frame,
            frames_per_second,
            ..
        } = self.facts;
        let names = self.part.names_of(&self.scene.description().lights);
        let digests = self.input.digests(encoding, centers).with_names(names);
        let digest = digests.of(&Shot {
            exposure: &self.scene.exposure(&view),
            frame,
            // Other files do not tell it.
            frames_per_second: frames_per_second.filter(|_| matches!(encoding, Encoding::Exr(_))),
        });
        let numbers = given.iter().filter_map(|(name, numbers)| match numbers {
            GivenNumbers::F64(numbers) => Some((*name, *numbers)),
            GivenNumbers::U32(_) => None,
        });
        let checksum = checksum(numbers);
        let digest = match checksum == self.checksum {
            true => digest,
            false => blake3::hash(&[digest.as_bytes(), &checksum.to_le_bytes()[..]].concat()),
        };
        Facts {
            digest,
            ..self.facts
        }
    }
}

/// The piece of a picture's file with this index.
fn piece(encoder: &Encoder, index: u32, image: &Image, given: &Given<'_>) -> Piece {
    let first = index * encoder.rows();
    let rows = first..(first + encoder.rows()).min(image.height());
    let mut samples = vec![0; encoder.sample_bytes(index)];
    encoder.encode(0, &mut samples, 0, image, rows.clone());
    if encoder.form.centers.is_some() {
        let centers =
            GivenCenters::new(&encoder.form, given).in_rows(rows.start, rows.end - rows.start);
        encoder.encode_geometry(&mut samples, 0, &centers);
    }
    encoder.piece(index, samples)
}

/// The arguments of `marbles render` with these options.
fn arguments(
    path: &Path,
    options: &SaveOptions,
    has_channels: bool,
) -> Result<RenderArguments, Error> {
    let SaveOptions {
        bits,
        linear,
        exposure,
        rgb,
        float,
        error,
        sidecar,
    } = *options;
    let mut words: Vec<OsString> = ["marbles", "render", "scene.ron", "-o"]
        .map(OsString::from)
        .into();
    words.push(path.into());
    for (is_set, word) in [
        (linear, "--linear"),
        (rgb, "--rgb"),
        (float, "--float"),
        (error, "--error-channel"),
        (sidecar, "--sidecar"),
        // Which ones does not matter here.
        (has_channels, "--channels=id"),
    ] {
        words.extend(is_set.then(|| word.into()));
    }
    words.extend(bits.map(|bits| format!("--bits={bits}").into()));
    words.extend(exposure.map(|exposure| format!("--exposure={exposure}").into()));
    let refused = |message: String| {
        let message = message.trim_start_matches("error: ");
        Error::Value(message.lines().next().unwrap_or_default().to_owned())
    };
    match Arguments::of(words, 1000) {
        Ok(Arguments {
            command: Command::Render(arguments),
        }) => Ok(arguments),
        Ok(_) => Err(refused("expected options".to_owned())),
        Err(error) => Err(refused(error.to_string())),
    }
}
