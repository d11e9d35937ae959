//! Several scenes on one command line, whose files must have different names.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::args::RenderArguments;
use super::figures::is_inside;
use crate::base::failure::Failure;
use crate::base::scene_name::scene_name;
use crate::base::shown::Shown;
use crate::sequence::pattern::{SCENE, has_place_for_scene};
use crate::sequence::request::Request;

/// The files of previous scenes, with their scenes; `None` if there is only one scene.
pub(super) struct Others(Option<HashMap<PathBuf, PathBuf>>);

impl Others {
    /// No files yet. Refuses outputs without `{scene}`, and scenes with the same name.
    pub(super) fn of(arguments: &RenderArguments) -> Result<Self, Failure> {
        if let [_] = arguments.scenes[..] {
            return Ok(Self(None));
        }
        let outputs = [&arguments.output, &arguments.legend, &arguments.scale_bar];
        let mut outputs = outputs.into_iter().flatten();
        let lacks_scene = |output: &&PathBuf| !has_place_for_scene(output) && !is_inside(output);
        if let Some(output) = outputs.find(lacks_scene) {
            let why = format!("several scenes need {SCENE} in the file name");
            return Err(Failure::unusable(output, &why));
        }
        refuse_same_names(&arguments.scenes)?;
        Ok(Self(Some(HashMap::new())))
    }

    /// Adds the pictures of another scene. Refuses pictures that would replace those of a previous scene: different
    /// names and frame numbers can combine to the same file name.
    pub(super) fn add(&mut self, request: &Request) -> Result<(), Failure> {
        let Some(files) = &mut self.0 else {
            return Ok(());
        };
        let scene = &request.scene_path;
        let frames = request.frames.iter();
        let parts = || 0..request.parts.len();
        let pictures = frames.flat_map(|frame| parts().map(move |part| request.path(frame, part)));
        for picture in pictures {
            if let Some(other) = files.insert(picture.clone(), scene.clone())
                && other != *scene
            {
                let why = format!(
                    "the pictures of {} and of {} would have this name",
                    other.shown(),
                    scene.shown()
                );
                return Err(Failure::unusable(&picture, &why));
            }
        }
        Ok(())
    }
}

/// Refuses scenes whose files would have the same names.
fn refuse_same_names(scenes: &[PathBuf]) -> Result<(), Failure> {
    let mut names: Vec<_> = scenes.iter().map(|scene| scene_name(scene)).collect();
    names.sort_unstable();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        None => Ok(()),
        Some(same) => {
            let name = Path::new(same[0]).shown();
            let message = format!("two scenes are called `{name}`, and would share their files");
            Err(Failure::Usage(message))
        }
    }
}
