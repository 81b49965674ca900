//! Writing a path of the document to a file.

use std::path::Path;

use super::{NO_PATH, PathFinder, PathTool};
use meshbrush_core::earth::{EarthPlane, Speed};
use meshbrush_core::layers::RiskField;
use meshbrush_core::path::Solution;
use meshbrush_io::io::{self, MeshSource, Provenance};
use meshbrush_kit::kit::background::{Aim, Background, Outcome, not_exported};
use meshbrush_kit::kit::derivation::Derived;
use meshbrush_kit::kit::mesh_export::OverlayMaker;
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::view::View;
use meshbrush_render::render::look::Look;
use meshbrush_render::render::path_export::{MeshOfPath, PathExport, PathFormat};
use meshbrush_ui::widgets::format;

/// Writes the path of the panel: as GeoJSON, as a table, as a route on the Earth, or as a picture over the
/// mesh in the colours of an overlay or of levels, as the ending says.
///
/// # Errors
/// Fails with a sentence when the path is not that of the document as it is, or when it is clear at once that
/// nothing can be written there.
pub fn export(
    session: &Session,
    (view, overlay): (&View, Option<OverlayMaker>),
    (paths, tool): (&PathFinder, &PathTool),
    background: &mut Background,
    path: &Path,
) -> Result<(), String> {
    let format = PathFormat::from_path(path).map_err(|error| format!("{error}."))?;
    let solution = current_path(session, paths, tool)?.clone();
    let settings = session.document().settings().clone();
    let plane = EarthPlane::new(settings.domain.projection, settings.unit);
    format.check(path, plane).map_err(|error| error.to_string())?;
    let name = settings.paths.name(tool.route_in(&settings.paths).unwrap_or(0));
    if let Some(obstacle) = io::obstacle(path) {
        return Err(format!("{} could not be written: {obstacle}.", path.display()));
    }
    let risk = RiskField::new(&settings.layers, session.document().paint()).within(&settings.domain.bounds);
    let (mesh, derived) = (session.follower().shared_mesh(), session.derived().map(Derived::shared_extract));
    let speed = Speed::from_knots(tool.speed);
    let tolerance = Some(tool.export_tolerance).filter(|&tolerance| tolerance > 0.0);
    let (look, file) = (view.picture_of(&settings), path.to_owned());
    background.start(Aim::Export, path, move |meter| {
        let write = || -> std::io::Result<usize> {
            let density =
                settings.paths.cost.density(risk, &settings.domain).map_err(std::io::Error::other)?;
            let export = PathExport::new(&solution, &*density, tolerance).map_err(std::io::Error::other)?;
            let export = export.named(name, plane).at_speed(speed, settings.unit);
            let export = export.in_coordinates(&settings.domain, None);
            let whole = derived.is_none().then(|| mesh.extract());
            let extract = whole.as_ref().or(derived.as_deref()).expect("one of the two");
            let source = MeshSource::Document(&settings.name);
            let provenance = Provenance::new(source, mesh.fingerprint(), "x, y").with_unit(settings.unit);
            let overlay = overlay.as_ref().filter(|_| matches!(format, PathFormat::Picture(_)));
            let look = Look { overlay: overlay.and_then(|make| make(extract, meter)), ..look.clone() };
            meter.check()?;
            let over = MeshOfPath { mesh: &mesh, extract, look: &look };
            export.write(&file, format, &over, &provenance, meter)?;
            Ok(export.samples().len())
        };
        match write() {
            Ok(points) => {
                let points = format::count(points as u64);
                Outcome::Exported(format!("The path was written to {} with {points} points.", file.display()))
            }
            Err(error) => not_exported(&error, meter, &file),
        }
    });
    Ok(())
}

/// Returns the path of the panel, if it is that of the document as it is.
fn current_path<'a>(
    session: &Session,
    paths: &'a PathFinder,
    tool: &PathTool,
) -> Result<&'a Solution, String> {
    let route = tool.route_in(&session.document().settings().paths).ok_or(NO_PATH)?;
    if !paths.is_current(session) {
        return Err("The path is being found for the last edit. Export it again when that is done.".into());
    }
    let shown = paths.shown().get(route);
    if let Some(problem) = shown.and_then(|shown| shown.problem.as_ref()) {
        return Err(format!("{problem} The path that is shown is outdated, so it is not exported."));
    }
    let found = shown.and_then(|shown| shown.found.as_ref());
    found.map(|found| &found.solution).ok_or_else(|| "There is no path to export yet.".into())
}
