//! The window driven as a person drives it, by role and label, without a display. Most tests need no graphics driver.
#![cfg(feature = "gui")]

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::App as _;
use eframe::egui::{self, Event, Key, Modifiers, PointerButton, Pos2, Rect, Vec2, pos2, vec2};
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::{DVec2, dvec2};
use meshbrush::app::command::{Command, DomainCommand};
use meshbrush::app::tools::{PaintKind, Tool};
use meshbrush::app::view::FieldOverlay;
use meshbrush::app::{App, CANVAS_NAME};
use meshbrush::colormap::Ground;
use meshbrush::document::{Base, Document, Example, Follower, Setting, Settings, Stage};
use meshbrush::domain::{CutShape, Domain, DomainShape};
use meshbrush::field::{Formula, RefinementRule};
use meshbrush::mesh::{Fingerprint, Location, TriangleId};

type Window = Harness<'static, App>;

/// Room for every section of the side panel at once, so that nothing must be scrolled to.
const TALL: Vec2 = vec2(1440.0, 1900.0);
/// Off the canvas, over nothing.
const RESTING_PLACE: Pos2 = pos2(600.0, 10.0);
/// In the first example: free of paint, and far from it.
const FREE: DVec2 = dvec2(0.9, 0.5);
const CTRL_SHIFT: Modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };

fn window() -> Window {
    window_of(vec2(1440.0, 900.0))
}

fn window_of(size: Vec2) -> Window {
    let mut window = Harness::builder()
        .with_size(size)
        .with_max_steps(4000)
        .build_eframe(|cc| App::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref()).unwrap());
    window.run();
    window
}

/// A window whose canvas is drawn, on the software driver. Slower: only for what is judged by its picture.
fn drawn_window() -> Window {
    let mut setup = egui_kittest::wgpu::default_wgpu_setup();
    if let eframe::egui_wgpu::WgpuSetup::CreateNew(create) = &mut setup {
        create.device_descriptor = Arc::new(meshbrush::render::gpu::device_descriptor);
    }
    let mut window = Harness::builder()
        .with_size(vec2(1100.0, 700.0))
        .with_max_steps(4000)
        .with_render_cursor(false)
        .wgpu_setup(setup)
        .build_eframe(|cc| App::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref()).unwrap());
    window.run();
    window
}

fn send(window: &mut Window, command: Command) {
    window.state_mut().send(command);
    window.run();
}

fn set(window: &mut Window, setting: Setting) {
    window.state_mut().send(Command::Set(setting));
    send(window, Command::EndGesture);
}

fn canvas(window: &Window) -> Rect {
    window.get_by_role_and_label(Role::Image, CANVAS_NAME).rect()
}

/// Where a point of the world is on the screen.
fn on_screen(window: &Window, world: DVec2) -> Pos2 {
    let px = window.state().view().camera.unwrap().screen_from_world(world);
    canvas(window).min + vec2(px.x as f32, px.y as f32)
}

/// What point of the world is at a place on the screen.
fn in_world(window: &Window, at: Pos2) -> DVec2 {
    let px = at - canvas(window).min;
    window.state().view().camera.unwrap().world_from_screen(dvec2(px.x.into(), px.y.into()))
}

fn button_event(pos: Pos2, button: PointerButton, pressed: bool, modifiers: Modifiers) -> Event {
    Event::PointerButton { pos, button, pressed, modifiers }
}

fn press(window: &mut Window, world: DVec2, modifiers: Modifiers) {
    let pos = on_screen(window, world);
    press_at(window, pos, PointerButton::Primary, modifiers);
}

fn press_at(window: &mut Window, pos: Pos2, button: PointerButton, modifiers: Modifiers) {
    window.event(Event::ModifiersChanged(modifiers));
    window.event(Event::PointerMoved(pos));
    window.event(button_event(pos, button, true, modifiers));
    window.run();
}

fn move_to(window: &mut Window, world: DVec2) {
    let pos = on_screen(window, world);
    window.event(Event::PointerMoved(pos));
    window.run();
}

fn release(window: &mut Window, world: DVec2) {
    let pos = on_screen(window, world);
    release_at(window, pos, PointerButton::Primary);
}

fn release_at(window: &mut Window, pos: Pos2, button: PointerButton) {
    window.event(button_event(pos, button, false, Modifiers::NONE));
    window.event(Event::ModifiersChanged(Modifiers::NONE));
    window.run();
}

fn click(window: &mut Window, world: DVec2, modifiers: Modifiers) {
    press(window, world, modifiers);
    release(window, world);
}

fn stroke(window: &mut Window, from: DVec2, to: DVec2) {
    press(window, from, Modifiers::NONE);
    for i in 1..=5 {
        move_to(window, from.lerp(to, f64::from(i) / 5.0));
    }
    release(window, to);
}

fn key(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run();
}

/// A press of Tab as the window passes it on: before egui moves the focus by it.
fn press_tab(window: &mut Window) {
    let tab = Event::Key {
        key: Key::Tab,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    let mut raw = egui::RawInput { events: vec![tab], ..Default::default() };
    let ctx = window.ctx.clone();
    window.state_mut().raw_input_hook(&ctx, &mut raw);
    for event in raw.events {
        window.event(event);
    }
    window.run();
}

fn triangles(window: &Window) -> usize {
    window.state().session().mesh().triangles().len()
}

fn fingerprint(window: &Window) -> Fingerprint {
    window.state().session().mesh().fingerprint()
}

fn settings(window: &Window) -> &Settings {
    window.state().session().document().settings()
}

fn entries(window: &Window) -> usize {
    window.state().session().document().history().len()
}

fn notice(window: &Window) -> String {
    window.state().session().notice().map_or(String::new(), |notice| notice.text.clone())
}

/// The level of the triangle round a point.
fn level_at(window: &Window, world: DVec2) -> u32 {
    let mesh = window.state().session().mesh();
    mesh.triangle(mesh.locate(world).triangle().expect("a point of the domain")).level()
}

fn selected(window: &Window) -> Option<TriangleId> {
    let readout = window.state().session().readout(window.state().view().quantity)?;
    readout.location.triangle()
}

fn open_section(window: &mut Window, title: &str) {
    let named = window.get_all_by_role_and_label(Role::Button, title);
    let header = named.max_by(|a, b| a.rect().left().total_cmp(&b.rect().left())).unwrap();
    if header.accesskit_node().data().is_expanded() != Some(true) {
        header.click();
        window.run();
    }
}

fn type_into(window: &mut Window, name: &str, text: &str) {
    window.get_by_role_and_label(Role::TextInput, name).focus();
    window.run();
    key(window, Modifiers::COMMAND, Key::A);
    window.get_by_role_and_label(Role::TextInput, name).type_text(text);
    window.run();
    key(window, Modifiers::NONE, Key::Enter);
}

fn choose(window: &mut Window, menu: &str, entry: &str) {
    open_menu(window, menu);
    window.get_by_role_and_label(Role::Button, entry).click();
    window.run();
}

/// Opens a menu of the bar; sections of the panel may have the same name.
fn open_menu(window: &mut Window, menu: &str) {
    let named = window.get_all_by_role_and_label(Role::Button, menu);
    named.min_by(|a, b| a.rect().top().total_cmp(&b.rect().top())).unwrap().click();
    window.run();
}

fn value_of(window: &Window, role: Role, name: &str) -> String {
    window.get_by_role_and_label(role, name).value().unwrap_or_default()
}

// ---------------------------------------------------------------------------------------------------- painting

#[test]
fn the_mesh_refines_under_the_brush_while_the_button_is_still_down() {
    let mut window = window();
    let (before, level) = (triangles(&window), level_at(&window, FREE));
    press(&mut window, FREE, Modifiers::NONE);
    let at_press = triangles(&window);
    assert!(at_press > before + 200, "{before} triangles before, {at_press} with the brush down");
    assert!(level_at(&window, FREE) >= level + 6);
    move_to(&mut window, FREE - dvec2(0.1, 0.0));
    let after_move = triangles(&window);
    assert!(after_move > at_press + 200, "{at_press} at first, {after_move} after a move");
    assert!(window.state().session().document().stroke().is_some(), "the brush is still down");
    release(&mut window, FREE - dvec2(0.1, 0.0));
    assert_eq!(triangles(&window), after_move, "lifting the brush changes nothing");
}

#[test]
fn the_eraser_coarsens_back() {
    let mut window = window();
    let before = fingerprint(&window);
    stroke(&mut window, FREE, FREE);
    assert_ne!(fingerprint(&window), before);
    key(&mut window, Modifiers::NONE, Key::E);
    window.state_mut().send(Command::BrushHardness(1.0));
    send(&mut window, Command::BrushRadius(0.09));
    stroke(&mut window, FREE, FREE);
    assert_eq!(fingerprint(&window), before, "all of the paint is gone, and so is all that it refined");
}

#[test]
fn a_stroke_is_one_entry_and_undo_and_redo_restore_the_very_mesh() {
    let mut window = window();
    let before = fingerprint(&window);
    stroke(&mut window, FREE, FREE - dvec2(0.15, 0.05));
    let once = fingerprint(&window);
    assert_eq!(entries(&window), 1);
    stroke(&mut window, dvec2(0.05, 0.05), dvec2(0.3, 0.05));
    let twice = fingerprint(&window);
    assert_eq!(entries(&window), 2);
    for (modifiers, expected) in [
        (Modifiers::COMMAND, once),
        (Modifiers::COMMAND, before),
        (CTRL_SHIFT, once),
        (CTRL_SHIFT, twice),
        (Modifiers::COMMAND, once),
    ] {
        key(&mut window, modifiers, Key::Z);
        assert_eq!(fingerprint(&window), expected);
    }
}

#[test]
fn a_painted_diameter_is_the_diameter_of_the_mesh() {
    let mut window = window();
    key(&mut window, Modifiers::NONE, Key::T);
    assert_eq!(window.state().tools().kind, PaintKind::Diameter);
    send(&mut window, Command::BrushDiameter(0.02));
    stroke(&mut window, FREE, FREE);
    let mesh = window.state().session().mesh();
    let diameter = mesh.diameter(level_at(&window, FREE));
    assert!(diameter <= 0.02 && diameter > 0.02 / 1.5, "{diameter}");
}

#[test]
fn escape_gives_the_stroke_up() {
    let mut window = window();
    let before = fingerprint(&window);
    press(&mut window, FREE, Modifiers::NONE);
    assert_ne!(fingerprint(&window), before);
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert_eq!(fingerprint(&window), before);
    move_to(&mut window, FREE - dvec2(0.1, 0.1));
    release(&mut window, FREE - dvec2(0.1, 0.1));
    assert_eq!((fingerprint(&window), entries(&window)), (before, 0));
}

#[test]
fn a_button_that_was_let_go_unseen_does_not_paint_on() {
    let mut window = window();
    press(&mut window, FREE, Modifiers::NONE);
    window.event(Event::PointerGone);
    window.event(Event::WindowFocused(false));
    window.run();
    window.event(Event::WindowFocused(true));
    window.run();
    let painted = fingerprint(&window);
    move_to(&mut window, FREE - dvec2(0.2, 0.2));
    assert_eq!(fingerprint(&window), painted);
    assert_eq!(entries(&window), 1, "the stroke ended where it was last seen");
}

#[test]
fn a_hundred_idle_frames_do_nothing() {
    let mut window = window();
    window.event(Event::PointerMoved(on_screen(&window, FREE)));
    window.run();
    let generation = window.state().session().follower().revision();
    let revision = window.state().session().document().revision();
    for frame in 0..100 {
        window.step();
        let delay = window.output().viewport_output[&egui::ViewportId::ROOT].repaint_delay;
        assert_eq!(delay, Duration::MAX, "frame {frame} asks for another");
    }
    assert_eq!(entries(&window), 0);
    assert_eq!(window.state().session().follower().revision(), generation);
    assert_eq!(window.state().session().document().revision(), revision);
}

// ------------------------------------------------------------------------------------------------------- query

#[test]
fn a_click_shows_the_triangle_and_each_chip_goes_to_its_neighbour() {
    let mut window = window_of(TALL);
    assert!(window.query_by_label_contains("Nothing asked yet").is_some());
    key(&mut window, Modifiers::NONE, Key::Q);
    click(&mut window, dvec2(0.71, 0.735), Modifiers::NONE);
    let mesh = window.state().session().mesh();
    let expected = mesh.locate(dvec2(0.71, 0.735)).triangle().unwrap();
    let start = selected(&window).expect("a triangle under the pointer");
    assert_eq!(start, expected);
    let level = mesh.triangle(start).level();
    let shown = value_of(&window, Role::Definition, "Level · orientation");
    assert!(shown.starts_with(&format!("{level} · ")), "{shown}");
    assert_eq!(entries(&window), 0, "a question is no edit");

    for (i, name) in ["Bisection neighbour", "Second neighbour", "Third neighbour"].iter().enumerate() {
        send(&mut window, Command::QueryTriangle(start));
        let there = window.state().session().mesh().triangle(start).neighbours[i].triangle().unwrap();
        window.get_by_role_and_label(Role::Button, name).click();
        window.run();
        assert_eq!(selected(&window), Some(there), "{name}");
    }
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert_eq!(selected(&window), None, "Escape lets go");
    assert!(window.query_by_label_contains("Nothing asked yet").is_some());
}

#[test]
fn the_inspector_counts_as_files_do() {
    let mut window = window_of(TALL);
    send(&mut window, Command::OpenExample(Example::Aegean));
    send(&mut window, Command::Use(Tool::Query));
    send(&mut window, Command::Query(dvec2(25.25, 38.1)));
    window.run();
    let mesh = window.state().session().mesh();
    let (id, extract) = (selected(&window).expect("a triangle of the sea"), mesh.extract());
    let place = extract.place_of(id).unwrap();
    assert_ne!(place, id, "triangles on land come before it");
    let shown = |number: usize| meshbrush::app::widgets::format::count(number as u64);
    let title = format!("Triangle {}", shown(place.index()));
    window.get_by_role_and_label(Role::Button, &title);
    for (i, (node, subscript)) in
        extract.triangles()[place.index()].vertices.iter().zip(["₁", "₂", "₃"]).enumerate()
    {
        let row = value_of(&window, Role::Definition, &format!("v{subscript} · {}", shown(node.index())));
        let corner = mesh.world_corners(id)[i];
        assert!(row.starts_with(&format!("{:.2}", corner.x)), "{row} at {corner}");
    }
    let across = mesh.neighbours_in_domain(id).map(|n| n.triangle().unwrap());
    let chips = across.map(|id| shown(extract.place_of(id).unwrap().index()));
    for (name, number) in ["Bisection neighbour", "Second neighbour", "Third neighbour"].iter().zip(chips) {
        assert_eq!(value_of(&window, Role::Button, name), number, "{name}");
    }
}

#[test]
fn a_click_outside_the_domain_says_so() {
    let mut window = window();
    key(&mut window, Modifiers::NONE, Key::Q);
    click(&mut window, dvec2(-0.1, 0.5), Modifiers::NONE);
    let readout = window.state().session().readout(window.state().view().quantity).unwrap();
    assert_eq!(readout.triangle, None);
    assert_eq!(readout.location, Location::OutsideBounds);
    assert!(window.query_by_label_contains("No triangle here").is_some());
}

#[test]
fn a_chip_at_the_edge_of_the_domain_goes_nowhere() {
    let mut window = window_of(TALL);
    let mesh = window.state().session().mesh();
    let id = mesh.locate(dvec2(0.02, 0.99)).triangle().unwrap();
    let missing = mesh.triangle(id).neighbours.iter().position(|n| n.triangle().is_none()).unwrap();
    send(&mut window, Command::QueryTriangle(id));
    let name = ["Bisection neighbour", "Second neighbour", "Third neighbour"][missing];
    let chip = window.get_by_role_and_label(Role::Button, name);

    assert!(chip.accesskit_node().is_disabled());
    chip.click();
    window.run();
    assert_eq!(selected(&window), Some(id));
}

// ------------------------------------------------------------------------------------------------------- view

fn wheel(window: &mut Window, at: Pos2, delta: f32) {
    window.event(Event::PointerMoved(at));
    window.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: vec2(0.0, delta),
        modifiers: Modifiers::NONE,
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
    });
    window.run();
}

#[test]
fn the_wheel_zooms_at_the_pointer() {
    let mut window = window();
    let at = on_screen(&window, dvec2(0.3, 0.7));
    for delta in [50.0, 50.0, -150.0] {
        let (before, scale) = (in_world(&window, at), window.state().view().camera.unwrap().px_per_world());
        wheel(&mut window, at, delta);
        let now = window.state().view().camera.unwrap().px_per_world();
        assert!(if delta > 0.0 { now > 1.1 * scale } else { now < 0.9 * scale }, "{scale} to {now}");
        let moved = in_world(&window, at).distance(before) * now;
        assert!(moved < 1e-3, "the point under the pointer moved by {moved} pixels");
    }
}

#[test]
fn the_wheel_over_the_panel_does_not_zoom() {
    let mut window = window();
    let camera = window.state().view().camera;
    wheel(&mut window, pos2(1300.0, 400.0), -80.0);
    assert_eq!(window.state().view().camera, camera);
}

#[test]
fn space_and_middle_drag_pan_and_home_fits() {
    let mut window = window();
    let fitted = window.state().view().camera;
    let (from, to) = (canvas(&window).center(), canvas(&window).center() + vec2(120.0, -60.0));
    let mut held = in_world(&window, from);
    window.key_down(Key::Space);
    press_at(&mut window, from, PointerButton::Primary, Modifiers::NONE);
    window.event(Event::PointerMoved(to));
    window.run();
    release_at(&mut window, to, PointerButton::Primary);
    window.key_up(Key::Space);
    window.run();
    assert!(in_world(&window, to).distance(held) < 1e-9, "the held point follows the pointer");
    assert_eq!(entries(&window), 0, "nothing was painted");

    held = in_world(&window, from);
    press_at(&mut window, from, PointerButton::Middle, Modifiers::NONE);
    window.event(Event::PointerMoved(to));
    window.run();
    release_at(&mut window, to, PointerButton::Middle);
    assert!(in_world(&window, to).distance(held) < 1e-9);
    assert_eq!(entries(&window), 0);

    key(&mut window, Modifiers::NONE, Key::H);
    held = in_world(&window, from);
    press_at(&mut window, from, PointerButton::Primary, Modifiers::NONE);
    window.event(Event::PointerMoved(to));
    window.run();
    release_at(&mut window, to, PointerButton::Primary);
    assert!(in_world(&window, to).distance(held) < 1e-9, "the pan tool pans");

    key(&mut window, Modifiers::NONE, Key::Home);
    assert_eq!(window.state().view().camera, fitted);
}

#[test]
fn the_hint_covers_nothing_of_a_fitted_domain() {
    for size in [vec2(900.0, 600.0), vec2(1440.0, 900.0)] {
        let window = window_of(size);
        let hint = window.get_by_label_contains("Drag to paint risk").rect();
        let rim = on_screen(&window, dvec2(0.5, 0.0));
        assert!(rim.y < hint.top() && hint.bottom() < canvas(&window).bottom(), "{rim} behind {hint}");
    }
}

#[test]
fn tab_hides_the_panels_and_brings_them_back() {
    let mut window = window();
    let narrow = canvas(&window);
    press_tab(&mut window);
    assert!(!window.state().view().panels);
    assert!(canvas(&window).width() > narrow.width() + 300.0);
    assert!(window.query_by_label("Levels").is_none());
    press_tab(&mut window);
    assert_eq!(canvas(&window), narrow);
}

#[test]
fn a_hovered_level_is_shown_alone_and_hiding_the_panels_ends_that() {
    let mut window = window();
    let legend = |window: &Window, level: u32| {
        let count = window.state().session().level_counts()[level as usize];
        let count = meshbrush::app::widgets::format::count(count as u64);
        window.get_by_label(&format!("Level {level}: {count} triangles")).rect().center()
    };
    let style = |window: &Window| window.state().view().style(settings(window), 1.0).shown_levels;
    assert_eq!(style(&window), u64::MAX);
    for level in [4, 7] {
        window.hover_at(legend(&window, level));
        window.run();
        assert_eq!(style(&window), 1 << level);
    }
    press_tab(&mut window);
    assert_eq!(style(&window), u64::MAX, "no legend, no lone level");
    press_tab(&mut window);
    window.hover_at(RESTING_PLACE);
    window.run();
    assert_eq!(style(&window), u64::MAX);
}

#[test]
fn the_theme_switches_by_menu_and_by_panel() {
    let mut window = window_of(TALL);
    assert_eq!(window.state().view().ground, Ground::Dark);
    choose(&mut window, "View", "Light theme");
    assert_eq!(window.state().view().ground, Ground::Light);
    open_section(&mut window, "View");
    window.get_by_role_and_label(Role::RadioButton, "Dark").click();
    window.run();
    assert_eq!(window.state().view().ground, Ground::Dark);
}

// ------------------------------------------------------------------------------------------- tools and their keys

#[test]
fn letters_take_tools_in_hand() {
    let mut window = window();
    for (letter, tool) in [
        (Key::E, Tool::Eraser),
        (Key::Q, Tool::Query),
        (Key::H, Tool::Pan),
        (Key::D, Tool::Domain),
        (Key::B, Tool::Brush),
    ] {
        key(&mut window, Modifiers::NONE, letter);
        assert_eq!(window.state().tools().tool, tool);
    }
    for (name, tool) in [("Eraser", Tool::Eraser), ("Query", Tool::Query), ("Brush", Tool::Brush)] {
        let buttons = window.get_all_by_role_and_label(Role::Button, name);
        let leftmost = buttons.min_by(|a, b| a.rect().left().total_cmp(&b.rect().left())).unwrap();
        leftmost.click();
        window.run();
        assert_eq!(window.state().tools().tool, tool);
    }
}

#[test]
fn a_tool_taken_in_hand_brings_its_section_into_view() {
    let mut window = window_of(vec2(900.0, 600.0));
    let panel = canvas(&window).right_center() + vec2(100.0, 0.0);
    wheel(&mut window, panel, -2000.0);
    let top = canvas(&window).top();
    let section = |window: &Window, name: &str| window.get_by_role_and_label(Role::Button, name).rect().top();
    assert!(section(&window, "Risk to diameter") < top, "scrolled away");
    key(&mut window, Modifiers::NONE, Key::Q);
    assert!(section(&window, "Triangle") >= top);
}

#[test]
fn brackets_and_digits_set_the_brush() {
    let mut window = window();
    let before = window.state().tools().clone();
    key(&mut window, Modifiers::NONE, Key::CloseBracket);
    assert!(window.state().tools().radius > before.radius);
    key(&mut window, Modifiers::NONE, Key::OpenBracket);
    key(&mut window, Modifiers::NONE, Key::OpenBracket);
    assert!(window.state().tools().radius < before.radius);
    assert_eq!(window.state().tools().hardness, before.hardness);
    // A keyboard says `{` where Shift and `[` are pressed.
    key(&mut window, Modifiers::SHIFT, Key::CloseCurlyBracket);
    assert!(window.state().tools().hardness > before.hardness);
    key(&mut window, Modifiers::SHIFT, Key::OpenCurlyBracket);
    key(&mut window, Modifiers::SHIFT, Key::OpenCurlyBracket);
    assert!(window.state().tools().hardness < before.hardness);
    for (digit, strength) in [(Key::Num1, 0.1), (Key::Num5, 0.5), (Key::Num0, 1.0)] {
        key(&mut window, Modifiers::NONE, digit);
        assert_eq!(window.state().tools().paint_strength, strength);
    }
    key(&mut window, Modifiers::NONE, Key::E);
    key(&mut window, Modifiers::NONE, Key::Num3);
    assert_eq!(window.state().tools().erase_strength, 0.3);
    assert_eq!(window.state().tools().paint_strength, 1.0, "the eraser has a strength of its own");
}

#[test]
fn alt_or_ctrl_click_picks_the_value_under_the_pointer() {
    let mut window = window();
    send(&mut window, Command::BrushStrength(0.11));
    click(&mut window, dvec2(0.245, 0.765), Modifiers::ALT);
    assert!((window.state().tools().paint_strength - 0.72).abs() < 0.02, "the risk of the first site");
    key(&mut window, Modifiers::NONE, Key::T);
    let before = window.state().tools().diameter;
    click(&mut window, dvec2(0.245, 0.765), Modifiers::COMMAND);
    assert_ne!(window.state().tools().diameter, before);
    assert_eq!(entries(&window), 0);
}

#[test]
fn shift_click_draws_a_straight_line_from_the_last_stroke() {
    let mut window = window();
    stroke(&mut window, FREE, FREE);
    let middle = FREE - dvec2(0.0, 0.15);
    assert_eq!(level_at(&window, FREE - dvec2(0.0, 0.1)), 0);
    click(&mut window, FREE - dvec2(0.0, 0.2), Modifiers::SHIFT);
    assert!(level_at(&window, middle) > 5);
    assert_eq!(entries(&window), 2);
}

#[test]
fn shift_drag_sizes_the_brush() {
    let mut window = window();
    let before = window.state().tools().radius;
    press(&mut window, FREE, Modifiers::SHIFT);
    move_to(&mut window, FREE + dvec2(0.05, 0.0));
    release(&mut window, FREE + dvec2(0.05, 0.0));
    assert!((window.state().tools().radius - before - 0.05).abs() < 1e-3);
    assert_eq!(entries(&window), 0, "nothing was painted");
}

#[test]
fn a_frame_drawn_with_the_domain_tool_becomes_the_domain() {
    let mut window = window();
    let before = fingerprint(&window);
    key(&mut window, Modifiers::NONE, Key::D);
    window.get_by_role_and_label(Role::RadioButton, "Frame").click();
    window.run();
    stroke(&mut window, dvec2(-0.05, 0.25), dvec2(0.5, 0.8));
    let bounds = settings(&window).domain.bounds;
    assert!(bounds.min.distance(dvec2(-0.05, 0.25)) < 0.003, "{bounds:?}");
    assert!(bounds.max.distance(dvec2(0.5, 0.8)) < 0.003, "{bounds:?}");
    assert_eq!(entries(&window), 1);
    assert!(level_at(&window, dvec2(0.24, 0.76)) > 5, "paint stays where it was");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), before);
    click(&mut window, FREE, Modifiers::NONE);
    assert_eq!((fingerprint(&window), entries(&window)), (before, 0), "a click is no rectangle");
    press(&mut window, FREE, Modifiers::NONE);
    move_to(&mut window, FREE - dvec2(0.3, 0.3));
    key(&mut window, Modifiers::NONE, Key::Escape);
    release(&mut window, FREE - dvec2(0.3, 0.3));
    assert_eq!(fingerprint(&window), before, "Escape gives it up");
}

#[test]
fn keys_typed_into_a_field_stay_there() {
    let mut window = window_of(TALL);
    stroke(&mut window, FREE, FREE);
    let painted = fingerprint(&window);
    window.get_by_role_and_label(Role::TextInput, "Size value").focus();
    window.run();
    for letter in [Key::E, Key::Q, Key::G, Key::Num1] {
        key(&mut window, Modifiers::NONE, letter);
    }
    window.get_by_role_and_label(Role::TextInput, "Size value").type_text("0.05");
    window.run();
    key(&mut window, Modifiers::COMMAND, Key::Z);
    key(&mut window, Modifiers::COMMAND, Key::Backspace);
    assert_eq!(window.state().tools().tool, Tool::Brush);
    assert!(window.state().view().edges);
    assert_eq!(window.state().tools().paint_strength, 0.8);
    assert_eq!(
        fingerprint(&window),
        painted,
        "neither undo nor clearing reaches the document from a text field"
    );
}

// -------------------------------------------------------------------------------------------- menus and palette

#[test]
fn the_palette_finds_and_runs_a_command() {
    let mut window = window();
    key(&mut window, Modifiers::COMMAND, Key::P);
    window.event(Event::Text("quer".into()));
    window.run();
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert_eq!(window.state().tools().tool, Tool::Query);
    assert!(window.query_by_label("Command").is_none(), "it closes");
    key(&mut window, Modifiers::COMMAND, Key::P);
    assert!(window.query_by_label("Command").is_some());
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.query_by_label("Command").is_none());
}

#[test]
fn a_long_menu_scrolls_in_a_small_window() {
    let mut window = window_of(vec2(900.0, 600.0));
    open_menu(&mut window, "Tool");
    let bottom = |window: &Window| {
        let last = window.query_all_by_label_contains("Strength 100 %").next();
        last.map_or(f32::INFINITY, |entry| entry.rect().bottom())
    };
    assert!(bottom(&window) > 600.0);
    wheel(&mut window, pos2(240.0, 300.0), -2000.0);
    assert!(bottom(&window) < 600.0, "{}", bottom(&window));
}

#[test]
fn every_command_is_in_a_menu_and_every_menu_entry_in_the_palette() {
    let mut window = window();
    key(&mut window, Modifiers::COMMAND, Key::P);
    let palette: BTreeSet<String> = labels(&window, Role::MenuItem);
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(palette.len() > 40, "{palette:?}");
    let at_rest = labels(&window, Role::Button);
    let mut menus = BTreeSet::new();
    for menu in ["File", "Edit", "Tool", "View", "Examples", "Help"] {
        open_menu(&mut window, menu);
        let entries: Vec<_> = labels(&window, Role::Button).difference(&at_rest).cloned().collect();
        assert!(!entries.is_empty(), "{menu} is empty");
        menus.extend(entries);
        key(&mut window, Modifiers::NONE, Key::Escape);
        assert_eq!(labels(&window, Role::Button), at_rest, "Escape closes {menu}");
    }
    // The label of an entry ends with its key.
    let names = |entry: &str, title: &str| entry == title || entry.starts_with(&format!("{title} "));
    let missing: Vec<_> =
        palette.iter().filter(|title| !menus.iter().any(|entry| names(entry, title))).collect();
    assert!(missing.is_empty(), "in no menu: {missing:?}");
    let unknown: Vec<_> =
        menus.iter().filter(|entry| !palette.iter().any(|title| names(entry, title))).collect();
    assert!(unknown.is_empty(), "not in the palette: {unknown:?}");
    for entry in
        ["Undo Ctrl+Z", "Redo Ctrl+Shift+Z", "Larger brush ]", "Softer brush Shift+[", "Fit domain Home"]
    {
        assert!(menus.contains(entry), "{entry} is not shown with its key");
    }
}

fn labels(window: &Window, role: Role) -> BTreeSet<String> {
    window.get_all_by_role(role).filter_map(|node| node.accesskit_node().label()).collect()
}

#[test]
fn escape_closes_what_is_open_first() {
    let mut window = window();
    key(&mut window, Modifiers::NONE, Key::Q);
    click(&mut window, FREE, Modifiers::NONE);
    choose(&mut window, "Help", "About Meshbrush");
    assert!(window.query_by_label_contains("Maubach").is_some());
    key(&mut window, Modifiers::NONE, Key::B);
    assert_eq!(window.state().tools().tool, Tool::Query, "a dialog keeps the keys");
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.query_by_label_contains("Maubach").is_none());
    assert!(selected(&window).is_some(), "the queried triangle is let go by the next Escape");
}

// --------------------------------------------------------------------------------------- documents and settings

#[test]
fn the_diamond_opens_by_menu_and_undo_stops_at_its_start() {
    let mut window = window();
    assert!(window.query_by_label("Radar threats").is_some(), "the bar says what is open");
    choose(&mut window, "Examples", "The report's diamond");
    assert_eq!(triangles(&window), 9560);
    assert_eq!(value_of(&window, Role::Definition, "triangles"), "9,560");
    assert_eq!(value_of(&window, Role::Definition, "rule"), "vertex");
    assert!(window.query_by_label("The report's diamond").is_some(), "and does not call it edited");
    let (opened, entries) = (fingerprint(&window), entries(&window));
    assert_eq!(entries, 0);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), opened, "undo does not return to the former document");
    assert!(window.query_by_label("The report's diamond").is_some());
    set(&mut window, Setting::Spacing(0.3));
    key(&mut window, Modifiers::COMMAND, Key::Z);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), opened);
}

#[test]
fn every_example_opens_and_new_is_empty() {
    let mut window = window();
    for example in Example::ALL {
        send(&mut window, Command::OpenExample(example));
        assert!(triangles(&window) > 5000, "{}", example.name());
        assert_eq!(notice(&window), "");
    }
    key(&mut window, Modifiers::COMMAND, Key::N);
    assert_eq!(window.state().session().mesh().level_counts().len(), 1);
}

/// Area of the mesh.
fn area(window: &Window) -> f64 {
    window.state().session().mesh().area()
}

#[test]
fn the_domain_is_cut_with_brush_rectangle_and_polygon_and_each_is_one_entry() {
    let mut window = window();
    let before = fingerprint(&window);
    key(&mut window, Modifiers::NONE, Key::D);
    let radius = window.state().tools().radius;
    stroke(&mut window, dvec2(0.3, 0.6), dvec2(0.6, 0.6));
    let cut = std::f64::consts::PI * radius * radius + 0.6 * radius;
    assert!((area(&window) - (1.0 - cut)).abs() < 0.005, "{} {cut}", area(&window));
    assert_eq!(entries(&window), 1);
    assert_eq!(window.state().session().topology().unwrap().holes, 1);
    assert_eq!(window.state().session().mesh().locate(dvec2(0.45, 0.6)), Location::OutsideDomain);
    let brushed = fingerprint(&window);

    window.get_by_role_and_label(Role::RadioButton, "Rectangle").click();
    window.run();
    let whole = area(&window);
    stroke(&mut window, dvec2(0.7, 0.1), dvec2(0.9, 0.3));
    assert!((area(&window) - (whole - 0.04)).abs() < 0.004, "{}", area(&window));
    assert_eq!(entries(&window), 2);

    window.get_by_role_and_label(Role::RadioButton, "Polygon").click();
    window.get_by_role_and_label(Role::RadioButton, "Add").click();
    window.run();
    let smaller = area(&window);
    for corner in [dvec2(0.65, 0.05), dvec2(0.95, 0.05), dvec2(0.65, 0.35)] {
        click(&mut window, corner, Modifiers::NONE);
    }
    assert_eq!(entries(&window), 2, "a polygon that is not closed cuts nothing");
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!((area(&window) - (smaller + 0.02)).abs() < 0.004, "half of the square is back");
    assert_eq!(entries(&window), 3);

    key(&mut window, Modifiers::COMMAND, Key::Z);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), brushed);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), before);
    assert_eq!(window.state().session().mesh().violations(), []);
}

/// A window on a round island with so many corners that a cut takes many frames, with the domain tool in hand.
fn window_on_a_long_coast() -> Window {
    const CORNERS: u32 = 200_000;
    let corner = |k: u32| {
        let angle = f64::from(k) / f64::from(CORNERS) * std::f64::consts::TAU;
        (0.4 + 0.01 * (99.0 * angle).sin()) * dvec2(angle.cos(), angle.sin())
    };
    let coast = Domain::of_polygons(&[vec![(0..CORNERS).map(corner).collect()]]).unwrap();
    let mut window = window();
    send(&mut window, Command::NewWith(Box::new(Settings::for_domain("coast".into(), coast))));
    key(&mut window, Modifiers::NONE, Key::D);
    window
}

/// Cuts along a line, and does not wait for it.
fn begin_to_cut(window: &mut Window, path: &[DVec2]) {
    let cut_shape = CutShape::Stroke { path: path.to_vec(), radius: 0.05 };
    window.state_mut().send(Command::Domain(DomainCommand::Reshape(cut_shape, false)));
    window.step();
}

#[test]
fn a_long_coast_is_cut_while_the_window_goes_on() {
    let mut window = window_on_a_long_coast();
    let (before, whole, entries_before) = (fingerprint(&window), area(&window), entries(&window));
    let [a, b, c] = [dvec2(-0.2, 0.0), DVec2::ZERO, dvec2(0.2, 0.0)];
    begin_to_cut(&mut window, &[a]);
    assert!(window.state().is_cutting(), "a frame does not wait for it");
    begin_to_cut(&mut window, &[a, b]);
    begin_to_cut(&mut window, &[b, c]);
    send(&mut window, Command::EndGesture);
    assert!(!window.state().is_cutting());
    let swept = 0.4 * 0.1 + std::f64::consts::PI * 0.05 * 0.05;
    assert!((whole - area(&window) - swept).abs() < 0.002, "{}", whole - area(&window));
    assert_eq!(entries(&window), entries_before + 1, "one gesture");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), before);
}

#[test]
fn a_cut_under_way_is_given_up_by_undo_by_escape_and_by_another_domain() {
    let mut window = window_on_a_long_coast();
    let (before, entries_before) = (fingerprint(&window), entries(&window));
    let give_up: [fn(&mut Window); 3] = [
        |window| key(window, Modifiers::COMMAND, Key::Z),
        |window| key(window, Modifiers::NONE, Key::Escape),
        |window| window.state_mut().execute(Command::CancelUpdate, &egui::Context::default()),
    ];
    for give_up in give_up {
        begin_to_cut(&mut window, &[DVec2::ZERO]);
        assert!(window.state().is_cutting());
        give_up(&mut window);
        assert!(!window.state().is_cutting());
        window.run();
        assert_eq!((fingerprint(&window), entries(&window)), (before, entries_before));
    }
    // Half of a stroke is cut, and the brush lifted: what is left is given up, and the half is an entry of its own.
    begin_to_cut(&mut window, &[DVec2::ZERO]);
    window.run();
    assert!(window.state().session().document().is_in_gesture());
    begin_to_cut(&mut window, &[DVec2::ZERO, dvec2(0.1, 0.0)]);
    window.state_mut().execute(Command::EndGesture, &egui::Context::default());
    window.state_mut().execute(Command::CancelUpdate, &egui::Context::default());
    assert!(!window.state().session().document().is_in_gesture(), "the journal would wait for its end");
    assert_eq!(entries(&window), entries_before + 1);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!((fingerprint(&window), entries(&window)), (before, entries_before));

    press(&mut window, DVec2::ZERO, Modifiers::NONE);
    move_to(&mut window, dvec2(0.1, 0.0));
    assert_ne!(fingerprint(&window), before);
    key(&mut window, Modifiers::NONE, Key::Escape);
    release(&mut window, dvec2(0.1, 0.0));
    assert_eq!(
        (fingerprint(&window), entries(&window)),
        (before, entries_before),
        "nor is half a stroke left"
    );

    begin_to_cut(&mut window, &[DVec2::ZERO]);
    let bounds = settings(&window).domain.bounds;
    set(&mut window, Setting::Domain(Domain::rectangle(bounds)));
    window.run();
    assert!(!window.state().is_cutting() && settings(&window).domain.region().is_none());
}

#[test]
fn the_outline_is_met_in_two_ways_and_the_panel_says_what_that_costs() {
    let mut window = window_of(TALL);
    send(&mut window, Command::OpenExample(Example::Aegean));
    key(&mut window, Modifiers::NONE, Key::D);
    let fitted = window.state().session().mesh().triangle_count();
    assert!(
        value_of(&window, Role::Definition, "Holes").ends_with(" (outline 65)"),
        "{}",
        value_of(&window, Role::Definition, "Holes")
    );
    assert!(fitted > 30_000);
    window.get_by_role_and_label(Role::RadioButton, "As in the report").click();
    window.run();
    assert!(window.state().session().mesh().triangle_count() < 1000);
    assert_eq!(window.state().session().mesh().outside_count(), 0);
    window.get_by_role_and_label(Role::RadioButton, "Fitted to outline").click();
    window.run();
    assert_eq!(window.state().session().mesh().triangle_count(), fitted);
    window.get_by_label("Whole rectangle").click();
    window.run();
    assert!(settings(&window).domain.region().is_none());
    assert_eq!(area(&window), 36.0);
}

#[test]
fn a_file_of_polygons_opens_as_a_document() {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("lake.geojson");
    let rings = "[[[10, 0], [14, 0], [14, 2], [10, 2], [10, 0]], [[11, 0.5], [12, 0.5], [12, 1], [11, 1], [11, 0.5]]]";
    std::fs::write(&path, format!("{{\"type\": \"Polygon\", \"coordinates\": {rings}}}")).unwrap();
    let mut window = window();
    send(&mut window, Command::OpenDomain(path.clone()));
    wait_until(&mut window, |window| settings(window).name == "lake");
    assert_eq!(settings(&window).domain.bounds.max, dvec2(14.0, 2.0));
    assert!((area(&window) - 7.5).abs() < 0.01, "{}", area(&window));
    std::fs::write(&path, "{\"type\": \"Point\", \"coordinates\": [1, 2]}").unwrap();
    send(&mut window, Command::OpenDomain(path));
    let text = wait_for_notice(&mut window);
    assert!(text.contains("lake.geojson: a domain needs a Polygon"), "{text}");
    assert_eq!(settings(&window).name, "lake");
}

#[test]
fn a_stroke_makes_the_title_say_edited() {
    let mut window = window();
    stroke(&mut window, FREE, FREE);
    assert!(window.query_by_label("Radar threats — edited").is_some());
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(window.query_by_label("Radar threats").is_some());
}

#[test]
fn spacing_diameters_and_base_change_the_mesh_at_once() {
    let mut window = window_of(TALL);
    open_section(&mut window, "Mesh");
    open_section(&mut window, "Base field");
    open_section(&mut window, "Domain");
    let mut last = fingerprint(&window);
    let mut changed = |window: &Window, what: &str| {
        assert_ne!(fingerprint(window), last, "{what}");
        last = fingerprint(window);
    };
    type_into(&mut window, "Spacing δ value", "0.1");
    assert_eq!(settings(&window).spacing, 0.1);
    changed(&window, "spacing");
    set(&mut window, Setting::SmallestDiameter(0.01));
    changed(&window, "h_min");
    set(&mut window, Setting::LargestDiameter(0.1));
    changed(&window, "h_max");
    window.get_by_role_and_label(Role::RadioButton, "Formula").click();
    window.run();
    type_into(&mut window, "Target diameter h̄(x, y)", "0.02 + 0.1*x");
    assert!(matches!(settings(&window).base, Base::Formula(_)));
    changed(&window, "formula");
    window.get_by_role_and_label(Role::RadioButton, "Constant").click();
    window.run();
    type_into(&mut window, "Diameter", "0.05");
    assert_eq!(settings(&window).base, Base::Constant(0.05));
    changed(&window, "constant");
    type_into(&mut window, "Domain where", "hypot(x - 0.5, y - 0.5) < 0.5");
    assert!(settings(&window).domain.formula().is_some());
    changed(&window, "domain");
    type_into(&mut window, "Right", "2");
    assert_eq!(settings(&window).domain.bounds.max.x, 2.0);
    changed(&window, "bounds");
    type_into(&mut window, "Resolution", "256");
    assert_eq!(settings(&window).resolution, 256);
    let mesh = window.state().session().mesh();
    assert_eq!(mesh.violations(), []);
}

#[test]
fn a_drag_of_a_slider_is_one_entry() {
    let mut window = window_of(TALL);
    open_section(&mut window, "Mesh");
    let track = |window: &Window| window.get_by_role_and_label(Role::Slider, "Spacing δ").rect();
    let place = track(&window);
    let at = |share: f32| pos2(place.left() + place.width() * share, place.center().y);
    press_at(&mut window, at(0.5), PointerButton::Primary, Modifiers::NONE);
    let spacing = settings(&window).spacing;
    for share in [0.6, 0.7, 0.65, 0.8] {
        window.event(Event::PointerMoved(at(share)));
        window.run();
    }
    assert!(settings(&window).spacing > 2.0 * spacing, "live");
    assert_eq!(track(&window), place, "the slider stays under the pointer, though there are more levels now");
    release_at(&mut window, at(0.8), PointerButton::Primary);
    assert_eq!(entries(&window), 1);
    press_at(&mut window, at(0.4), PointerButton::Primary, Modifiers::NONE);
    release_at(&mut window, at(0.4), PointerButton::Primary);
    assert_eq!(entries(&window), 2, "the next drag is another");
}

#[test]
fn a_formula_that_cannot_be_read_says_why_and_changes_nothing() {
    let mut window = window_of(TALL);
    let before = (fingerprint(&window), settings(&window).clone());
    open_section(&mut window, "Base field");
    window.get_by_role_and_label(Role::RadioButton, "Formula").click();
    window.run();
    type_into(&mut window, "Target diameter h̄(x, y)", "0.1 + sqr(x)");
    assert!(window.query_by_label_contains("sqr").is_some(), "the sentence names what is wrong");
    assert_eq!((fingerprint(&window), settings(&window).clone()), before);
    assert_eq!(entries(&window), 0);
}

#[test]
fn a_formula_that_is_no_length_somewhere_says_where_and_changes_nothing() {
    for (formula, x) in [("if(x > 0.75, sqrt(-1), 0.1)", "x = 0.75"), ("0.1 - 0.2*(x > 0.5)", "x = 0.5")] {
        for rule in [RefinementRule::Area, RefinementRule::Vertex] {
            let mut window = window_of(TALL);
            set(&mut window, Setting::RefinementRule(rule));
            let before = (fingerprint(&window), settings(&window).clone(), entries(&window));
            open_section(&mut window, "Base field");
            window.get_by_role_and_label(Role::RadioButton, "Formula").click();
            window.run();
            type_into(&mut window, "Target diameter h̄(x, y)", formula);
            let told = notice(&window);
            assert!(told.contains(x) || told.contains("x = 0."), "{formula}: {told}");
            assert!(window.query_by_role_and_label(Role::Alert, &told).is_some(), "{told}");
            assert_eq!((fingerprint(&window), settings(&window).clone(), entries(&window)), before);
        }
    }
}

#[test]
fn impossible_settings_are_refused_with_a_sentence() {
    let mut window = window();
    let before = (fingerprint(&window), settings(&window).clone());
    for setting in [
        Setting::Spacing(0.0),
        Setting::Spacing(1e-9),
        Setting::SmallestDiameter(f64::NAN),
        Setting::Base(Base::Constant(-1.0)),
        Setting::Resolution(1),
        Setting::Bounds(meshbrush::geometry::Rect::new(DVec2::ONE, DVec2::ZERO)),
        Setting::Domain(Domain {
            bounds: meshbrush::geometry::Rect::UNIT,
            shape: DomainShape::Formula(Formula::parse("x > 9").unwrap()),
        }),
    ] {
        set(&mut window, setting.clone());
        assert!(notice(&window).ends_with('.'), "{setting:?}: {}", notice(&window));
        assert_eq!((fingerprint(&window), settings(&window).clone()), before, "{setting:?}");
        assert_eq!(entries(&window), 0);
        send(&mut window, Command::Escape);
        assert_eq!(notice(&window), "", "Escape dismisses it");
    }
}

/// The tag beside the brush ring.
fn price_tag(window: &Window) -> Option<String> {
    let mut tags = window.query_all_by_role(Role::Label).filter_map(|node| node.accesskit_node().value());
    tags.find(|label| {
        ["+", "−", "over", "frees", "no change", "counting"].iter().any(|start| label.starts_with(start))
    })
}

fn hover(window: &mut Window, world: DVec2) -> Option<String> {
    move_to(window, world);
    price_tag(window)
}

/// The number on the tag for a dab at a place, and what a click there then does to the number of triangles.
fn told_and_true(window: &mut Window, world: DVec2) -> (String, i64) {
    let told = hover(window, world).expect("a tag beside the ring");
    let before = triangles(window) as i64;
    click(window, world, Modifiers::NONE);
    (told, triangles(window) as i64 - before)
}

fn as_told(change: i64) -> String {
    match change {
        0 => "no change".into(),
        _ => format!("{} triangles", meshbrush::app::widgets::format::change(change)),
    }
}

#[test]
fn the_brush_shows_its_price_before_the_click_and_the_price_is_true() {
    let mut window = window();
    let (version, count) = (window.state().session().document().version(), triangles(&window));
    assert_eq!(price_tag(&window), None, "the pointer is not on the canvas");
    assert!(hover(&mut window, FREE).unwrap().starts_with('+'));
    let session = window.state().session();
    assert_eq!(
        (session.document().version(), triangles(&window)),
        (version, count),
        "hovering changes nothing"
    );
    let mut seen = BTreeSet::new();
    for tool in [Tool::Brush, Tool::Eraser] {
        send(&mut window, Command::Use(tool));
        for place in [FREE, FREE - dvec2(0.03, 0.02), dvec2(0.02, 0.97), FREE] {
            let (told, change) = told_and_true(&mut window, place);
            assert_eq!(told, as_told(change), "{tool:?} at {place}");
            seen.insert(change.signum());
        }
    }
    assert_eq!(seen.into_iter().collect::<Vec<_>>(), [-1, 1]);
    // Beside the domain.
    assert_eq!(told_and_true(&mut window, dvec2(1.09, 0.5)), ("no change".into(), 0));
}

#[test]
fn the_price_is_asked_only_where_a_click_paints_a_dab() {
    let mut window = window();
    assert!(hover(&mut window, FREE).is_some());
    for tool in [Tool::Query, Tool::Domain, Tool::Pan] {
        send(&mut window, Command::Use(tool));
        assert_eq!(price_tag(&window), None, "{tool:?}");
    }
    send(&mut window, Command::Use(Tool::Brush));
    assert!(price_tag(&window).is_some());
    for modifiers in [Modifiers::SHIFT, Modifiers::ALT] {
        window.event(Event::ModifiersChanged(modifiers));
        window.run();
        assert_eq!(price_tag(&window), None, "{modifiers:?}");
    }
    window.event(Event::ModifiersChanged(Modifiers::NONE));
    press(&mut window, FREE, Modifiers::NONE);
    assert_eq!(price_tag(&window), None, "a stroke is under way");
    release(&mut window, FREE);
    assert!(price_tag(&window).is_some());
    set(&mut window, Setting::RefinementRule(RefinementRule::Vertex));
    assert_eq!(price_tag(&window), None, "every edit makes the mesh anew");
    set(&mut window, Setting::RefinementRule(RefinementRule::Area));
    // A larger brush costs more, with the pointer where it is.
    let small = price_tag(&window).unwrap();
    send(&mut window, Command::ScaleBrush(2.0));
    assert_ne!(price_tag(&window).unwrap(), small);
}

#[test]
fn a_price_past_the_budget_says_so() {
    let mut window = window();
    let count = triangles(&window);
    set(&mut window, Setting::MaxTriangles(count + 100));
    let tag = hover(&mut window, FREE).unwrap();
    assert!(tag.starts_with('+') && tag.ends_with(" triangles, over the budget"), "{tag}");
    send(&mut window, Command::Use(Tool::Eraser));
    assert!(!price_tag(&window).unwrap().contains("budget"));
}

#[test]
fn the_budgets_are_typed_in_the_panel_and_what_is_too_small_is_told() {
    let mut window = window_of(TALL);
    open_section(&mut window, "Mesh");
    type_into(&mut window, "Memory budget", "0.5");
    assert_eq!(settings(&window).max_memory, 500_000_000);
    type_into(&mut window, "Triangle budget", "1.5");
    assert_eq!(settings(&window).max_triangles, 1_500_000);
    let count = triangles(&window);
    // Room for fewer triangles than there are.
    type_into(&mut window, "Memory budget", "0.001");
    assert!(notice(&window).contains("1 MB of memory"), "{}", notice(&window));
    assert_eq!((settings(&window).max_memory, triangles(&window)), (500_000_000, count));
    set(&mut window, Setting::MaxMemory(86 * (count + 100)));
    let tag = hover(&mut window, FREE).unwrap();
    assert!(tag.ends_with("over the budget"), "{tag}");
}

#[test]
fn the_rule_switches_and_says_what_it_misses() {
    let mut window = window_of(TALL);
    open_section(&mut window, "Mesh");
    let area = fingerprint(&window);
    window.get_by_role_and_label(Role::RadioButton, "Vertex rule").click();
    window.run();
    assert_eq!(settings(&window).rule, RefinementRule::Vertex);
    assert_ne!(fingerprint(&window), area);
    assert!(window.query_by_label_contains("leaves no trace").is_some());
    window.get_by_role_and_label(Role::RadioButton, "Area rule").click();
    window.run();
    assert_eq!(fingerprint(&window), area);
}

#[test]
fn past_the_budget_the_message_says_so_and_undo_brings_the_mesh_back() {
    let mut window = window();
    set(&mut window, Setting::MaxTriangles(60_000));
    let before = (fingerprint(&window), settings(&window).clone());
    set(&mut window, Setting::SmallestDiameter(0.0005));
    assert!(notice(&window).contains("60000") || notice(&window).contains("60,000"), "{}", notice(&window));
    assert_eq!((fingerprint(&window), settings(&window).clone()), before);

    let count = triangles(&window);
    set(&mut window, Setting::MaxTriangles(count + 100));
    let before = fingerprint(&window);
    // A stroke goes as far as the budget does, and is taken back whole.
    stroke(&mut window, FREE, FREE);
    assert!(notice(&window).contains("limit"), "{}", notice(&window));
    assert!((count..=count + 100).contains(&triangles(&window)), "{}", triangles(&window));
    assert_eq!(window.state().session().mesh().violations(), []);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), before);
}

#[test]
fn a_message_is_dismissed_by_its_cross_and_nothing_is_painted_under_it() {
    let mut window = window();
    send(&mut window, Command::CancelUpdate);
    assert!(!notice(&window).is_empty());
    let (before, version) = (fingerprint(&window), window.state().session().document().version());
    window.get_by_label("Dismiss").click();
    window.run();
    assert_eq!(notice(&window), "");
    assert_eq!((fingerprint(&window), window.state().session().document().version()), (before, version));
    assert_eq!(entries(&window), 0);
}

#[test]
fn while_the_mesh_stops_short_of_the_paint_a_message_says_so_and_stays() {
    let mut window = window();
    let count = triangles(&window);
    let whole = fingerprint(&window);
    set(&mut window, Setting::MaxTriangles(count + 100));
    stroke(&mut window, FREE, FREE);
    let standing = notice(&window);
    assert!(standing.contains("what you painted is kept") && standing.contains("undo"), "{standing}");
    assert!(window.get_by_role(Role::Alert).accesskit_node().label().is_some_and(|label| label == standing));
    // Neither Escape nor what works elsewhere takes it away, and there is no cross.
    key(&mut window, Modifiers::NONE, Key::Escape);
    set(&mut window, Setting::MaxTriangles(count + 110));
    assert!(notice(&window).contains("what you painted is kept"), "{}", notice(&window));
    assert!(window.query_by_label("Dismiss").is_none());
    assert_eq!(price_tag(&window), None, "a mesh that is behind has no price to tell");
    assert!(window.query_by_label_contains("Refining").is_none(), "nothing goes on");
    // A larger budget does, and the work goes on by itself.
    set(&mut window, Setting::MaxTriangles(Settings::MAX_TRIANGLES));
    assert_eq!(notice(&window), "");
    assert!(triangles(&window) > count + 110);
    // Undo leads back to the small budget; it takes no other entry with it.
    let entries_before = entries(&window);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(notice(&window).ends_with("the former mesh is shown."), "{}", notice(&window));
    assert_eq!((entries(&window), settings(&window).max_triangles), (entries_before - 1, count + 110));
    // The button undoes the second budget, which does not help, and then the stroke, which does.
    for _ in 0..2 {
        window.get_by_role_and_label(Role::Alert, &notice(&window));
        let on_canvas = canvas(&window);
        let buttons: Vec<_> = window.get_all_by_role_and_label(Role::Button, "Undo").collect();
        buttons.iter().find(|button| on_canvas.contains_rect(button.rect())).expect("in the banner").click();
        drop(buttons);
        window.run();
    }
    assert_eq!((notice(&window), fingerprint(&window)), (String::new(), whole));
    assert_eq!(settings(&window).max_triangles, count + 100);
}

// ------------------------------------------------------------------------------------------------------- files

fn scratch(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// Runs frames until work off the thread has been heard of.
fn wait_until(window: &mut Window, done: impl Fn(&Window) -> bool) {
    for _ in 0..1000 {
        window.run();
        if done(window) {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("it did not happen");
}

fn wait_for_notice(window: &mut Window) -> String {
    let patience = Instant::now() + Duration::from_secs(20);
    while notice(window).is_empty() {
        assert!(Instant::now() < patience, "nothing was told");
        std::thread::sleep(Duration::from_millis(5));
        window.run();
    }
    notice(window)
}

#[test]
fn an_export_writes_the_file_and_tells() {
    let mut window = window();
    for ending in ["vtu", "msh", "svg", "png"] {
        let file = scratch(&format!("app-export.{ending}"));
        let _ = std::fs::remove_file(&file); // absent at the first run
        send(&mut window, Command::Export(file.clone()));
        let told = wait_for_notice(&mut window);
        assert!(told.contains("triangles written to") && told.contains(ending), "{told}");
        assert!(std::fs::metadata(&file).unwrap().len() > 100_000);
        send(&mut window, Command::Escape);
    }
    send(&mut window, Command::Export(scratch("app-export.doc")));
    assert!(wait_for_notice(&mut window).contains(".vtu"));
    send(&mut window, Command::Escape);
    send(&mut window, Command::Export(scratch("no such folder/mesh.vtu")));
    assert!(wait_for_notice(&mut window).contains("could not be written: there is no folder"));
    stroke(&mut window, dvec2(0.1, 0.1), dvec2(0.2, 0.1));
    assert!(notice(&window).contains("no folder"), "what failed stays");
}

#[test]
fn an_export_asks_before_it_replaces_any_of_its_files() {
    let mut window = window();
    let [nodes, elements] = ["node", "ele"].map(|ending| scratch(&format!("app-replace.{ending}")));
    for ending in ["node", "neigh", "edge"] {
        let _ = std::fs::remove_file(nodes.with_extension(ending)); // absent at the first run
    }
    std::fs::write(&elements, "of another mesh").unwrap();
    let button = |window: &mut Window, label: &str| {
        window.get_by_role_and_label(Role::Button, label).click();
        window.run();
    };
    send(&mut window, Command::ExportAs(nodes.clone()));
    button(&mut window, "Cancel");
    assert_eq!((notice(&window).as_str(), nodes.exists()), ("", false));
    send(&mut window, Command::ExportAs(nodes.clone()));
    assert!(window.query_by_label_contains("app-replace.ele?").is_some(), "the one that is there");
    button(&mut window, "Replace");
    assert!(wait_for_notice(&mut window).contains("triangles written to"));
    assert!(nodes.exists() && std::fs::read_to_string(&elements).unwrap() != "of another mesh");
    stroke(&mut window, dvec2(0.1, 0.1), dvec2(0.2, 0.1));
    assert_eq!(notice(&window), "", "news go once work goes on");
}

#[test]
fn the_export_dialog_takes_a_path() {
    let mut window = window();
    let file = scratch("app-dialog.obj");
    let _ = std::fs::remove_file(&file); // absent at the first run
    key(&mut window, Modifiers::COMMAND, Key::E);
    window.run_steps(3);
    window.event(Event::Text(file.display().to_string()));
    window.run();
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!(wait_for_notice(&mut window).contains("written"));
    assert!(file.exists());
}

#[test]
fn a_bad_picture_is_told_and_a_good_one_becomes_risk() {
    let mut window = window();
    let before = fingerprint(&window);
    let bad = scratch("app-bad.png");
    std::fs::write(&bad, b"no picture").unwrap();
    send(&mut window, Command::OpenImage(bad));
    let told = wait_for_notice(&mut window);
    assert!(told.contains("app-bad.png"), "{told}");
    assert_eq!(fingerprint(&window), before);
    send(&mut window, Command::Escape);

    let good = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/jacksboro_slope.png");
    send(&mut window, Command::OpenImage(good.into()));
    let patience = Instant::now() + Duration::from_secs(20);
    while fingerprint(&window) == before {
        assert!(Instant::now() < patience, "{}", notice(&window));
        std::thread::sleep(Duration::from_millis(5));
        window.run();
    }
    assert!(matches!(settings(&window).base, Base::RiskImage { .. }));
}

// -------------------------------------------------------------------------------------------------- long work

/// A smallest diameter that makes the first example's mesh have about two million triangles.
const TWO_MILLIONS: f64 = 0.00025;

#[test]
fn the_former_mesh_is_shown_until_the_new_one_is_whole() {
    let mut window = window();
    let (before, generation) = (fingerprint(&window), window.state().session().follower().revision());
    window.state_mut().send(Command::Set(Setting::SmallestDiameter(TWO_MILLIONS)));
    window.step();
    let mut frames = 0;
    while window.state().session().stage() != Stage::InStep {
        assert_eq!(window.state().session().follower().revision(), generation);
        assert_eq!(fingerprint(&window), before, "not a part of the new mesh is shown");
        window.step();
        frames += 1;
    }
    assert!(frames > 5, "so much work is spread over more than {frames} frames");
    assert!(triangles(&window) > 1_500_000, "{}", triangles(&window));
    assert_eq!(window.state().session().follower().revision(), generation + 1);
}

#[test]
fn in_a_small_window_nothing_covers_the_button_that_cancels() {
    let mut window = window_of(vec2(900.0, 600.0));
    window.state_mut().send(Command::Set(Setting::SmallestDiameter(1e-4)));
    let patience = Instant::now() + Duration::from_secs(20);
    while window.query_by_label("Cancel").is_none() {
        assert!(Instant::now() < patience, "no progress was shown");
        window.step();
    }
    assert!(window.query_by_label_contains("Drag to paint risk").is_none(), "the hint makes room");
}

#[test]
fn cancel_gives_a_long_update_up_and_the_next_edit_takes_it_up_again() {
    let mut window = window();
    let before = fingerprint(&window);
    window.state_mut().send(Command::Set(Setting::SmallestDiameter(1e-4)));
    let patience = Instant::now() + Duration::from_secs(20);
    while window.query_by_label("Cancel").is_none() {
        assert!(Instant::now() < patience, "no progress was shown");
        window.step();
    }
    assert!(window.query_by_role(Role::ProgressIndicator).is_some());
    window.get_by_role_and_label(Role::Button, "Cancel").click();
    window.run();
    assert_eq!(window.state().session().stage(), Stage::InStep);
    assert_eq!(fingerprint(&window), before);
    assert!(notice(&window).contains("not updated"), "{}", notice(&window));
    assert!(window.query_by_label("Cancel").is_none());
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(fingerprint(&window), before);
    stroke(&mut window, FREE, FREE);
    assert_ne!(fingerprint(&window), before);
}

#[test]
fn one_slice_of_work_is_small_however_much_there_is_to_do() {
    const VISITS: usize = 2048;
    let mut document =
        Example::Threats.document(|| unreachable!("not of this example"), || unreachable!("nor this"));
    let mut follower = Follower::new(&mut document).unwrap();
    document.set(Setting::SmallestDiameter(TWO_MILLIONS)).unwrap();
    let (mut last, mut most, mut slices) = (0, 0, 0);
    loop {
        match follower.advance(&mut document, VISITS).unwrap() {
            Stage::InStep => break,
            Stage::Outlining | Stage::Filling => {}
            Stage::Refining { triangles } => {
                most = most.max(triangles.saturating_sub(last.max(1200)));
                last = triangles;
            }
        }
        slices += 1;
    }
    assert!(last > 1_000_000 && slices > 500, "{last} triangles in {slices} slices");
    // A visit bisects a triangle, its neighbour, and now and then a chain of them.
    assert!(most <= 4 * VISITS, "{most} triangles in one slice of {VISITS} visits");
}

#[test]
fn a_long_stroke_never_waits_for_the_mesh() {
    let mut window = window();
    window.state_mut().send(Command::Set(Setting::SmallestDiameter(TWO_MILLIONS)));
    window.step();
    let from = on_screen(&window, FREE);
    window.event(Event::PointerMoved(from));
    window.event(button_event(from, PointerButton::Primary, true, Modifiers::NONE));
    for i in 0..10 {
        window.event(Event::PointerMoved(from - vec2(8.0 * i as f32, 0.0)));
    }
    window.step();
    let document: &Document = window.state().session().document();
    assert!(document.stroke().is_some());
    assert!(document.paint().risk.sample(FREE - dvec2(0.05, 0.0)).unwrap() > 0.1, "paint does not wait");
    release_at(&mut window, from, PointerButton::Primary);
    assert!(level_at(&window, FREE) > 10);
}

// ------------------------------------------------------------------------------------------------------ layout

#[test]
fn the_bars_have_room_for_what_they_show_at_any_width() {
    for width in [900.0, 940.0, 1000.0, 1100.0, 1440.0] {
        for zoom in [1.0, 1e6] {
            let mut window = window_of(vec2(width, 600.0));
            window.hover_at(canvas(&window).center());
            send(&mut window, Command::Zoom(zoom));
            let screen = Rect::from_min_size(Pos2::ZERO, vec2(width, 600.0));
            let bottom = window.get_all_by_role(Role::Definition).filter(|cell| cell.rect().top() > 570.0);
            let cells: Vec<Rect> = bottom.map(|cell| cell.rect()).collect();
            assert!(cells.len() >= 5, "{} cells at {width}", cells.len());
            for (i, cell) in cells.iter().enumerate() {
                assert!(screen.contains_rect(*cell), "{cell:?} at {width}");
                assert!(cells[..i].iter().all(|other| !other.intersects(*cell)), "{cells:?} at {width}");
            }
            let right = cells.iter().map(|cell| cell.right()).fold(0.0, f32::max);
            assert!((width - 16.0 - right).abs() < 1.0, "the last cell ends with the panel, not at {right}");
        }
    }
}

// --------------------------------------------------------------------------------------------------- pictures

/// What the window looks like: rows from the top, four bytes a pixel.
struct Picture {
    width: usize,
    rgba: Vec<u8>,
}

fn picture(window: &mut Window) -> Picture {
    let image = window.render().unwrap();
    Picture { width: image.width() as usize, rgba: image.into_raw() }
}

fn pixel(picture: &Picture, at: Pos2) -> [u8; 3] {
    let start = 4 * (at.y.round() as usize * picture.width + at.x.round() as usize);
    picture.rgba[start..start + 3].try_into().unwrap()
}

fn is_colorful([r, g, b]: [u8; 3]) -> bool {
    r.max(g).max(b) - r.min(g).min(b) > 40
}

/// How many pixels within `radius` points of `middle` are coloured as a refined level.
fn colorful(image: &Picture, middle: Pos2, radius: i32) -> usize {
    let offsets = (-radius..=radius).flat_map(|y| (-radius..=radius).map(move |x| vec2(x as f32, y as f32)));
    offsets.filter(|offset| is_colorful(pixel(image, middle + *offset))).count()
}

#[test]
fn a_stroke_is_seen_on_the_canvas_and_gone_after_undo() {
    let mut window = drawn_window();
    let at = on_screen(&window, FREE);
    window.hover_at(RESTING_PLACE);
    window.run();
    let empty = picture(&mut window);
    assert_eq!(colorful(&empty, at, 20), 0);
    stroke(&mut window, FREE, FREE);
    window.hover_at(RESTING_PLACE);
    window.run();
    let painted = picture(&mut window);
    assert!(colorful(&painted, at, 20) > 1000);
    let hovered = window.state().view().clone();
    key(&mut window, Modifiers::COMMAND, Key::Z);
    window.run();
    let undone = picture(&mut window);
    assert_eq!(colorful(&undone, at, 20), 0);
    assert_eq!(hovered.camera, window.state().view().camera);
}

#[test]
fn an_overlay_and_the_light_theme_are_seen_on_the_canvas() {
    let mut window = drawn_window();
    window.hover_at(RESTING_PLACE);
    window.run();
    let at = on_screen(&window, dvec2(0.72, 0.74));
    let plain = picture(&mut window);
    send(&mut window, Command::Overlay(FieldOverlay::Risk));
    let [r, g, _] = pixel(&picture(&mut window), at);
    assert!(r > g, "risk is warm");
    send(&mut window, Command::Overlay(FieldOverlay::Risk));
    assert_eq!(pixel(&picture(&mut window), at), pixel(&plain, at), "the same command takes it away");
    choose(&mut window, "View", "Light theme");
    let light = picture(&mut window);
    let corner = canvas(&window).left_top() + vec2(3.0, 3.0);
    assert!(pixel(&plain, corner)[0] < 40 && pixel(&light, corner)[0] > 180);
}

#[test]
fn the_screenshots_are_the_same_every_time() {
    let take = |name: &str| {
        let folder = scratch(name);
        let files = meshbrush::app::write_screenshots(&folder).unwrap();
        files.iter().map(|file| std::fs::read(file).unwrap()).collect::<Vec<_>>()
    };
    let (first, second) = std::thread::scope(|scope| {
        let second = scope.spawn(|| take("screenshots-2"));
        (take("screenshots-1"), second.join().unwrap())
    });
    assert_eq!(first.len(), 9);
    assert!(first == second, "the same commands, another picture");
}
