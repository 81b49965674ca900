//! The figures of the report in menus and in the palette.

use super::FigureCommand;
use meshbrush_kit::kit::command::Command;
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu};
use meshbrush_study::report::ReportFigure;

/// Returns an entry for each figure.
pub fn entries(_: &FrameState<'_>) -> Vec<CatalogItem> {
    let items = ReportFigure::ALL.into_iter().enumerate().map(|(number, figure)| {
        let open = Command::from(FigureCommand::Open(figure));
        let item = CatalogItem::new(Menu::Method, format!("The report, {}", figure.name()), open);
        if number == 0 { item.group() } else { item }
    });
    items.collect()
}
