use eframe::egui::{RichText, Ui};

use super::super::App;
use super::super::command::{Command, DomainCommand};
use super::super::theme::{font, tokens};
use super::super::tools::{DomainToolMode, Tool};
use super::super::widgets::{ActionButton, NumberRow, Section, SliderRow, format, segmented, value_row};
use crate::document::Setting;
use crate::domain::{BoundaryTreatment, Domain, Region};
use crate::geometry::Rect;

impl App {
    /// The tool, the polygons and how their outline is met, the rectangle, and the formula that cuts the domain out of it. With its
    /// tool in hand it stands first, open.
    pub(super) fn domain_ui(&mut self, ui: &mut Ui) {
        let section = Section::new("Domain");
        let in_hand = self.tools.tool == Tool::Domain;
        let section = if in_hand { section.id("domain tool") } else { section.closed() };
        section.show(ui, |ui| {
            if in_hand {
                self.domain_tool_ui(ui);
            }
            if let Some(region) = self.session.document().settings().domain.region().cloned() {
                self.region_ui(ui, &region);
            }
            self.bounds_ui(ui);
            self.inside_ui(ui);
            self.domain_buttons_ui(ui);
        });
    }

    fn domain_tool_ui(&mut self, ui: &mut Ui) {
        let mut shape = self.tools.domain_shape;
        let choices = [
            (DomainToolMode::Brush, "Brush"),
            (DomainToolMode::Rectangle, "Rectangle"),
            (DomainToolMode::Polygon, "Polygon"),
            (DomainToolMode::Frame, "Frame"),
        ];
        if segmented(ui, "What cuts the domain", &mut shape, &choices).changed() {
            self.commands.push(Command::Domain(DomainCommand::Shape(shape)));
        }
        ui.add_space(4.0);
        if shape == DomainToolMode::Frame {
            self.words(ui, "Drag a rectangle: the coarse grid covers it. Polygons are cut off at its sides.");
            return;
        }
        let mut adds = self.tools.domain_adds;
        let choices = [(false, "Take away"), (true, "Add")];
        if segmented(ui, "Add or take away", &mut adds, &choices).changed() {
            self.commands.push(Command::Domain(DomainCommand::Adds(adds)));
        }
        ui.add_space(4.0);
        if shape == DomainToolMode::Brush {
            self.size_ui(ui);
        } else if shape == DomainToolMode::Polygon {
            self.words(
                ui,
                "Click corner after corner; Enter, or the first corner, closes the polygon. Esc gives it up.",
            );
        }
    }

    /// How the mesh meets the outline, and what it gains and loses by that.
    fn region_ui(&mut self, ui: &mut Ui, region: &Region) {
        let boundary = self.session.document().settings().boundary;
        let spacing = self.session.document().settings().spacing;
        let fitted = match boundary {
            BoundaryTreatment::Fitted { .. } => boundary,
            BoundaryTreatment::Report => self.last_fitted.unwrap_or(BoundaryTreatment::usual(spacing)),
        };
        let mut chosen = boundary;
        let choices = [(fitted, "Fitted to outline"), (BoundaryTreatment::Report, "As in the report")];
        if segmented(ui, "How the outline is met", &mut chosen, &choices).changed() {
            self.last_fitted = Some(fitted);
            self.commands.extend([Command::Set(Setting::Boundary(chosen)), Command::EndGesture]);
        }
        match boundary {
            BoundaryTreatment::Fitted { diameter } => self.fitted_ui(ui, diameter),
            BoundaryTreatment::Report => self.words(
                ui,
                "Appendix A: a coarse triangle stays if its three corners are inside. What is narrower than the coarse grid is lost.",
            ),
        }
        self.gain_ui(ui, region);
    }

    fn fitted_ui(&mut self, ui: &mut Ui, diameter: f64) {
        let mut diameter = diameter;
        let extent = self.session.document().settings().domain.bounds.size().max_element();
        let row = SliderRow::new("At outline", &mut diameter, 1e-4 * extent..=0.1 * extent).logarithmic();
        let help = "Largest diameter of a triangle that the outline passes through. Then what has its middle outside is left out.";
        let response = row.help(help).show(ui);
        if response.changed() {
            self.commands.push(Command::Set(Setting::Boundary(BoundaryTreatment::Fitted { diameter })));
        }
        self.settle(&response);
    }

    /// The area of the mesh against that of the polygons, and what became of their parts and holes.
    fn gain_ui(&self, ui: &mut Ui, region: &Region) {
        let (area, wanted) = (self.session.mesh().area(), region.area());
        let percent = 100.0 * (area - wanted) / wanted;
        let word = if percent < 0.0 { "less" } else { "more" };
        let area = format!("{} % {word}", format::digits(percent.abs(), 2));
        value_row(ui, "Area", &area).on_hover_text("Area of the mesh against that of the outline");
        let (polygons, holes) = (region.polygons().len(), region.hole_count());
        let count = |n: usize| format::count(n as u64);
        let topology = self.session.topology();
        let found = |n: Option<usize>| n.map_or("…".into(), count);
        let parts = format!("{} (outline {})", found(topology.map(|t| t.parts)), count(polygons));
        value_row(ui, "Parts", &parts)
            .on_hover_text("Parts of the mesh that edges join, and polygons of the outline");
        let holes = format!("{} (outline {})", found(topology.map(|t| t.holes)), count(holes));
        value_row(ui, "Holes", &holes).on_hover_text("Holes of the mesh, and holes of the outline");
        value_row(ui, "Corners", &count(region.corner_count()));
        ui.add_space(4.0);
    }

    fn domain_buttons_ui(&mut self, ui: &mut Ui) {
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            if ui.add(ActionButton::new("Open domain…")).clicked() {
                self.commands.push(Command::AskForDomain);
            }
            let domain = &self.session.document().settings().domain;
            let whole = Domain::rectangle(domain.bounds);
            let button = ActionButton::new("Whole rectangle");
            if ui.add_enabled_ui(*domain != whole, |ui| ui.add(button)).inner.clicked() {
                self.commands.extend([Command::Set(Setting::Domain(whole)), Command::EndGesture]);
            }
        });
    }

    fn words(&self, ui: &mut Ui, words: &str) {
        ui.label(RichText::new(words).font(font::caption()).color(tokens(ui).faint));
        ui.add_space(4.0);
    }

    fn bounds_ui(&mut self, ui: &mut Ui) {
        let bounds = self.session.document().settings().domain.bounds;
        let mut edges = [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y];
        let mut changed = false;
        for (name, value) in ["Left", "Bottom", "Right", "Top"].into_iter().zip(&mut edges) {
            changed |= NumberRow::new(name, value).show(ui).changed();
        }
        if changed {
            let [left, bottom, right, top] = edges;
            let bounds = Rect::new(glam::dvec2(left, bottom), glam::dvec2(right, top));
            self.commands.push(Command::Domain(DomainCommand::Frame(bounds)));
        }
    }
}
