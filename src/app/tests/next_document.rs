//! What is left of a document when another one is opened, and when the brush follows the document.

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use super::{
    FREE, PAINTED_DIAMETER, PAINTED_RISK, Window, click, entries, key, move_to, painted, send, set, settings,
    stroke, triangles, window,
};
use crate::app::features::domain::DomainTool;
use crate::app::features::domain::{DomainCommand, DomainToolMode};
use crate::app::features::painting::BRUSH;
use crate::app::features::regions::RegionCommand;
use crate::app::features::regions::RegionTool;
use meshbrush_core::document::{Example, Setting};
use meshbrush_core::layers::{LayerId, LayerKind, Quantity};
use meshbrush_kit::kit::command::{
    BrushCommand, Command, EditCommand, FileCommand, LayerCommand, ShellCommand, SpaceCommand, ViewCommand,
};
use meshbrush_kit::kit::tools::{BrushMode, PaintKind};
use meshbrush_kit::kit::view::{FieldOverlay, View};
use meshbrush_mesh::geometry::Rect;

fn brush(window: &mut Window, command: BrushCommand) {
    send(window, Command::from(command));
}

/// Chooses of everything that belongs to a document something unusual.
fn disarrange(window: &mut Window) {
    stroke(window, FREE, FREE);
    for command in [
        BrushCommand::Kind(PaintKind::Diameter),
        BrushCommand::Mode(BrushMode::Set),
        BrushCommand::Radius(0.2),
        BrushCommand::Error(3.0),
        BrushCommand::MirrorX(true),
        BrushCommand::MirrorY(true),
    ] {
        brush(window, command);
    }
    for command in [
        Command::from(ViewCommand::SetOverlay(FieldOverlay::Depth)),
        Command::from(ViewCommand::ToggleLevel(3)),
        Command::from(ViewCommand::ShowLevel(Some(2))),
        Command::from(ViewCommand::Zoom(3.0)),
        Command::from(ViewCommand::Space(SpaceCommand::Toggle)),
        Command::from(DomainCommand::Mode(DomainToolMode::Polygon)),
        Command::from(DomainCommand::AddCorner(dvec2(0.1, 0.1))),
        Command::from(RegionCommand::AddCorner(dvec2(0.2, 0.1))),
        Command::from(crate::app::features::inspection::InspectCommand::Query(FREE)),
        Command::from(ShellCommand::Use(&BRUSH)),
    ] {
        send(window, command);
    }
}

/// Returns the view as text, without where its canvas is.
fn described(view: &View) -> String {
    format!("{:?}", View { camera: None, ..view.clone() })
}

#[test]
fn nothing_of_a_document_is_left_in_the_next_one() {
    let open = Command::from(FileCommand::OpenExample(Example::ALL[1]));
    let mut default = window();
    send(&mut default, open.clone());
    let mut changed = window();
    disarrange(&mut changed);
    send(&mut changed, open);
    changed.get_by_role_and_label(Role::Button, "Do not save").click();
    changed.run();
    let (tools, default_tools) = (changed.state().tools(), default.state().tools());
    assert!(!tools.differs_in_choice(default_tools));
    assert_eq!((tools.mirrored, tools.last_painted), ([false; 2], None));
    let extent = settings(&changed).domain.bounds.size().max_element();
    assert_eq!(tools.radius, 0.2 * extent, "the brush keeps its share of the domain");
    assert_eq!(tools.diameter, default_tools.diameter);
    assert_eq!(
        (tools.settings::<DomainTool>(), tools.settings::<RegionTool>(), tools.error),
        (default_tools.settings::<DomainTool>(), default_tools.settings::<RegionTool>(), 1.0)
    );
    assert_eq!(described(changed.state().view()), described(default.state().view()));
    assert_eq!(changed.state().session().queried(), None);
    click(&mut changed, FREE, Modifiers::SHIFT);
    assert_eq!(entries(&changed), 1, "a dab: no line comes from where the last document was painted");
}

#[test]
fn what_a_person_arranged_stays_for_the_next_document() {
    let mut window = window();
    for command in [BrushCommand::Hardness(0.7), BrushCommand::Strength(0.3), BrushCommand::Smoothing(0.4)] {
        brush(&mut window, command);
    }
    send(&mut window, Command::from(ViewCommand::ToggleEdges));
    send(&mut window, Command::from(ViewCommand::Colormap(meshbrush_render::colormap::Colormap::Turbo)));
    send(&mut window, Command::from(FileCommand::New));
    let tools = window.state().tools();
    assert_eq!((tools.hardness, tools.strength(), tools.smoothing), (0.7, 0.3, 0.4));
    let view = window.state().view();
    assert_eq!((view.edges, view.colormap), (false, meshbrush_render::colormap::Colormap::Turbo));
}

#[test]
fn while_a_document_is_made_nothing_of_the_last_one_is_shown() {
    let mut window = window();
    assert!(triangles(&window) > 1000);
    let former = window.state().session().document_id();
    window.state_mut().send(Command::from(FileCommand::OpenExample(Example::CelticSea)));
    let mut frames = 0;
    loop {
        window.step();
        let session = window.state().session();
        if session.document_id() == former {
            continue;
        }
        if !session.awaits_mesh() {
            break;
        }
        frames += 1;
        assert!(session.mesh().raw_triangle_count() < 10 && session.derived().is_none());
        assert_eq!(session.mesh().lattice().bounds(), settings(&window).domain.bounds);
        let texts = super::painted_texts(window.output());
        let cell = texts.iter().position(|(text, _)| text == "triangles").expect("the status bar");
        assert_eq!(texts[cell + 1].0, "–", "the number of triangles");
    }
    assert!(frames > 2, "it takes a while: {frames} frames");
    window.run();
    assert!(triangles(&window) > 20_000);
}

/// A document with a paint layer of diameters above one of risk.
fn add_diameter_layer(window: &mut Window) -> LayerId {
    send(window, Command::from(LayerCommand::Add(Box::new(LayerKind::paint(Quantity::Diameter)))));
    super::active(window).id
}

#[test]
fn the_brush_paints_the_quantity_of_the_selected_layer_however_it_was_selected() {
    let mut window = window();
    let kind = |window: &Window| window.state().tools().kind;
    send(&mut window, Command::from(LayerCommand::Select(PAINTED_RISK)));
    assert_eq!(kind(&window), PaintKind::Risk);
    send(&mut window, Command::from(LayerCommand::Delete(PAINTED_DIAMETER)));
    send(&mut window, Command::from(LayerCommand::Select(PAINTED_RISK)));
    let added = add_diameter_layer(&mut window);
    assert_eq!(kind(&window), PaintKind::Diameter);
    send(&mut window, Command::from(LayerCommand::Delete(added)));
    assert_eq!((super::active(&window).id, kind(&window)), (PAINTED_RISK, PaintKind::Risk), "deleted");
    add_diameter_layer(&mut window);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(kind(&window), PaintKind::Risk, "undone");
    brush(&mut window, BrushCommand::Kind(PaintKind::Diameter));
    assert_eq!(kind(&window), PaintKind::Diameter, "a person may choose what no layer takes");
    send(&mut window, Command::from(LayerCommand::Select(PAINTED_RISK)));
    assert_eq!(kind(&window), PaintKind::Risk, "selected again");
    stroke(&mut window, FREE, FREE);
    assert!(painted(&window, PAINTED_RISK, FREE) > 0.0);
}

#[test]
fn the_brush_keeps_its_share_of_the_domain_there_and_back() {
    let mut window = window();
    let sizes = |window: &Window| [window.state().tools().radius, window.state().tools().diameter];
    let before = sizes(&window);
    let grown = Rect::new(DVec2::ZERO, DVec2::splat(5.0));
    set(&mut window, Setting::Bounds(grown));
    let near = |found: [f64; 2], wanted: [f64; 2]| {
        found.iter().zip(wanted).all(|(found, wanted)| (found / wanted - 1.0).abs() < 1e-12)
    };
    assert!(near(sizes(&window), before.map(|size| 5.0 * size)), "{:?}", sizes(&window));
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(near(sizes(&window), before), "{:?}", sizes(&window));
    key(&mut window, CTRL_Y.0, CTRL_Y.1);
    assert!(near(sizes(&window), before.map(|size| 5.0 * size)), "{:?}", sizes(&window));
}

const CTRL_Y: (Modifiers, Key) = (Modifiers::COMMAND, Key::Y);

#[test]
fn the_brush_is_of_use_at_any_zoom() {
    let mut window = window();
    let least = |window: &mut Window| {
        brush(window, BrushCommand::Radius(0.0));
        window.state().tools().radius
    };
    assert_eq!(least(&mut window), 1e-4, "the whole domain is in sight");
    send(&mut window, Command::from(ViewCommand::LookAt(FREE)));
    send(&mut window, Command::from(ViewCommand::Zoom(20_000.0)));
    let px = window.state().view().world_per_px();
    let radius = least(&mut window);
    assert!(radius <= px && radius > 0.1 * px, "{radius} beside a pixel of {px}");
    let lattice = *window.state().session().mesh().lattice();
    assert!(radius >= lattice.step().max_element(), "no finer than meshes are");
    brush(&mut window, BrushCommand::Radius(20.0 * px));
    move_to(&mut window, FREE);
    click(&mut window, FREE, Modifiers::NONE);
    assert_eq!(entries(&window), 1);
    send(&mut window, Command::from(EditCommand::Undo));
}
