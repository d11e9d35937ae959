//! The lights of a scene over time: at rest, through keys, on a turntable, and attached to the camera.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};
use marbles_core::{
    Camera, DirectionalLight, Emission as CoreEmission, Light as CoreLight, LightFalloff,
    PointLight,
};

use super::channels::{Keys, PointCurve};
use super::checks;
use super::curve::Curve;
use super::error::{FrameError, FrameFault};
use super::turntable::Turntable;
use crate::file::{self, Animation, File, Key, Turned};
use crate::text::{Placed, optional, refuse};
use crate::values::Mu;

/// The lights of a scene over time.
#[derive(Clone, Debug)]
pub(crate) struct Lights {
    lights: Vec<Light>,
    /// The turntable that turns them.
    turntable: Option<Turntable>,
    /// Whether some key names one of them.
    is_keyed: bool,
}

/// A light over time.
#[derive(Clone, Debug)]
struct Light {
    name: Option<String>,
    kind: Kind,
    /// The direction toward it, or its position, in the axes of the world or of the camera.
    place: PointCurve,
    intensity: PointCurve,
    /// That of a point light that sends light in some directions more than in others.
    emission: Option<Emission>,
    /// Whether it moves with the camera.
    is_attached: bool,
}

/// The directions in which a lamp sends light, over time.
#[derive(Clone, Debug)]
struct Emission {
    /// The direction that it faces, in the axes of the world or of the camera.
    direction: PointCurve,
    mu: Curve,
}

/// The kind of a light.
#[derive(Clone, Debug)]
enum Kind {
    Directional {
        /// In degrees.
        diameter: Curve,
    },
    Point {
        falloff: LightFalloff,
        /// `None` until it is chosen, where the file names none.
        reference: Option<f64>,
    },
}

impl Lights {
    /// The lights that the file describes; `None` where a fault was reported.
    pub(crate) fn new(file: &File) -> Option<Self> {
        checks::check_lights(file);
        let mut keys: &[Placed<Key>] = &[];
        let mut turntable = None;
        if let Some(animation) = &file.animation {
            match animation.value.as_ref()? {
                Animation::Keyframes { keys: all, .. } => keys = all,
                animation @ Animation::Turntable { what, .. } => {
                    if what.get()? == Turned::Lights {
                        turntable = Some(Turntable::new(animation)?);
                    }
                }
            }
        }
        let keys: Vec<&Key> = keys.iter().filter_map(|key| key.value.as_ref()).collect();
        let lights: Vec<_> = file.lights.iter().map(|one| light(one, &keys)).collect();
        Some(Self {
            lights: lights.into_iter().collect::<Option<_>>()?,
            turntable,
            is_keyed: keys.iter().any(|key| key.light.is_some()),
        })
    }

    /// The lights' names, where they have any.
    pub(crate) fn names(&self) -> Vec<Option<String>> {
        self.lights.iter().map(|light| light.name.clone()).collect()
    }

    /// Returns whether the lights of frames may differ from those of others.
    pub(crate) fn may_move(&self) -> bool {
        let mut lights = self.lights.iter();
        self.is_keyed || self.turntable.is_some() || lights.any(|light| light.is_attached)
    }

    /// Returns whether some light has a color in some frame.
    pub(crate) fn may_have_color(&self) -> bool {
        let mut lights = self.lights.iter();
        lights.any(|light| light.intensity.may_have_color())
    }

    /// The number of the frame by which noise is drawn, the same in every turn of a turntable.
    pub(crate) fn looped(&self, frame: i32) -> i32 {
        let turntable = self.turntable.as_ref();
        turntable.map_or(frame, |turntable| turntable.looped(frame))
    }

    /// Returns whether some light has no reference distance that it needs.
    pub(crate) fn lack_references(&self) -> bool {
        self.lights.iter().any(|light| light.kind.lacks_reference())
    }

    /// Returns whether some light without a reference distance that it needs is attached to the camera.
    pub(crate) fn lack_attached_references(&self) -> bool {
        let mut lights = self.lights.iter();
        lights.any(|light| light.is_attached && light.kind.lacks_reference())
    }

    /// Gives each of the lights that lack a reference distance the one that `distance` finds for its position among
    /// `placed`, the same lights in a frame.
    pub(crate) fn choose_references(
        &mut self,
        placed: &[CoreLight],
        distance: impl Fn(DVec3) -> Option<f64>,
    ) {
        let lights = self.lights.iter_mut().zip(placed);
        for (light, placed) in lights.filter(|(light, _)| light.kind.lacks_reference()) {
            if let (Kind::Point { reference, .. }, CoreLight::Point(placed)) =
                (&mut light.kind, placed)
            {
                *reference = distance(placed.position());
            }
        }
    }

    /// As many lights, all of them dark and above, for frames that have none.
    pub(crate) fn somewhere(&self) -> Vec<CoreLight> {
        let light = |_: &Light| {
            DirectionalLight::new(DVec3::Y, DVec3::ZERO)
                .map(CoreLight::from)
                .ok()
        };
        self.lights.iter().filter_map(light).collect()
    }

    /// The lights in frame `frame`, in which the camera is here. Those of a turntable turn about its axis
    /// through `target`.
    pub(crate) fn at(
        &self,
        frame: i32,
        camera: &Camera,
        target: DVec3,
    ) -> Result<Vec<CoreLight>, FrameError> {
        let turntable = self.turntable.as_ref();
        let rotation = turntable.map(|turntable| turntable.rotation(frame));
        let at = |(index, light): (usize, &Light)| {
            let placed = light.at(f64::from(frame), camera, rotation, target);
            placed.map_err(|fault| FrameError {
                frame,
                fault: fault(index),
            })
        };
        self.lights.iter().enumerate().map(at).collect()
    }
}

impl Light {
    /// The light at a time, turned by a `rotation`.
    fn at(
        &self,
        time: f64,
        camera: &Camera,
        rotation: Option<DMat3>,
        target: DVec3,
    ) -> Result<CoreLight, fn(usize) -> FrameFault> {
        let place = self.place.at(time);
        let turned = |vector: DVec3| rotation.map_or(vector, |rotation| rotation * vector);
        let direction = |vector: DVec3| match self.is_attached {
            true => camera.world_from_camera * vector,
            false => turned(vector),
        };
        let intensity = self.intensity.at(time);
        match self.kind {
            Kind::Directional { ref diameter } => {
                // Rounding must not lead a curve, or an angle just below 180 degrees, out of the range.
                let diameter = diameter.at(time).to_radians().clamp(0.0, PI.next_down());
                DirectionalLight::new(direction(place), intensity)
                    .and_then(|light| light.with_diameter(diameter))
                    .map(CoreLight::from)
                    .map_err(|_| FrameFault::LightNowhere as _)
            }
            Kind::Point { falloff, reference } => {
                // Where it is not chosen, nothing depends on it.
                let reference = reference.unwrap_or(1.0);
                let position = match rotation {
                    _ if self.is_attached => camera.position + camera.world_from_camera * place,
                    Some(_) => target + turned(place - target),
                    None => place,
                };
                let light = PointLight::new(position, intensity, falloff, reference)
                    .map_err(|_| FrameFault::LightTooFar as fn(usize) -> FrameFault)?;
                let Some(emission) = &self.emission else {
                    return Ok(light.into());
                };
                let facing = direction(emission.direction.at(time));
                CoreEmission::new(facing, emission.mu.at(time))
                    .map(|emission| light.with_emission(emission).into())
                    .map_err(|_| FrameFault::LightNowhere as _)
            }
        }
    }
}

impl Kind {
    fn lacks_reference(&self) -> bool {
        let falls_off = LightFalloff::InverseSquare;
        matches!(self, Self::Point { falloff, reference: None } if *falloff == falls_off)
    }
}

/// A light of the file and its keys.
fn light(light: &Placed<file::Light>, keys: &[&Key]) -> Option<Light> {
    let light = light.value.as_ref()?;
    let (name, attached, intensity) = match light {
        file::Light::Directional {
            name,
            attached,
            intensity,
            ..
        }
        | file::Light::Point {
            name,
            attached,
            intensity,
            ..
        } => (name, attached, intensity),
    };
    let name = optional(name, |name| Some(name.0.clone()))?;
    let attached = optional(attached, |attached| Some(*attached))?;
    let own = |key: &&&Key| {
        let keyed = key.light.as_ref().and_then(|name| name.value.as_ref());
        keyed.is_some_and(|keyed| Some(&keyed.0) == name.as_ref())
    };
    let keys = Keys(keys.iter().filter(own).copied().collect());
    let (kind, place) = kind(light, &keys)?;
    let emission = emission(light, &keys)?;
    let intensity = intensity.get()?.0;
    Some(Light {
        kind,
        place,
        emission,
        intensity: keys.vectors(intensity, |key| Some(key.intensity.as_ref()?.get()?.0)),
        is_attached: attached.is_some(),
        name,
    })
}

/// The kind of a light, and its place over time.
fn kind(light: &file::Light, keys: &Keys<'_>) -> Option<(Kind, PointCurve)> {
    match light {
        file::Light::Directional {
            toward, diameter, ..
        } => {
            let direction = toward.direction()?;
            let place = keys.vectors(direction, |key| Some(key.toward.as_ref()?.get()?.0));
            let diameter = keys.numbers(diameter.get()?.0, |key| &key.diameter);
            Some((Kind::Directional { diameter }, place))
        }
        file::Light::Point {
            position,
            falloff,
            reference,
            ..
        } => {
            let falloff = match falloff.get()? {
                file::Falloff::InverseSquare => LightFalloff::InverseSquare,
                file::Falloff::None => LightFalloff::None,
            };
            let reference = optional(reference, |reference| Some(reference.0))?;
            let position = position.get()?.0;
            let place = keys.vectors(position, |key| Some(key.position.as_ref()?.get()?.0));
            Some((Kind::Point { falloff, reference }, place))
        }
    }
}

/// The directions in which a light of the file sends light; none of one that sends as much in all of them, and `None` where a
/// fault was reported.
fn emission(light: &file::Light, keys: &Keys<'_>) -> Option<Option<Emission>> {
    let file::Light::Point {
        direction: facing,
        mu,
        ..
    } = light
    else {
        return Some(None);
    };
    let Some(facing) = facing else {
        if let Some(mu) = mu {
            let message =
                "expected a `direction` beside `mu`: the one that the lamp faces; found none";
            return refuse(mu.place.clone(), message);
        }
        return Some(None);
    };
    let mu = match mu {
        Some(mu) => mu.get()?,
        None => Mu::default(),
    };
    let direction = facing.direction()?;
    Some(Some(Emission {
        direction: keys.vectors(direction, |key| Some(key.direction.as_ref()?.get()?.0)),
        mu: keys.numbers(mu.0, |key| &key.mu),
    }))
}
