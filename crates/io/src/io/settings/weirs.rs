//! What lines are for solvers, as texts have it.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::SavedLine;
use crate::io::KeyFault;
use meshbrush_core::domain::{Crest, Line, LineKind, Weir, WeirError};

/// What a line is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SavedLineType {
    /// Edges with a name.
    Line,
    /// A weir or levee.
    Weir,
}

/// The height of a crest, in metres and positive upwards.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "a crest is a height in metres, the name of a file with a grid of heights, or a list of pairs of a share of \
                 the length and a height there, as in [[0, 2.5], [1, 3]]."
)]
pub enum SavedCrest {
    /// One height.
    Height(f64),
    /// A share of the length, from 0 to 1, and the height there, in turn.
    Profile(Vec<[f64; 2]>),
    /// A file with a grid of heights.
    Grid(PathBuf),
}

/// Returns the saved form of a crest that is in place.
impl From<&Crest> for SavedCrest {
    fn from(crest: &Crest) -> Self {
        match crest {
            Crest::Height(height) => Self::Height(*height),
            Crest::Profile(pairs) => Self::Profile(pairs.clone()),
        }
    }
}

/// What a line is, before the grid of its crest is read.
pub(super) enum CheckedKind {
    /// Nothing is to be read.
    Known(LineKind),
    /// The file with the grid, and the weir without its crest.
    Grid(PathBuf, Weir),
}

impl SavedLine {
    /// Returns the keys of the kind of a line, and no others.
    pub(super) fn of_kind(kind: &LineKind) -> Self {
        let LineKind::Weir(Weir { crest, subcritical, supercritical }) = kind else {
            return Self::default();
        };
        let unusual = |value: f64| (value != Weir::USUAL_COEFFICIENT).then_some(value);
        Self {
            line_type: Some(SavedLineType::Weir),
            crest: Some(crest.into()),
            subcritical: unusual(*subcritical),
            supercritical: unusual(*supercritical),
            ..Self::default()
        }
    }

    /// Returns the file with the heights of the crest, if one has them.
    pub(super) fn crest_file(&self) -> Option<&Path> {
        match &self.crest {
            Some(SavedCrest::Grid(file)) => Some(file),
            _ => None,
        }
    }

    /// Returns what the line is.
    pub(super) fn checked_kind(&self) -> Result<CheckedKind, KeyFault> {
        if self.line_type != Some(SavedLineType::Weir) {
            let weir_keys = [
                ("crest", self.crest.is_some()),
                ("subcritical", self.subcritical.is_some()),
                ("supercritical", self.supercritical.is_some()),
            ];
            let given = weir_keys.into_iter().find(|(_, is_given)| *is_given);
            return given.map_or(Ok(CheckedKind::Known(LineKind::Edges)), |(key, _)| {
                let sentence =
                    "this is for a weir, and the line is none. Write `type = \"weir\"`, or leave it out.";
                Err(KeyFault::key(key, sentence))
            });
        }
        let Some(crest) = &self.crest else {
            let sentence = "a weir needs `crest`: its height in metres, positive upwards, or a file with a grid of heights.";
            return Err(KeyFault::entry("type", sentence));
        };
        let (crest, file) = match crest {
            SavedCrest::Height(height) => (Crest::Height(*height), None),
            SavedCrest::Profile(pairs) => (Crest::Profile(pairs.clone()), None),
            SavedCrest::Grid(file) => (Crest::Height(0.0), Some(file.clone())),
        };
        let usual = |value: Option<f64>| value.unwrap_or(Weir::USUAL_COEFFICIENT);
        let (subcritical, supercritical) = (usual(self.subcritical), usual(self.supercritical));
        let weir = Weir { crest, subcritical, supercritical };
        weir.check().map_err(|error| KeyFault::value(self.key_of(&error), error.to_string()))?;
        Ok(match file {
            Some(file) => CheckedKind::Grid(file, weir),
            None => CheckedKind::Known(LineKind::Weir(weir)),
        })
    }

    /// Returns the key whose value is of no use.
    fn key_of(&self, error: &WeirError) -> &'static str {
        match error {
            WeirError::Coefficient(value)
                if self.subcritical.is_some_and(|own| own.to_bits() == value.to_bits()) =>
            {
                "subcritical"
            }
            WeirError::Coefficient(_) => "supercritical",
            _ => "crest",
        }
    }

    /// Gives lines the kind that the keys say; `read` reads a line's crest from the grid of a file.
    pub(super) fn give_kind<E: From<KeyFault>>(
        &self,
        lines: &mut [Line],
        mut read: impl FnMut(&Path, &Line) -> Result<Crest, E>,
    ) -> Result<(), E> {
        match self.checked_kind()? {
            CheckedKind::Known(kind) => lines.iter_mut().for_each(|line| line.kind = kind.clone()),
            CheckedKind::Grid(file, weir) => {
                for line in lines {
                    let crest = read(&file, line)?;
                    line.kind = LineKind::Weir(Weir { crest, ..weir.clone() });
                }
            }
        }
        Ok(())
    }
}
