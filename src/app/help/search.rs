//! The search in the manual.

use std::sync::Arc;

use eframe::egui::{self, Id, Role, Sense, Ui, WidgetInfo, vec2};

use super::manual::{PAGES, Page};
use super::markdown::{Block, Span, blocks, plain};
use meshbrush_kit::kit::command::{Command, HelpTopic, ShellCommand};
use meshbrush_ui::theme::{font, metrics, tokens};
use meshbrush_ui::widgets::SearchField;

/// Most places that are listed.
const MOST: usize = 40;
/// Letters before and after the first word that was found.
const AROUND: usize = 40;

/// A part of a page, from one heading to the next.
struct PagePart {
    page: &'static Page,
    /// The number of the block of the heading.
    block: usize,
    heading: String,
    text: String,
}

/// A place in the manual that a search found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hit {
    /// The page.
    pub page: &'static Page,
    /// The number of the block of the heading above the text.
    pub block: usize,
    /// The heading.
    pub heading: String,
    /// The text around the first word that was found.
    pub excerpt: String,
}

/// Shows the field to search with, and returns what was typed.
pub fn field(ui: &mut Ui) -> String {
    let id = Id::unique("search in the manual");
    let mut query: String = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    SearchField::new("Search the manual", "Search").show(ui, &mut query);
    ui.data_mut(|data| data.insert_temp(id, query.clone()));
    query.trim().to_owned()
}

/// Forgets what was typed.
pub fn clear(ui: &Ui) {
    ui.data_mut(|data| data.remove::<String>(Id::unique("search in the manual")));
}

/// Shows the places that have all words of a query. A click opens the place.
pub fn results(ui: &mut Ui, query: &str, commands: &mut Vec<Command>) {
    let hits = hits(&parts(ui), query);
    if hits.is_empty() {
        ui.label("No page has all of these words. Try fewer words, or a part of one.");
    }
    for hit in &hits {
        if row(ui, hit) {
            let topic = HelpTopic::Heading(hit.page.file, hit.block);
            commands.push(Command::from(ShellCommand::ShowHelp(topic)));
            clear(ui);
        }
    }
}

/// Returns the parts of all pages, which are made once.
fn parts(ui: &Ui) -> Arc<Vec<PagePart>> {
    let id = Id::unique("parts of the manual");
    ui.data(|data| data.get_temp::<Arc<Vec<PagePart>>>(id)).unwrap_or_else(|| {
        let parts = Arc::new(PAGES.iter().flat_map(parts_of).collect());
        ui.data_mut(|data| data.insert_temp(id, Arc::clone(&parts)));
        parts
    })
}

fn parts_of(page: &'static Page) -> Vec<PagePart> {
    let mut parts: Vec<PagePart> = Vec::new();
    for (block, content) in blocks(page.text).iter().enumerate() {
        let text = match content {
            Block::Heading(_, spans) => {
                parts.push(PagePart { page, block, heading: plain(spans), text: String::new() });
                continue;
            }
            Block::Paragraph(spans) | Block::Item(_, _, spans) => plain(spans),
            Block::Code(text) | Block::Picture(_, text) => text.clone(),
            Block::Table(rows) => rows.iter().map(|row| row_text(row)).collect::<Vec<_>>().join(" "),
        };
        if let Some(part) = parts.last_mut() {
            part.text += &text;
            part.text.push(' ');
        }
    }
    parts
}

fn row_text(cells: &[Vec<Span>]) -> String {
    cells.iter().map(|cell| plain(cell)).collect::<Vec<_>>().join(" ")
}

/// Returns the parts that have all words of a query, those with all of them in the heading first.
fn hits(parts: &[PagePart], query: &str) -> Vec<Hit> {
    let words: Vec<String> = query.split_whitespace().map(str::to_lowercase).collect();
    let has_all = |text: &str| words.iter().all(|word| text.contains(word.as_str()));
    let mut found: Vec<(bool, Hit)> = Vec::new();
    for part in parts {
        let (heading, text) = (part.heading.to_lowercase(), part.text.to_lowercase());
        if !has_all(&format!("{heading} {text}")) {
            continue;
        }
        let first = words.iter().find_map(|word| text.find(word.as_str())).unwrap_or(0);
        let excerpt = excerpt(&part.text, text[..first].chars().count());
        let PagePart { page, block, ref heading, .. } = *part;
        found.push((
            !has_all(&heading.to_lowercase()),
            Hit { page, block, heading: heading.clone(), excerpt },
        ));
    }
    found.sort_by_key(|(is_in_text, _)| *is_in_text);
    found.into_iter().take(MOST).map(|(_, hit)| hit).collect()
}

/// Returns the text around a letter, in whole words.
fn excerpt(text: &str, at: usize) -> String {
    let letters: Vec<char> = text.chars().collect();
    let is_space = |place: &usize| letters[*place].is_whitespace();
    let start = (0..at.saturating_sub(AROUND).min(letters.len())).rev().find(is_space).map_or(0, |at| at + 1);
    let end = ((at + 2 * AROUND).min(letters.len())..letters.len()).find(is_space).unwrap_or(letters.len());
    let middle: String = letters[start..end].iter().collect();
    let before = if start > 0 { "… " } else { "" };
    let after = if end < letters.len() { " …" } else { "" };
    format!("{before}{}{after}", middle.trim())
}

/// Shows a place. Returns whether it was clicked.
fn row(ui: &mut Ui, hit: &Hit) -> bool {
    let t = *tokens(ui);
    let title = match hit.heading == hit.page.title {
        true => hit.heading.clone(),
        false => format!("{} › {}", hit.page.title, hit.heading),
    };
    let width = ui.available_width() - 16.0;
    let layout = |text: String, font: egui::FontId, color| ui.painter().layout(text, font, color, width);
    let heading = layout(title.clone(), font::strong(), t.value);
    let text = layout(hit.excerpt.clone(), font::caption(), t.label);
    let height = heading.size().y + text.size().y + 12.0;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Link, true, &title));
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, metrics::RADIUS_CONTROL, t.field);
    }
    let at = rect.min + vec2(8.0, 5.0);
    ui.painter().galley(at + vec2(0.0, heading.size().y + 2.0), text, t.label);
    ui.painter().galley(at, heading, t.value);
    response.on_hover_cursor(egui::CursorIcon::PointingHand).clicked()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(query: &str) -> Vec<(String, String)> {
        let parts: Vec<PagePart> = PAGES.iter().flat_map(parts_of).collect();
        hits(&parts, query).into_iter().map(|hit| (hit.page.title.to_owned(), hit.heading)).collect()
    }

    #[test]
    fn a_part_of_a_page_is_found_by_words_of_its_text_in_any_order() {
        let laws = ("Size and risk".to_owned(), "Risks of threats".to_owned());
        assert!(found("radar gaussian disc").contains(&laws));
        assert!(found("disc RADAR").contains(&laws));
        assert!(found("no such words anywhere").is_empty());
    }

    #[test]
    fn headings_come_first() {
        assert_eq!(found("how layers combine")[0].1, "How layers combine");
    }

    #[test]
    fn an_excerpt_has_whole_words_around_the_place() {
        let text = "one two three ".repeat(20);
        let part = excerpt(&text, text.find("two").unwrap() + 140);
        assert!(part.starts_with("… ") && part.ends_with(" …"), "{part}");
        assert!(part.trim_matches(['…', ' ']).split(' ').all(|word| ["one", "two", "three"].contains(&word)));
        assert_eq!(excerpt("short", 2), "short");
    }
}
