//! What colours the triangles of a picture in place of their levels.

use std::fmt;
use std::str::FromStr;

use glam::DVec2;
use rayon::prelude::*;

use super::build::FinishedMesh;
use super::failure::Failure;
use meshbrush_core::layers::{LevelCache, NodeDepths};
use meshbrush_core::quality::{QualityMeasure, TriangleMeasures};
use meshbrush_mesh::mesh::{Extract, TriangleId};
use meshbrush_mesh::text::{LengthUnit, digits};
use meshbrush_render::colormap::LevelColors;
use meshbrush_render::colormap::overlay_palette::OverlayPalette;
use meshbrush_render::render::furniture::Legend;
use meshbrush_render::render::overlay::{OverlayColors, PictureOverlay, measure_overlay};

/// Triangles that a thread takes at a time, with a cache of its own.
const GRAIN: usize = 4096;

/// What colours the triangles of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorBy {
    /// Their levels.
    #[default]
    Levels,
    /// The level that h̄ asks for at their middles.
    Target,
    /// How good they are.
    Measure(QualityMeasure),
}

/// The error for a word that names nothing to colour by.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("“{0}” is nothing that triangles can be coloured by; use {names}.", names = ColorBy::names())]
pub struct UnknownColorBy(String);

impl ColorBy {
    fn all() -> impl Iterator<Item = Self> {
        [Self::Levels, Self::Target].into_iter().chain(QualityMeasure::ALL.map(Self::Measure))
    }

    /// Returns its name, as in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Levels => "levels",
            Self::Target => "target",
            Self::Measure(measure) => measure.key(),
        }
    }

    fn names() -> String {
        let names: Vec<&str> = Self::all().map(Self::name).collect();
        let (last, others) = names.split_last().unwrap_or((&"", &[]));
        format!("{} or {last}", others.join(", "))
    }

    /// Returns the colours of the triangles of a mesh as files get it, with their legend; `None` for levels.
    ///
    /// # Errors
    /// Fails with a sentence where the mesh does not have the measure.
    pub fn overlay(
        self,
        finished: &FinishedMesh,
        extract: &Extract,
        palette: &OverlayPalette,
        levels: &LevelColors,
    ) -> Result<Option<PictureOverlay>, Failure> {
        match self {
            Self::Levels => Ok(None),
            Self::Target => Ok(Some(by_target(finished, extract, palette, levels))),
            Self::Measure(measure) => by_measure(measure, finished, extract, palette).map(Some),
        }
    }
}

impl fmt::Display for ColorBy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for ColorBy {
    type Err = UnknownColorBy;

    /// Reads a name; `-` and `_` are the same.
    fn from_str(text: &str) -> Result<Self, UnknownColorBy> {
        let name = text.trim().replace('-', "_");
        Self::all().find(|by| by.name() == name).ok_or_else(|| UnknownColorBy(text.into()))
    }
}

fn by_measure(
    measure: QualityMeasure,
    finished: &FinishedMesh,
    extract: &Extract,
    palette: &OverlayPalette,
) -> Result<PictureOverlay, Failure> {
    let cannot = |reason: &str| {
        let by = ColorBy::Measure(measure);
        Failure::Usage(format!("--color-by {by}: {reason}"))
    };
    let is_time = measure == QualityMeasure::TimeStep;
    if is_time && finished.unit() == LengthUnit::Degree {
        let reason = "lengths are degrees, and time steps need metres. Choose a plane with --projection.";
        return Err(cannot(reason));
    }
    let depths = is_time.then(|| NodeDepths::of(finished.layers(), extract.view())).flatten();
    let depths = depths.transpose().map_err(|error| cannot(&format!("{error}.")))?;
    let measures = TriangleMeasures::new(extract.view(), finished.ground());
    let mut measures = measures.with_target(&finished.built().field, finished.paint());
    if let Some(NodeDepths { depths, .. }) = &depths {
        measures = measures.with_depths(depths, finished.unit());
    }
    if measure.is_of_links() {
        measures = measures.with_links(finished.unit());
    }
    let time = |seconds: f64| format!("{} s", digits(seconds, 3));
    let overlay = measure_overlay(&measures, measure, palette, time);
    overlay.ok_or_else(|| {
        cannot("no triangle has a time step: it follows from a layer of depths. Add one with --depth.")
    })
}

/// Colours each triangle by the level that h̄ asks for at its middle.
fn by_target(
    finished: &FinishedMesh,
    extract: &Extract,
    palette: &OverlayPalette,
    colors: &LevelColors,
) -> PictureOverlay {
    let (field, paint, view) = (&finished.built().field, finished.paint(), extract.view());
    let count = extract.triangles().len();
    let level = |triangle: usize, squares: &mut LevelCache| {
        let middle = view.world_corners(TriangleId::from_index(triangle)).iter().sum::<DVec2>() / 3.0;
        let target = field.quick_decision_at(squares, paint, middle).target;
        field.level_of_diameter(target, middle).unwrap_or(63).min(63)
    };
    let part = |from: usize| -> Vec<u32> {
        let mut squares = LevelCache::default();
        (from..count.min(from + GRAIN)).map(|triangle| level(triangle, &mut squares)).collect()
    };
    let levels: Vec<u32> = (0..count).into_par_iter().step_by(GRAIN).flat_map_iter(part).collect();
    let [least, most] = [levels.iter().min(), levels.iter().max()].map(|level| level.copied().unwrap_or(0));
    let row = |level: u32| {
        let diameter = finished.unit().after(&digits(finished.mesh().diameter(level), 3));
        (colors.of(level as u8), vec![level.to_string(), diameter])
    };
    let triangles: Vec<_> = levels.iter().map(|&level| colors.of(level as u8)).collect();
    PictureOverlay {
        legend: Legend::rows("h̄ by level", (least..=most).map(row)),
        neutral: palette.neutral(),
        colors: OverlayColors::Triangles(triangles.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_json_and_others_are_refused_with_all_of_them() {
        for by in ColorBy::all() {
            assert_eq!(by.to_string().parse(), Ok(by));
            assert_eq!(by.to_string().replace('_', "-").parse(), Ok(by));
        }
        let refused = "angle".parse::<ColorBy>().unwrap_err().to_string();
        assert!(
            refused.starts_with("“angle” is nothing that triangles can be coloured by; use levels, target, ")
        );
        assert!(refused.ends_with("triangles_at_node, link_length or link_cosine."), "{refused}");
    }
}
