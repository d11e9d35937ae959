//! Channels with properties of the first hits of rays through pixel centers, and with averages over pixels.

use clap::ValueEnum;
use marbles_core::{
    Average, AverageSettings, Axes, Depth, Geometry, GeometrySettings, Precision, Quantity,
};

/// A group of channels, with the name on the command line.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum CenterChannel {
    /// Distance
    Depth,
    /// Shading normal; in scenes with bumps also the geometric normal
    Normal,
    /// Visible point
    Position,
    /// Index of the sphere, an unsigned integer
    Id,
    /// Albedo of the sphere
    Albedo,
    /// 1 if a sphere is visible
    Mask,
    /// Mean of the shading normal over the visible spheres of the pixel
    #[value(name = "mean_normal")]
    MeanNormal,
    /// Index of the sphere that covers most of the pixel, and the fraction of the pixel that it covers
    #[value(name = "coverage_id")]
    CoverageId,
}

/// A kind of depth, with the name on the command line.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum DepthForm {
    /// Distance along the axis of view
    Axis,
    /// Distance from the viewpoint
    Ray,
}

/// The axes of normals and positions, with the names on the command line.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum AxesForm {
    /// Axes of the scene: x right, y up, z forward, left-handed
    World,
    /// Axes of the camera: x right, y down, z forward
    #[value(name = "camera-opencv")]
    CameraOpenCv,
    /// Axes of the camera: x right, y up, z toward the viewer
    #[value(name = "camera-opengl")]
    CameraOpenGl,
}

/// The additional channels of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CenterChannels {
    /// The groups, as bits.
    wanted: u16,
    /// The tolerance of averages.
    pub(crate) tolerance: f64,
    pub(crate) depth: DepthForm,
    pub(crate) axes: AxesForm,
    /// Whether shading normals differ from geometric normals. If so, the file contains both.
    has_bumps: bool,
}

/// The source of a channel's numbers.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Source {
    /// A component of a quantity.
    Value(Quantity, usize),
    /// The index of the sphere.
    Id,
    /// 1 if a sphere is visible.
    Mask,
    /// A component of an average.
    Average(Average, usize),
    /// The index of the sphere that covers most of the pixel.
    CoverageId,
}

impl Source {
    /// Returns whether the numbers are unsigned integers: indices of spheres.
    pub(crate) fn is_index(self) -> bool {
        matches!(self, Self::Id | Self::CoverageId)
    }
}

/// The center values of rows of pixels.
pub(crate) trait CenterValues {
    /// The number of columns and rows.
    fn size(&self) -> (u32, u32);

    /// Passes the numbers of a row's pixels to `take`, from left to right; none of a source that is not there. All are
    /// passed at once, which is several times as fast as one by one.
    fn each_number(&self, source: Source, row: u32, take: impl FnMut(f64));

    /// Passes the indices of the spheres of a row's pixels to `take`, from left to right.
    fn each_index(&self, source: Source, row: u32, take: impl FnMut(u32));
}

impl CenterValues for Geometry {
    fn size(&self) -> (u32, u32) {
        (self.width(), self.height())
    }

    fn each_number(&self, source: Source, row: u32, take: impl FnMut(f64)) {
        match source {
            Source::Value(quantity, component) => {
                let values = self.values(quantity, component, row);
                values.into_iter().flatten().for_each(take);
            }
            Source::Average(average, component) => {
                let values = self.averages(average, component, row);
                values.into_iter().flatten().for_each(take);
            }
            Source::Id | Source::CoverageId | Source::Mask => {
                let mask = |id| f64::from(u8::from(id != Self::NOTHING));
                self.ids(row).map(mask).for_each(take);
            }
        }
    }

    fn each_index(&self, source: Source, row: u32, take: impl FnMut(u32)) {
        match source {
            Source::CoverageId => {
                let ids = self.coverage_ids(row);
                ids.into_iter().flatten().for_each(take);
            }
            _ => self.ids(row).for_each(take),
        }
    }
}

/// The name of an EXR's channel, and the source of its numbers. The part before the period is the name of its layer, and of
/// an array. The only component of a layer is `V`, as in the files that Blender writes.
type Named = (&'static str, Source);

/// The channels of every group, in the order of the file formats without names.
const CHANNELS: [(CenterChannel, &[Named]); 9] = {
    use Quantity::{Albedo, Depth, GeometricNormal, Normal, Position};
    use Source::{Average, CoverageId, Id, Mask, Value};
    use marbles_core::Average::{Coverage, Normal as MeanNormal};
    [
        (CenterChannel::Depth, &[("depth.Z", Value(Depth, 0))]),
        (
            CenterChannel::Normal,
            &[
                ("normal.X", Value(Normal, 0)),
                ("normal.Y", Value(Normal, 1)),
                ("normal.Z", Value(Normal, 2)),
            ],
        ),
        (
            CenterChannel::Normal,
            &[
                ("geometric_normal.X", Value(GeometricNormal, 0)),
                ("geometric_normal.Y", Value(GeometricNormal, 1)),
                ("geometric_normal.Z", Value(GeometricNormal, 2)),
            ],
        ),
        (
            CenterChannel::Position,
            &[
                ("position.X", Value(Position, 0)),
                ("position.Y", Value(Position, 1)),
                ("position.Z", Value(Position, 2)),
            ],
        ),
        (
            CenterChannel::Albedo,
            &[
                ("albedo.R", Value(Albedo, 0)),
                ("albedo.G", Value(Albedo, 1)),
                ("albedo.B", Value(Albedo, 2)),
            ],
        ),
        (CenterChannel::Id, &[("id.V", Id)]),
        (CenterChannel::Mask, &[("mask.V", Mask)]),
        (
            CenterChannel::MeanNormal,
            &[
                ("mean_normal.X", Average(MeanNormal, 0)),
                ("mean_normal.Y", Average(MeanNormal, 1)),
                ("mean_normal.Z", Average(MeanNormal, 2)),
                ("mean_normal_error.V", Average(MeanNormal, 3)),
            ],
        ),
        (
            CenterChannel::CoverageId,
            &[
                ("coverage_id.V", CoverageId),
                ("coverage_share.V", Average(Coverage, 0)),
                ("coverage_error.V", Average(Coverage, 1)),
            ],
        ),
    ]
};

impl CenterChannels {
    /// Some groups of channels for a world with or without bumps; averages have this tolerance.
    pub(crate) fn new(
        groups: &[CenterChannel],
        depth: DepthForm,
        axes: AxesForm,
        has_bumps: bool,
        tolerance: f64,
    ) -> Self {
        Self {
            tolerance,
            wanted: groups.iter().fold(0, |set, group| set | 1 << *group as u16),
            depth,
            axes,
            has_bumps,
        }
    }

    /// Whether the group was requested.
    pub(crate) fn has(&self, group: CenterChannel) -> bool {
        self.wanted >> group as u16 & 1 == 1
    }

    /// Whether averages were requested.
    pub(crate) fn has_averages(&self) -> bool {
        self.has(CenterChannel::MeanNormal) || self.has(CenterChannel::CoverageId)
    }

    /// The channels and their names.
    pub(crate) fn list(&self) -> impl Iterator<Item = Named> {
        let wanted = CHANNELS.into_iter().filter(|(group, _)| self.has(*group));
        let channels = wanted.flat_map(|(_, channels)| channels.iter().copied());
        channels.filter(|(_, source)| {
            let is_geometric = matches!(source, Source::Value(Quantity::GeometricNormal, _));
            self.has_bumps || !is_geometric
        })
    }

    /// The settings for computing them with numbers of this type.
    pub(crate) fn settings(&self, precision: Precision) -> GeometrySettings {
        let quantities = self.list().filter_map(|(_, source)| match source {
            Source::Value(quantity, _) => Some(quantity),
            Source::Id | Source::Mask | Source::Average(..) | Source::CoverageId => None,
        });
        GeometrySettings {
            quantities: quantities.collect(),
            depth: match self.depth {
                DepthForm::Axis => Depth::Axis,
                DepthForm::Ray => Depth::Ray,
            },
            axes: match self.axes {
                AxesForm::World => Axes::World,
                AxesForm::CameraOpenCv => Axes::CameraOpenCv,
                AxesForm::CameraOpenGl => Axes::CameraOpenGl,
            },
            precision,
            averages: AverageSettings {
                normal: self.has(CenterChannel::MeanNormal),
                coverage: self.has(CenterChannel::CoverageId),
                tolerance: self.tolerance,
            },
        }
    }
}

/// The name on the command line.
pub(crate) fn name_of(value: &impl ValueEnum) -> String {
    let name = value.to_possible_value();
    name.map_or_else(String::new, |value| value.get_name().to_owned())
}
