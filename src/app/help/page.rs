//! A page of the manual, drawn.

use std::io::Cursor;
use std::sync::Arc;

use eframe::egui::{
    self, Color32, ColorImage, FontFamily, FontId, Galley, Id, Label, Margin, Role, Sense, Stroke,
    TextureHandle, TextureOptions, Ui, WidgetInfo, pos2, vec2,
};
use egui::text::{LayoutJob, TextFormat};

use super::manual::{Page, page_of};
use super::markdown::{Block, Span, blocks, plain};
use crate::app::host::asset;
use meshbrush_io::io::png::decode_picture;
use meshbrush_kit::kit::command::{Command, HelpTopic, ShellCommand};
use meshbrush_ui::theme::{font, metrics, tokens};

/// Space between cells of a table.
const CELL_GAP: f32 = 16.0;
/// Indentation of a list for each level.
const INDENT: f32 = 18.0;

/// Draws a page over the available width, and scrolls to the block `to`, if there is one. Links to other
/// pages send commands.
pub fn show(ui: &mut Ui, page: &Page, to: Option<usize>, commands: &mut Vec<Command>) {
    // Parsed once: a page is drawn in every frame.
    let id = Id::unique(page.file);
    let parsed = ui.data(|data| data.get_temp::<Arc<Vec<Block>>>(id)).unwrap_or_else(|| {
        let parsed = Arc::new(blocks(page.text));
        ui.data_mut(|data| data.insert_temp(id, parsed.clone()));
        parsed
    });
    ui.spacing_mut().item_spacing.y = 8.0;
    for (number, block) in parsed.iter().enumerate() {
        if to == Some(number) {
            ui.scroll_to_cursor(Some(egui::Align::TOP));
        }
        show_block(ui, block, commands);
    }
    ui.add_space(16.0);
}

fn show_block(ui: &mut Ui, block: &Block, commands: &mut Vec<Command>) {
    match block {
        Block::Heading(level, spans) => heading(ui, *level, &plain(spans)),
        Block::Paragraph(spans) => text(ui, spans, commands),
        Block::Item(depth, mark, spans) => {
            ui.horizontal_top(|ui| {
                ui.spacing_mut().item_spacing.x = 0.0;
                ui.add_space(INDENT * (*depth as f32 - 1.0));
                let mark = egui::RichText::new(mark).color(tokens(ui).label);
                ui.add_sized(vec2(INDENT, 16.0), Label::new(mark));
                ui.vertical(|ui| text(ui, spans, commands));
            });
        }
        Block::Code(lines) => code(ui, lines),
        Block::Table(rows) => table(ui, rows),
        Block::Picture(file, description) => show_picture(ui, file, description),
    }
}

fn heading(ui: &mut Ui, level: usize, text: &str) {
    let size = match level {
        1 => 20.0,
        2 => 15.0,
        _ => 13.0,
    };
    ui.add_space(if level == 1 { 0.0 } else { 8.0 });
    let font = FontId::new(size, FontFamily::Name(font::SEMIBOLD.into()));
    let response = ui.label(egui::RichText::new(text).font(font).color(tokens(ui).value));
    response.widget_info(|| WidgetInfo::labeled(Role::Heading, true, text));
}

/// Running text; a link is a word to click on.
fn text(ui: &mut Ui, spans: &[Span], commands: &mut Vec<Command>) {
    if spans.iter().all(|span| span.link.is_none()) {
        ui.add(Label::new(job(ui, spans)).wrap());
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
        for part in spans.chunk_by(|a, b| a.link == b.link) {
            match part[0].link.as_deref().and_then(page_of) {
                Some(page) => {
                    if ui.link(plain(part)).clicked() {
                        commands.push(Command::from(ShellCommand::ShowHelp(HelpTopic::Page(page.file))));
                    }
                }
                None => drop(ui.label(job(ui, part))),
            }
        }
    });
}

/// Returns the spans as one text with their styles.
fn job(ui: &Ui, spans: &[Span]) -> LayoutJob {
    let t = tokens(ui);
    let mut job = LayoutJob::default();
    for span in spans {
        let format = match (span.code, span.strong) {
            (true, _) => TextFormat { background: t.field, ..TextFormat::simple(font::value(), t.value) },
            (false, true) => TextFormat::simple(font::strong(), t.value),
            (false, false) => TextFormat::simple(font::body(), t.text),
        };
        job.append(&span.text, 0.0, TextFormat { line_height: Some(19.0), ..format });
    }
    job
}

fn code(ui: &mut Ui, lines: &str) {
    let t = tokens(ui);
    let frame =
        egui::Frame::new().fill(t.well).corner_radius(metrics::RADIUS_CONTROL).inner_margin(Margin::same(10));
    frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.add(Label::new(egui::RichText::new(lines).font(font::value()).color(t.value)).wrap());
    });
}

/// Columns as wide as their text; the last one takes what is left.
fn table(ui: &mut Ui, rows: &[Vec<Vec<Span>>]) {
    let widths = column_widths(ui, rows);
    for (number, row) in rows.iter().enumerate() {
        let cells: Vec<Arc<Galley>> = (row.iter().zip(&widths))
            .map(|(cell, width)| {
                let mut job = job(ui, cell);
                job.wrap.max_width = *width;
                ui.painter().layout_job(job)
            })
            .collect();
        let height = cells.iter().map(|cell| cell.size().y).fold(0.0, f32::max);
        if height == 0.0 {
            continue;
        }
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
        let spoken = row.iter().map(|cell| plain(cell)).collect::<Vec<_>>().join(" ");
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
        let mut x = rect.left();
        for (cell, width) in cells.into_iter().zip(&widths) {
            ui.painter().galley(pos2(x, rect.top()), cell, Color32::PLACEHOLDER);
            x += width + CELL_GAP;
        }
        if number == 0 {
            ui.painter().hline(rect.x_range(), rect.bottom() + 3.0, Stroke::new(1.0, tokens(ui).line));
        }
    }
}

fn column_widths(ui: &Ui, rows: &[Vec<Vec<Span>>]) -> Vec<f32> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let room = ui.available_width();
    let widest = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| ui.painter().layout_job(job(ui, cell)).size().x.ceil()).fold(0.0, f32::max)
    };
    let mut widths: Vec<f32> = (0..columns).map(|column| widest(column).min(0.45 * room)).collect();
    if let Some((last, others)) = widths.split_last_mut() {
        let taken: f32 = others.iter().map(|width| width + CELL_GAP).sum();
        *last = (room - taken).max(80.0);
    }
    widths
}

/// A picture, at most as wide as the page. Of one that a browser has not fetched, only what it shows.
fn show_picture(ui: &mut Ui, file: &str, description: &str) {
    if let Some(texture) = texture(ui, file) {
        show_texture(ui, &texture, description);
    }
    ui.label(egui::RichText::new(description).font(font::caption()).color(tokens(ui).label));
}

fn show_texture(ui: &mut Ui, texture: &TextureHandle, description: &str) {
    let size = texture.size_vec2();
    let scale = (ui.available_width() / size.x).min(1.0);
    let image = egui::Image::new(texture).fit_to_exact_size(size * scale).alt_text(description);
    ui.add(image.corner_radius(metrics::RADIUS_CONTROL));
}

/// Returns the texture of a picture, decoded when it is shown for the first time.
fn texture(ui: &Ui, file: &str) -> Option<TextureHandle> {
    let id = Id::unique(file).with("texture");
    if let Some(texture) = ui.data(|data| data.get_temp::<TextureHandle>(id)) {
        return Some(texture);
    }
    let decoded = decode_picture(Cursor::new(asset(file)?)).ok()?;
    let size = decoded.size.map(|side| side as usize);
    let image = ColorImage::from_rgba_unmultiplied(size, &decoded.rgba);
    let texture = ui.ctx().load_texture(file, image, TextureOptions::LINEAR);
    ui.data_mut(|data| data.insert_temp(id, texture.clone()));
    Some(texture)
}
