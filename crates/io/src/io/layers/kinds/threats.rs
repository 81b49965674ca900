use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::super::{LayerData, LayerOrigin, SavedThreat, Stored, each};
use super::kind_keys::{KindKeys, LoadKind};
use crate::io::KeyFault;
use meshbrush_core::layers::{LayerKind, Threat, ThreatError};

/// The keys of threats, which are in a file or in place.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThreatKeys {
    /// A table of threats.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// Threats in place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threats: Option<Vec<SavedThreat>>,
}

impl ThreatKeys {
    /// Returns the threats, if they are in place.
    fn in_place(&self) -> Result<Option<Vec<Threat>>, KeyFault> {
        match (&self.file, &self.threats) {
            (Some(_), None) => Ok(None),
            (None, Some(list)) => each("threats", list, threat).map(Some),
            (Some(_), Some(_)) => {
                Err(KeyFault::key("threats", "the threats are in `file` or in `threats`, not in both."))
            }
            (None, None) => {
                let needs = "needs `file`, a .csv, or `threats`, a list of { x, y, range, peak, law }";
                Err(ThreatKeys::missing(needs))
            }
        }
    }
}

impl KindKeys for ThreatKeys {
    fn check(&self, _: Stored) -> Result<(), KeyFault> {
        self.in_place().map(|_| ())
    }

    fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    fn file_key(&mut self) -> Option<&mut Option<PathBuf>> {
        Some(&mut self.file)
    }

    fn is_risk(&self) -> bool {
        true
    }
}

impl LoadKind for ThreatKeys {
    const WORD: &str = "threats";
    const NAME: &str = "Threats";

    fn load<D: LayerData>(&self, origin: &LayerOrigin, data: &mut D) -> Result<LayerKind, D::Error> {
        Ok(LayerKind::Threats(match self.in_place()? {
            Some(list) => origin.indexed_threats(list)?,
            None => data.threats(origin)?,
        }))
    }
}

fn threat(saved: &SavedThreat) -> Result<Threat, KeyFault> {
    let threat = Threat::from(*saved);
    let key = |error: &ThreatError| match error {
        ThreatError::Place { x, .. } if !x.is_finite() => "x",
        ThreatError::Place { .. } => "y",
        ThreatError::Range(_) => "range",
        ThreatError::Peak(_) => "peak",
    };
    threat.check().map(|()| threat).map_err(|error| KeyFault::value(key(&error), error.to_string()))
}
