//! The pictures of the repository, drawn by the program itself without a display.

mod manual;
mod offscreen;
mod tour;

use std::path::{Path, PathBuf};

use eframe::egui::{Event, Pos2, ThemePreference, Vec2};
use glam::{DVec2, dvec2};

use super::SMALLEST_SIZE;
use super::WINDOW_SIZE;
use super::features::boundary::BoundaryCommand;
use super::features::boundary::BoundaryToolMode;
use super::features::domain::DomainCommand;
use super::features::domain::DomainToolMode;
use super::features::inspection::InspectCommand;
use super::features::paths::{AlternativesCommand, FrontCommand, PATH, PathCommand};
use super::features::pins::PinsCommand;
use super::features::plots::{PlotKind, PlotsCommand};
use super::features::regions::{RegionCommand, RegionShape, RegionTarget};
use super::features::report::FigureCommand;
use super::features::stepping::StepCommand;
use crate::app::features::inspection::QUERY;
pub use manual::write as write_manual;
use meshbrush_core::document::{DrawnShape, Example, Setting};
use meshbrush_core::domain::CutShape;
use meshbrush_core::field::{Formula, RefinementRule};
use meshbrush_core::layers::{Layer, LayerKind, Threats};
use meshbrush_io::io;
use meshbrush_kit::kit::command::{
    BrushCommand, Command, EditCommand, FileCommand, LayerCommand, ShellCommand, SpaceCommand, ViewCommand,
};
use meshbrush_kit::kit::tools::PaintKind;
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_render::render::Image;
use meshbrush_study::report::ReportFigure;
use offscreen::OffscreenWindow;
pub use tour::write as write_tour;

/// A picture: its name, the size of the window in points, pixels for a point, and what happens before it is
/// taken.
struct Scene {
    name: &'static str,
    size: [f32; 2],
    px_per_point: f32,
    act: fn(&mut OffscreenWindow),
}

const SCENES: [Scene; 22] = [
    scene("window", window),
    scene("query", query),
    scene("why", why),
    scene("plots", plots),
    scene("pins", pins),
    scene("steps", steps),
    scene("figure-4", figure_4),
    scene("walk", walk),
    scene("diamond", diamond),
    scene("terrain", terrain),
    scene("aegean", aegean),
    scene("space", space),
    scene("surface", surface),
    scene("layers", layers),
    scene("path", path),
    Scene { name: "front", size: [1280.0, 1360.0], px_per_point: 1.0, act: front },
    scene("boundary", boundary),
    scene("region", region),
    scene("light", light),
    scene("deep", deep),
    scene("palette", palette),
    Scene { name: "smallest", size: SMALLEST_SIZE, px_per_point: 2.0, act: smallest },
];

const fn scene(name: &'static str, act: fn(&mut OffscreenWindow)) -> Scene {
    Scene { name, size: WINDOW_SIZE, px_per_point: 1.0, act }
}

/// Writes every picture into a folder, and returns the files.
///
/// # Errors
/// Fails with a sentence when there is no graphics driver or a file cannot be written.
pub fn write(folder: &Path) -> Result<Vec<PathBuf>, String> {
    make_folder(folder)?;
    SCENES.iter().map(|scene| scene.write(folder)).collect()
}

impl Scene {
    fn write(&self, folder: &Path) -> Result<PathBuf, String> {
        let mut window = OffscreenWindow::open(Vec2::from(self.size), self.px_per_point)?;
        (self.act)(&mut window);
        let picture = window.picture()?;
        write_picture(folder, self.name, &picture)
    }
}

fn make_folder(folder: &Path) -> Result<(), String> {
    io::make_folder(folder).map_err(|error| format!("{} cannot be made: {error}.", folder.display()))
}

fn write_picture(folder: &Path, name: &str, picture: &Image) -> Result<PathBuf, String> {
    let file = folder.join(format!("{name}.png"));
    let written =
        io::write_file(&file, |mut out| io::png::write_small(&mut out, picture.size, &picture.rgba));
    written.map_err(|error| format!("{} cannot be written: {error}.", file.display()))?;
    Ok(file)
}

/// The first example, about to be painted on, with a queried triangle.
fn window(window: &mut OffscreenWindow) {
    window.send(Command::from(InspectCommand::Query(dvec2(0.651, 0.464))));
    point_at(window, dvec2(0.56, 0.66));
}

/// A triangle at the end of the route, and its neighbours.
fn query(window: &mut OffscreenWindow) {
    let place = dvec2(0.6472, 0.1368);
    window.send(Command::from(ShellCommand::Use(&QUERY)));
    look_at(window, place, 7.0);
    window.send(Command::from(InspectCommand::Query(place)));
    point_at(window, place + dvec2(0.012, 0.028));
}

/// A triangle that compatibility asked for, with the chain of triangles that led to it.
fn why(window: &mut OffscreenWindow) {
    let place = dvec2(0.7431, 0.0208);
    window.send(Command::from(ShellCommand::Use(&QUERY)));
    look_at(window, place + dvec2(0.0, 0.03), 5.0);
    window.send(Command::from(InspectCommand::Query(place)));
    point_at(window, place - dvec2(0.0, 0.05));
}

/// Takes a picture of the cost of compatibility, by level.
fn plots(window: &mut OffscreenWindow) {
    window.send(Command::from(PlotsCommand::Show(PlotKind::Bisections)));
}

/// Pins with the table of their values.
fn pins(window: &mut OffscreenWindow) {
    window.send(Command::from(ShellCommand::Use(&QUERY)));
    for pin in [dvec2(0.651, 0.464), dvec2(0.27, 0.51), dvec2(0.715, 0.735), dvec2(0.9, 0.9)] {
        window.send(Command::from(PinsCommand::Add(pin)));
    }
}

/// A step of the refinement, with a triangle that waits on the stack.
fn steps(window: &mut OffscreenWindow) {
    window.send(Command::from(EditCommand::Set(Setting::SmallestDiameter(0.06))));
    window.send(Command::from(EditCommand::Set(Setting::Spacing(0.25))));
    window.send(Command::from(StepCommand::Begin(None)));
    window.send(Command::from(StepCommand::GoTo(120)));
}

/// A pair of triangles whose neighbours are updated, as in Figure 4 of the report.
fn figure_4(window: &mut OffscreenWindow) {
    window.send(Command::from(FigureCommand::Open(ReportFigure::Neighbours)));
}

/// The walk of point location, with the test of Figure 6 of the report.
fn walk(window: &mut OffscreenWindow) {
    window.send(Command::from(FigureCommand::Open(ReportFigure::Orientation)));
    look_at(window, dvec2(6.2, 0.8), 8.0);
}

/// Figure 1 of the report.
fn diamond(window: &mut OffscreenWindow) {
    window.send(Command::from(FileCommand::OpenExample(Example::Diamond)));
    window.send(Command::from(ShellCommand::Use(&QUERY)));
    window.send(Command::from(InspectCommand::Query(dvec2(6.3, 2.3))));
}

/// Slope as risk, close enough to see triangles.
fn terrain(window: &mut OffscreenWindow) {
    window.send(Command::from(FileCommand::OpenExample(Example::Terrain)));
    window.send(Command::from(ShellCommand::Use(&QUERY)));
    look_at(window, dvec2(20.2, 19.8), 5.0);
    window.send(Command::from(InspectCommand::Query(dvec2(22.1, 19.2))));
}

/// A sea with its mesh fitted to the coast, about to be cut.
fn aegean(window: &mut OffscreenWindow) {
    window.send(Command::from(FileCommand::OpenExample(Example::Aegean)));
    window.send(Command::from(DomainCommand::Mode(DomainToolMode::Brush)));
    window.send(Command::from(BrushCommand::Radius(0.2)));
    point_at(window, dvec2(25.25, 38.1));
}

/// A sea in space, about to be painted on.
fn space(window: &mut OffscreenWindow) {
    window.send(Command::from(FileCommand::OpenExample(Example::CelticSea)));
    window.send(Command::from(ViewCommand::SetOverlay(FieldOverlay::None)));
    window.send(Command::from(ViewCommand::Space(SpaceCommand::Toggle)));
    window.send(Command::from(ViewCommand::Zoom(1.3)));
    let middle = window.domain_center();
    point_at(window, middle);
}

/// The smallest mesh within an error of a terrain, where it is higher and lower, and the curve of the errors.
fn surface(window: &mut OffscreenWindow) {
    window.send(Command::from(FileCommand::OpenExample(Example::Heights)));
    window.send(Command::from(ViewCommand::SetOverlay(FieldOverlay::SurfaceError)));
    let middle = window.domain_center();
    look_at(window, middle, 8.0);
}

/// Every kind of layer. The overlay has the colours of the layers that decide h̄; the threats are selected.
fn layers(window: &mut OffscreenWindow) {
    window.send(Command::from(FileCommand::OpenExample(Example::Layers)));
    window.send(Command::from(ViewCommand::SetOverlay(FieldOverlay::Layer)));
    let is_threats = |layer: &&Layer| layer.kind.is::<Threats>();
    if let Some(threats) = window.layers().iter().find(is_threats).map(|layer| layer.id) {
        window.send(Command::from(LayerCommand::Select(threats)));
    }
    window.send(Command::from(ShellCommand::Use(&QUERY)));
    point_at(window, dvec2(15.9, 17.2));
}

/// A path of least cost between threats, with its proved interval and the risk along it.
fn path(window: &mut OffscreenWindow) {
    window.send(Command::from(FileCommand::OpenExample(Example::Path)));
    window.send(Command::from(ShellCommand::Use(&PATH)));
    window.send(Command::from(ViewCommand::SetOverlay(FieldOverlay::Risk)));
}

/// Takes pictures of other paths: the corridor around the best one, alternatives, and the front of length
/// against risk.
fn front(window: &mut OffscreenWindow) {
    path(window);
    for command in [
        PathCommand::ShowCorridor(true),
        PathCommand::CorridorShare(0.05),
        PathCommand::Alternatives(AlternativesCommand::Show(true)),
        PathCommand::Front(FrontCommand::Show(true)),
    ] {
        window.send(Command::from(command));
    }
}

/// The pieces of a coast, one of them selected.
fn boundary(window: &mut OffscreenWindow) {
    window.send(Command::from(FileCommand::OpenExample(Example::Aegean)));
    window.send(Command::from(BoundaryCommand::Mode(BoundaryToolMode::Select)));
    window.send(Command::from(BoundaryCommand::Click(dvec2(24.9, 35.35), 0.3)));
    point_at(window, dvec2(26.0, 38.3));
}

/// A keep-out region that was drawn by hand, another one under way, and the mask of a layer.
fn region(window: &mut OffscreenWindow) {
    path(window);
    let draw = |shape| Command::from(RegionCommand::Draw(DrawnShape::Area(shape), true));
    let end = || Command::from(EditCommand::EndGesture);
    window.send(Command::from(RegionCommand::Target(RegionTarget::KeepOut)));
    let corners = vec![dvec2(64.0, 28.0), dvec2(77.0, 36.0), dvec2(72.0, 47.0), dvec2(62.0, 40.0)];
    window.send(draw(CutShape::Ring(corners)));
    window.send(end());
    window.send(Command::from(RegionCommand::Target(RegionTarget::Mask)));
    window.send(Command::from(BrushCommand::Radius(12.0)));
    window.send(draw(CutShape::Stroke { path: vec![dvec2(20.0, 30.0), dvec2(40.0, 70.0)], radius: 12.0 }));
    window.send(end());
    window.send(Command::from(RegionCommand::Target(RegionTarget::KeepOut)));
    window.send(Command::from(RegionCommand::Shape(RegionShape::Polygon)));
    for corner in [dvec2(80.0, 50.0), dvec2(96.0, 52.0), dvec2(94.0, 62.0)] {
        window.send(Command::from(RegionCommand::AddCorner(corner)));
    }
    point_at(window, dvec2(84.0, 64.0));
}

/// The first example in the light theme.
fn light(window: &mut OffscreenWindow) {
    window.send(Command::from(ViewCommand::Theme(ThemePreference::Light)));
    window.send(Command::from(InspectCommand::Query(dvec2(0.715, 0.61))));
    point_at(window, dvec2(0.43, 0.73));
}

/// More than thirty levels around a point, by a formula.
fn deep(window: &mut OffscreenWindow) {
    let place = dvec2(0.3127, 0.6183);
    let formula = Formula::parse("max(1e-8, 0.3*hypot(x - 0.3127, y - 0.6183))").expect("a valid formula");
    window.send(Command::from(FileCommand::New));
    window.send(Command::from(EditCommand::Set(Setting::RefinementRule(RefinementRule::Vertex))));
    window.send(Command::from(EditCommand::Set(Setting::SmallestDiameter(1e-8))));
    window.send(Command::from(EditCommand::Set(Setting::Layers(Layer::default_stack(LayerKind::target(
        formula,
    ))))));
    window.send(Command::from(ShellCommand::Use(&QUERY)));
    look_at(window, place, 2e5);
    window.send(Command::from(InspectCommand::Query(place + dvec2(1.1e-6, 0.7e-6))));
}

/// A command by a few of its letters.
fn palette(window: &mut OffscreenWindow) {
    window.send(Command::from(ShellCommand::Palette));
    window.event(Event::Text("over".into()));
}

/// The smallest window, painting a diameter.
fn smallest(window: &mut OffscreenWindow) {
    window.send(Command::from(BrushCommand::Kind(PaintKind::Diameter)));
    point_at(window, dvec2(0.9, 0.5));
}

fn point_at(window: &mut OffscreenWindow, world: DVec2) {
    let at = on_screen(window, world);
    window.event(Event::PointerMoved(at));
}

/// Puts a point of the world in the middle, as a middle drag does, and zooms.
fn look_at(window: &mut OffscreenWindow, world: DVec2, factor: f64) {
    window.send(Command::from(ViewCommand::LookAt(world)));
    window.send(Command::from(ViewCommand::Zoom(factor)));
}

/// Returns the position of a point of the world on the screen.
fn on_screen(window: &OffscreenWindow, world: DVec2) -> Pos2 {
    window.screen_from_world(world).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sizes of windows in points, with pixels for a point: small and large screens, and some at 200 %.
    const SCREENS: [([f32; 2], f32); 5] = [
        ([1280.0, 720.0], 1.0),
        ([1440.0, 900.0], 1.0),
        ([2560.0, 1440.0], 1.0),
        ([1280.0, 720.0], 2.0),
        ([960.0, 540.0], 2.0),
    ];

    /// Writes pictures at all sizes into a folder, for a look:
    /// `MESHBRUSH_SCREENS=/tmp/screens cargo test --lib scenes_at_the_sizes_of_screens -- --ignored`.
    #[test]
    #[ignore = "writes pictures for a look"]
    fn scenes_at_the_sizes_of_screens() {
        let folder = std::env::var_os("MESHBRUSH_SCREENS").expect("a folder in MESHBRUSH_SCREENS");
        let folder = PathBuf::from(folder);
        make_folder(&folder).unwrap();
        let shown = ["window", "query", "steps", "aegean", "layers", "path", "light"];
        for scene in SCENES.iter().filter(|scene| shown.contains(&scene.name)) {
            for (size, px_per_point) in SCREENS {
                let mut window = OffscreenWindow::open(Vec2::from(size), px_per_point).unwrap();
                (scene.act)(&mut window);
                let name = format!("{}-{}x{}@{px_per_point}", scene.name, size[0], size[1]);
                write_picture(&folder, &name, &window.picture().unwrap()).unwrap();
            }
        }
    }
}
