//! Lines of a project.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use meshbrush_core::domain::{Crest, Line, LineKind, Weir};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StoredLine {
    name: String,
    /// x and y of each corner.
    points: Vec<[f64; 2]>,
    #[serde(default)]
    closed: bool,
    /// Missing where it is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weir: Option<StoredWeir>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredWeir {
    crest: StoredCrest,
    subcritical: f64,
    supercritical: f64,
}

/// In metres, positive upwards.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum StoredCrest {
    Height(f64),
    /// Shares of the length and the heights there.
    Profile(Vec<[f64; 2]>),
}

impl StoredLine {
    pub(super) fn of(Line { name, points, closed, kind }: &Line) -> Self {
        let points = points.iter().map(DVec2::to_array).collect();
        let weir = match kind {
            LineKind::Edges => None,
            LineKind::Weir(weir) => Some(StoredWeir::of(weir)),
        };
        Self { name: name.clone(), points, closed: *closed, weir }
    }

    pub(super) fn load(self) -> Line {
        let points = self.points.into_iter().map(DVec2::from_array).collect();
        let kind = self.weir.map_or(LineKind::Edges, |weir| LineKind::Weir(weir.load()));
        Line { name: self.name, points, closed: self.closed, kind }
    }
}

impl StoredWeir {
    fn of(Weir { crest, subcritical, supercritical }: &Weir) -> Self {
        let crest = match crest {
            Crest::Height(height) => StoredCrest::Height(*height),
            Crest::Profile(pairs) => StoredCrest::Profile(pairs.clone()),
        };
        Self { crest, subcritical: *subcritical, supercritical: *supercritical }
    }

    fn load(self) -> Weir {
        let crest = match self.crest {
            StoredCrest::Height(height) => Crest::Height(height),
            StoredCrest::Profile(pairs) => Crest::Profile(pairs),
        };
        Weir { crest, subcritical: self.subcritical, supercritical: self.supercritical }
    }
}
