//! Compares whole pictures of scenes with pictures of 3 × 3 as many pixels.

use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec4;
use marbles_core::{Image, Method, Renderer, Settings, View};
use marbles_scene::Scene;

/// The default tolerances. At 5e-5 the renderer once changed its method.
const TOLERANCES: [f64; 5] = [1e-2, 1e-3, 1e-4, 5e-5, 1e-5];

/// The factor of the finer picture, and its tolerance.
const FINER: u32 = 3;
const FINEST: f64 = 1e-7;

/// The rounding error of the mean of parts, in units of light.
const ROUNDING: f64 = 1e-13;

/// The options.
struct Options {
    scenes: Vec<PathBuf>,
    tolerances: Vec<f64>,
    /// `None` for the scene's own size and two odd ones.
    size: Option<(u32, u32)>,
    is_own_size: bool,
}

impl Options {
    fn parse(arguments: &[&str]) -> Result<Self, String> {
        let mut options = Self {
            scenes: Vec::new(),
            tolerances: TOLERANCES.to_vec(),
            size: None,
            is_own_size: false,
        };
        let mut rest = arguments.iter();
        while let Some(&argument) = rest.next() {
            let mut value = || {
                rest.next()
                    .copied()
                    .ok_or(format!("{argument} needs a value"))
            };
            match argument {
                "--tolerances" => options.tolerances = list(value()?)?,
                "--size" => match value()? {
                    "own" => options.is_own_size = true,
                    size => options.size = Some(parse_size(size)?),
                },
                scene => options.scenes.push(scene.into()),
            }
        }
        if options.scenes.is_empty() {
            options.scenes = examples()?;
        }
        Ok(options)
    }

    /// The sizes in which a scene is rendered.
    fn sizes(&self, view: &View) -> Vec<(u32, u32)> {
        let own = (view.width, view.height);
        match self.size {
            Some(size) => vec![size],
            None if self.is_own_size => vec![own],
            // One wider than the scene's own, with pixels nearly as large; one as high, with larger ones.
            None => {
                let wide = ((view.width * 6 / 7) | 1, (view.height * 3 / 7) | 1);
                let small = ((view.width / 4) | 1, (view.height / 3) | 1);
                vec![own, wide, small]
            }
        }
    }
}

fn list(text: &str) -> Result<Vec<f64>, String> {
    let number = |text: &str| {
        text.parse()
            .map_err(|_| format!("{text} is not a tolerance"))
    };
    text.split(',').map(number).collect()
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once('x');
    let sides = sides.and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    sides.ok_or_else(|| format!("a size is 120x80, not {text}"))
}

/// The example scenes.
fn examples() -> Result<Vec<PathBuf>, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let at = |error| format!("{}: {error}", folder.display());
    let mut scenes = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(at)? {
        let path = entry.map_err(at)?.path();
        if path.extension().is_some_and(|ending| ending == "ron") {
            scenes.push(path);
        }
    }
    scenes.sort();
    Ok(scenes)
}

/// Counts, for every scene, size and tolerance, the pixels over the tolerance without a report, the reported ones, and
/// those with errors larger than their claims. Returns an error that contains the table if there is a pixel of the
/// first kind.
pub(crate) fn whole(arguments: &[&str]) -> Result<String, String> {
    let options = Options::parse(arguments)?;
    let mut table = String::from(
        "| scene | size | tolerance | over unsaid | given up | beyond claim | worst / tolerance | worst / claim | in doubt | seconds |\n\
         |---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    // A long run tells its rows as it has them; nothing is left to do when even this fails.
    let _ = write!(io::stderr(), "{table}");
    let mut broken = 0;
    for path in &options.scenes {
        let (scene, with_thick_lines) = load(path)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let frame = scene.frames().map_or(1, |frames| *frames.start());
        let view = scene.view(frame).map_err(|error| error.to_string())?;
        let world = scene.world_at(frame).map_err(|error| error.to_string())?;
        let renderer = Renderer::new(&world);
        let finer_world = with_thick_lines
            .world_at(frame)
            .map_err(|error| error.to_string())?;
        let finer_renderer = Renderer::new(&finer_world);
        for (width, height) in options.sizes(&view) {
            let view = View {
                width,
                height,
                ..view
            };
            let finer = View {
                width: width * FINER,
                height: height * FINER,
                ..view
            };
            let Some(finer) = picture(&finer_renderer, &with_thick_lines, &finer, FINEST) else {
                continue;
            };
            for &tolerance in &options.tolerances {
                let start = Instant::now();
                let Some(image) = picture(&renderer, &scene, &view, tolerance) else {
                    continue;
                };
                let seconds = start.elapsed().as_secs_f64();
                let count = Count::of(&image, &finer, tolerance);
                broken += count.over;
                let row = format!(
                    "| {name} | {width}x{height} | {tolerance:e} | {} | {} | {} | {:.2} | {:.2} | {} | {seconds:.2} |",
                    count.over,
                    count.given_up,
                    count.beyond,
                    count.worst,
                    count.worst_of_claim,
                    count.doubtful
                );
                let places = format!(
                    "{}{}",
                    told("over", &count.places),
                    told("beyond", &count.beyond_places)
                );
                let _ = writeln!(io::stderr(), "{row}{places}");
                // Writing to a string does not fail.
                let _ = writeln!(table, "{row}");
            }
        }
    }
    match broken {
        0 => Ok(table),
        _ => Err(format!(
            "{broken} pixels are over a tolerance and do not say so\n{table}"
        )),
    }
}

/// A scene, and the same scene with outlines that are thicker by the factor of the finer picture: outlines whose width
/// is in pixels then look the same in the finer picture.
fn load(path: &Path) -> Result<(Scene, Scene), String> {
    const LINE: &str = "outline: (width: ";
    let at = |error| format!("{}: {error}", path.display());
    let text = std::fs::read_to_string(path).map_err(at)?;
    let parts = text.split(LINE).enumerate().map(|(index, part)| {
        let end = part.find([',', ')']).unwrap_or(0);
        match part[..end].parse::<f64>() {
            Ok(width) if index > 0 => format!("{}{}", width * f64::from(FINER), &part[end..]),
            _ => part.to_owned(),
        }
    });
    let thick = parts.collect::<Vec<_>>().join(LINE);
    let parse = |text: &str| Scene::parse(text, path).map_err(|error| error.to_string());
    Ok((parse(&text)?, parse(&thick)?))
}

/// The first places of a list.
fn told(name: &str, places: &[(u32, u32)]) -> String {
    match places.is_empty() {
        true => String::new(),
        false => format!(" {name} {:?}", &places[..places.len().min(6)]),
    }
}

fn picture(renderer: &Renderer<'_>, scene: &Scene, view: &View, tolerance: f64) -> Option<Image> {
    let settings = Settings {
        method: Method::Tolerance(tolerance),
        alpha: false,
    };
    let go = |_| ControlFlow::Continue(());
    renderer
        .render_with_progress(scene.exposure(view), &settings, &go)
        .ok()
}

/// The results of the pixels of a picture.
#[derive(Default)]
struct Count {
    over: usize,
    given_up: usize,
    beyond: usize,
    /// The largest error of a pixel that is not reported, in tolerances; and the largest error in multiples of the
    /// claim, among those that exceed it.
    worst: f64,
    worst_of_claim: f64,
    /// The number of pixels for which the finer picture is not more precise.
    doubtful: usize,
    places: Vec<(u32, u32)>,
    beyond_places: Vec<(u32, u32)>,
}

impl Count {
    fn of(image: &Image, finer: &Image, tolerance: f64) -> Self {
        let mut count = Self::default();
        for row in 0..image.height() {
            for col in 0..image.width() {
                count.add(image, finer, (col, row), tolerance);
            }
        }
        count
    }

    fn add(&mut self, image: &Image, finer: &Image, (col, row): (u32, u32), tolerance: f64) {
        let (mut mean, mut uncertain) = (DVec4::ZERO, 0.0);
        let parts = FINER * FINER;
        for part in 0..parts {
            let (col, row) = (col * FINER + part % FINER, row * FINER + part / FINER);
            mean += DVec4::from_array(finer.rgba(col, row)) / f64::from(parts);
            uncertain += finer.error(col, row) / f64::from(parts);
        }
        let error = (DVec4::from_array(image.rgba(col, row)) - mean)
            .abs()
            .max_element();
        let claimed = image.error(col, row);
        let is_over = image.status(col, row).is_over_tolerance();
        self.given_up += usize::from(is_over);
        self.doubtful += usize::from(uncertain > 0.1 * tolerance);
        if !is_over {
            self.worst = self.worst.max((error - uncertain) / tolerance);
            if error > tolerance + uncertain {
                self.over += 1;
                self.places.push((col, row));
            }
        }
        if error > claimed + uncertain + ROUNDING {
            self.beyond += 1;
            self.beyond_places.push((col, row));
            let ratio = (error - uncertain) / claimed.max(ROUNDING);
            self.worst_of_claim = self.worst_of_claim.max(ratio);
        }
    }
}
