//! Projections as PROJ writes them: `+proj=tmerc +lon_0=15 +k_0=0.9996 +ellps=WGS84 +units=m`.

use std::fmt;
use std::str::FromStr;

use glam::{DVec2, dvec2};

use super::{Parameters, Projection, ProjectionKind};
use crate::text::excerpt;

/// A text that is no projection of this program.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "“{text}” is not a projection of this program: {problem}. Write one of auto, metres, merc, tmerc, stere and lcc, the code of \
     one such as EPSG:32633, or all numbers as PROJ does: “+proj=lcc +lat_0=60 +lat_1=60 +lat_2=60 +lon_0=20 +ellps=WGS84 +units=m”."
)]
pub struct ProjectionTextError {
    /// The beginning of the text.
    text: String,
    problem: String,
}

impl ProjectionTextError {
    pub(super) fn new(text: &str, problem: String) -> Self {
        Self { text: excerpt(80, text), problem }
    }
}

impl fmt::Display for Projection {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "+proj={} ", self.kind().word())?;
        match self.parameters {
            Parameters::Mercator { true_latitude } => write!(f, "+lat_ts={true_latitude} ")?,
            Parameters::TransverseMercator { scale } => write!(f, "+lat_0=0 +k_0={scale} ")?,
            Parameters::PolarStereographic { true_latitude } => {
                write!(f, "+lat_0={} +lat_ts={true_latitude} ", 90.0_f64.copysign(true_latitude))?;
            }
            Parameters::Lambert { origin, parallels: [first, second] } => {
                write!(f, "+lat_0={origin} +lat_1={first} +lat_2={second} ")?;
            }
        }
        write!(f, "+lon_0={} ", self.central_meridian)?;
        if self.origin != DVec2::ZERO {
            write!(f, "+x_0={} +y_0={} ", self.origin.x, self.origin.y)?;
        }
        write!(f, "+ellps=WGS84 +units=m")
    }
}

/// Largest false easting and northing, in metres.
const FARTHEST: f64 = 1e8;

/// The numbers of a text.
#[derive(Default)]
struct ProjParameters {
    kind: Option<ProjectionKind>,
    numbers: Vec<(String, f64)>,
}

impl ProjParameters {
    fn parse(text: &str) -> Result<Self, String> {
        let mut words = Self::default();
        for word in text.split_whitespace() {
            let (key, value) = word.trim_start_matches('+').split_once('=').unwrap_or((word, ""));
            match (key, value) {
                ("proj", _) => {
                    let kind = ProjectionKind::ALL.into_iter().find(|kind| kind.word() == value);
                    let known = ProjectionKind::ALL.map(ProjectionKind::word).join(", ");
                    words.kind = Some(kind.ok_or_else(|| {
                        format!(
                            "its family must be one of {known}, which keep angles, and it is “{}”",
                            excerpt(20, value)
                        )
                    })?);
                }
                ("ellps" | "datum", "WGS84")
                | ("units", "m")
                | ("+no_defs" | "no_defs" | "+type" | "type", _) => {}
                ("lon_0" | "lat_0" | "lat_1" | "lat_2" | "lat_ts" | "k_0" | "x_0" | "y_0", _) => {
                    let number = value.parse().ok().filter(|number: &f64| number.is_finite());
                    let number = number.ok_or_else(|| format!("{key} needs a finite number"))?;
                    words.numbers.push((key.to_owned(), number));
                }
                _ => return Err(format!("“{}” is not known here", excerpt(30, word))),
            }
        }
        Ok(words)
    }

    fn get(&self, key: &str) -> Option<f64> {
        self.numbers.iter().find(|(known, _)| known == key).map(|&(_, number)| number)
    }

    /// Returns a number within limits.
    fn within(&self, key: &str, default: f64, most: f64) -> Result<f64, String> {
        let number = self.get(key).unwrap_or(default);
        if number.abs() <= most { Ok(number) } else { Err(format!("{key} is from {} to {most}", -most)) }
    }

    fn projection(&self) -> Result<Projection, String> {
        let kind = self.kind.ok_or("it has no +proj")?;
        let origin = dvec2(self.within("x_0", 0.0, FARTHEST)?, self.within("y_0", 0.0, FARTHEST)?);
        let parameters = match kind {
            ProjectionKind::Mercator => {
                Parameters::Mercator { true_latitude: self.within("lat_ts", 0.0, 85.0)? }
            }
            ProjectionKind::TransverseMercator => {
                self.within("lat_0", 0.0, 0.0).map_err(|_| "lat_0 is 0".to_owned())?;
                let scale = self.get("k_0").unwrap_or(1.0);
                if !(0.1..=10.0).contains(&scale) {
                    return Err("k_0 is from 0.1 to 10".into());
                }
                Parameters::TransverseMercator { scale }
            }
            ProjectionKind::PolarStereographic => {
                let pole = self.get("lat_0").unwrap_or(90.0);
                let true_latitude = self.within("lat_ts", pole, 90.0)?;
                if pole.abs() != 90.0 || pole * true_latitude <= 0.0 {
                    return Err("lat_0 is 90 or -90, and lat_ts of the same half".into());
                }
                Parameters::PolarStereographic { true_latitude }
            }
            ProjectionKind::Lambert => {
                let origin = self.within("lat_0", 0.0, 89.0)?;
                let first = self.within("lat_1", origin, 89.0)?;
                let parallels = [first, self.within("lat_2", first, 89.0)?];
                if (parallels[0] + parallels[1]).abs() < 1.0 {
                    return Err("lat_1 and lat_2 are not on opposite sides of the equator".into());
                }
                Parameters::Lambert { origin, parallels }
            }
        };
        Ok(Projection::new(self.within("lon_0", 0.0, 360.0)?, parameters).with_origin(origin))
    }
}

impl FromStr for Projection {
    type Err = ProjectionTextError;

    fn from_str(text: &str) -> Result<Self, ProjectionTextError> {
        let parsed = ProjParameters::parse(text).and_then(|words| words.projection());
        parsed.map_err(|problem| ProjectionTextError::new(text, problem))
    }
}
