//! The domain: the tool that edits it, its outline, its bounds and its formula.

use eframe::egui::{Id, Ui};

use super::brush::size_row;
use super::{Panel, end_gesture_when_released, formula, remark, set_once};
use crate::app::command::{Command, DomainCommand};
use crate::app::dialogs::FileRequest;
use crate::app::frame::FrameState;
use crate::app::tools::{DOMAIN as DOMAIN_TOOL, DomainToolMode};
use crate::app::widgets::{ActionButton, NumberRow, Section, SliderRow, format, segmented, value_row};
use crate::document::Setting;
use crate::domain::{BoundaryTreatment, Domain, DomainShape, Region};
use crate::geometry::Rect;

/// The domain. While its tool is selected, it is open and the tool's settings are in it.
pub static DOMAIN: Panel = Panel { name: "domain", only_with_tool: false, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let section = Section::new("Domain");
    let selected = state.tools.tool == &DOMAIN_TOOL;
    let section = if selected { section.id("domain tool") } else { section.closed() };
    section.show(ui, |ui| {
        if selected {
            tool_rows(ui, state, commands);
        }
        if let Some(region) = state.session.document().settings().domain.region() {
            boundary_rows(ui, state, commands);
            outline_rows(ui, state, region);
        }
        bounds_rows(ui, state, commands);
        formula_row(ui, state, commands);
        buttons(ui, state, commands);
    });
}

fn tool_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut mode = state.tools.domain.mode;
    let choices = [
        (DomainToolMode::Brush, "Brush"),
        (DomainToolMode::Rectangle, "Rectangle"),
        (DomainToolMode::Polygon, "Polygon"),
        (DomainToolMode::Frame, "Frame"),
    ];
    if segmented(ui, "What cuts the domain", &mut mode, &choices).changed() {
        commands.push(Command::Domain(DomainCommand::Mode(mode)));
    }
    ui.add_space(4.0);
    if mode == DomainToolMode::Frame {
        return remark(ui, "Drag a rectangle: the coarse grid covers it. Polygons are cut off at its sides.");
    }
    let mut adds = state.tools.domain.adds;
    if segmented(ui, "Add or remove", &mut adds, &[(false, "Remove"), (true, "Add")]).changed() {
        commands.push(Command::Domain(DomainCommand::Adds(adds)));
    }
    ui.add_space(4.0);
    match mode {
        DomainToolMode::Brush => size_row(ui, state, commands),
        DomainToolMode::Polygon => {
            remark(
                ui,
                "Click each corner; Enter, or a click on the first corner, closes the polygon. Esc cancels it.",
            );
        }
        DomainToolMode::Rectangle | DomainToolMode::Frame => {}
    }
}

/// How the mesh meets the outline. The last diameter of a fitted outline is kept in egui's memory.
fn boundary_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let settings = state.session.document().settings();
    let boundary = settings.boundary;
    let id = Id::unique("last fitted outline");
    let fitted = match boundary {
        BoundaryTreatment::Fitted { .. } | BoundaryTreatment::OnOutline { .. } => boundary,
        BoundaryTreatment::Report => {
            let last = ui.data(|data| data.get_temp(id));
            last.unwrap_or(BoundaryTreatment::usual(settings.spacing))
        }
    };
    let mut chosen = boundary;
    let choices = [(fitted, "Fitted to outline"), (BoundaryTreatment::Report, "As in the report")];
    if segmented(ui, "Boundary treatment", &mut chosen, &choices).changed() {
        ui.data_mut(|data| data.insert_temp(id, fitted));
        set_once(Setting::Boundary(chosen), commands);
    }
    match boundary {
        BoundaryTreatment::Fitted { diameter } | BoundaryTreatment::OnOutline { diameter } => {
            fitted_row(ui, state, diameter, commands)
        }
        BoundaryTreatment::Report => remark(
            ui,
            "Appendix A: a coarse triangle stays if its three corners are inside. Parts narrower than the coarse grid are lost.",
        ),
    }
}

fn fitted_row(ui: &mut Ui, state: &FrameState<'_>, diameter: f64, commands: &mut Vec<Command>) {
    let mut diameter = diameter;
    let extent = state.session.document().settings().domain.bounds.size().max_element();
    let row = SliderRow::new("At outline", &mut diameter, 1e-4 * extent..=0.1 * extent).logarithmic();
    let help = "Largest diameter of a triangle that the outline crosses. Triangles with their centroid outside are then \
                left out.";
    let response = row.help(help).show(ui);
    if response.changed() {
        commands.push(Command::Set(Setting::Boundary(BoundaryTreatment::Fitted { diameter })));
    }
    end_gesture_when_released(&response, commands);
}

/// Area, parts and holes of the mesh, compared with those of the outline.
fn outline_rows(ui: &mut Ui, state: &FrameState<'_>, region: &Region) {
    let (area, wanted) = (state.session.mesh().area(), region.area());
    let percent = 100.0 * (area - wanted) / wanted;
    let word = if percent < 0.0 { "less" } else { "more" };
    let area = format!("{} % {word}", format::digits(percent.abs(), 2));
    value_row(ui, "Area", &area).on_hover_text("Area of the mesh compared with that of the outline");
    let (polygons, holes) = (region.polygons().len(), region.hole_count());
    let count = |n: usize| format::count(n as u64);
    let topology = state.session.topology();
    let found = |n: Option<usize>| n.map_or("…".into(), count);
    let parts = format!("{} (outline {})", found(topology.map(|t| t.parts)), count(polygons));
    value_row(ui, "Parts", &parts)
        .on_hover_text("Edge-connected parts of the mesh, and polygons of the outline");
    let holes = format!("{} (outline {})", found(topology.map(|t| t.holes)), count(holes));
    value_row(ui, "Holes", &holes).on_hover_text("Holes of the mesh, and holes of the outline");
    value_row(ui, "Corners", &count(region.corner_count()));
    ui.add_space(4.0);
}

fn bounds_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let bounds = state.session.document().settings().domain.bounds;
    let mut sides = [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y];
    let mut changed = false;
    for (name, value) in ["Left", "Bottom", "Right", "Top"].into_iter().zip(&mut sides) {
        changed |= NumberRow::new(name, value).show(ui).changed();
    }
    if changed {
        let [left, bottom, right, top] = sides;
        let bounds = Rect::new(glam::dvec2(left, bottom), glam::dvec2(right, top));
        commands.push(Command::Domain(DomainCommand::Bounds(bounds)));
    }
}

/// The formula that selects a part of the bounds.
fn formula_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let domain = &state.session.document().settings().domain;
    let hint = if domain.region().is_some() {
        "in the polygons; or x^2 + y^2 < 1"
    } else {
        "everywhere; or x^2 + y^2 < 1"
    };
    if let Some(inside) = formula::row(ui, "Domain where", hint, domain.formula()) {
        let shape = inside.map_or(DomainShape::Whole, DomainShape::Formula);
        set_once(Setting::Domain(Domain { bounds: domain.bounds, shape }), commands);
    }
}

fn buttons(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        if ui.add(ActionButton::new("Open domain…")).clicked() {
            commands.push(Command::Ask(FileRequest::OpenDomain));
        }
        let domain = &state.session.document().settings().domain;
        let whole = Domain::rectangle(domain.bounds);
        let button = ActionButton::new("Whole rectangle");
        if ui.add_enabled_ui(*domain != whole, |ui| ui.add(button)).inner.clicked() {
            set_once(Setting::Domain(whole), commands);
        }
    });
}
