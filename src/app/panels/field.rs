use eframe::egui::{Response, Ui};

use super::super::App;
use super::super::command::Command;
use super::super::widgets::{ActionButton, NumberRow, Section, TextError, TextRow, segmented, value_row};
use crate::document::{Base, RESOLUTIONS, Setting};
use crate::domain::{Domain, DomainShape};
use crate::field::Formula;

/// Texts as typed, which need not be sound yet.
#[derive(Clone, Debug, Default)]
pub struct FieldTexts {
    base: FormulaText,
    inside: FormulaText,
    /// The kind of base being set up, where the document has another one still.
    pending: Option<BaseKind>,
}

#[derive(Clone, Debug, Default)]
struct FormulaText {
    text: String,
    /// The formula in the document that the text was last equal to.
    of: Option<Formula>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BaseKind {
    Constant,
    Formula,
    Image,
}

impl From<&Base> for BaseKind {
    fn from(base: &Base) -> Self {
        match base {
            Base::Constant(_) => Self::Constant,
            Base::Formula(_) => Self::Formula,
            Base::RiskImage { .. } => Self::Image,
        }
    }
}

impl App {
    pub(super) fn field_ui(&mut self, ui: &mut Ui) {
        Section::new("Base field").closed().show(ui, |ui| {
            let base = self.session.document().settings().base.clone();
            let mut kind = self.field_texts.pending.unwrap_or((&base).into());
            if kind == BaseKind::from(&base) {
                self.field_texts.pending = None;
            }
            let choices = [
                (BaseKind::Constant, "Constant"),
                (BaseKind::Formula, "Formula"),
                (BaseKind::Image, "Picture"),
            ];
            if segmented(ui, "Base field", &mut kind, &choices).changed() {
                self.choose_base(kind);
            }
            ui.add_space(4.0);
            match kind {
                BaseKind::Constant => self.constant_ui(ui, &base),
                BaseKind::Formula => self.formula_ui(ui, &base),
                BaseKind::Image => self.image_ui(ui, &base),
            }
            self.resolution_ui(ui);
        });
    }

    fn choose_base(&mut self, kind: BaseKind) {
        self.field_texts.pending = Some(kind);
        let h_max = self.session.document().settings().transfer.h_max;
        match kind {
            BaseKind::Constant => self.set_whole(Setting::Base(Base::Constant(h_max))),
            BaseKind::Image => self.commands.push(Command::AskForImage),
            BaseKind::Formula => {}
        }
    }

    fn set_whole(&mut self, setting: Setting) {
        self.commands.extend([Command::Set(setting), Command::EndGesture]);
    }

    fn constant_ui(&mut self, ui: &mut Ui, base: &Base) {
        let h_max = self.session.document().settings().transfer.h_max;
        let mut value = if let Base::Constant(value) = base { *value } else { h_max };
        let help = "Target diameter where nothing is painted; h_min and h_max bound it.";
        let response = NumberRow::new("Diameter", &mut value).help(help).show(ui);
        if response.changed() {
            self.set_whole(Setting::Base(Base::Constant(value)));
        }
    }

    fn formula_ui(&mut self, ui: &mut Ui, base: &Base) {
        let current = if let Base::Formula(formula) = base { Some(formula.clone()) } else { None };
        let hint = "if(abs(x) + abs(y) < 0.4, 0.01, 0.2)";
        let typed = formula_row(ui, "Target diameter h̄(x, y)", hint, &mut self.field_texts.base, current);
        if let Some(Some(formula)) = typed {
            self.set_whole(Setting::Base(Base::Formula(formula)));
        }
    }

    fn image_ui(&mut self, ui: &mut Ui, base: &Base) {
        if let Base::RiskImage { name, raster } = base {
            let [columns, rows] = raster.size();
            value_row(ui, "Risk from", name);
            value_row(ui, "Pixels", &format!("{columns} × {rows}"));
        }
        if ui.add(ActionButton::new("Open picture…")).clicked() {
            self.commands.push(Command::AskForImage);
        }
    }

    fn resolution_ui(&mut self, ui: &mut Ui) {
        let [columns, rows] = self.session.document().settings().raster_size();
        let mut resolution = f64::from(self.session.document().settings().resolution);
        let help = format!(
            "Pixels of the field along the longer side; now {columns} × {rows}. Paint finer than a pixel is lost."
        );
        let range = f64::from(*RESOLUTIONS.start())..=f64::from(*RESOLUTIONS.end());
        let row = NumberRow::new("Resolution", &mut resolution).integer().range(range).unit("px").help(&help);
        if row.show(ui).changed() {
            self.set_whole(Setting::Resolution(resolution as u32));
        }
    }

    /// The formula that cuts the domain out of its rectangle.
    pub(super) fn inside_ui(&mut self, ui: &mut Ui) {
        let domain = &self.session.document().settings().domain;
        let (bounds, current) = (domain.bounds, domain.formula().cloned());
        let hint = if domain.region().is_some() {
            "in the polygons; or x^2 + y^2 < 1"
        } else {
            "everywhere; or x^2 + y^2 < 1"
        };
        if let Some(inside) = formula_row(ui, "Domain where", hint, &mut self.field_texts.inside, current) {
            let shape = inside.map_or(DomainShape::Whole, DomainShape::Formula);
            self.set_whole(Setting::Domain(Domain { bounds, shape }));
        }
    }
}

/// A row for a formula. Answers with the formula once it is typed to the end and sound; `Some(None)` when it was emptied.
fn formula_row(
    ui: &mut Ui,
    label: &str,
    hint: &str,
    typed: &mut FormulaText,
    current: Option<Formula>,
) -> Option<Option<Formula>> {
    // Undo, or another document: the text follows.
    if typed.of != current {
        typed.text = current.as_ref().map_or(String::new(), |formula| formula.source().to_owned());
        typed.of = current.clone();
    }
    let empty = typed.text.trim().is_empty();
    let parsed = if empty { Ok(None) } else { Formula::parse(&typed.text).map(Some) };
    let message = parsed.as_ref().err().map(ToString::to_string);
    let error = parsed.as_ref().err().zip(message.as_deref());
    let error = error.map(|(error, message)| TextError { message, at: Some(error.span().start) });
    let response = TextRow::formula(label, &mut typed.text).hint(hint).error(error).show(ui);
    let new = parsed.ok().filter(|formula| *formula != current)?;
    complete(&response).then_some(new)
}

fn complete(response: &Response) -> bool {
    response.lost_focus()
}
