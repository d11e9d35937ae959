//! The worlds of a sequence, prepared for rendering: a single one, or one for each step of clouds that change over
//! time.
//!
//! A separate thread reads the next step while the current one is rendered. It waits until the previous step is
//! dropped, so at most two are in memory.

use std::iter::Peekable;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::sync::{Arc, Condvar, Mutex, OnceLock, PoisonError};

use marbles_core::{Renderer, World, parallel};
use marbles_scene::{Scene, SceneError, StepKey};
use rayon::ThreadPoolBuilder;
use self_cell::self_cell;

use super::digest::{Digests, Input, hashes_of_spheres};
use super::request::Request;
use crate::base::failure::Failure;
use crate::base::memory;

/// The largest number of steps in memory.
const MOST: usize = 2;

/// A world, with the data prepared for it.
pub(super) struct Step {
    key: Option<StepKey>,
    world: PreparedWorld,
    /// One for each picture of a frame.
    pub(super) digests: Vec<Digests>,
    /// The input of each picture of a frame.
    pub(super) inputs: Vec<Input>,
    /// Counts the step as long as it is in memory.
    _place: Place,
}

self_cell!(
    struct PreparedWorld {
        owner: World,
        #[not_covariant]
        dependent: Renderers,
    }
);

/// Prepared when the first frame needs them: one for each picture of a frame, then one for each layer.
type Renderers<'world> = OnceLock<Vec<Renderer<'world>>>;

impl Step {
    fn new(request: &Request, key: Option<StepKey>, world: World, place: Place) -> Self {
        let spheres = hashes_of_spheres(&world);
        let names = &request.scene.description().lights;
        let layers = request.layer_names();
        let inputs = request
            .parts
            .iter()
            .map(|part| Input::new(&part.of(&world), &spheres, &request.settings));
        let inputs: Vec<Input> = inputs.collect();
        let digests = request.parts.iter().zip(&inputs).map(|(part, input)| {
            let centers = request.centers.filter(|_| part.has_centers());
            let digests = input.digests(request.encoding, centers.as_ref());
            digests
                .with_names(part.names_of(names))
                .with_layers(&layers)
        });
        Self {
            key,
            digests: digests.collect(),
            inputs,
            world: PreparedWorld::new(world, |_| OnceLock::new()),
            _place: place,
        }
    }

    /// The number of spheres.
    pub(super) fn spheres(&self) -> usize {
        self.world.borrow_owner().spheres().len()
    }

    /// Refuses a step if there is not enough memory to prepare it.
    pub(super) fn require_memory(&self) -> Result<(), Failure> {
        self.world
            .with_dependent(|world, renderers| match renderers.get() {
                Some(_) => Ok(()),
                None => memory::require_for(world),
            })
    }

    /// Passes on the renderers, which are made at the first use; `begin` is called before.
    pub(super) fn with_renderers<'a, T>(
        &'a self,
        request: &Request,
        begin: impl FnOnce(),
        take: impl for<'world> FnOnce(&'a [Renderer<'world>]) -> T,
    ) -> T {
        self.world.with_dependent(|world, renderers| {
            let renderers = renderers.get_or_init(|| {
                begin();
                let renderer = Renderer::new(world);
                let parts = request.parts.iter().map(|part| part.light);
                let layers = request.layers.iter().map(|layer| Some(layer.light));
                let lights = parts.chain(layers);
                let renderers = lights.map(|light| match light {
                    Some(light) => renderer.under(light),
                    None => renderer.clone(),
                });
                renderers.collect()
            });
            take(renderers)
        })
    }
}

/// The steps of a sequence, with the current one.
pub(super) struct Steps<'a> {
    request: &'a Request,
    current: Option<Arc<Step>>,
    /// The frame whose step is being read.
    asked: Option<i32>,
    /// The frames whose steps have not been read ahead.
    upcoming: Peekable<Box<dyn Iterator<Item = i32> + Send + 'a>>,
    reader: Option<Reader>,
    places: Places,
}

/// The reading thread.
struct Reader {
    frames: Sender<i32>,
    worlds: Receiver<(Result<World, SceneError>, Place)>,
}

/// The opposite ends of the channels of a [`Reader`].
pub(super) struct ReaderTask {
    frames: Receiver<i32>,
    worlds: SyncSender<(Result<World, SceneError>, Place)>,
    places: Places,
}

impl<'a> Steps<'a> {
    /// The steps of a request, and the task of the reading thread, if there are steps to read.
    pub(super) fn new(request: &'a Request) -> (Self, Option<ReaderTask>) {
        let places = Places::default();
        let (reader, task) = if request.scene.has_steps() {
            let (frames, wanted) = channel();
            let (sender, worlds) = sync_channel(1);
            let task = ReaderTask {
                frames: wanted,
                worlds: sender,
                places: places.clone(),
            };
            (Some(Reader { frames, worlds }), Some(task))
        } else {
            (None, None)
        };
        let frames: Box<dyn Iterator<Item = i32> + Send + 'a> = Box::new(request.frames.iter());
        let steps = Self {
            request,
            current: None,
            asked: None,
            upcoming: frames.peekable(),
            reader,
            places,
        };
        (steps, task)
    }

    /// The step for a frame.
    ///
    /// # Errors
    /// If its tables cannot be read.
    pub(super) fn of(&mut self, frame: i32) -> Result<Arc<Step>, Failure> {
        let request = self.request;
        let scene = &request.scene;
        let key = scene.steps_at(frame);
        if let Some(current) = self.current.as_ref().filter(|step| step.key == key) {
            return Ok(Arc::clone(current));
        }
        self.current = None;
        let (world, place) = match &self.reader {
            None => (Ok(scene.world().clone()), self.places.take()),
            Some(reader) => reader.read(scene, frame, key.as_ref(), &mut self.asked),
        };
        let world = world.map_err(|error| match error.is_of_changed_table() {
            true => Failure::Changed(error.to_string()),
            false => Failure::Work(error.to_string()),
        })?;
        let step = Arc::new(Step::new(request, key, world, place));
        self.current = Some(Arc::clone(&step));
        self.read_ahead(&step);
        Ok(step)
    }

    /// Requests the step that is likely to come next.
    fn read_ahead(&mut self, step: &Step) {
        let Some(reader) = self.reader.as_ref().filter(|_| self.asked.is_none()) else {
            return;
        };
        let scene = &self.request.scene;
        let is_this = |frame: &i32| scene.steps_at(*frame) == step.key;
        while self.upcoming.next_if(|frame| !is_this(frame)).is_some() {}
        while self.upcoming.next_if(is_this).is_some() {}
        if let Some(&frame) = self.upcoming.peek()
            && reader.frames.send(frame).is_ok()
        {
            self.asked = Some(frame);
        }
    }
}

impl Reader {
    /// The world of a frame, which may have been requested before.
    fn read(
        &self,
        scene: &Scene,
        frame: i32,
        key: Option<&StepKey>,
        asked: &mut Option<i32>,
    ) -> (Result<World, SceneError>, Place) {
        let lost = "the reader ends after its frames";
        if let Some(asked) = asked.take() {
            let read = self.worlds.recv().expect(lost);
            if scene.steps_at(asked).as_ref() == key {
                return read;
            }
        }
        self.frames.send(frame).expect(lost);
        self.worlds.recv().expect(lost)
    }
}

impl ReaderTask {
    /// Reads worlds as long as they are requested.
    pub(super) fn run(self, scene: &Scene) {
        // The threads that render are busy: what is asked of their pool waits for them.
        let own = ThreadPoolBuilder::new()
            .num_threads(1)
            .use_current_thread()
            .build();
        for frame in self.frames {
            let place = self.places.take();
            let world = match &own {
                Ok(pool) => parallel::install(pool, || scene.world_at(frame)),
                Err(_) => scene.world_at(frame),
            };
            if self.worlds.send((world, place)).is_err() {
                return;
            }
        }
    }
}

/// The slots for steps in memory.
#[derive(Clone, Default)]
struct Places(Arc<(Mutex<usize>, Condvar)>);

/// A slot that is taken until it is dropped.
struct Place(Places);

impl Places {
    /// Waits for a free slot.
    fn take(&self) -> Place {
        let (taken, changed) = &*self.0;
        let mut taken = taken.lock().unwrap_or_else(PoisonError::into_inner);
        while *taken >= MOST {
            taken = changed.wait(taken).unwrap_or_else(PoisonError::into_inner);
        }
        *taken += 1;
        Place(self.clone())
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let (taken, changed) = &*self.0.0;
        *taken.lock().unwrap_or_else(PoisonError::into_inner) -= 1;
        changed.notify_all();
    }
}
