//! The window driven as a person drives it, by role and label, without a display. Most tests need no graphics
//! driver.

mod add_data;
#[cfg(unix)]
mod background;
mod budget;
mod celtic_sea;
mod commands;
mod cut_controls;
mod derivation;
mod docks;
mod file_dialog;
mod files;
mod gallery;
mod held_jobs;
mod help;
#[cfg(unix)]
mod identity;
mod key_presses;
mod key_table;
mod keyboard_walk;
mod keys;
mod links;
mod long_work;
mod menus;
mod messages;
mod next_document;
mod numbers;
mod open_domain;
mod orientation;
mod other_window;
mod overlay_pictures;
mod overlays;
mod painted;
mod palette;
pub mod pictures;
mod places;
mod presentation;
mod project;
mod reading_order;
mod recipes;
mod settings;
mod shapes;
mod six_jobs;
mod size_prices;
mod software_window;
mod space;
mod steady;
mod threads;
pub mod tips;
mod view;
mod without_threads;

pub use places::*;
pub use shapes::*;

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::accesskit::Role;
use eframe::egui::{self, Event, Key, Modifiers, PointerButton, Pos2, Rect, Vec2, pos2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, HarnessBuilder};
use glam::{DVec2, dvec2};

use crate::app::App;
use crate::app::canvas::CANVAS_NAME;
use crate::app::features::paths::{PathFinder, Paths};
use crate::app::features::stepping::{Stepping, Steps};
use meshbrush_core::document::{Document, Setting, Settings};
use meshbrush_core::layers::{Layer, LayerId, LayerKind, RasterLayer, RasterReading};
use meshbrush_kit::kit::Features;
use meshbrush_kit::kit::command::{BrushCommand, Command, EditCommand, FileCommand, LayerCommand, Opened};
use meshbrush_kit::kit::session::Session;
use meshbrush_kit::kit::tools::Tools;
use meshbrush_kit::kit::view::View;
use meshbrush_mesh::mesh::{Fingerprint, TriangleId};

pub type Window = Harness<'static, App>;

/// Where tests write files.
pub const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/target/tmp");
/// Room for every section of a dock at once, so that nothing must be scrolled to.
pub const TALL: Vec2 = vec2(1440.0, 2000.0);

/// Off the canvas, over nothing.
pub const RESTING_PLACE: Pos2 = pos2(600.0, 10.0);

/// In the first example: free of paint, and far from it.
pub const FREE: DVec2 = dvec2(0.9, 0.5);

pub const CTRL_SHIFT: Modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };

/// The layers of paint in a new document.
pub const PAINTED_DIAMETER: LayerId = LayerId(1);
pub const PAINTED_RISK: LayerId = LayerId(2);

/// The storage of what a window keeps from run to run, in memory.
#[derive(Default)]
pub struct Kept(BTreeMap<String, String>);

impl eframe::Storage for Kept {
    fn get_string(&self, key: &str) -> Option<String> {
        self.0.get(key).cloned()
    }

    fn set_string(&mut self, key: &str, value: String) {
        self.0.insert(key.to_owned(), value);
    }

    fn remove_string(&mut self, key: &str) {
        self.0.remove(key);
    }

    fn flush(&mut self) {}
}

/// Returns the painted value of a layer at a point.
pub fn painted(window: &Window, layer: LayerId, point: DVec2) -> f32 {
    let paint = window.state().session().document().paint();
    paint.get(layer).expect("a layer that was painted on").sample(point)
}

/// Selects the layer at the bottom.
pub fn select_base(window: &mut Window) {
    send(window, Command::from(LayerCommand::Select(LayerId(0))));
}

/// Returns the layers of the document, with another one at the bottom.
pub fn with_base(window: &Window, kind: LayerKind) -> Setting {
    let mut layers = settings(window).layers.clone();
    layers[0].kind = kind;
    Setting::Layers(layers)
}

/// Returns whether a layer reads a raster.
pub fn has_raster(window: &Window, wanted: &RasterReading) -> bool {
    let mut layers = settings(window).layers.iter();
    layers.any(
        |layer| matches!(&layer.kind, LayerKind::Raster(RasterLayer { reading, .. }) if reading == wanted),
    )
}

pub fn window() -> Window {
    window_of(vec2(1440.0, 900.0))
}

pub fn window_of(size: Vec2) -> Window {
    window_with(Harness::builder().with_size(size))
}

pub fn window_with(builder: HarnessBuilder<App>) -> Window {
    let mut window = builder
        .with_max_steps(4000)
        .build_eframe(|cc| App::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref()).unwrap());
    window.run();
    window
}

pub fn send(window: &mut Window, command: Command) {
    window.state_mut().send(command);
    window.run();
}

/// Returns the command that shows a new document, as one that was read.
pub fn show(settings: Settings) -> Command {
    let document = Document::new(settings, None).expect("valid settings");
    Command::from(FileCommand::Show(Opened { document: Arc::new(document), home: None }))
}

pub fn set(window: &mut Window, setting: Setting) {
    window.state_mut().send(Command::from(EditCommand::Set(setting)));
    send(window, Command::from(EditCommand::EndGesture));
}

pub fn canvas(window: &Window) -> Rect {
    window.get_by_role_and_label(Role::Image, CANVAS_NAME).rect()
}

/// Returns the position of a point of the world on the screen.
pub fn on_screen(window: &Window, world: DVec2) -> Pos2 {
    let px = window.state().view().camera.unwrap().screen_from_world(world);
    canvas(window).min + vec2(px.x as f32, px.y as f32)
}

/// Returns the point of the world at a position on the screen.
pub fn in_world(window: &Window, at: Pos2) -> DVec2 {
    let px = at - canvas(window).min;
    window.state().view().camera.unwrap().world_from_screen(dvec2(px.x.into(), px.y.into()))
}

pub fn button_event(pos: Pos2, button: PointerButton, pressed: bool, modifiers: Modifiers) -> Event {
    Event::PointerButton { pos, button, pressed, modifiers }
}

pub fn press(window: &mut Window, world: DVec2, modifiers: Modifiers) {
    let pos = on_screen(window, world);
    press_at(window, pos, PointerButton::Primary, modifiers);
}

pub fn press_at(window: &mut Window, pos: Pos2, button: PointerButton, modifiers: Modifiers) {
    window.event(Event::ModifiersChanged(modifiers));
    window.event(Event::PointerMoved(pos));
    window.event(button_event(pos, button, true, modifiers));
    window.run();
}

pub fn move_to(window: &mut Window, world: DVec2) {
    let pos = on_screen(window, world);
    window.event(Event::PointerMoved(pos));
    window.run();
}

pub fn release(window: &mut Window, world: DVec2) {
    let pos = on_screen(window, world);
    release_at(window, pos, PointerButton::Primary);
}

pub fn release_at(window: &mut Window, pos: Pos2, button: PointerButton) {
    window.event(button_event(pos, button, false, Modifiers::NONE));
    window.event(Event::ModifiersChanged(Modifiers::NONE));
    window.run();
}

pub fn click(window: &mut Window, world: DVec2, modifiers: Modifiers) {
    press(window, world, modifiers);
    release(window, world);
}

pub fn stroke(window: &mut Window, from: DVec2, to: DVec2) {
    press(window, from, Modifiers::NONE);
    for i in 1..=5 {
        move_to(window, from.lerp(to, f64::from(i) / 5.0));
    }
    release(window, to);
}

pub fn key(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run();
}

pub fn triangles(window: &Window) -> usize {
    window.state().session().mesh().raw_triangle_count()
}

pub fn fingerprint(window: &Window) -> Fingerprint {
    window.state().session().mesh().fingerprint()
}

pub fn settings(window: &Window) -> &Settings {
    window.state().session().document().settings()
}

pub fn entries(window: &Window) -> usize {
    window.state().session().document().history().len()
}

pub fn notice(window: &Window) -> String {
    window.state().session().notices().shown().map_or(String::new(), |notice| notice.text.clone())
}

/// Returns the level of the triangle round a point.
pub fn level_at(window: &Window, world: DVec2) -> u32 {
    let mesh = window.state().session().mesh();
    mesh.triangle(mesh.locate(world).triangle().expect("a point of the domain")).level()
}

pub fn selected(window: &Window) -> Option<TriangleId> {
    let readout = window.state().session().readout(window.state().view().quantity)?;
    readout.location.triangle()
}

pub fn type_into(window: &mut Window, name: &str, text: &str) {
    find(window, Role::TextInput, name);
    window.get_by_role_and_label(Role::TextInput, name).focus();
    window.run();
    key(window, Modifiers::COMMAND, Key::A);
    window.get_by_role_and_label(Role::TextInput, name).type_text(text);
    window.run();
    key(window, Modifiers::NONE, Key::Enter);
}

pub fn choose(window: &mut Window, menu: &str, entry: &str) {
    open_menu(window, menu);
    window.get_by_role_and_label(Role::Button, entry).click();
    window.run();
}

/// Runs a command of a menu within a menu.
pub fn choose_within(window: &mut Window, menu: &str, submenu: &str, entry: &str) {
    open_menu(window, menu);
    let buttons = window.get_all_by_role_and_label(Role::Button, submenu);
    // The docks at the right can have a button of that name.
    buttons.min_by(|a, b| a.rect().left().total_cmp(&b.rect().left())).unwrap().click();
    window.run();
    window.get_by_role_and_label(Role::Button, entry).click();
    window.run();
}

/// Runs a command that is in no menu: the palette has it.
pub fn choose_in_palette(window: &mut Window, title: &str) {
    key(window, Modifiers::COMMAND, Key::P);
    window.event(Event::Text(title.to_owned()));
    window.run();
    key(window, Modifiers::NONE, Key::Enter);
}

/// Opens a menu of the bar; sections of the panel may have the same name.
pub fn open_menu(window: &mut Window, menu: &str) {
    let named = window.get_all_by_role_and_label(Role::Button, menu);
    named.min_by(|a, b| a.rect().top().total_cmp(&b.rect().top())).unwrap().click();
    window.run();
}

pub fn value_of(window: &Window, role: Role, name: &str) -> String {
    window.get_by_role_and_label(role, name).value().unwrap_or_default()
}

pub fn wheel(window: &mut Window, at: Pos2, delta: f32) {
    wheel_with(window, at, delta, Modifiers::NONE);
}

pub fn wheel_with(window: &mut Window, at: Pos2, delta: f32, modifiers: Modifiers) {
    window.event(Event::ModifiersChanged(modifiers));
    window.event(Event::PointerMoved(at));
    window.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: vec2(0.0, delta),
        modifiers,
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
    });
    window.run();
    window.event(Event::ModifiersChanged(Modifiers::NONE));
    window.run();
}

/// Returns the area of the mesh.
pub fn area(window: &Window) -> f64 {
    window.state().session().mesh().area()
}

pub fn scratch(name: &str) -> PathBuf {
    fs::create_dir_all(FOLDER).unwrap();
    PathBuf::from(FOLDER).join(name)
}

/// Runs frames until something is so. Between them it waits for what jobs send.
#[track_caller]
pub fn wait_until(window: &mut Window, is_so: impl Fn(&Window) -> bool) {
    window.run();
    wait(window, |window| _ = window.run(), is_so);
}

/// As [`wait_until`], and looks at each single frame.
#[track_caller]
pub fn step_until(window: &mut Window, is_so: impl Fn(&Window) -> bool) {
    wait(window, Window::step, is_so);
}

#[track_caller]
fn wait(window: &mut Window, frames: impl Fn(&mut Window), is_so: impl Fn(&Window) -> bool) {
    let patience = Instant::now() + Duration::from_secs(120);
    while !is_so(window) {
        assert!(Instant::now() < patience, "it did not happen; shown: {}", notice(window));
        window.state().jobs.wait_for_news(Duration::from_millis(5));
        frames(window);
    }
}

/// Runs frames until no job is left.
pub fn wait_for_jobs(window: &mut Window) {
    loop {
        let started = window.state().jobs.started();
        window.state().jobs.wait_for_threads();
        window.run();
        // What a job finds can let another one begin.
        if window.state().jobs.started() == started {
            return;
        }
    }
}

#[track_caller]
pub fn wait_for_notice(window: &mut Window) -> String {
    wait(window, |window| _ = window.run(), |window| !notice(window).is_empty());
    notice(window)
}

/// Returns the tag beside the brush ring.
pub fn price_tag(window: &Window) -> Option<String> {
    let mut tags = window.query_all_by_role(Role::Label).filter_map(|node| node.accesskit_node().value());
    tags.find(|label| {
        ["+", "−", "over", "frees", "no change", "counting"].iter().any(|start| label.starts_with(start))
    })
}

pub fn hover(window: &mut Window, world: DVec2) -> Option<String> {
    move_to(window, world);
    price_tag(window)
}
/// Returns an empty folder of its own for each test `name` of the file `of`.
pub fn folder(of: &str, name: &str) -> PathBuf {
    let folder = scratch(of).join(name);
    let _ = fs::remove_dir_all(&folder); // absent at the first run
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// A short vertical stroke at an x of the unit square.
pub fn paint(window: &mut Window, x: f64) {
    send(window, Command::from(BrushCommand::BeginStroke(dvec2(x, 0.5))));
    send(window, Command::from(BrushCommand::DrawTo(dvec2(x, 0.6))));
    send(window, Command::from(BrushCommand::EndStroke));
}

/// Returns the selected layer.
pub fn active(window: &Window) -> &Layer {
    document(window).active_layer().expect("a selected layer")
}

/// Clicks on a button of the docks or of the strip. The window has no other button of that name outside
/// menus.
pub fn click_button(window: &mut Window, name: &str) {
    find(window, Role::Button, name);
    window.get_by_role_and_label(Role::Button, name).click();
    window.run();
}

pub fn document(window: &Window) -> &Document {
    window.state().session().document()
}

/// Functions for tests only.
impl App {
    pub fn session(&self) -> &Session {
        &self.session
    }

    pub fn tools(&self) -> &Tools {
        &self.tools
    }

    pub fn view(&self) -> &View {
        &self.view
    }

    pub fn paths(&self) -> &PathFinder {
        &self.features.get::<Paths>().finder
    }

    pub fn features(&self) -> &Features {
        &self.features
    }

    pub fn stepping(&self) -> Option<&Steps> {
        self.features.get::<Stepping>().steps()
    }

    pub fn is_cutting(&self) -> bool {
        self.session.is_cutting()
    }
}
