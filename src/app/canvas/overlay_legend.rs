//! The legends of overlays as data, for the canvas and for exported pictures.

use meshbrush_core::layers::{DepthSurface, SurfaceNorm};
use meshbrush_core::quality::QualityMeasure;
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::{FieldOverlay, deepest_level};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_render::colormap::overlay_palette::{MOST_ERROR, MOST_SLACK, OLD_AGE, OverlayPalette};
use meshbrush_render::render::furniture::{Legend, LegendBody};
use meshbrush_render::render::overlay::measure_legend;
use meshbrush_study::relief::isobath_interval;
use meshbrush_ui::widgets::format;

use super::quality_colors::measure_of;
use crate::app::features::statistics::NoTimeStep;

/// A legend, and what a screen reader says of it.
pub(super) struct SpokenLegend {
    pub legend: Legend,
    pub spoken: String,
}

impl SpokenLegend {
    fn new(legend: Legend, spoken: String) -> Self {
        Self { legend, spoken: format!("Legend: {spoken}") }
    }

    /// Says the title and the ends of a scale.
    fn of_scale(legend: Legend, what: &str) -> Self {
        let ends = match &legend.body {
            LegendBody::Scale(scale) => format!("{} to {}", scale.ends[0], scale.ends[2]),
            LegendBody::Rows(_) | LegendBody::Missing(_) => String::new(),
        };
        Self::new(legend, format!("{what} {ends}"))
    }

    fn missing(title: &str, reason: &str) -> Self {
        Self::new(Legend::missing(title, reason), reason.to_owned())
    }
}

/// Returns the legend of an overlay; `None` where there is no overlay. `smallest` is the smallest time step
/// in seconds, where it is known.
pub(super) fn legend_of(
    kind: FieldOverlay,
    session: &Session,
    palette: &OverlayPalette,
    smallest: Option<f64>,
) -> Option<SpokenLegend> {
    Some(match kind {
        FieldOverlay::None => return None,
        FieldOverlay::Risk => risk(palette),
        FieldOverlay::Target => target(session, palette),
        FieldOverlay::Layer => layers(session, palette),
        FieldOverlay::Slack => slack(palette),
        FieldOverlay::Forced => {
            let row = (palette.forced(true), vec!["compatibility".to_owned()]);
            let spoken = "triangles that only compatibility asked for".to_owned();
            SpokenLegend::new(Legend::rows("Cause", [row]), spoken)
        }
        FieldOverlay::Age => age(palette),
        FieldOverlay::Depth => depth(session, palette),
        FieldOverlay::DepthError => depth_error(session, palette),
        FieldOverlay::Surface => surface(session, palette),
        FieldOverlay::SurfaceError => surface_error(session, palette),
        FieldOverlay::SmallestAngle
        | FieldOverlay::LargestAngle
        | FieldOverlay::EdgeRatio
        | FieldOverlay::TargetRatio
        | FieldOverlay::TimeStep
        | FieldOverlay::Valence
        | FieldOverlay::LinkLength
        | FieldOverlay::Orthogonality => measure(measure_of(kind)?, session, palette, smallest),
    })
}

/// A measure of triangles.
fn measure(
    measure: QualityMeasure,
    session: &Session,
    palette: &OverlayPalette,
    smallest: Option<f64>,
) -> SpokenLegend {
    if measure == QualityMeasure::TimeStep
        && let Some(missing) = no_time_step(session)
    {
        return SpokenLegend::missing("Time step", missing.reason());
    }
    let note = smallest.map_or_else(String::new, |seconds| format!("smallest {}", format::time(seconds)));
    let legend = measure_legend(measure, palette, note);
    let title = legend.title.clone();
    SpokenLegend::of_scale(legend, &title)
}

/// Returns why there are no time steps, where there are none.
pub(super) fn no_time_step(session: &Session) -> Option<NoTimeStep> {
    let settings = session.document().settings();
    match settings.unit {
        LengthUnit::Degree => Some(NoTimeStep::Degrees),
        _ => DepthSurface::of(&settings.layers).is_none().then_some(NoTimeStep::NoDepths),
    }
}

/// Risk from 0 to 1, a cell for each sixteenth.
fn risk(palette: &OverlayPalette) -> SpokenLegend {
    let colors = (0..=16_u8).map(|i| palette.risk((f32::from(i) / 16.0 * 255.0) as u8));
    let legend = Legend::scale("Risk", colors, ["0", "0.5", "1"].map(str::to_owned), "");
    SpokenLegend::of_scale(legend, "risk")
}

/// How often the mesh could be halved less.
fn slack(palette: &OverlayPalette) -> SpokenLegend {
    let steps = 16_u16;
    let color = |step| palette.slack((f32::from(step) + 0.5) / f32::from(steps) * MOST_SLACK);
    let ends = ["1", "4", "≥ 16"].map(str::to_owned);
    let legend = Legend::scale("Slack h̄ / h", (0..steps).map(color), ends, "");
    SpokenLegend::new(legend, "slack 1 to 16".into())
}

/// Ages, from the last edit to old triangles, with a cell for each edit.
fn age(palette: &OverlayPalette) -> SpokenLegend {
    let colors = (0..OLD_AGE + 1).map(|age| palette.age(Some(age)));
    let ends = ["0".into(), (OLD_AGE / 2).to_string(), format!("≥ {OLD_AGE}")];
    SpokenLegend::new(Legend::scale("Edits ago", colors, ends, ""), "edits ago, 0 to 10".into())
}

/// Depths from the shore to the deepest place, and the metres between isobaths.
fn depth(session: &Session, palette: &OverlayPalette) -> SpokenLegend {
    let Some(surface) = DepthSurface::of(&session.document().settings().layers) else {
        return SpokenLegend::missing("Depth", "no layer of depths");
    };
    let deepest = surface.deepest();
    let metres = |depth: f64| LengthUnit::Metre.after(&format::significant(depth, 3));
    let steps = 16_u8;
    let share = |step: u8| (f32::from(step) / f32::from(steps)).powi(2);
    let colors = (0..=steps).map(|step| palette.water(share(step)));
    let ends = ["0".into(), format::significant(0.25 * deepest, 3), metres(deepest)];
    let note = format!("isobaths every {}", metres(isobath_interval(deepest)));
    SpokenLegend::of_scale(Legend::scale("Depth", colors, ends, note), "depth")
}

/// How much deeper the mesh is, as a share of the depth.
fn depth_error(session: &Session, palette: &OverlayPalette) -> SpokenLegend {
    if DepthSurface::of(&session.document().settings().layers).is_none() {
        return SpokenLegend::missing("Depth", "no layer of depths");
    }
    let percent = format::digits(f64::from(100.0 * MOST_ERROR), 3);
    let steps = 8_i8;
    let color = |step: i8| palette.depth_error(MOST_ERROR * f32::from(step) / f32::from(steps));
    let ends = [format!("−{percent} %"), "0".into(), format!("{percent} %")];
    let legend = Legend::scale("Depth error", (-steps..=steps).map(color), ends, "shallower, deeper");
    SpokenLegend::of_scale(legend, "depth error")
}

/// Heights from the lowest to the highest sample, and how far contour lines are apart.
fn surface(session: &Session, palette: &OverlayPalette) -> SpokenLegend {
    let range = session.follower().surface().and_then(|rule| rule.samples().height_range());
    let Some([lowest, highest]) = range else {
        return SpokenLegend::missing("Surface", "no layer of a surface");
    };
    let ends = [lowest, lowest.midpoint(highest), highest].map(|height| format::significant(height, 3));
    let steps = 16_u8;
    let color = |step: u8| palette.height(f32::from(step) / f32::from(steps));
    let interval = isobath_interval((highest - lowest).max(f64::MIN_POSITIVE));
    let note = format!("contours every {}", format::significant(interval, 3));
    SpokenLegend::of_scale(Legend::scale("Surface", (0..=steps).map(color), ends, note), "surface")
}

/// How much higher the mesh is than the surface, up to the error that is allowed.
fn surface_error(session: &Session, palette: &OverlayPalette) -> SpokenLegend {
    let Some(rule) = session.follower().surface() else {
        return SpokenLegend::missing("Surface error", "no layer of a surface");
    };
    let errors: Vec<f64> = rule.errors().map(|(_, error)| error).collect();
    let is_summed = SurfaceNorm::ALL[1..].iter().any(|norm| rule.error_of(*norm).is_some());
    let is_varied = rule.has_errors_of_layers();
    let ends = match errors[..] {
        _ if is_summed => ["−largest", "0", "largest"].map(str::to_owned),
        [first, ..] if !is_varied && first.is_finite() && errors.iter().all(|error| *error == first) => {
            let error = format::significant(first, 3);
            [format!("−{error}"), "0".into(), error]
        }
        // Several errors are allowed.
        _ => ["−100 %", "0", "100 %"].map(str::to_owned),
    };
    let steps = 8_i8;
    let color = |step: i8| palette.surface_error(f32::from(step) / f32::from(steps));
    let legend = Legend::scale("Surface error", (-steps..=steps).map(color), ends, "mesh lower, higher");
    SpokenLegend::of_scale(legend, "surface error")
}

/// The visible layers in their colours, from the top.
fn layers(session: &Session, palette: &OverlayPalette) -> SpokenLegend {
    let layers = session.follower().settings().layers.iter().rev().filter(|layer| layer.visible);
    let rows: Vec<_> =
        layers.map(|layer| (palette.layer(Some(layer.id)), vec![layer.name.to_string()])).collect();
    let names: Vec<&str> = rows.iter().map(|(_, name)| name[0].as_str()).collect();
    let spoken = format!("layers {}", names.join(", "));
    SpokenLegend::new(Legend::rows("Deciding layer", rows), spoken)
}

/// The levels that h̄ can ask for, with the diameters of their triangles.
fn target(session: &Session, palette: &OverlayPalette) -> SpokenLegend {
    let (settings, mesh) = (session.follower().settings(), session.mesh());
    let levels = u32::from(deepest_level(settings)) + 1;
    let row = |level: u32| {
        let diameter = format::length(mesh.diameter(level), settings.unit);
        (palette.level(level as u8), vec![level.to_string(), diameter])
    };
    let spoken = format!("diameters of levels 0 to {}", levels - 1);
    SpokenLegend::new(Legend::rows("h̄ by level", (0..levels).map(row)), spoken)
}
