//! The transfer function of a PNG: the relation between codes and light.

use png::Info;

use marbles_core::srgb;

/// The unit of a gAMA chunk.
const GAMMA_UNIT: f64 = 100_000.0;
/// The gAMA of sRGB pictures, which is only an approximation.
const GAMMA_OF_SRGB: u32 = 45_455;
/// The numbers of "linear" and "sRGB" in a cICP chunk.
///
/// Source: ITU-T H.273, table 3.
const LINEAR_TRANSFER: u8 = 8;
const SRGB_TRANSFER: u8 = 13;

/// The function from codes to light, both from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Curve {
    Srgb,
    Linear,
    /// Light is a power of the code, with this exponent.
    Power(f64),
}

impl Curve {
    /// The warning about a profile, whose function and colors may differ from sRGB.
    pub(crate) const IGNORED_PROFILE: &str =
        "its ICC profile is ignored: its colors are read as sRGB";

    /// The function according to the chunk with the highest priority, and a warning if it is not supported.
    ///
    /// Source: PNG, third edition, 4.3 "Color spaces". A file without such chunks is sRGB.
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
