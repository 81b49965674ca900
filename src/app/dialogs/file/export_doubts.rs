//! What a person may miss in the files of an export, in sentences.

use meshbrush_core::document::Settings;
use meshbrush_core::layers::DepthSurface;
use meshbrush_io::io::ThirdCoordinate;
use meshbrush_kit::kit::mesh_export::{DepthFigures, ExportFigures};
use meshbrush_render::render::export::ExportFormat;
use meshbrush_ui::widgets::format;

/// Returns a sentence for each thing of a document that files of a format do not hold as a person may expect,
/// or the reason why they cannot be written. Figures are those of the mesh, once they are known.
pub fn sentences(
    format: ExportFormat,
    settings: &Settings,
    figures: Option<&Result<ExportFigures, String>>,
) -> impl Iterator<Item = String> {
    let of_format = [lost_in_pictures(format), lost_in_models(format, settings)];
    let of_mesh = match figures {
        Some(Ok(figures)) => {
            [filled_depths(settings, figures), depth_of_zero(format, figures), closed(format, figures)]
        }
        Some(Err(problem)) => {
            [Some(format!("It cannot be written: {}.", problem.trim_end_matches('.'))), None, None]
        }
        None => [None, None, None],
    };
    let of_rules =
        figures.and_then(|figures| figures.as_ref().ok()?.broken_rules.clone()).unwrap_or_default();
    of_format.into_iter().chain(of_mesh).flatten().chain(of_rules)
}

fn lost_in_pictures(format: ExportFormat) -> Option<String> {
    let is_picture = !format.wants_node_data();
    is_picture.then(|| "A picture has no nodes and triangles that a program could read.".into())
}

fn lost_in_models(format: ExportFormat, settings: &Settings) -> Option<String> {
    let has_depths = DepthSurface::of(&settings.layers).is_some();
    let has_pieces = !settings.boundary_marks.is_empty();
    let what = match (has_depths, has_pieces) {
        (true, true) => "Depths and the pieces of the boundary are",
        (true, false) => "Depths are",
        (false, true) => "The pieces of the boundary are",
        (false, false) => return None,
    };
    let is_model = format.third_coordinate() == ThirdCoordinate::Model;
    is_model.then(|| format!("{what} not in files of models."))
}

fn filled_depths(settings: &Settings, figures: &ExportFigures) -> Option<String> {
    let DepthFigures { filled, farthest } = figures.depths.filter(|depths| depths.filled > 0)?;
    let [filled, nodes] = [filled, figures.nodes].map(|count| format::count(count as u64));
    let distance = format::length(settings.domain.longest_on_earth(farthest), settings.unit);
    Some(format!(
        "{filled} of {nodes} nodes are where no layer has a depth. They get that of the nearest pixel, at most \
         {distance} away."
    ))
}

fn depth_of_zero(format: ExportFormat, figures: &ExportFigures) -> Option<String> {
    let lacks = format.has_open_boundary() && figures.depths.is_none();
    lacks.then(|| "There is no layer of depths: the solver gets a depth of 0 everywhere.".into())
}

fn closed(format: ExportFormat, figures: &ExportFigures) -> Option<String> {
    let is_closed = format.has_open_boundary() && !figures.has_open_edge;
    is_closed.then(|| {
        "No part of the boundary is open: the solver gets a closed basin. Domain > Boundary gives pieces a type.".into()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use meshbrush_core::domain::{BoundaryMarks, BoundaryType};

    fn said(ending: &str, settings: &Settings, figures: &Result<ExportFigures, String>) -> String {
        let format = ExportFormat::from_ending(ending).expect("a format");
        sentences(format, settings, Some(figures)).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn a_solver_is_told_to_get_filled_depths_and_a_closed_basin() {
        let depths = Some(DepthFigures { filled: 191, farthest: 0.25 });
        let figures = ExportFigures {
            bytes: None,
            triangles: 2,
            nodes: 1234,
            squares: 0,
            depths,
            broken_rules: None,
            has_open_edge: false,
        };
        let settings = Settings::default();
        let text = said("14", &settings, &Ok(figures.clone()));
        assert!(text.contains("191 of 1,234 nodes are where no layer has a depth"), "{text}");
        assert!(text.contains("closed basin") && !text.contains("depth of 0"), "{text}");
        assert_eq!(said("vtu", &settings, &Ok(ExportFigures { depths: None, ..figures.clone() })), "");
        let open = ExportFigures { depths: None, has_open_edge: true, ..figures };
        assert!(said("14", &settings, &Ok(open)).starts_with("There is no layer of depths"));
    }

    #[test]
    fn a_model_has_no_pieces_of_the_boundary_and_a_problem_is_said() {
        let mark = (DVec2::ZERO, BoundaryType::Open);
        let boundary_marks = BoundaryMarks { types: vec![mark], ..BoundaryMarks::default() }.into();
        let settings = Settings { boundary_marks, ..Settings::default() };
        let text = said("obj", &settings, &Err("12 nodes have no depth.".into()));
        assert_eq!(
            text,
            "The pieces of the boundary are not in files of models. It cannot be written: 12 nodes have no depth."
        );
    }
}
