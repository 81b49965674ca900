//! The controls, driven by role and label, and drawn in both themes.

use eframe::egui;
use egui::accesskit::Role;
use egui::{Align2, Color32, Event, Modifiers, PointerButton, Theme, Ui, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::{painted_radii, painted_texts};
use meshbrush_ui::theme;
use meshbrush_ui::widgets::*;

/// Everything that the gallery's controls edit.
struct State {
    size: f64,
    strength: f64,
    levels: f64,
    mode: u8,
    transfer: CurveValues,
    /// How many edits of it have ended.
    curve_done: usize,
    formula: String,
    broken: String,
    name: String,
    rule: u8,
    edges: bool,
    grid: bool,
    spacing: f64,
    limit: f64,
    chosen: Option<usize>,
    palette: bool,
    answer: Option<ConfirmAnswer>,
    asking: bool,
    clicks: Vec<String>,
    hovered_level: Option<u32>,
    done: usize,
}

impl Default for State {
    fn default() -> Self {
        Self {
            size: 0.064,
            strength: 0.8,
            levels: 10.0,
            mode: 0,
            transfer: CurveValues { h_max: 0.2, h_risk: 0.0024, shape: 1.6 },
            curve_done: 0,
            formula: "if(abs(x)+abs(y)<0.4, 0.0125, 1)".into(),
            broken: "0.1 + sqr(x) * 3".into(),
            name: "radar threats".into(),
            rule: 0,
            edges: true,
            grid: false,
            spacing: 0.05,
            limit: 2_000_000.0,
            chosen: None,
            palette: false,
            answer: None,
            asking: false,
            clicks: Vec::new(),
            hovered_level: None,
            done: 0,
        }
    }
}

const COUNTS: [u64; 11] = [632, 193, 308, 748, 1_176, 1_814, 2_546, 4_106, 5_604, 8_900, 11_960];
const VIRIDIS: [u32; 11] = [
    0x1d212b, 0x482878, 0x3e4989, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b, 0xdde318,
    0xfde725,
];

fn rgb(hex: u32) -> Color32 {
    let [_, r, g, b] = hex.to_be_bytes();
    Color32::from_rgb(r, g, b)
}

fn level_rows(ui: &Ui, count: u32) -> Vec<LevelRow> {
    let row = |level: u32| {
        let i = (level as usize * 10) / (count.max(2) as usize - 1);
        let color = if level == 0 { theme::tokens(ui).level_zero } else { rgb(VIRIDIS[i.max(1)]) };
        LevelRow { level, color, count: COUNTS[i], diameter: 0.1 / f64::from(level).exp2().sqrt() }
    };
    (0..count).map(row).collect()
}

fn power(value: &CurveValues, risk: f64) -> f64 {
    value.h_max * (value.h_risk / value.h_max).powf(risk.powf(value.shape))
}

const COMMANDS: [PaletteItem<'static>; 6] = [
    PaletteItem { title: "Save", words: "", keys: "Ctrl+S", enabled: true },
    PaletteItem { title: "Save as…", words: "", keys: "Ctrl+Shift+S", enabled: true },
    PaletteItem { title: "Undo", words: "", keys: "Ctrl+Z", enabled: true },
    PaletteItem { title: "Redo", words: "", keys: "Ctrl+Shift+Z", enabled: false },
    PaletteItem { title: "Fit view", words: "", keys: "Home", enabled: true },
    PaletteItem { title: "Export mesh", words: "", keys: "", enabled: true },
];

fn brush(ui: &mut Ui, state: &mut State) {
    Section::new("Brush").show(ui, |ui| {
        segmented(ui, "Brush mode", &mut state.mode, &[(0, "Risk"), (1, "Diameter")]);
        ui.add_space(4.0);
        let size = SliderRow::new("Size", &mut state.size, 1e-3..=1.0).logarithmic().show(ui);
        state.done += usize::from(edit_done(&size));
        SliderRow::new("Strength", &mut state.strength, 0.0..=1.0).show(ui);
        SliderRow::new("Level cap", &mut state.levels, 0.0..=54.0).step(1.0).show(ui);
        ui.add_enabled_ui(false, |ui| {
            let mut hardness = 0.35;
            SliderRow::new("Hardness", &mut hardness, 0.0..=1.0).show(ui);
        });
    });
}

fn field(ui: &mut Ui, state: &mut State) {
    Section::new("Risk to diameter").note("16 decades").show(ui, |ui| {
        let curve = TransferCurve::new(&mut state.transfer, &power, 1e-4..=1.0, 0.1..=10.0).show(ui);
        state.curve_done += usize::from(edit_done(&curve));
    });
    Section::new("Field").show(ui, |ui| {
        TextRow::formula("Target h̄(x, y)", &mut state.formula).show(ui);
        let error = TextError { message: "sqr is not a function; did you mean sqrt?", at: Some(6) };
        TextRow::formula("Risk", &mut state.broken).error(Some(error)).show(ui);
        TextRow::new("Name", &mut state.name).hint("untitled").show(ui);
        dropdown_row(ui, "RefinementRule", &mut state.rule, &[(0, "Area rule"), (1, "Vertex rule")]);
        NumberRow::new("Coarse spacing", &mut state.spacing).range(1e-6..=1.0).unit("km").show(ui);
        NumberRow::new("Budget", &mut state.limit).range(2.0..=1e9).integer().show(ui);
        toggle_row(ui, "Show edges", &mut state.edges);
        toggle_row(ui, "Show coarse grid", &mut state.grid);
    });
}

fn inspector(ui: &mut Ui, state: &mut State, levels: u32) {
    Section::new("Levels").note("37,987 triangles").show(ui, |ui| {
        let rows = level_rows(ui, levels);
        state.hovered_level = LevelLegend::new(&rows).lit(Some(8)).show(ui).hovered;
    });
    Section::new("Triangle 18,204").id("inspector").show(ui, |ui| {
        value_row(ui, "Level · orientation", "8 · anticlockwise");
        value_row(ui, "ζ₁ ζ₂ ζ₃", "0.214 0.551 0.235");
        value_row(ui, "Risk true", "0.7298 (+0.0016)");
        value_row(ui, "A name of some length", "12,345,678.901234567890");
        chips(ui, |ui| {
            let t = theme::tokens(ui);
            for (i, number) in ["18,205", "9,117", "31,040"].iter().enumerate() {
                let name = format!("Go to neighbour {}", i + 1);
                if Chip::new(t.neighbours[i], number, &name).show(ui).clicked() {
                    state.clicks.push(format!("neighbour {}", i + 1));
                }
            }
            Chip::new(t.neighbours[2], "boundary", "No third neighbour").enabled(false).show(ui);
        });
    });
}

fn tools(ui: &mut Ui, state: &mut State) {
    ui.horizontal(|ui| {
        for (icon, name, key) in [
            (Icon::BRUSH, "Brush", "B"),
            (Icon::ERASER, "Eraser", "E"),
            (Icon::QUERY, "Query", "Q"),
            (Icon::DOMAIN, "Domain", "D"),
            (Icon::PAN, "Pan", "Space"),
        ] {
            if ToolButton::new(icon, name).key(key).selected(name == "Brush").show(ui).clicked() {
                state.clicks.push(name.into());
            }
        }
        for icon in [Icon::UNDO, Icon::REDO, Icon::FIT] {
            ToolButton::small(icon, &format!("{icon:?}")).show(ui);
        }
    });
}

fn messages(ui: &mut Ui, state: &mut State) {
    tools(ui, state);
    ui.add_space(8.0);
    if progress_row(ui, "Refining", "1,126,079 triangles") {
        state.clicks.push("cancel".into());
    }
    progress_row(ui, "Sampling the field", "");
    ui.add_space(8.0);
    let text = "The stroke needs 4,120,000 triangles; the budget is 2,000,000. The mesh is as it was.";
    match Banner::error(text).action("Raise the budget").show(ui) {
        BannerAnswer::Open => {}
        answer => state.clicks.push(format!("{answer:?}")),
    }
    Banner::info("Saved to radar.meshbrush.").show(ui);
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        ui.add(ActionButton::new("Export").kind(ButtonKind::Main));
        ui.add(ActionButton::new("Cancel"));
        ui.add(ActionButton::new("Discard").kind(ButtonKind::Danger));
        ui.add_enabled(false, ActionButton::new("Disabled"));
    });
    empty_state(ui, Icon::QUERY, "No triangle selected", "Click the mesh with the query tool.");
    for font in [theme::font::body(), theme::font::strong(), theme::font::value()] {
        let text = "h̄ ζ₁ ζ₂ ζ₃ → ↑ ↓ ℓ ≤ θ √2 δ̄ x² 0.4 −1,234 ∈ Ω";
        ui.label(egui::RichText::new(text).font(font));
    }
    status_bar(ui);
    overlays(ui);
}

fn status_bar(ui: &mut Ui) {
    let t = theme::tokens(ui);
    egui::Frame::new().fill(t.window).inner_margin(egui::Margin::symmetric(8, 2)).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 12.0;
            StatusCell::new("x", "0.5813", 6).show(ui);
            StatusCell::new("y", "0.7402", 6).show(ui);
            StatusCell::new("h̄", "0.0061", 6).show(ui);
            StatusCell::new("triangles", "37,987", 9).show(ui);
            StatusCell::new("update", "0.4 ms", 6).show(ui);
        });
    });
}

fn overlays(ui: &mut Ui) {
    let t = theme::tokens(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 110.0), egui::Sense::hover());
    ui.painter().rect_filled(rect, 0.0, t.canvas);
    let above = rect.center() - vec2(0.0, 24.0);
    floating_tag(ui, above, Align2::CENTER_CENTER, rect, "paint +2,418 triangles", t.value);
    let hints = [
        Hint::Text("Drag to paint risk"),
        Hint::Key("["),
        Hint::Key("]"),
        Hint::Text("size"),
        Hint::Key("E"),
        Hint::Text("erase"),
        Hint::Key("Ctrl+Z"),
        Hint::Text("undo"),
    ];
    hint_pill(ui, rect.left_bottom() + vec2(8.0, -8.0), Align2::LEFT_BOTTOM, rect.shrink(8.0), &hints);
}

fn gallery(ui: &mut Ui, state: &mut State, levels: u32) {
    let panel = theme::tokens(ui).panel;
    ui.painter().rect_filled(ui.max_rect().expand(40.0), 0.0, panel);
    ui.horizontal_top(|ui| {
        for column in 0..3 {
            let width = if column == 2 { 440.0 } else { theme::metrics::PANEL_WIDTH - 32.0 };
            ui.allocate_ui_with_layout(vec2(width, 860.0), egui::Layout::top_down(egui::Align::Min), |ui| {
                ui.set_width(width);
                ui.shrink_clip_rect(ui.max_rect().expand(16.0));
                match column {
                    0 => {
                        brush(ui, state);
                        field(ui, state);
                    }
                    1 => inspector(ui, state, levels),
                    _ => messages(ui, state),
                }
            });
            ui.add_space(24.0);
        }
    });
    if state.palette {
        match command_palette(ui.ctx(), &COMMANDS) {
            PaletteAnswer::Open => {}
            PaletteAnswer::Closed => state.palette = false,
            PaletteAnswer::Chosen(index) => (state.palette, state.chosen) = (false, Some(index)),
        }
    }
    if state.asking {
        let text = "“radar threats” has changes that are not saved. They will be lost.";
        let dialog =
            ConfirmDialog::new("Close without saving?", text, "Discard").alternative("Save…").danger();
        state.answer = dialog.show(ui.ctx()).or(state.answer);
        state.asking = state.answer.is_none();
    }
}

/// Returns the gallery without a picture: needs no graphics driver.
fn harness(state: State) -> Harness<'static, State> {
    harness_for(state, Theme::Dark, 11, 1.0, false)
}

fn harness_for(state: State, shown: Theme, levels: u32, scale: f32, draw: bool) -> Harness<'static, State> {
    let builder = Harness::builder()
        .with_size(vec2(1160.0, 900.0))
        .with_pixels_per_point(scale)
        .with_theme(shown)
        .with_max_steps(16)
        .with_render_cursor(false)
        .with_context_setup(theme::install);
    let builder = if draw { builder.wgpu() } else { builder };
    let mut harness = builder.build_ui_state(move |ui, state| gallery(ui, state, levels), state);
    harness.run();
    harness
}

/// One column of the gallery as a small picture: what a panel looks like.
fn panel_picture(name: &str, shown: Theme, contents: fn(&mut Ui, &mut State)) {
    let mut harness = Harness::builder()
        .with_size(vec2(theme::metrics::PANEL_WIDTH, 400.0))
        .with_theme(shown)
        .with_max_steps(16)
        .with_render_cursor(false)
        .with_context_setup(theme::install)
        .wgpu()
        .build_ui_state(
            move |ui, state: &mut State| {
                ui.painter().rect_filled(ui.ctx().content_rect(), 0.0, theme::tokens(ui).panel);
                egui::Frame::new()
                    .inner_margin(egui::Margin::symmetric(8, 0))
                    .show(ui, |ui| contents(ui, state));
            },
            State::default(),
        );
    harness.run();
    harness.snapshot(name);
}

#[test]
fn a_panel_looks_as_it_did_in_the_dark() {
    panel_picture("panel_dark", Theme::Dark, |ui, state| {
        brush(ui, state);
        Section::new("Risk to diameter")
            .show(ui, |ui| TransferCurve::new(&mut state.transfer, &power, 1e-4..=1.0, 0.1..=10.0).show(ui));
    });
}

#[test]
fn a_panel_looks_as_it_did_in_the_light() {
    panel_picture("panel_light", Theme::Light, |ui, state| inspector(ui, state, 11));
}

/// Saves pictures of what pointer and keyboard do to the controls.
fn states(path: &str, shown: Theme) {
    let mut harness = harness_for(State::default(), shown, 11, 1.0, true);
    harness.get_by_label("Size value").focus();
    harness.run();
    harness.get_by_label("Size value").type_text("0.x");
    harness.get_by_label("Level 5: 1,814 triangles").hover();
    harness.run_steps(60);
    harness.render().unwrap().save(format!("{path}1.png")).unwrap();
    let mut harness = harness_for(State::default(), shown, 11, 1.0, true);
    harness.get_by_role_and_label(Role::Slider, "Strength").focus();
    harness.get_by_label("Eraser").hover();
    harness.run_steps(60);
    harness.render().unwrap().save(format!("{path}2.png")).unwrap();
    let mut harness = harness_for(State::default(), shown, 11, 1.0, true);
    harness.get_by_role_and_label(Role::Button, "Levels").click();
    harness.get_by_label("RefinementRule").click();
    harness.run();
    harness.get_by_label("Field").focus();
    let handle = harness.get_by_role_and_label(Role::Slider, "Curve shape").rect().center();
    harness.hover_at(handle + vec2(40.0, 0.0));
    harness.run_steps(60);
    harness.render().unwrap().save(format!("{path}3.png")).unwrap();
}

/// Saves the gallery into the folder named by the environment variable `GALLERY`, for people who work on its
/// looks.
#[test]
fn pictures() {
    let Ok(folder) = std::env::var("GALLERY") else {
        return;
    };
    for (name, shown) in [("dark", Theme::Dark), ("light", Theme::Light)] {
        states(&format!("{folder}/{name}-states"), shown);
        for scale in [1.0, 2.0] {
            let mut harness = harness_for(State::default(), shown, 11, scale, true);
            harness.render().unwrap().save(format!("{folder}/{name}{scale}.png")).unwrap();
        }
        let mut harness = harness_for(State::default(), shown, 54, 1.0, true);
        harness.state_mut().palette = true;
        harness.run();
        harness.event(egui::Event::Text("sa".into()));
        harness.run();
        harness.render().unwrap().save(format!("{folder}/{name}-palette.png")).unwrap();
        let mut harness = harness_for(State::default(), shown, 11, 1.0, true);
        harness.state_mut().asking = true;
        harness.run();
        harness.render().unwrap().save(format!("{folder}/{name}-confirm.png")).unwrap();
    }
}

/// Returns the value of a row or field, found by its name.
fn value_of(harness: &Harness<'_, State>, role: Role, name: &str) -> String {
    harness.get_by_role_and_label(role, name).value().unwrap_or_default()
}

fn type_into(harness: &mut Harness<'_, State>, name: &str, text: &str) {
    harness.get_by_role_and_label(Role::TextInput, name).focus();
    harness.run();
    harness.get_by_role_and_label(Role::TextInput, name).type_text(text);
    harness.run();
    harness.key_press(egui::Key::Enter);
    harness.run();
}

#[test]
fn a_slider_takes_a_value_that_tests_and_screen_readers_set() {
    let mut harness = harness(State::default());
    harness.get_by_role_and_label(Role::Slider, "Strength").set_value_accesskit(0.25);
    harness.run();
    assert_eq!(harness.state().strength, 0.25);
    assert_eq!(value_of(&harness, Role::TextInput, "Strength value"), "0.25");
    harness.get_by_role_and_label(Role::Slider, "Strength").set_value_accesskit(7.0);
    harness.run();
    assert_eq!(harness.state().strength, 1.0, "a value outside the range is taken as its end");
}

#[test]
fn a_focused_slider_follows_the_arrow_keys() {
    let mut harness = harness(State::default());
    harness.get_by_role_and_label(Role::Slider, "Strength").focus();
    harness.run();
    harness.key_press(egui::Key::ArrowLeft);
    harness.run();
    assert_eq!(harness.state().strength, 0.79);
    harness.key_press_modifiers(egui::Modifiers::SHIFT, egui::Key::ArrowLeft);
    harness.run();
    assert_eq!(harness.state().strength, 0.69);
    harness.key_press(egui::Key::Home);
    harness.run();
    assert_eq!(harness.state().strength, 0.0);
    assert!(harness.get_by_role_and_label(Role::Slider, "Strength").is_focused());
}

#[test]
fn a_stepped_slider_moves_by_whole_steps() {
    let mut harness = harness(State::default());
    harness.get_by_role_and_label(Role::Slider, "Level cap").focus();
    harness.run();
    harness.key_press(egui::Key::ArrowRight);
    harness.run();
    assert_eq!(harness.state().levels, 11.0);
}

#[test]
fn a_slider_is_dragged_and_tells_when_it_was_let_go() {
    let mut harness = harness(State::default());
    let track = harness.get_by_role_and_label(Role::Slider, "Size").rect();
    harness.drag_at(track.center());
    harness.run();
    assert_eq!(harness.state().size, 0.0316, "the middle of a logarithmic track, with three digits");
    assert_eq!(harness.state().done, 0);
    harness.hover_at(track.right_center() + vec2(90.0, 0.0));
    harness.run();
    assert_eq!(harness.state().size, 1.0);
    harness.drop_at(track.right_center() + vec2(90.0, 0.0));
    harness.run();
    assert_eq!(harness.state().done, 1);
}

#[test]
fn a_number_is_typed() {
    let mut harness = harness(State::default());
    type_into(&mut harness, "Size value", "0.1234567");
    assert_eq!(harness.state().size, 0.1234567, "what is typed is kept exactly");
    assert_eq!(value_of(&harness, Role::TextInput, "Size value"), "0.123");
    assert_eq!(harness.state().done, 1);
    type_into(&mut harness, "Coarse spacing", "0.25 km");
    assert_eq!(harness.state().spacing, 0.25);
    type_into(&mut harness, "Budget", "1,500,000");
    assert_eq!(harness.state().limit, 1_500_000.0);
}

#[test]
fn wrong_numbers_and_escape_change_nothing() {
    let mut harness = harness(State::default());
    type_into(&mut harness, "Size value", "much");
    assert_eq!(harness.state().size, 0.064);
    harness.get_by_label("Size value").focus();
    harness.run();
    harness.get_by_label("Size value").type_text("0.5");
    harness.run();
    harness.key_press(egui::Key::Escape);
    harness.run();
    assert_eq!(harness.state().size, 0.064);
    assert_eq!(value_of(&harness, Role::TextInput, "Size value"), "0.0640");
}

#[test]
fn a_click_elsewhere_keeps_what_was_typed() {
    let mut harness = harness(State::default());
    harness.get_by_label("Size value").click();
    harness.run();
    harness.get_by_label("Size value").type_text("0.5");
    harness.run();
    harness.get_by_label("Show edges").click();
    harness.run();
    assert_eq!(harness.state().size, 0.5);
}

#[test]
fn a_disabled_slider_stays_as_it_is() {
    let mut harness = harness(State::default());
    let track = harness.get_by_role_and_label(Role::Slider, "Hardness").rect();
    harness.drag_at(track.center());
    harness.run();
    harness.get_by_label("Hardness value").click();
    harness.run();
    assert_eq!(value_of(&harness, Role::TextInput, "Hardness value"), "0.35");
}

#[test]
fn a_segment_is_chosen_by_pointer_and_by_key() {
    let mut harness = harness(State::default());
    harness.get_by_role_and_label(Role::RadioButton, "Diameter").click();
    harness.run();
    assert_eq!(harness.state().mode, 1);
    harness.get_by_role_and_label(Role::RadioButton, "Diameter").focus();
    harness.run();
    harness.key_press(egui::Key::ArrowLeft);
    harness.run();
    assert_eq!(harness.state().mode, 0);
    assert!(harness.get_by_role_and_label(Role::RadioButton, "Risk").is_focused());
}

#[test]
fn the_legend_returns_the_level_under_the_pointer() {
    let mut harness = harness(State::default());
    harness.get_by_label("Level 9: 8,900 triangles").hover();
    harness.run();
    assert_eq!(harness.state().hovered_level, Some(9));
}

#[test]
fn chips_tools_and_cancel_answer_clicks() {
    let mut harness = harness(State::default());
    for name in ["Go to neighbour 2", "Eraser"] {
        harness.get_by_label(name).click();
        harness.run();
    }
    let cancel = harness.get_all_by_label("Cancel").next().unwrap().rect().center();
    harness.drag_at(cancel);
    harness.drop_at(cancel);
    harness.run();
    assert_eq!(harness.state().clicks, ["neighbour 2", "Eraser", "cancel"]);
}

#[test]
fn bytes_are_told_as_a_share_where_it_is_known_how_many_there_are() {
    let mut harness = Harness::builder().with_size(vec2(360.0, 100.0)).build_ui(|ui| {
        theme::install(ui.ctx());
        bytes_row(ui, "Reading coast.geojson", 125_000_000, Some(250_000_000));
        bytes_row(ui, "Writing mesh.obj", 1_234_567, None);
    });
    harness.run();
    let share = |what| {
        let bar = harness.get_by_role_and_label(Role::ProgressIndicator, what);
        bar.accesskit_node().numeric_value()
    };
    assert_eq!(share("Reading coast.geojson"), Some(0.5));
    assert_eq!(share("Writing mesh.obj"), None, "there is no bar then");
    let texts: Vec<String> = painted_texts(harness.output()).into_iter().map(|(text, _)| text).collect();
    for text in ["Reading coast.geojson", " 50 %", "Writing mesh.obj", "1.2 MB"] {
        assert!(texts.iter().any(|painted| painted.ends_with(text)), "{text} of {texts:?}");
    }
    for name in ["Cancel: Reading coast.geojson", "Cancel: Writing mesh.obj"] {
        harness.get_by_role_and_label(Role::Button, name);
    }
}

#[test]
fn a_chip_is_reached_by_keyboard() {
    let mut harness = harness(State::default());
    harness.get_by_label("Go to neighbour 1").focus();
    harness.run();
    harness.key_press(egui::Key::Enter);
    harness.run();
    assert_eq!(harness.state().clicks, ["neighbour 1"]);
}

#[test]
fn rows_tell_their_values() {
    let harness = harness(State::default());
    assert_eq!(value_of(&harness, Role::Definition, "Risk true"), "0.7298 (+0.0016)");
    assert_eq!(value_of(&harness, Role::Definition, "triangles"), "37,987");
}

#[test]
fn a_section_folds_away() {
    let mut harness = harness(State::default());
    harness.get_by_role_and_label(Role::Button, "Levels").click();
    harness.run();
    assert!(harness.query_by_label("Level 9: 8,900 triangles").is_none());
    harness.get_by_role_and_label(Role::Button, "Levels").click();
    harness.run();
    assert!(harness.query_by_label("Level 9: 8,900 triangles").is_some());
}

#[test]
fn the_transfer_curve_is_edited_by_its_handles() {
    let mut harness = harness(State::default());
    let drag = |harness: &mut Harness<'_, State>, name: &str, by: f32| {
        let handle = harness.get_by_role_and_label(Role::Slider, name).rect().center();
        harness.drag_at(handle);
        harness.run();
        harness.hover_at(handle + vec2(0.0, by));
        harness.run();
        harness.drop_at(handle + vec2(0.0, by));
        harness.run();
    };
    let before = harness.state().transfer;
    let thumb = theme::tokens_of(&harness.ctx).thumb;
    let thumbs = |harness: &Harness<'_, State>| painted_radii(harness.output(), thumb);
    let at_rest = thumbs(&harness);
    let h_max = harness.get_by_role_and_label(Role::Slider, "h_max").rect().center();
    harness.hover_at(h_max);
    harness.run();
    assert_eq!(thumbs(&harness), at_rest + 1.0, "a handle grows under the pointer");
    drag(&mut harness, "h_max", -10.0);
    assert!(harness.state().transfer.h_max > before.h_max);
    drag(&mut harness, "Curve shape", -10.0);
    assert!(harness.state().transfer.shape > before.shape, "a larger shape lifts this curve");
    drag(&mut harness, "h_risk", -900.0);
    let after = harness.state().transfer;
    assert_eq!(after.h_risk, after.h_max, "h_risk stops at h_max");
    let done = harness.state().curve_done;
    harness.get_by_role_and_label(Role::Slider, "h_max").focus();
    harness.run();
    harness.key_press(egui::Key::ArrowUp);
    harness.run();
    assert!(harness.state().transfer.h_max > after.h_max);
    assert_eq!(harness.state().curve_done, done + 1, "a key is an edit of its own");
}

/// A slow frame brings several events at once.
#[test]
fn a_handle_of_the_transfer_curve_follows_a_drag_within_one_frame() {
    for in_first_frame in [1, 2, 3] {
        let mut harness = harness(State::default());
        let before = harness.state().transfer.h_max;
        let handle = harness.get_by_role_and_label(Role::Slider, "h_max").rect().center();
        harness.hover_at(handle);
        harness.run();
        let away = handle + vec2(0.0, 30.0);
        let button = |pos, pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        let events = [button(handle, true), Event::PointerMoved(away), button(away, false)];
        let (first, second) = events.split_at(in_first_frame);
        for events in [first, second] {
            harness.input_mut().events.extend(events.iter().cloned());
            harness.step();
        }
        harness.run();
        assert!(harness.state().transfer.h_max < before, "{in_first_frame} events in the first frame");
    }
}

#[test]
fn the_numbers_of_the_transfer_curve_are_never_cut() {
    let mut harness = harness(State::default());
    harness.state_mut().transfer = CurveValues { h_max: 249_000.0, h_risk: 12_300.0, shape: 1.0 };
    harness.run();
    for (name, number) in [("h_max value", "249,000"), ("h_risk value", "12,300")] {
        assert_eq!(value_of(&harness, Role::TextInput, name), number);
        let field = harness.get_by_role_and_label(Role::TextInput, name).rect();
        assert!(field.width() >= 80.0, "{name} has {} points", field.width());
    }
}

#[test]
fn the_transfer_curve_is_edited_by_number_and_key() {
    let mut harness = harness(State::default());
    type_into(&mut harness, "h_risk value", "0.01");
    assert_eq!(harness.state().transfer.h_risk, 0.01);
    harness.get_by_role_and_label(Role::Slider, "h_max").focus();
    harness.run();
    harness.key_press(egui::Key::ArrowUp);
    harness.run();
    assert_eq!(harness.state().transfer.h_max, 0.21);
}

#[test]
fn text_dropdown_and_toggle_change_their_values() {
    let mut harness = harness(State::default());
    type_into(&mut harness, "Name", " 2");
    assert_eq!(harness.state().name, "radar threats 2");
    harness.get_by_role_and_label(Role::CheckBox, "Show edges").click();
    harness.run();
    assert!(!harness.state().edges);
    harness.get_by_role_and_label(Role::ComboBox, "RefinementRule").click();
    harness.run();
    harness.get_by_label("Vertex rule").click();
    harness.run();
    assert_eq!(harness.state().rule, 1);
}

#[test]
fn a_banner_is_dismissed_or_acted_on() {
    let mut harness = harness(State::default());
    harness.get_by_label("Raise the budget").click();
    harness.run();
    let first = harness.get_all_by_label("Dismiss").next().unwrap().rect().center();
    harness.drag_at(first);
    harness.drop_at(first);
    harness.run();
    assert_eq!(harness.state().clicks, ["Acted", "Dismissed"]);
}

fn opened_palette() -> Harness<'static, State> {
    let mut harness = harness(State::default());
    harness.state_mut().palette = true;
    harness.run();
    harness
}

#[test]
fn the_palette_narrows_and_enter_chooses() {
    let mut harness = opened_palette();
    harness.get_by_label("Command").type_text("exp");
    harness.run();
    assert!(harness.query_by_role_and_label(Role::MenuItem, "Undo").is_none());
    harness.key_press(egui::Key::Enter);
    harness.run();
    assert_eq!(harness.state().chosen, Some(5));
    assert!(!harness.state().palette);
}

#[test]
fn the_palette_follows_arrows_and_the_pointer() {
    let mut harness = opened_palette();
    harness.key_press(egui::Key::ArrowDown);
    harness.key_press(egui::Key::ArrowDown);
    harness.run();
    harness.key_press(egui::Key::Enter);
    harness.run();
    assert_eq!(harness.state().chosen, Some(2));
    harness.state_mut().palette = true;
    harness.run();
    harness.get_by_role_and_label(Role::MenuItem, "Fit view").click();
    harness.run();
    assert_eq!(harness.state().chosen, Some(4));
}

#[test]
fn the_palette_keeps_what_is_disabled_and_closes_by_escape() {
    let mut harness = opened_palette();
    harness.get_by_label("Command").type_text("redo");
    harness.run();
    harness.key_press(egui::Key::Enter);
    harness.run();
    assert_eq!(harness.state().chosen, None);
    assert!(harness.state().palette);
    harness.key_press(egui::Key::Escape);
    harness.run();
    assert!(!harness.state().palette);
}

fn asked() -> Harness<'static, State> {
    let mut harness = harness(State { asking: true, ..State::default() });
    harness.run();
    harness
}

#[test]
fn a_question_is_answered_by_button_enter_or_escape() {
    let mut harness = asked();
    harness.get_all_by_label("Discard").last().unwrap().click();
    harness.run();
    assert_eq!(harness.state().answer, Some(ConfirmAnswer::Confirmed));
    let mut harness = asked();
    harness.get_by_label("Save…").click();
    harness.run();
    assert_eq!(harness.state().answer, Some(ConfirmAnswer::Alternative));
    for key in [egui::Key::Enter, egui::Key::Escape] {
        let mut harness = asked();
        harness.key_press(key);
        harness.run();
        assert_eq!(
            harness.state().answer,
            Some(ConfirmAnswer::Cancelled),
            "a danger is not what Enter takes"
        );
    }
}
