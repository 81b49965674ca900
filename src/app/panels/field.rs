//! The base field: the target diameter where nothing is painted.

use eframe::egui::Ui;

use super::formula::FormulaRow;
use super::{Panel, set_once};
use crate::app::command::Command;
use crate::app::dialogs::FileRequest;
use crate::app::frame::FrameState;
use crate::app::widgets::{ActionButton, NumberRow, Section, ValueRow, segmented};
use crate::document::{Base, RESOLUTIONS, Setting, Settings};

/// The base field and its resolution.
pub static FIELD: Panel = Panel { name: "field", only_with_tool: false, show };

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
            Base::RiskImage { .. } | Base::DiameterGrid { .. } => Self::Image,
        }
    }
}

fn show(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    Section::new("Base field").closed().show(ui, |ui| {
        let base = &state.session.document().settings().base;
        let kind = kind_row(ui, state, base, commands);
        ui.add_space(4.0);
        match kind {
            BaseKind::Constant => constant_row(ui, state, base, commands),
            BaseKind::Formula => formula_row(ui, state, base, commands),
            BaseKind::Image => image_rows(ui, base, commands),
        }
        resolution_row(ui, state, commands);
    });
}

/// Chooses a kind of base. A formula that is not typed yet is kept in egui's memory until the document has it
/// or another document is opened.
fn kind_row(ui: &mut Ui, state: &FrameState<'_>, base: &Base, commands: &mut Vec<Command>) -> BaseKind {
    let id = ui.make_persistent_id("kind of base being set up");
    let refused = refused_kind(ui, state, base);
    let opened = state.session.opened_documents();
    let begun = ui.data(|data| data.get_temp::<(BaseKind, u64)>(id)).filter(|(_, of)| *of == opened);
    let pending = refused.or(begun.map(|(kind, _)| kind));
    let mut kind = pending.unwrap_or(base.into());
    if let Some(pending) = pending {
        ui.data_mut(|data| data.insert_temp(id, (pending, opened)));
    }
    if kind == BaseKind::from(base) {
        ui.data_mut(|data| data.remove::<(BaseKind, u64)>(id));
    }
    let choices =
        [(BaseKind::Constant, "Constant"), (BaseKind::Formula, "Formula"), (BaseKind::Image, "Picture")];
    if segmented(ui, "Base field", &mut kind, &choices).changed() {
        let h_max = state.session.document().settings().transfer.h_max;
        match kind {
            BaseKind::Constant => set_once(Setting::Base(Base::Constant(h_max)), commands),
            BaseKind::Image => commands.push(Command::Ask(FileRequest::OpenImage)),
            BaseKind::Formula => {}
        }
        // A picture is chosen in a dialog, which can be cancelled: until then the former kind stays.
        if kind == BaseKind::Image {
            ui.data_mut(|data| data.remove::<(BaseKind, u64)>(id));
            return base.into();
        }
        ui.data_mut(|data| data.insert_temp(id, (kind, opened)));
    }
    kind
}

/// The kind of a base that the document had in the last frame and refused: what was typed for it stays.
fn refused_kind(ui: &Ui, state: &FrameState<'_>, base: &Base) -> Option<BaseKind> {
    let (id, kind) = (ui.make_persistent_id("kind of base in the last frame"), BaseKind::from(base));
    let before = ui.data_mut(|data| std::mem::replace(data.get_temp_mut_or(id, kind), kind));
    let failed = state.session.notices().shown().is_some_and(|notice| notice.failed);
    (failed && before == BaseKind::Formula && before != kind).then_some(before)
}

fn constant_row(ui: &mut Ui, state: &FrameState<'_>, base: &Base, commands: &mut Vec<Command>) {
    let h_max = state.session.document().settings().transfer.h_max;
    let mut value = if let Base::Constant(value) = base { *value } else { h_max };
    let help = "Target diameter where nothing is painted; h_min and h_max bound it.";
    let row = NumberRow::new("Diameter", &mut value).range(f64::MIN_POSITIVE..=f64::MAX).default(h_max);
    if row.unit(state.unit().symbol()).help(help).show(ui).changed() {
        set_once(Setting::Base(Base::Constant(value)), commands);
    }
}

fn formula_row(ui: &mut Ui, state: &FrameState<'_>, base: &Base, commands: &mut Vec<Command>) {
    let current = if let Base::Formula(formula) = base { Some(formula) } else { None };
    let row = FormulaRow {
        label: "Target diameter h̄(x, y)",
        hint: "if(abs(x) + abs(y) < 0.4, 0.01, 0.2)",
        help: "Target diameter at x and y where nothing is painted, as a formula; h_min and h_max bound it.",
    };
    if let Some(Some(formula)) = row.show(ui, state, current) {
        set_once(Setting::Base(Base::Formula(formula)), commands);
    }
}

fn image_rows(ui: &mut Ui, base: &Base, commands: &mut Vec<Command>) {
    let shown = match base {
        Base::RiskImage { name, raster } => Some(("Risk from", name, raster)),
        Base::DiameterGrid { name, raster } => Some(("Diameters from", name, raster)),
        Base::Constant(_) | Base::Formula(_) => None,
    };
    if let Some((label, name, raster)) = shown {
        let [columns, rows] = raster.size();
        ValueRow::new(label, name).help("The file that the base field was read from.").show(ui);
        let pixels = format!("{columns} × {rows}");
        ValueRow::new("Pixels", &pixels).help("Columns and rows of that file.").show(ui);
    }
    if ui.add(ActionButton::new("Open picture…")).clicked() {
        commands.push(Command::Ask(FileRequest::OpenImage));
    }
    if ui.add(ActionButton::new("Open diameters…")).clicked() {
        commands.push(Command::Ask(FileRequest::OpenDiameters));
    }
}

fn resolution_row(ui: &mut Ui, state: &FrameState<'_>, commands: &mut Vec<Command>) {
    let settings = state.session.document().settings();
    let [columns, rows] = settings.raster_size();
    let mut resolution = f64::from(settings.resolution);
    let help = format!(
        "Pixels of the field along the longer side; now {columns} × {rows}. Paint finer than a pixel is lost."
    );
    let range = f64::from(*RESOLUTIONS.start())..=f64::from(*RESOLUTIONS.end());
    let row = NumberRow::new("Resolution", &mut resolution).integer().range(range).unit("px").help(&help);
    let row = row.default(f64::from(Settings::default().resolution));
    if row.show(ui).changed() {
        set_once(Setting::Resolution(resolution as u32), commands);
    }
}
