//! Every control explains itself.

use std::sync::Arc;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::DVec2;

use super::{
    FREE, TALL, Window, canvas, choose, entries, key, open_popup, open_section, open_tab, send, wait_until,
    window_of,
};
use crate::app::features::ROWS;
use crate::app::features::inspection::InspectCommand;
use crate::app::features::stepping::StepCommand;
use crate::app::features::threats::ThreatsCommand;
use meshbrush_core::document::{Setting, Settings};
use meshbrush_core::domain::PieceChoice;
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{
    DepthRule, DepthSizes, Depths, DistanceLayer, DistanceTo, LayerKind, PositiveDepth, RasterSource,
    ShapeList, Shapes, Threats,
};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_kit::kit::command::{Command, EditCommand, LayerCommand, ShellCommand};
use meshbrush_kit::kit::{Tab, all_tools};
use meshbrush_mesh::geometry::Rect;

/// Height of the menu bar, in points.
const MENU_BAR: f32 = 36.0;

const SLOPE: DepthRule = DepthRule::Slope { triangles: 9.0, smoothing: 0.0 };
const COURANT: DepthRule = DepthRule::Courant { time_step: 1.0, number: 0.5 };

const CONTROLS: [Role; 7] = [
    Role::Button,
    Role::Slider,
    Role::TextInput,
    Role::RadioButton,
    Role::CheckBox,
    Role::ComboBox,
    Role::Definition,
];

/// Returns the names of the controls and values on the tool strip, in the docks, on the strip above the
/// canvas and in its popups that have no sentence.
pub fn unexplained(window: &Window) -> Vec<String> {
    let canvas = canvas(window);
    let controls = CONTROLS.into_iter().flat_map(|role| window.query_all_by_role(role));
    controls
        .filter(|node| node.rect().top() >= MENU_BAR)
        // The status bar.
        .filter(|node| node.rect().bottom() <= canvas.bottom())
        // The title of a section shows that it folds.
        .filter(|node| {
            node.accesskit_node().data().is_expanded().is_none()
                || node.accesskit_node().role() == Role::ComboBox
        })
        .filter(|node| node.accesskit_node().description().is_none_or(|text| text.is_empty()))
        .map(|node| node.accesskit_node().label().unwrap_or_default())
        .collect()
}

#[test]
fn every_control_of_the_panels_has_a_sentence() {
    let mut window = window_of(vec2(TALL.x, 3000.0));
    send(&mut window, Command::from(InspectCommand::Query(FREE)));
    for section in ["Mesh", "Background picture", "Statistics", "Quality"] {
        open_section(&mut window, section);
    }
    wait_until(&mut window, |window| window.query_by_label("Fingerprint").is_some());
    for tab in Tab::LOWER.into_iter().filter(|tab| *tab != Tab::Method) {
        open_tab(&mut window, tab);
        assert_eq!(unexplained(&window), [""; 0], "{tab:?}");
    }
    choose(&mut window, "Method", "Show the tab Method");
    assert_eq!(unexplained(&window), [""; 0]);
    for popup in ["More options", "View options", "Overlays"] {
        open_popup(&mut window, popup);
        assert_eq!(unexplained(&window), [""; 0], "{popup}");
        key(&mut window, Modifiers::NONE, Key::Escape);
    }
    send(&mut window, Command::from(EditCommand::Set(Setting::Gradation(Some(5.0)))));
    open_tab(&mut window, Tab::Size);
    assert_eq!(unexplained(&window), [""; 0]);
    let distance =
        LayerKind::Distance(DistanceLayer { to: DistanceTo::Outline, at_zero: 0.1, slope: 0.3, range: 0.2 });
    let to = DistanceTo::Pieces(PieceChoice::of_land());
    let pieces = LayerKind::Distance(DistanceLayer { to, at_zero: 0.1, slope: 0.3, range: 0.2 });
    let raster = || {
        let raster = Raster::from_values(Rect::UNIT, [2, 1], vec![0.0, 1.0]);
        RasterSource { name: "depth.asc".into(), raster: Arc::new(RasterPyramid::new(raster)) }
    };
    let transfer = Settings::default().transfer;
    let [curve, band] = [LayerKind::curve_of(raster(), &transfer), LayerKind::band_of(raster(), &transfer)];
    let [curve, band] = [curve, band].map(|kind| kind.expect("a raster with values"));
    let line = ShapeList { lines: vec![vec![FREE, DVec2::ZERO]], ..ShapeList::default() };
    let corridor = LayerKind::corridor(Shapes::new(line, true).unwrap(), 1.0, &transfer, 0.2);
    let (formula, risk) = (LayerKind::constant(0.2), LayerKind::risk(Formula::constant_of(0.1)));
    let [straits, feature_size] = [LayerKind::straits(&transfer), LayerKind::feature_size(&transfer)];
    let depths = [DepthRule::Nothing, DepthRule::DEFAULT_WAVELENGTH, SLOPE, COURANT].map(|rule| {
        let sizes = DepthSizes { positive: PositiveDepth::Up, offset: 0.0, between: [0.0, 9.0], rule };
        Depths::new(raster(), sizes).into()
    });
    for kind in [formula, risk, distance, pieces, corridor, curve, band, straits, feature_size]
        .into_iter()
        .chain(depths)
    {
        send(&mut window, Command::from(LayerCommand::Add(Box::new(kind))));
        assert_eq!(unexplained(&window), [""; 0]);
    }
    send(&mut window, Command::from(LayerCommand::Add(Box::new(LayerKind::Threats(Threats::default())))));
    send(&mut window, Command::from(ThreatsCommand::Place(FREE)));
    assert!(window.query_by_label("Selected threat").is_some());
    assert_eq!(unexplained(&window), [""; 0]);
    for tool in all_tools(ROWS) {
        send(&mut window, Command::from(ShellCommand::Use(tool)));
        assert_eq!(unexplained(&window), [""; 0], "{}", tool.name);
    }
    // An edited document would be asked about before another one opens.
    for _ in 0..entries(&window) {
        send(&mut window, Command::from(EditCommand::Undo));
    }
    choose(&mut window, "Examples", "Aegean Sea");
    open_section(&mut window, "Fit to outline");
    wait_until(&mut window, |window| window.query_by_label("Misclassified").is_some());
    for tool in all_tools(ROWS) {
        send(&mut window, Command::from(ShellCommand::Use(tool)));
        assert_eq!(unexplained(&window), [""; 0], "{} in a domain of polygons", tool.name);
    }
}

#[test]
fn every_control_of_the_steps_has_a_sentence() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(EditCommand::Set(Setting::SmallestDiameter(0.06))));
    send(&mut window, Command::from(EditCommand::Set(Setting::Spacing(0.25))));
    send(&mut window, Command::from(StepCommand::Begin(None)));
    wait_until(&mut window, |window| window.query_by_label("Changed rows").is_some());
    open_section(&mut window, "Export");
    for moved in [0, 1, 5, 40] {
        send(&mut window, Command::from(StepCommand::Move(moved)));
        assert_eq!(unexplained(&window), [""; 0], "{moved} steps");
    }
}

#[test]
fn a_tooltip_is_beside_the_panel() {
    let mut window = window_of(TALL);
    let limit = window.get_by_role_and_label(Role::CheckBox, "Limit gradation").rect().center();
    window.hover_at(limit);
    window.run_steps(8);
    let tooltip = window.get_by_label_contains("Limits how fast h̄ may change").rect();
    assert!(tooltip.right() <= canvas(&window).right(), "{tooltip:?}");
    window.hover_at(window.get_by_role_and_label(Role::Button, "Eraser").rect().center());
    window.run_steps(8);
    let tooltip = window.get_by_label_contains("Takes paint away").rect();
    assert!(tooltip.left() >= canvas(&window).left(), "{tooltip:?}");
    window.hover_at(window.get_by_role_and_label(Role::Definition, "h̄ · level").rect().center());
    window.run_steps(8);
    let tooltip = window.get_by_label_contains("What one stroke asks for").rect();
    assert!(tooltip.top() >= canvas(&window).top(), "below the strip: {tooltip:?}");
}

#[test]
fn risk_and_diameter_take_the_same_room() {
    let mut window = window_of(TALL);
    let hardness = |window: &Window| window.get_by_role_and_label(Role::Slider, "Hardness").rect();
    let before = hardness(&window);
    key(&mut window, Modifiers::NONE, Key::T);
    assert_eq!(hardness(&window), before);
}
