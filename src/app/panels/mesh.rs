use eframe::egui::{RichText, Ui};

use super::super::App;
use super::super::command::Command;
use super::super::theme::{font, tokens};
use super::super::widgets::{NumberRow, Section, SliderRow, format, segmented, value_row};
use crate::document::{LEAST_MEMORY, Setting};
use crate::field::RefinementRule;

/// Triangles in a million.
const MILLION: f64 = 1e6;
/// Bytes in a gigabyte.
const BILLION: f64 = 1e9;

impl App {
    pub(super) fn mesh_ui(&mut self, ui: &mut Ui) {
        Section::new("Mesh").closed().show(ui, |ui| {
            self.spacing_ui(ui);
            self.rule_ui(ui);
            self.budget_ui(ui);
        });
    }

    fn spacing_ui(&mut self, ui: &mut Ui) {
        let settings = self.session.document().settings();
        let extent = settings.domain.bounds.size().max_element();
        let mut spacing = settings.spacing;
        let help = "Side of a coarse cell. Cells are made a little smaller where the domain asks for it.";
        let range = extent / 250.0..=extent;
        let response = SliderRow::new("Spacing δ", &mut spacing, range).logarithmic().help(help).show(ui);
        if response.changed() {
            self.commands.push(Command::Set(Setting::Spacing(spacing)));
        }
        self.settle(&response);
        let [columns, rows] = self.session.mesh().lattice().cells();
        value_row(ui, "Coarse grid", &format!("{columns} × {rows}"));
    }

    fn rule_ui(&mut self, ui: &mut Ui) {
        let mut rule = self.session.document().settings().rule;
        let choices = [(RefinementRule::Area, "Area rule"), (RefinementRule::Vertex, "Vertex rule")];
        if segmented(ui, "Refinement rule", &mut rule, &choices).changed() {
            self.commands.extend([Command::Set(Setting::RefinementRule(rule)), Command::EndGesture]);
        }
        let words = match rule {
            RefinementRule::Area => "A triangle obeys h̄ everywhere inside it: no stroke is missed.",
            RefinementRule::Vertex => {
                "The report's rule: h̄ counts at the three corners only. A stroke that passes between the nodes leaves \
                 no trace, and every edit makes the mesh anew."
            }
        };
        ui.label(RichText::new(words).font(font::caption()).color(tokens(ui).faint));
        ui.add_space(4.0);
    }

    fn budget_ui(&mut self, ui: &mut Ui) {
        let settings = self.session.document().settings();
        let mut millions = settings.max_triangles as f64 / MILLION;
        let mut gigabytes = settings.max_memory as f64 / BILLION;
        let help = "Most triangles, in millions. A stroke that would need more stops there; a setting is taken back.";
        let row = NumberRow::new("Triangle budget", &mut millions).range(0.001..=100.0).unit("M").help(help);
        if row.show(ui).changed() {
            let max_triangles = (millions * MILLION).round() as usize;
            self.commands.extend([Command::Set(Setting::MaxTriangles(max_triangles)), Command::EndGesture]);
        }
        let help = "Most memory, in gigabytes, for the mesh and for the next one while that is made beside it: 86 bytes \
                    a triangle. The smaller of the two budgets counts.";
        let least = LEAST_MEMORY as f64 / BILLION;
        let row = NumberRow::new("Memory budget", &mut gigabytes).range(least..=1000.0).unit("GB").help(help);
        if row.show(ui).changed() {
            let max_memory = (gigabytes * BILLION).round() as usize;
            self.commands.extend([Command::Set(Setting::MaxMemory(max_memory)), Command::EndGesture]);
        }
        let bytes = self.session.mesh().bytes() as f64;
        value_row(ui, "Memory in use", &format!("{} MB", format::fixed(bytes / MILLION, 1)));
    }
}
