//! The panel of layers, its commands, and what the window shows of layers.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use crate::app::features::inspection::InspectCommand;
use crate::app::features::layers::LayerEditor;
use crate::app::tests::{
    CTRL_SHIFT, FREE, TALL, Window, active, button_event, choose, choose_in_palette, choose_within,
    click_button, document, entries, key, level_at, move_to, notice, press_at, release_at, send, set,
    settings, stroke, triangles, type_into, value_of, wait_until, window, window_of, window_with,
};
use meshbrush_core::document::Setting;
use meshbrush_core::domain::Domain;
use meshbrush_core::layers::{
    Combine, FormulaLayer, Layer, LayerId, LayerKind, Mask, Quantity, RasterLayer, RasterReading,
};
use meshbrush_kit::kit::command::{BrushCommand, Command, EditCommand, FileCommand, LayerCommand};
use meshbrush_kit::kit::tools::PaintKind;
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_mesh::text::LengthUnit;

/// A place in the first example where risk is painted.
const PAINTED: glam::DVec2 = dvec2(0.245, 0.765);

/// Returns the names of the layers, from the top.
fn names(window: &Window) -> Vec<&str> {
    settings(window).layers.iter().rev().map(|layer| layer.name.as_str()).collect()
}

fn row(window: &Window, name: &str) -> Pos2 {
    window.get_by_role_and_label(Role::ListBoxOption, name).rect().center()
}

fn click_on(window: &mut Window, role: Role, name: &str) {
    window.get_by_role_and_label(role, name).click();
    window.run();
}

/// Selects a layer by a click on its row.
pub fn select(window: &mut Window, name: &str) {
    click_on(window, Role::ListBoxOption, name);
    assert_eq!(active(window).name, name);
}

/// Drags a row by a distance in points.
fn drag_row(window: &mut Window, name: &str, down: f32) {
    let from = row(window, name);
    press_at(window, from, PointerButton::Primary, Modifiers::NONE);
    for share in [0.3, 0.7, 1.0] {
        let at = from + vec2(0.0, share * down);
        window.event(Event::PointerMoved(at));
        window.run();
    }
    release_at(window, from + vec2(0.0, down), PointerButton::Primary);
}

/// Chooses in a group: other groups have choices of the same name.
pub fn choose_in(window: &mut Window, group: &str, choice: &str) {
    let group = window.get_by_role_and_label(Role::RadioGroup, group).rect();
    let choices = window.get_all_by_role_and_label(Role::RadioButton, choice);
    let own: Vec<_> = choices.filter(|choice| group.contains(choice.rect().center())).collect();
    assert_eq!(own.len(), 1, "{choice}");
    own[0].click();
    drop(own);
    window.run();
}

fn layer(id: u32, window: &Window) -> &Layer {
    settings(window).layer(LayerId(id)).expect("a layer")
}

fn add(window: &mut Window, kind: LayerKind) {
    send(window, Command::from(LayerCommand::Add(Box::new(kind))));
}

#[test]
fn the_panel_lists_the_layers_from_the_top_with_their_kinds() {
    let window = window_of(TALL);
    assert_eq!(names(&window), ["Painted risk", "Painted diameter", "Base"]);
    let tops: Vec<f32> = names(&window).iter().map(|name| row(&window, name).y).collect();
    assert!(tops.is_sorted(), "{tops:?}");
    assert_eq!(value_of(&window, Role::ListBoxOption, "Base"), "Formula, Finest");
    assert_eq!(active(&window).name, "Painted risk", "the highest paint layer is selected at first");
}

#[test]
fn a_hidden_layer_asks_for_nothing_until_it_is_shown_again() {
    let mut window = window_of(TALL);
    let before = triangles(&window);
    click_on(&mut window, Role::CheckBox, "Painted risk visible");
    assert!(!layer(2, &window).visible);
    assert!(triangles(&window) < before / 2, "{}", triangles(&window));
    key(&mut window, Modifiers::SHIFT, Key::H);
    assert_eq!(triangles(&window), before);
    assert_eq!(entries(&window), 2, "each is a gesture of its own");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(!layer(2, &window).visible);
}

#[test]
fn the_add_menu_adds_every_kind_above_the_selected_layer() {
    let mut window = window_of(TALL);
    select(&mut window, "Base");
    for (entry, name) in [
        ("paint, as risk", "Painted risk 2"),
        ("paint, as target diameter", "Painted diameter 2"),
        ("formula for the target diameter", "Formula"),
        ("formula for the risk", "Formula 2"),
    ] {
        click_button(&mut window, "Add layer");
        click_button(&mut window, entry);
        assert_eq!(active(&window).name, name);
    }
    let expected = [
        "Painted risk",
        "Painted diameter",
        "Formula 2",
        "Formula",
        "Painted diameter 2",
        "Painted risk 2",
        "Base",
    ];
    assert_eq!(names(&window), expected);
    click_button(&mut window, "Add layer");
    click_button(&mut window, "picture or grid, as risk…");
    assert!(window.query_by_label_contains("Open picture as risk").is_some(), "it asks for a file");
}

#[test]
fn a_mask_from_a_file_limits_a_layer_until_it_is_removed() {
    let file = crate::app::tests::folder("app-layers", "mask").join("right.geojson");
    let right = r#"{"type": "Polygon", "coordinates": [[[0.5, 0], [1, 0], [1, 1], [0.5, 1], [0.5, 0]]]}"#;
    std::fs::write(&file, right).unwrap();
    let mut window = window_of(TALL);
    let (before, fine, coarse) = (triangles(&window), level_at(&window, PAINTED), level_at(&window, FREE));
    assert_eq!(value_of(&window, Role::Definition, "Mask"), "none");
    click_button(&mut window, "Mask from file…");
    type_into(&mut window, "Path", file.to_str().unwrap());
    wait_until(&mut window, |window| active(window).mask.is_some());
    assert!(value_of(&window, Role::Definition, "Mask").starts_with("0.5"));
    assert!(triangles(&window) < before && level_at(&window, PAINTED) < fine);
    assert_eq!((level_at(&window, FREE), entries(&window)), (coarse, 1));
    click_button(&mut window, "Remove mask");
    assert_eq!((active(&window).mask.is_none(), triangles(&window), entries(&window)), (true, before, 2));
    std::fs::write(&file, "{\"type\": \"Polygon\"").unwrap();
    send(&mut window, Command::from(LayerCommand::OpenMask(file)));
    wait_until(&mut window, |window| notice(window).contains("right.geojson"));
    assert!(active(&window).mask.is_none());
}

#[test]
fn a_layer_is_duplicated_with_its_paint_and_deleted() {
    let mut window = window_of(TALL);
    click_button(&mut window, "Duplicate layer");
    assert_eq!(names(&window), ["Painted risk 2", "Painted risk", "Painted diameter", "Base"]);
    assert_eq!(active(&window).name, "Painted risk 2");
    let before = triangles(&window);
    send(&mut window, Command::from(LayerCommand::Delete(LayerId(2))));
    assert_eq!(triangles(&window), before, "the copy asks for the same");
    click_button(&mut window, "Delete layer");
    assert_eq!(names(&window), ["Painted diameter", "Base"]);
    assert_eq!(active(&window).name, "Painted diameter", "the one below is selected");
    assert!(triangles(&window) < before / 2);
    add(&mut window, LayerKind::paint(Quantity::Risk));
    assert!(triangles(&window) < before / 2, "a new layer is blank");
    for _ in 0..4 {
        key(&mut window, Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(names(&window), ["Painted risk", "Painted diameter", "Base"]);
    assert_eq!(triangles(&window), before);
}

#[test]
fn a_layer_is_renamed_in_place_by_double_click_or_key() {
    const FIELD: &str = "New name of the layer";
    // Frames short enough for a double click.
    let mut window = window_with(Harness::builder().with_size(TALL).with_step_dt(1.0 / 60.0));
    let base = row(&window, "Base");
    window.event(Event::PointerMoved(base));
    for pressed in [true, false, true, false] {
        window.event(button_event(base, PointerButton::Primary, pressed, Modifiers::NONE));
    }
    window.run();
    window.get_by_role_and_label(Role::TextInput, FIELD).type_text("Open sea");
    window.run();
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert_eq!(layer(0, &window).name, "Open sea", "the old name was selected, so that typing replaces it");
    assert!(window.query_by_label(FIELD).is_none());
    key(&mut window, Modifiers::NONE, Key::F2);
    window.get_by_role_and_label(Role::TextInput, FIELD).type_text("Never");
    window.run();
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert_eq!(layer(0, &window).name, "Open sea");
    choose(&mut window, "Layer", "Rename layer F2");
    window.get_by_role_and_label(Role::TextInput, FIELD).type_text("  ");
    window.run();
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert_eq!(layer(0, &window).name, "Open sea", "no layer is without a name");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(layer(0, &window).name, "Base");
    assert_eq!(entries(&window), 0);
}

#[test]
fn a_row_is_dragged_to_another_place() {
    let mut window = window_of(TALL);
    let step = row(&window, "Base").y - row(&window, "Painted diameter").y;
    drag_row(&mut window, "Painted risk", 2.4 * step);
    assert_eq!(names(&window), ["Painted diameter", "Base", "Painted risk"]);
    drag_row(&mut window, "Base", -step);
    assert_eq!(names(&window), ["Base", "Painted diameter", "Painted risk"]);
    drag_row(&mut window, "Painted diameter", 0.4 * step);
    assert_eq!(names(&window), ["Base", "Painted diameter", "Painted risk"], "dropped where it was");
    assert_eq!(entries(&window), 2);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(names(&window), ["Painted risk", "Painted diameter", "Base"]);
}

#[test]
fn escape_drops_a_dragged_row_where_it_was() {
    let mut window = window_of(TALL);
    let from = row(&window, "Painted risk");
    press_at(&mut window, from, PointerButton::Primary, Modifiers::NONE);
    window.event(Event::PointerMoved(row(&window, "Base") + vec2(0.0, 10.0)));
    window.run();
    key(&mut window, Modifiers::NONE, Key::Escape);
    release_at(&mut window, from + vec2(0.0, 80.0), PointerButton::Primary);
    assert_eq!(names(&window), ["Painted risk", "Painted diameter", "Base"]);
}

#[test]
fn the_keyboard_selects_moves_duplicates_and_deletes() {
    let mut window = window();
    key(&mut window, Modifiers::NONE, Key::PageDown);
    assert_eq!(active(&window).name, "Painted diameter");
    key(&mut window, Modifiers::NONE, Key::PageDown);
    key(&mut window, Modifiers::NONE, Key::PageDown);
    assert_eq!(active(&window).name, "Base", "the lowest stays selected");
    key(&mut window, Modifiers::NONE, Key::PageUp);
    key(&mut window, Modifiers::COMMAND, Key::CloseBracket);
    assert_eq!(names(&window), ["Painted diameter", "Painted risk", "Base"]);
    key(&mut window, Modifiers::COMMAND, Key::OpenBracket);
    key(&mut window, Modifiers::COMMAND, Key::OpenBracket);
    assert_eq!(names(&window), ["Painted risk", "Base", "Painted diameter"]);
    key(&mut window, Modifiers::COMMAND, Key::J);
    assert_eq!(names(&window), ["Painted risk", "Base", "Painted diameter 2", "Painted diameter"]);
    key(&mut window, Modifiers::SHIFT, Key::Delete);
    assert_eq!(names(&window), ["Painted risk", "Base", "Painted diameter"]);
    key(&mut window, CTRL_SHIFT, Key::N);
    assert_eq!(active(&window).paints(), Some(Quantity::Risk));
    assert_eq!(names(&window).len(), 4);
}

#[test]
fn the_menu_has_every_command_of_the_stack() {
    let mut window = window_of(TALL);
    choose_in_palette(&mut window, "Combine: Floor");
    assert_eq!(active(&window).combine, Combine::Floor);
    choose(&mut window, "Layer", "Layer is locked");
    assert!(active(&window).locked);
    choose(&mut window, "Layer", "Limit gradation");
    assert!(settings(&window).gradation.is_some());
    choose_within(&mut window, "Layer", "Add layer", "formula for the risk");
    assert_eq!(active(&window).name, "Formula");
}

#[test]
fn a_locked_layer_keeps_its_parameters_its_paint_and_its_place_in_the_stack() {
    let mut window = window_of(TALL);
    click_on(&mut window, Role::CheckBox, "Painted risk locked");
    let before = settings(&window).clone();
    let painted = triangles(&window);
    click_on(&mut window, Role::RadioButton, "Replace");
    click_button(&mut window, "Delete layer");
    click_button(&mut window, "Clear this layer");
    key(&mut window, Modifiers::SHIFT, Key::Delete);
    send(&mut window, Command::from(EditCommand::ClearPaint));
    assert_eq!((settings(&window), triangles(&window)), (&before, painted));
    click_on(&mut window, Role::CheckBox, "Painted risk locked");
    choose(&mut window, "Layer", "Clear the selected layer");
    assert!(triangles(&window) < painted / 2);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(triangles(&window), painted);
}

#[test]
fn the_ways_to_combine_change_the_mesh() {
    let mut window = window_of(TALL);
    let finest = triangles(&window);
    // A diameter everywhere, above all paint.
    select(&mut window, "Painted risk");
    add(&mut window, LayerKind::constant(0.05));
    let over_all = triangles(&window);
    assert!(over_all > finest);
    click_on(&mut window, Role::RadioButton, "Floor");
    let floor = triangles(&window);
    assert!(floor < finest, "nothing gets finer than 0.05");
    click_on(&mut window, Role::RadioButton, "Replace");
    let replaced = triangles(&window);
    assert!(replaced != floor && replaced < over_all);
    assert_eq!(level_at(&window, PAINTED), level_at(&window, FREE), "paint below does not count");
    click_on(&mut window, Role::RadioButton, "Finest");
    assert_eq!(triangles(&window), over_all);
}

#[test]
fn a_formula_layer_has_its_quantity_its_number_and_its_formula() {
    let mut window = window_of(TALL);
    select(&mut window, "Base");
    type_into(&mut window, "Diameter", "0.1");
    assert_eq!(layer(0, &window).kind, LayerKind::constant(0.1));
    type_into(&mut window, "Target diameter h̄(x, y)", "0.05 + 0.1*x");
    let Some(FormulaLayer { formula, .. }) = layer(0, &window).kind.get() else { panic!("a formula") };
    assert_eq!(formula.source(), "0.05 + 0.1*x");
    assert!(window.query_by_role_and_label(Role::TextInput, "Diameter").is_none(), "it is no constant");
    choose_in(&mut window, "What the formula gives", "Risk");
    assert!(matches!(
        layer(0, &window).kind,
        LayerKind::Formula(FormulaLayer { quantity: Quantity::Risk, .. })
    ));
    type_into(&mut window, "Risk at (x, y)", "0.5");
    let before = entries(&window);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(entries(&window), before - 1);
    assert_eq!(value_of(&window, Role::TextInput, "Risk at (x, y)"), "0.05 + 0.1*x");
}

#[test]
fn another_selected_formula_layer_shows_its_own_formula() {
    let mut window = window_of(TALL);
    select(&mut window, "Base");
    type_into(&mut window, "Target diameter h̄(x, y)", "0.2 +");
    add(&mut window, LayerKind::constant(0.15));
    assert_eq!(value_of(&window, Role::TextInput, "Target diameter h̄(x, y)"), "0.15");
    select(&mut window, "Base");
    assert_eq!(layer(0, &window).kind, LayerKind::constant(0.2));
}

#[test]
fn a_raster_layer_shows_its_file_its_pixels_and_how_it_is_read() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(meshbrush_core::document::Example::Terrain)));
    select(&mut window, "Base");
    assert!(value_of(&window, Role::Definition, "Pixels").contains('×'));
    assert!(!value_of(&window, Role::Definition, "File").is_empty());
    let reading = |window: &Window| match &active(window).kind {
        LayerKind::Raster(RasterLayer { reading, .. }) => reading.clone(),
        other => panic!("{other:?}"),
    };
    assert_eq!(reading(&window), RasterReading::Risk);
    choose_in(&mut window, "What the values mean", "Diameter");
    assert!(notice(&window).contains("the target diameter is 0"), "{}", notice(&window));
    assert_eq!(reading(&window), RasterReading::Risk, "a project with such a layer would not open");
}

#[test]
fn a_stroke_without_a_usable_layer_offers_what_helps() {
    let mut window = window_of(TALL);
    click_on(&mut window, Role::CheckBox, "Painted risk locked");
    let before = triangles(&window);
    stroke(&mut window, FREE, FREE);
    assert!(notice(&window).contains("“Painted risk” is locked"), "{}", notice(&window));
    assert_eq!(triangles(&window), before);
    click_button(&mut window, "Unlock the layer");
    assert!(!layer(2, &window).locked && notice(&window).is_empty());
    click_on(&mut window, Role::CheckBox, "Painted risk visible");
    stroke(&mut window, FREE, FREE);
    click_button(&mut window, "Show the layer");
    assert!(layer(2, &window).visible);
    click_button(&mut window, "Delete layer");
    assert_eq!(active(&window).paints(), Some(Quantity::Diameter), "the brush paints the layer that is left");
    click_button(&mut window, "Delete layer");
    stroke(&mut window, FREE, FREE);
    click_button(&mut window, "Add a paint layer");
    assert_eq!(active(&window).paints(), Some(Quantity::Diameter));
    stroke(&mut window, FREE, FREE);
    assert!(level_at(&window, FREE) > 3, "now it can be painted on");
}

#[test]
fn the_brush_paints_on_the_selected_layer_and_its_choice_selects_one() {
    let mut window = window_of(TALL);
    add(&mut window, LayerKind::paint(Quantity::Risk));
    let new = active(&window).id;
    stroke(&mut window, FREE, FREE);
    let is_painted =
        |window: &Window, id| document(window).paint().get(id).is_some_and(|raster| !raster.is_blank());
    assert!(is_painted(&window, new));
    send(&mut window, Command::from(BrushCommand::Kind(PaintKind::Diameter)));
    assert_eq!(active(&window).name, "Painted diameter");
    send(&mut window, Command::from(BrushCommand::Kind(PaintKind::Risk)));
    assert_eq!(active(&window).id, new, "the highest of that quantity");
    select(&mut window, "Painted diameter");
    assert_eq!(window.state().tools().kind, PaintKind::Diameter, "and a layer chooses what is painted");
}

#[test]
fn gradation_is_limited_by_a_switch_and_a_number() {
    let mut window = window_of(TALL);
    let before = triangles(&window);
    click_on(&mut window, Role::CheckBox, "Limit gradation");
    let default = triangles(&window);
    assert!(default > before, "{before} {default}");
    type_into(&mut window, "Gradation g value", "1.5");
    assert_eq!(settings(&window).gradation, Some(1.5));
    assert!(triangles(&window) < default);
    assert_eq!(entries(&window), 2);
    click_on(&mut window, Role::CheckBox, "Limit gradation");
    assert_eq!((settings(&window).gradation, triangles(&window)), (None, before));
}

#[test]
fn status_bar_and_inspector_name_the_layer_that_decides() {
    let mut window = window_of(TALL);
    move_to(&mut window, PAINTED);
    assert_eq!(value_of(&window, Role::Definition, "by"), "Painted risk");
    move_to(&mut window, FREE);
    assert_eq!(value_of(&window, Role::Definition, "by"), "Base");
    send(&mut window, Command::from(InspectCommand::Query(PAINTED)));
    assert_eq!(value_of(&window, Role::Definition, "Decided by"), "Painted risk");
    let asked = |window: &Window, layer: &str| value_of(window, Role::Definition, layer);
    assert_eq!(asked(&window, "Painted diameter"), "nothing");
    assert_eq!(asked(&window, "Base"), "0.2");
    let risk: f64 = asked(&window, "Painted risk").parse().unwrap();
    assert!(risk < 0.1, "{risk}");
    send(&mut window, Command::from(InspectCommand::Query(dvec2(0.95, 0.95))));
    assert!(window.query_by_label("Through gradation from").is_none());
    send(&mut window, Command::from(EditCommand::Set(Setting::Gradation(Some(0.5)))));
    assert_eq!(value_of(&window, Role::Definition, "Decided by"), "Painted risk");
    assert!(window.query_by_label("Through gradation from").is_some());
    assert_eq!(asked(&window, "Painted risk"), "nothing", "it asks for nothing at the point itself");
}

#[test]
fn the_overlay_of_deciding_layers_has_a_legend_and_a_dot_per_row() {
    let mut window = window_of(TALL);
    choose_in_palette(&mut window, "Overlay deciding layer");
    assert_eq!(window.state().view().overlay, FieldOverlay::Layer);
    assert!(window.query_by_label("Legend: layers Painted risk, Painted diameter, Base").is_some());
    click_on(&mut window, Role::CheckBox, "Painted diameter visible");
    assert!(window.query_by_label("Legend: layers Painted risk, Base").is_some());
}

#[test]
fn every_row_gets_a_picture_of_what_its_layer_asks_for() {
    let mut window = window_of(TALL);
    let has = |window: &Window, id: u32| {
        window.state().features.get::<LayerEditor>().pictures.texture(LayerId(id)).is_some()
    };
    wait_until(&mut window, |window| (0..3).all(|id| has(window, id)));
    add(&mut window, LayerKind::constant(0.1));
    wait_until(&mut window, |window| has(window, 3));
}

#[test]
fn the_area_of_a_mask_is_that_on_the_earth() {
    let mut window = window_of(TALL);
    let ring = [[0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 1.0]].map(glam::DVec2::from).to_vec();
    let (id, mask) = (active(&window).id, Mask::new(&[vec![ring]]).unwrap());
    send(&mut window, Command::from(LayerCommand::Mask(id, Some(mask))));
    assert!(value_of(&window, Role::Definition, "Mask").starts_with("0.5"));
    // In this plane, lengths are half of those on the Earth.
    let projection = "+proj=tmerc +lon_0=15 +k_0=0.5".parse().ok();
    let domain = Domain { projection, ..settings(&window).domain.clone() };
    set(&mut window, Setting::LengthUnit(LengthUnit::Metre));
    set(&mut window, Setting::Domain(domain));
    let area = value_of(&window, Role::Definition, "Mask");
    assert!(area.starts_with('2') && area.ends_with(" m²"), "{area}");
}
