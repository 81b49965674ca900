//! The view in space: turning it, and acting on the surface in it.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use super::links::{copied, open};
use super::{
    Window, canvas, entries, key, notice, open_popup, press_at, release_at, scratch, send, settings,
    type_into, wait_for_jobs, wheel, window,
};
use crate::app::canvas::space_sight;
use crate::app::features::inspection::QUERY;
use meshbrush_core::document::Setting;
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{Layer, LayerId, Surface, SurfaceGoal, SurfaceNorm, SurfaceSource};
use meshbrush_kit::kit::command::{
    Command, EditCommand, FileCommand, ShellCommand, SpaceCommand, ViewCommand,
};
use meshbrush_kit::kit::heights::SpaceSight;
use meshbrush_kit::kit::marks::point_from_px;
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_render::scene::ViewDirection;

/// Shows the hills of a formula in space.
fn hills() -> Window {
    let mut window = window();
    let surface = Surface {
        source: SurfaceSource::Formula(Formula::parse("sin(9 * x) * cos(7 * y)").unwrap()),
        goal: SurfaceGoal::Within(0.05),
        norm: SurfaceNorm::Largest,
    };
    let mut layers = settings(&window).layers.clone();
    layers.push(Layer::new(LayerId(70), "Hills", surface));
    send(&mut window, Command::from(EditCommand::Set(Setting::Layers(layers))));
    send(&mut window, Command::from(EditCommand::EndGesture));
    wait_for_jobs(&mut window);
    key(&mut window, Modifiers::SHIFT, Key::V);
    wait_for_jobs(&mut window);
    window
}

fn sight(window: &Window) -> SpaceSight<'_> {
    space_sight(window.state().view(), window.state().session()).expect("the view is in space")
}

/// Where a place of the plan is on the screen, in points.
fn seen(window: &Window, world: DVec2) -> Pos2 {
    point_from_px(canvas(window), sight(window).screen(world), window.ctx.pixels_per_point())
}

fn drag(window: &mut Window, button: PointerButton, modifiers: Modifiers, by: [f32; 2]) {
    let from = canvas(window).center();
    press_at(window, from, button, modifiers);
    window.event(Event::PointerMoved(from + vec2(by[0], by[1])));
    window.run();
    release_at(window, from + vec2(by[0], by[1]), button);
    window.run();
}

#[test]
fn a_picture_of_the_mesh_is_in_space_as_the_view_is() {
    let mut window = hills();
    let picture = |window: &mut Window, name: &str| {
        let file = scratch(name);
        send(window, Command::from(FileCommand::Export(file.clone())));
        wait_for_jobs(window);
        std::fs::read(&file).ok()
    };
    let default = picture(&mut window, "app-space.png").unwrap();
    send(
        &mut window,
        Command::from(ViewCommand::Space(SpaceCommand::LookFrom(ViewDirection {
            azimuth: 120.0,
            altitude: 30.0,
        }))),
    );
    let turned = picture(&mut window, "app-space-turned.png").unwrap();
    assert!(default != turned);
    assert_eq!(picture(&mut window, "app-space.svg"), None, "only pixels show what is hidden");
    key(&mut window, Modifiers::SHIFT, Key::V);
    let plan = picture(&mut window, "app-space-plan.png").unwrap();
    assert!(plan != default && picture(&mut window, "app-space-plan.svg").is_some());
}

#[test]
fn a_link_shows_the_same_view_in_space() {
    let mut first = hills();
    let exaggerated = SpaceCommand::Exaggerate(Some(0.3));
    send(&mut first, Command::from(ViewCommand::Space(exaggerated)));
    drag(&mut first, PointerButton::Middle, Modifiers::NONE, [50.0, -20.0]);
    let at = canvas(&first).center() + vec2(90.0, 40.0);
    wheel(&mut first, at, 300.0);
    wait_for_jobs(&mut first);
    let link = copied(&mut first);
    let mut second = window();
    open(&mut second, &link);
    wait_for_jobs(&mut second);
    let [shown, expected] = [&second, &first].map(|window| sight(window).camera);
    assert_eq!(shown.direction(), expected.direction());
    let places = [dvec2(0.2, 0.3), dvec2(0.5, 0.5), dvec2(0.8, 0.6)];
    for place in places {
        let distance = seen(&second, place).distance(seen(&first, place));
        assert!(distance < 0.1, "{place}: {distance}");
    }
    // A link without it shows the plan.
    key(&mut first, Modifiers::SHIFT, Key::V);
    let link = copied(&mut first);
    open(&mut second, &link);
    assert!(!second.state().view().space.is_on);
}

#[test]
fn the_key_shows_the_surface_and_escape_the_plan() {
    let mut window = hills();
    let before = window.state().view().camera;
    assert!(window.state().view().space.is_on && window.state().view().space_view().is_some());
    key(&mut window, Modifiers::NONE, Key::Escape);
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(!window.state().view().space.is_on);
    assert_ne!(window.state().view().camera, before, "the plan is fitted again");
}

#[test]
fn a_document_without_heights_says_what_is_missing() {
    let mut window = window();
    key(&mut window, Modifiers::SHIFT, Key::V);
    wait_for_jobs(&mut window);
    assert!(window.query_by_label_contains("no heights to show in space").is_some());
}

#[test]
fn middle_drags_turn_and_with_shift_they_pan() {
    let mut window = hills();
    let before = sight(&window).camera;
    drag(&mut window, PointerButton::Middle, Modifiers::NONE, [50.0, 20.0]);
    let turned = sight(&window).camera.direction();
    assert!((turned.azimuth - before.direction().azimuth - 20.0).abs() < 1e-3, "{turned:?}");
    assert!((turned.altitude - before.direction().altitude - 6.0).abs() < 1e-3, "{turned:?}");
    let held = canvas(&window).center();
    let world = sight(&window).camera.world_from_screen(sight(&window).camera.plan().half_size_px());
    drag(&mut window, PointerButton::Middle, Modifiers::SHIFT, [50.0, 20.0]);
    let now = sight(&window).camera;
    let px = now.screen_from_world(world, now.height());
    let moved = point_from_px(canvas(&window), px, window.ctx.pixels_per_point());
    assert!(moved.distance(held + vec2(50.0, 20.0)) < 0.1, "{moved}");
    assert_eq!(now.direction(), turned);
    key(&mut window, Modifiers::NONE, Key::Home);
    assert_eq!(sight(&window).camera.direction(), turned, "Home keeps the direction");
    assert!(window.state().view().is_fitted);
}

#[test]
fn the_wheel_keeps_the_point_of_the_surface_under_the_pointer() {
    let mut window = hills();
    let world = dvec2(0.3, 0.4);
    let at = seen(&window, world);
    for _ in 0..3 {
        wheel(&mut window, at, 60.0);
    }
    let factor = sight(&window).camera.plan().px_per_world();
    assert!(seen(&window, world).distance(at) < 0.1, "{} {at} at {factor}", seen(&window, world));
}

#[test]
fn strokes_queries_and_pins_meet_the_surface() {
    let mut window = hills();
    for world in [dvec2(0.3, 0.42), dvec2(0.71, 0.65)] {
        let at = seen(&window, world);
        window.event(Event::PointerMoved(at));
        window.run();
        let under = sight(&window).world({
            let offset = at - canvas(&window).min;
            dvec2(f64::from(offset.x), f64::from(offset.y)) * f64::from(window.ctx.pixels_per_point())
        });
        // A point behind a hill shows what is in front of it.
        if under.distance(world) > 1e-3 {
            continue;
        }
        let edits = entries(&window);
        press_at(&mut window, at, PointerButton::Primary, Modifiers::NONE);
        release_at(&mut window, at, PointerButton::Primary);
        wait_for_jobs(&mut window);
        assert_eq!(entries(&window), edits + 1, "a dab of the brush");
        let painted = window.state().tools().last_painted.unwrap();
        assert!(painted.distance(world) < 1e-3, "{painted} is not {world}");
    }
    send(&mut window, Command::from(ShellCommand::Use(&QUERY)));
    let at = seen(&window, dvec2(0.3, 0.42));
    press_at(&mut window, at, PointerButton::Primary, Modifiers::NONE);
    release_at(&mut window, at, PointerButton::Primary);
    window.run();
    let queried = window.state().session().queried().expect("a triangle is inspected");
    assert!(queried.distance(dvec2(0.3, 0.42)) < 1e-3, "{queried}");
}

#[test]
fn other_tools_say_that_they_work_in_the_plan() {
    let mut window = hills();
    key(&mut window, Modifiers::NONE, Key::D);
    let edits = entries(&window);
    drag(&mut window, PointerButton::Primary, Modifiers::NONE, [50.0, 20.0]);
    assert!(notice(&window).contains("works in the plan"), "{}", notice(&window));
    assert_eq!(entries(&window), edits);
}

#[test]
fn hints_and_legend_are_those_of_the_view() {
    let mut window = hills();
    assert!(window.query_by_label_contains("Space pans").is_none());
    send(&mut window, Command::from(ViewCommand::SetOverlay(FieldOverlay::Surface)));
    window.run();
    assert!(window.query_by_label_contains("overlays are shown in the plan").is_some());
    key(&mut window, Modifiers::SHIFT, Key::V);
    window.run();
    assert!(window.query_by_label_contains("Space pans").is_some());
    assert!(window.query_by_label_contains("Legend: surface").is_some());
}

#[test]
fn heights_and_light_are_numbers() {
    let mut window = hills();
    let default = sight(&window).camera.exaggeration();
    send(&mut window, Command::from(ViewCommand::Space(SpaceCommand::Exaggerate(Some(3.0 * default)))));
    assert!((sight(&window).camera.exaggeration() / default - 3.0).abs() < 1e-9);
    send(&mut window, Command::from(ViewCommand::Space(SpaceCommand::Exaggerate(None))));
    assert_eq!(sight(&window).camera.exaggeration(), default);
    open_popup(&mut window, "View options");
    let fields = ["Heights ×", "Look to", "From above", "Light from", "Light above"];
    for (name, typed) in fields.into_iter().zip(["12", "40", "35", "100", "20"]) {
        type_into(&mut window, name, typed);
    }
    let space = &window.state().view().space;
    let (seen, light) = (space.direction, space.light);
    assert_eq!(space.exaggeration, Some(12.0));
    assert_eq!([seen.azimuth, seen.altitude, light.azimuth, light.altitude], [40.0, 35.0, 100.0, 20.0]);
    send(&mut window, Command::from(ViewCommand::Space(SpaceCommand::Toggle)));
    assert!(
        window.query_by_role_and_label(Role::TextInput, "Look to").is_none(),
        "the plan has no direction"
    );
}

#[test]
fn centring_a_place_puts_the_surface_there_in_the_middle() {
    let mut window = hills();
    send(&mut window, Command::from(ViewCommand::Zoom(4.0)));
    for world in [dvec2(0.17, 0.1), dvec2(0.6, 0.5)] {
        send(&mut window, Command::from(ViewCommand::LookAt(world)));
        window.run();
        let off = seen(&window, world).distance(canvas(&window).center());
        assert!(off < 1.0, "{world} is {off} points from the middle");
    }
}
