//! The overlay of the canvas in exported pictures.

use std::sync::Arc;

use super::overlay::OverlayState;
use super::overlay_data::OverlayData;
use super::overlay_legend::{legend_of, no_time_step};
use super::quality_colors::measure_of;
use meshbrush_io::io::Meter;
use meshbrush_kit::kit::mesh_export::OverlayMaker;
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::{FieldOverlay, View, deepest_level};
use meshbrush_mesh::mesh::Extract;
use meshbrush_render::colormap::LevelColors;
use meshbrush_render::colormap::overlay_palette::OverlayPalette;
use meshbrush_render::render::overlay::{OverlayColors, PictureOverlay};
use meshbrush_ui::widgets::format;

/// Returns what makes the overlay of exported pictures, if they show one. Time steps are those of a Courant
/// number.
pub fn overlay_of_picture(session: &Session, view: &View, courant: f64) -> Option<OverlayMaker> {
    let kind = view.overlay_of_pictures();
    let settings = session.document().settings();
    let theme = view.picture.ground_in(view.ground).theme();
    let levels = LevelColors::new(view.colormap, theme, deepest_level(settings));
    let palette = OverlayPalette::new(theme, levels);
    let legend = legend_of(kind, session, &palette, None)?.legend;
    let has_measure = kind != FieldOverlay::TimeStep || no_time_step(session).is_none();
    let measure = measure_of(kind).filter(|_| has_measure);
    let (domain, data) = (settings.domain.bounds, Arc::new(OverlayData::of(session, kind)));
    Some(Box::new(move |extract: &Extract, meter: &Meter| {
        let goes_on = || !meter.is_cancelled();
        let neutral = palette.neutral();
        if let Some(measure) = measure {
            let time = |seconds: f64| format::time(courant * seconds);
            if let Some(overlay) = data.quality().overlay(extract, measure, &palette, time) {
                return Some(overlay);
            }
        }
        let by_triangle = data.colors_by_triangle(kind, &palette, extract, &goes_on);
        if let Some(colors) = by_triangle {
            let colors = OverlayColors::Triangles(colors.into());
            return Some(PictureOverlay { legend: legend.clone(), neutral, colors });
        }
        let (data, palette, meter) = (data.clone(), palette.clone(), meter.clone());
        let extract = Arc::new(extract.clone().into_owned());
        let colors = OverlayColors::Pixels(Arc::new(move |bounds, size| {
            let state = OverlayState::once(kind, domain, (bounds, size), palette.clone());
            data.colors(&state, Some(&extract), &|| !meter.is_cancelled()).unwrap_or_default()
        }));
        Some(PictureOverlay { legend: legend.clone(), neutral, colors })
    }))
}
