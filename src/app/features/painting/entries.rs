//! The brush in menus and in the palette.

use eframe::egui::{Key, Modifiers};

use super::options::can_paint_errors;
use super::{ERASER, GESTURES};
use meshbrush_kit::kit::command::{BrushCommand, Command};
use meshbrush_kit::kit::tools::{BrushMode, PaintKind, Tools};
use meshbrush_kit::kit::{CatalogItem, DIGITS, FrameState, GestureHelp, Menu, NOT_QUERYING, Submenu};

/// The brush, gestures that are hard to find, and what the digits set.
pub fn entries(state: &FrameState<'_>) -> Vec<CatalogItem> {
    // The menu has what the selected tool does.
    let is_brush = state.tools.paints();
    let brush = brush(state).into_iter().chain(GESTURES.iter().filter_map(GestureHelp::entry));
    let brush = brush.map(|item| item.in_menu(is_brush).above());
    let brush = brush.chain(presets(state.tools).map(move |item| item.in_menu(is_brush).above()));
    brush.chain(amounts(state.tools).map(CatalogItem::palette_only)).collect()
}

fn brush(state: &FrameState<'_>) -> Vec<CatalogItem> {
    use Menu::Tool as InTool;
    let tools = state.tools;
    let kind = |title: &str, kind| {
        CatalogItem::new(InTool, title, Command::from(BrushCommand::Kind(kind))).checked(tools.kind == kind)
    };
    let mode = |mode, title: &str| {
        let item = CatalogItem::new(InTool, title, Command::from(BrushCommand::Mode(mode)));
        item.checked(tools.mode == mode)
    };
    let mirror = |title: &str, command: fn(bool) -> BrushCommand, on: bool| {
        CatalogItem::new(InTool, title, Command::from(command(!on))).checked(on).palette_only()
    };
    let harder = |title: &str, step: f64, key, bracket| {
        let hardness = (tools.hardness + step).clamp(0.0, 1.0);
        CatalogItem::new(InTool, title, Command::from(BrushCommand::Hardness(hardness)))
            .keys(Modifiers::SHIFT, key)
            .keys(Modifiers::SHIFT, bracket)
            .palette_only()
    };
    // I is above J on every keyboard; brackets need AltGr on many.
    vec![
        kind("Paint risk", PaintKind::Risk).key(Key::R).group(),
        kind("Paint target diameter", PaintKind::Diameter).key(Key::T),
        kind("Paint largest error", PaintKind::Error).in_menu(can_paint_errors(state)),
        mode(BrushMode::BuildUp, "Build up").key(Key::U).group(),
        mode(BrushMode::Set, "Set the value").key(Key::V),
        mode(BrushMode::Lower, "Lower").key(Key::L),
        mirror("Mirror strokes left and right", BrushCommand::MirrorX, tools.mirrored[0]).group(),
        mirror("Mirror strokes above and below", BrushCommand::MirrorY, tools.mirrored[1]),
        CatalogItem::new(InTool, "Larger brush", Command::from(BrushCommand::Scale(1.15)))
            .key(Key::I)
            .key(Key::CloseBracket)
            .group(),
        CatalogItem::new(InTool, "Smaller brush", Command::from(BrushCommand::Scale(1.0 / 1.15)))
            .key(Key::J)
            .key(Key::OpenBracket),
        harder("Harder brush", 0.1, Key::I, Key::CloseCurlyBracket),
        harder("Softer brush", -0.1, Key::J, Key::OpenCurlyBracket),
    ]
}

/// The presets of the brush, and what keeps it as one.
fn presets(tools: &Tools) -> impl Iterator<Item = CatalogItem> {
    let chosen = tools.chosen_preset();
    let uses = tools.presets().iter().enumerate().map(move |(number, preset)| {
        let command = Command::from(BrushCommand::UsePreset(number));
        let item = CatalogItem::new(Menu::Tool, format!("Brush preset: {}", preset.name), command);
        item.id(format!("brush-preset-{}", number + 1)).checked(chosen == Some(number))
    });
    let keep = Command::from(BrushCommand::KeepPreset);
    let keep = CatalogItem::new(Menu::Tool, "Keep the brush as a preset", keep).enabled(chosen.is_none());
    uses.chain([keep]).map(|item| item.within(Submenu::BrushPresets))
}

/// What the digits set: the strength, or the risk in the mode *Set*. A diameter is no share, so there they do
/// nothing. With the query tool they belong to the neighbours.
fn amounts(tools: &Tools) -> impl Iterator<Item = CatalogItem> + use<> {
    let has_keys = !tools.tool.queries;
    let paints = tools.tool != &ERASER;
    let sets_risk = paints && tools.kind == PaintKind::Risk && tools.mode == BrushMode::Set;
    let is_share = !paints || tools.kind == PaintKind::Risk;
    DIGITS.into_iter().enumerate().map(move |(i, key)| {
        let share = (i + 1) as f64 / 10.0;
        let (title, command) = if sets_risk {
            (format!("Risk {share}"), BrushCommand::Risk(share))
        } else {
            (format!("Strength {} %", 10 * (i + 1)), BrushCommand::Strength(share))
        };
        let item = CatalogItem::new(Menu::Tool, title, Command::from(command)).enabled(is_share);
        let item = item.id(format!("amount-{}", i + 1)).key(key).only(NOT_QUERYING, has_keys);
        if i == 0 { item.group() } else { item }
    })
}
