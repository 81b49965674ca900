//! The question what a file of data is to be.

use std::sync::Arc;

use eframe::egui::{
    self, Align, Color32, ColorImage, Context, Id, Key, Layout, Modifiers, Rect, RichText, Sense,
    TextureHandle, TextureOptions, Ui, vec2,
};

use crate::app::features::ROWS;
use meshbrush_kit::kit::background::name_of;
use meshbrush_kit::kit::command::{Command, ShellCommand};
use meshbrush_kit::kit::{
    DataContents, DataFile, DataRole, EmptyDocument, FileAct, FrameState, Preview, RasterFacts,
};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_ui::theme::{font, metrics, tokens};
use meshbrush_ui::widgets::{ActionButton, ButtonKind, ValueRow, dialog, dialog_title, format};

/// Width of the dialog, and of the picture with the facts below it, in points.
const WIDTH: f32 = 700.0;
const FACTS: f32 = 272.0;
/// Indentation of the sentence below a choice, in points.
const BESIDE_RADIO: f32 = 16.0;
/// What the ends of an extent are rounded to, as a share of its longer side.
const STEP_OF_EXTENT: f64 = 1e-5;
/// Height of the picture, in points.
const PICTURE: f32 = 188.0;

/// The state of the question, in egui's memory while it is open.
#[derive(Clone)]
struct DataQuestion {
    /// The file that it is about.
    file: Arc<DataFile>,
    texture: TextureHandle,
    /// The picture of the water beside the shapes.
    sea_texture: Option<TextureHandle>,
    /// The title of the chosen role.
    chosen: Option<&'static str>,
}

/// Asks what a file is to be, and sends the command of the chosen role.
pub fn ask(ctx: &Context, state: &FrameState<'_>, file: &Arc<DataFile>, commands: &mut Vec<Command>) {
    let id = Id::unique("question about a file of data");
    let roles = roles(state, file);
    let kept = ctx.data(|data| data.get_temp::<DataQuestion>(id));
    let kept = kept.filter(|question| Arc::ptr_eq(&question.file, file));
    let mut question = kept.unwrap_or_else(|| DataQuestion {
        file: file.clone(),
        texture: texture(ctx, &file.preview),
        sea_texture: file.sea.as_ref().ok().map(|sea| texture(ctx, sea)),
        chosen: proposed(&roles),
    });
    let shown = dialog(ctx, "add data", |ui| question.contents(ui, state, &roles));
    let chosen = roles.iter().find(|(role, _)| Some(role.title) == question.chosen).map(|(role, _)| *role);
    let is_closed = shown.should_close() || shown.inner == Some(false);
    match (shown.inner, chosen) {
        (Some(true), Some(role)) => {
            let command = (role.kind.command)(file.path.clone());
            commands.extend([Command::from(ShellCommand::CloseDialog), command]);
        }
        _ if is_closed => commands.push(Command::from(ShellCommand::CloseDialog)),
        _ => {
            ctx.data_mut(|data| data.insert_temp(id, question));
            return;
        }
    }
    ctx.data_mut(|data| data.remove::<DataQuestion>(id));
}

/// Returns the roles for such files in their order, each with the reason why it is impossible.
fn roles(state: &FrameState<'_>, file: &DataFile) -> Vec<(&'static DataRole, Option<String>)> {
    let all = ROWS.iter().flat_map(|row| row.roles);
    let is_offered = |role: &&DataRole| !file.is_opened || role.kind.act == FileAct::OpenDocument;
    let mut roles: Vec<_> = all.filter(|role| (role.is_for)(&file.contents)).filter(is_offered).collect();
    roles.sort_by_key(|role| role.place);
    roles.into_iter().map(|role| (role, (role.refusal)(file, state))).collect()
}

/// Returns the title of the role that is proposed: the first possible one. Most shapes are no land.
fn proposed(roles: &[(&'static DataRole, Option<String>)]) -> Option<&'static str> {
    let possible = || roles.iter().filter(|(_, refusal)| refusal.is_none()).map(|(role, _)| *role);
    let proposed = possible().find(|role| !role.kind.is_of_sea).or_else(|| possible().next());
    proposed.map(|role| role.title)
}

fn texture(ctx: &Context, preview: &Preview) -> TextureHandle {
    let pixel = |[r, g, b, a]: [u8; 4]| Color32::from_rgba_unmultiplied(r, g, b, a);
    let pixels = preview.rgba.iter().copied().map(pixel).collect();
    ctx.load_texture("preview of a file", ColorImage::new(preview.size, pixels), TextureOptions::LINEAR)
}

impl DataQuestion {
    /// Returns whether to add the file or to cancel, once that was decided.
    fn contents(
        &mut self,
        ui: &mut Ui,
        state: &FrameState<'_>,
        roles: &[(&'static DataRole, Option<String>)],
    ) -> Option<bool> {
        ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - 64.0));
        dialog_title(ui, &format!("{} {}", self.verb(), name_of(&self.file.path)));
        ui.add_space(8.0);
        ui.horizontal_top(|ui| {
            ui.vertical(|ui| {
                ui.set_width(FACTS);
                self.picture(ui, roles);
                fact_rows(ui, &self.file);
            });
            ui.add_space(16.0);
            ui.vertical(|ui| self.choices(ui, roles));
        });
        ui.add_space(8.0);
        let chosen = roles.iter().find(|(role, _)| Some(role.title) == self.chosen);
        let is_added = chosen.is_none_or(|(role, _)| role.kind.act != FileAct::OpenDocument);
        if let Some(note) = note_on_extent(state, &self.file).filter(|_| is_added) {
            ui.label(RichText::new(note).font(font::caption()).color(tokens(ui).label));
        }
        self.buttons(ui)
    }

    /// Returns the word on the button.
    fn verb(&self) -> &'static str {
        if self.file.is_opened { FileAct::OpenDocument.verb() } else { FileAct::Add.verb() }
    }

    /// Shows the picture in the middle of its place: the water, where the chosen role is for that.
    fn picture(&self, ui: &mut Ui, roles: &[(&'static DataRole, Option<String>)]) {
        let is_sea = roles.iter().any(|(role, _)| Some(role.title) == self.chosen && role.kind.is_of_sea);
        let texture = self.sea_texture.as_ref().filter(|_| is_sea).unwrap_or(&self.texture);
        let (place, _) = ui.allocate_exact_size(vec2(FACTS, PICTURE), Sense::hover());
        let t = *tokens(ui);
        ui.painter().rect_filled(place, metrics::RADIUS_CONTROL, t.well);
        let room = place.shrink(8.0);
        let size = texture.size_vec2();
        let size = size * (room.width() / size.x).min(room.height() / size.y);
        let tint = if self.file.preview.is_drawing { t.accent } else { Color32::WHITE };
        let name = format!("Picture of {}", name_of(&self.file.path));
        let image = egui::Image::new(texture).tint(tint).alt_text(name);
        ui.put(Rect::from_center_size(room.center(), size), image.fit_to_exact_size(size));
        ui.add_space(8.0);
    }

    fn choices(&mut self, ui: &mut Ui, roles: &[(&'static DataRole, Option<String>)]) {
        let t = *tokens(ui);
        ui.label(RichText::new("What is the file to be?").color(t.label));
        ui.add_space(4.0);
        for (role, refusal) in roles {
            let title = RichText::new(role.title).color(t.value);
            let is_chosen = self.chosen == Some(role.title);
            let radio = ui.add_enabled(refusal.is_none(), egui::RadioButton::new(is_chosen, title));
            if radio.clicked() {
                self.chosen = Some(role.title);
            }
            ui.horizontal_top(|ui| {
                ui.add_space(BESIDE_RADIO);
                let text = refusal.as_deref().unwrap_or(role.sentence);
                ui.label(RichText::new(text).font(font::caption()).color(t.label));
            });
            ui.add_space(4.0);
        }
    }

    fn buttons(&self, ui: &mut Ui) -> Option<bool> {
        let is_ready = self.chosen.is_some();
        let is_entered = ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let add = ActionButton::new(self.verb()).kind(ButtonKind::Main);
            if ui.add_enabled_ui(is_ready, |ui| ui.add(add)).inner.clicked() {
                return Some(true);
            }
            ui.add(ActionButton::new("Cancel")).clicked().then_some(false)
        })
        .inner
        .or((is_entered && is_ready).then_some(true))
    }
}

/// Shows the kind of the file, its size, its extent and the range of its values.
fn fact_rows(ui: &mut Ui, file: &DataFile) {
    ValueRow::new("Contents", &contents_text(file)).help("What the file holds.").show(ui);
    ValueRow::new("File size", &format::file_size(file.bytes)).help("The size of the file.").show(ui);
    let extents = match &file.extent {
        Some(extent) => {
            let step = STEP_OF_EXTENT * extent.size().max_element();
            let end = |value| {
                let text = format::coordinate(value, step, LengthUnit::None);
                format::without_zeros(&text).to_owned()
            };
            let range = |low, high| format!("{} … {}", end(low), file.unit.after(&end(high)));
            [range(extent.min.x, extent.max.x), range(extent.min.y, extent.max.y)]
        }
        None => ["the domain's", "the domain's"].map(String::from),
    };
    for (name, extent) in ["x", "y"].iter().zip(&extents) {
        ValueRow::new(name, extent)
            .help("The extent of the file, in its own coordinates, or in the plane of the document.")
            .show(ui);
    }
    let Some(RasterFacts { values, missing, size: [columns, rows] }) = file.raster() else { return };
    let values =
        values.map_or("none".into(), |[least, greatest]| format!("{} … {}", number(least), number(greatest)));
    ValueRow::new("Values", &values).help("The least and the greatest value of a pixel.").show(ui);
    if missing > 0 {
        let share = 100.0 * missing as f64 / (f64::from(columns) * f64::from(rows));
        let text = format!("{} %", format::digits(share, 2));
        ValueRow::new("Without a value", &text).help("The share of the pixels without a value.").show(ui);
    }
}

fn number(value: f64) -> String {
    format::digits(value, 7)
}

fn contents_text(file: &DataFile) -> String {
    let counted = |count: usize, one: &str| match count {
        1 => format!("1 {one}"),
        _ => format!("{} {one}s", format::count(count as u64)),
    };
    match file.contents {
        DataContents::Grid(RasterFacts { size: [columns, rows], .. }) => format!("grid, {columns} × {rows}"),
        DataContents::Picture(RasterFacts { size: [columns, rows], .. }) => {
            format!("picture, {columns} × {rows}")
        }
        DataContents::Shapes { points, lines, polygons } => {
            let kinds = [(polygons, "polygon"), (lines, "line"), (points, "point")];
            let kinds = kinds.into_iter().filter(|(count, _)| *count > 0);
            kinds.map(|(count, one)| counted(count, one)).collect::<Vec<_>>().join(", ")
        }
        DataContents::Threats(count) => counted(count, "threat"),
        DataContents::Points(count) => counted(count, "point"),
    }
}

/// Returns a sentence about an empty document, which takes the extent of its first file.
fn note_on_extent(state: &FrameState<'_>, file: &DataFile) -> Option<&'static str> {
    let empty = EmptyDocument::of(state.session)?;
    empty.over(&file.path, file.extent?, LengthUnit::None)?;
    Some("The document is empty: with this file it takes the extent of the file.")
}
