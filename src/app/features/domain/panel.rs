//! The domain: its outline, its bounds and its formula.

use eframe::egui::{Id, Ui};

use super::{ADD_OUTLINE, DomainCommand, OPEN_DOMAIN};
use meshbrush_core::document::{Setting, Settings};
use meshbrush_core::domain::{BoundaryTreatment, Domain, DomainShape};
use meshbrush_core::field::RefinementRule;
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand};
use meshbrush_kit::kit::{
    FormulaRow, FrameState, Panel, Tab, button_rows, end_gesture_when_released, remark, set_once,
};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Cleaning, KeptParts};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::widgets::{
    ActionButton, NumberRow, Section, SliderRow, ValueRow, dropdown_row, format, segmented, toggle_row,
    value_row,
};

/// Share of the area from which parts stay, to start with.
const DEFAULT_SHARE: f64 = 0.01;

/// The outline of the domain, its unit, its bounds and its formula.
pub static DOMAIN_PANEL: Panel = Panel { name: "domain", tab: Tab::Domain, place: 0, show };

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Domain").show(ui, |ui| {
        let domain = &state.session.document().settings().domain;
        if !domain.is_whole() {
            boundary_rows(ui, state, commands);
        }
        if let Some(region) = domain.region() {
            value_row(ui, "Corners", &format::count(region.corner_count() as u64));
            ui.add_space(4.0);
        }
        unit_row(ui, state, commands);
        bounds_rows(ui, state, commands);
        formula_row(ui, state, commands);
        buttons(ui, state, commands);
    });
}

/// How the mesh meets the outline, and which parts of it stay. The last diameter at the outline is kept in
/// egui's memory.
fn boundary_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let settings = state.session.document().settings();
    let id = Id::unique("last diameter at the outline");
    let diameter = settings.boundary.diameter().unwrap_or_else(|| {
        let last = ui.data(|data| data.get_temp(id));
        last.unwrap_or_else(|| default_diameter(settings))
    });
    let mut chosen = settings.boundary;
    let choices = [
        (BoundaryTreatment::OnOutline { diameter }, "On outline"),
        (BoundaryTreatment::Fitted { diameter }, "Fitted"),
        (BoundaryTreatment::Report, "As in report"),
    ];
    if segmented(ui, "Boundary treatment", &mut chosen, &choices).changed() {
        ui.data_mut(|data| data.insert_temp(id, diameter));
        set_once(Setting::Boundary(chosen), commands);
    }
    ui.add_space(4.0);
    remark(
        ui,
        match settings.boundary {
            BoundaryTreatment::OnOutline { .. } if settings.rule == RefinementRule::Vertex => {
                "Nodes lie on the outline. Features narrower than the triangles there vanish or join."
            }
            BoundaryTreatment::OnOutline { .. } => {
                "Nodes lie on the outline, and no edge is longer than its target. Features narrower than the triangles there vanish or join."
            }
            BoundaryTreatment::Fitted { .. } => {
                "A triangle stays if its centroid is inside: all angles are 45° or 90°, and the boundary is a staircase."
            }
            BoundaryTreatment::Report => {
                "Appendix A: a coarse triangle stays if its three corners are inside. Parts narrower than the coarse grid \
                 are lost."
            }
        },
    );
    // Of the mesh that is shown: of another formula, the line may not be known yet.
    let shown = state.session.follower().settings();
    if let Some(error) = shown.domain.outline_error(shown.boundary) {
        remark(ui, &error.to_string());
    }
    if settings.boundary.diameter().is_some() {
        diameter_row(ui, state, diameter, commands);
        cleaning_rows(ui, settings.cleaning, settings.boundary, commands);
    }
}

/// Returns the diameter at the outline unless a person chooses one.
fn default_diameter(settings: &Settings) -> f64 {
    BoundaryTreatment::default_diameter(settings.domain.longest_on_earth(settings.spacing))
}

fn diameter_row(ui: &mut Ui, state: &FrameState<'_>, mut diameter: f64, commands: &mut Vec<Command>) {
    let settings = state.session.document().settings();
    let extent = settings.domain.bounds.size().max_element();
    let row = SliderRow::new("At outline", &mut diameter, 1e-4 * extent..=0.1 * extent).logarithmic();
    let help = "Largest diameter of a triangle that the outline passes through.";
    let default = default_diameter(settings);
    let row = row.typed_range(f64::MIN_POSITIVE..=extent).default(default);
    let response = row.unit(state.unit().symbol()).help(help).show(ui);
    if response.changed() {
        commands.push(Command::from(EditCommand::Set(Setting::Boundary(
            settings.boundary.with_diameter(diameter),
        ))));
    }
    end_gesture_when_released(&response, commands);
}

/// Which parts stay, and whether the domain may touch itself in a node.
fn cleaning_rows(ui: &mut Ui, cleaning: Cleaning, boundary: BoundaryTreatment, commands: &mut Vec<Command>) {
    let mut parts = cleaning.parts;
    let share = match parts {
        KeptParts::Share(share) => share,
        _ => DEFAULT_SHARE,
    };
    let from_share = KeptParts::Share(share);
    let choices =
        [(KeptParts::Largest, "Largest part"), (from_share, "Large parts"), (KeptParts::All, "All parts")];
    if segmented(ui, "Parts that stay", &mut parts, &choices).changed() {
        set_once(Setting::Cleaning(Cleaning { parts, ..cleaning }), commands);
    }
    ui.add_space(4.0);
    if let KeptParts::Share(mut share) = cleaning.parts {
        let row = SliderRow::new("From share", &mut share, 1e-4..=1.0).logarithmic();
        let row = row.typed_range(0.0..=1.0).default(DEFAULT_SHARE);
        let response = row.help("Parts with at least this share of the area stay.").show(ui);
        if response.changed() {
            let parts = KeptParts::Share(share);
            commands.push(Command::from(EditCommand::Set(Setting::Cleaning(Cleaning { parts, ..cleaning }))));
        }
        end_gesture_when_released(&response, commands);
    }
    if matches!(boundary, BoundaryTreatment::OnOutline { .. }) {
        let mut improves_boundary = cleaning.improves_boundary;
        if toggle_row(ui, "Improve triangles along it", &mut improves_boundary).changed() {
            set_once(Setting::Cleaning(Cleaning { improves_boundary, ..cleaning }), commands);
        }
    }
    if matches!(boundary, BoundaryTreatment::Fitted { .. }) {
        let mut keeps_pinches = cleaning.keeps_pinches;
        if toggle_row(ui, "Keep pinched nodes", &mut keeps_pinches).changed() {
            set_once(Setting::Cleaning(Cleaning { keeps_pinches, ..cleaning }), commands);
        }
    }
}

/// The unit of coordinates and lengths.
fn unit_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let mut unit = state.unit();
    if let Some(plane) = state.session.document().settings().domain.projection {
        let help = format!(
            "The domain lies in the plane {plane}. Target diameters and lengths of paths are metres on the Earth."
        );
        ValueRow::new("Plane", plane.kind().name()).help(&help).show(ui);
        value_row(ui, "Unit", unit_title(unit));
        return;
    }
    let choices = LengthUnit::ALL.map(|unit| (unit, unit_title(unit)));
    if dropdown_row(ui, "Unit", &mut unit, &choices).changed() {
        set_once(Setting::LengthUnit(unit), commands);
    }
}

fn unit_title(unit: LengthUnit) -> &'static str {
    match unit {
        LengthUnit::None => "None",
        LengthUnit::Metre => "Metres (m)",
        LengthUnit::Kilometre => "Kilometres (km)",
        LengthUnit::Degree => "Degrees (°)",
    }
}

fn bounds_rows(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let bounds = state.session.document().settings().domain.bounds;
    let mut sides = [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y];
    let mut changed = false;
    for (name, value) in ["Left", "Bottom", "Right", "Top"].into_iter().zip(&mut sides) {
        changed |= NumberRow::new(name, value).unit(state.unit().symbol()).show(ui).changed();
    }
    if changed {
        let [left, bottom, right, top] = sides;
        let bounds = Rect::new(glam::dvec2(left, bottom), glam::dvec2(right, top));
        commands.push(Command::from(DomainCommand::Bounds(bounds)));
    }
}

/// The formula that selects a part of the bounds.
fn formula_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let domain = &state.session.document().settings().domain;
    let hint =
        if domain.region().is_some() { "polygons; or x^2 + y^2 < 1" } else { "everywhere; or x^2 + y^2 < 1" };
    let help = "The domain is where this formula is true. Nodes lie on the line where it becomes false, unless the boundary is as in \
                the report: then whole coarse triangles stay, with three corners inside.";
    let row = FormulaRow { label: "Domain where", hint, help };
    if let Some(inside) = row.show(ui, state, domain.formula()) {
        let shape = inside.map_or(DomainShape::Whole, DomainShape::from);
        set_once(Setting::Domain(Domain { shape, ..domain.clone() }), commands);
    }
}

fn buttons(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    ui.add_space(4.0);
    let row = [
        ("Open domain…", true, Command::from(FileCommand::Ask(&OPEN_DOMAIN))),
        ("Add outline…", true, Command::from(FileCommand::Ask(&ADD_OUTLINE))),
    ];
    button_rows(ui, [row], commands);
    let domain = &state.session.document().settings().domain;
    let whole = Domain { projection: domain.projection, ..Domain::rectangle(domain.bounds) };
    let button = ActionButton::new("Whole rectangle");
    if ui.add_enabled_ui(*domain != whole, |ui| ui.add(button)).inner.clicked() {
        set_once(Setting::Domain(whole), commands);
    }
}
