//! Plots in the menus View and Method, and in the palette.

use eframe::egui::Key;

use super::files::EXPORT_PLOT;
use super::{PlotKind, PlotsCommand};
use crate::app::features::plots::Plots;
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_kit::kit::{CatalogItem, FrameState, Menu};

/// Returns the plots, and what to do with them.
pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    let item = |title: &str, command| CatalogItem::new(Menu::View, title, Command::from(command));
    let plots = &state.feature::<Plots>();
    let show = item("Show the plots", PlotsCommand::Show(plots.kind())).key(Key::F9).group();
    let of_kind = |(kind, name): (PlotKind, &str)| {
        let title = format!("Plot {}{}", name[..1].to_lowercase(), &name[1..]);
        let shown = CatalogItem::new(Menu::Method, title, Command::from(PlotsCommand::Show(kind)));
        let is_of_method = kind == PlotKind::Bisections || kind.is_of_experiment();
        shown.checked(plots.kind() == kind).in_menu(is_of_method)
    };
    let of_method = |title: &str, command| CatalogItem::new(Menu::Method, title, Command::from(command));
    let measure = if plots.is_measuring() {
        of_method("Cancel the measuring of time", PlotsCommand::CancelMeasuring)
    } else {
        of_method("Measure the time per triangle", PlotsCommand::Measure)
    };
    let measure = measure.id("measure-the-time-per-triangle");
    let is_known = plots.is_known();
    let export = CatalogItem::new(Menu::View, "Export plot…", Command::from(FileCommand::Ask(&EXPORT_PLOT)));
    let copy = item("Copy the numbers of the plot", PlotsCommand::Copy);
    let mut items = vec![show];
    items.extend(PlotKind::ALL.map(of_kind));
    items.extend([measure, export.enabled(is_known).palette_only(), copy.enabled(is_known).palette_only()]);
    items
}
