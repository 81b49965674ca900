//! Options with a length that has a unit.

use super::args::InputArguments;
use super::failure::Failure;
use meshbrush_mesh::text::{Length, LengthUnit};

/// An option with a length that has a unit.
#[derive(Debug)]
pub struct LengthWithUnit {
    option: &'static str,
    length: Length,
}

impl LengthWithUnit {
    /// Returns the lengths with a unit among the options on what to mesh.
    pub fn all(typed: &InputArguments) -> Vec<Self> {
        let lengths = [
            ("--boundary-diameter", &typed.boundary_diameter),
            ("--spacing", &typed.spacing),
            ("--distance-at-zero", &typed.distances.distance_at_zero),
            ("--distance-range", &typed.distances.distance_range),
            ("--smoothing", &typed.water.smoothing),
            ("--widest-strait", &typed.water.widest_strait),
            ("--widest-feature", &typed.water.widest_feature),
            ("--h-min", &typed.h_min),
            ("--h-risk", &typed.h_risk),
            ("--h-max", &typed.h_max),
        ];
        let lengths = lengths.into_iter().filter_map(|(option, length)| Some((option, length.clone()?)));
        let targets = typed.target.iter().filter_map(|text| Some(("--target", Length::with_unit(text)?)));
        let with_unit = lengths.chain(targets).filter(|(_, length)| length.has_unit());
        with_unit.map(|(option, length)| Self { option, length }).collect()
    }

    /// Returns whether it is in metres.
    pub fn is_metric(&self) -> bool {
        self.length.unit() == LengthUnit::Metre
    }

    /// Checks that the length has a meaning in a document.
    ///
    /// # Errors
    /// Fails with the option where lengths of the document are in another unit.
    pub fn check(&self, of_document: LengthUnit) -> Result<(), Failure> {
        check(self.option, &self.length, of_document)
    }
}

/// Checks that the length of an option has a meaning in a document.
///
/// # Errors
/// Fails with the option where lengths of the document are in another unit.
pub fn check(option: &str, length: &Length, of_document: LengthUnit) -> Result<(), Failure> {
    length.check(of_document).map_err(|problem| Failure::Usage(format!("{option} {length}: {problem}")))
}
