//! The curve by which the codes of a PNG stand for light.

use png::Info;

use marbles_core::srgb;

/// A gAMA chunk counts in these units.
const GAMMA_UNIT: f64 = 100_000.0;
/// The gAMA of sRGB pictures, whose curve it can only approximate.
const GAMMA_OF_SRGB: u32 = 45_455;
/// "Linear" and "sRGB" in a cICP chunk.
///
/// Source: ITU-T H.273, table 3.
const LINEAR_TRANSFER: u8 = 8;
const SRGB_TRANSFER: u8 = 13;

/// The curve by which codes from 0 to 1 stand for light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Curve {
    Srgb,
    Linear,
    /// Light is this power of the code.
    Power(f64),
}

impl Curve {
    /// The warning about a profile that may have another curve, and other colors.
    pub(crate) const IGNORED_PROFILE: &str =
        "its ICC profile is not applied, its colors are taken as sRGB";

    /// The curve by a file's strongest word about it, and a warning where that cannot be followed.
    ///
    /// Source: PNG, third edition, 4.3 "Color spaces". A file that says nothing is sRGB.
    pub(crate) fn of(info: &Info) -> Result<(Self, Option<&'static str>), String> {
        if let Some(points) = info.coding_independent_code_points {
            return match points.transfer_function {
                SRGB_TRANSFER => Ok((Self::Srgb, None)),
                LINEAR_TRANSFER => Ok((Self::Linear, None)),
                other => Err(format!(
                    "its cICP chunk names the transfer function {other}, expected \
                     {SRGB_TRANSFER} (sRGB) or {LINEAR_TRANSFER} (linear)"
                )),
            };
        }
        if info.icc_profile.is_some() {
            return Ok((Self::Srgb, Some(Self::IGNORED_PROFILE)));
        }
        let gamma = info.gama_chunk.map(png::ScaledFloat::into_scaled);
        let curve = match gamma {
            _ if info.srgb.is_some() => Self::Srgb,
            None | Some(0 | GAMMA_OF_SRGB) => Self::Srgb,
            Some(gamma) if f64::from(gamma) == GAMMA_UNIT => Self::Linear,
            Some(gamma) => Self::Power(GAMMA_UNIT / f64::from(gamma)),
        };
        Ok((curve, None))
    }

    /// Its name, for people.
    pub(crate) fn name(self) -> String {
        match self {
            Self::Srgb => "sRGB".to_owned(),
            Self::Linear => "linear".to_owned(),
            Self::Power(power) => format!("gamma {power:.2}"),
        }
    }

    /// The light of a code from 0 to 1.
    pub(crate) fn light(self, code: f64) -> f64 {
        match self {
            Self::Srgb => srgb::decode(code),
            Self::Linear => code,
            Self::Power(power) => libm::pow(code, power),
        }
    }
}
