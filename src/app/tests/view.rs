//! Zoom, panels, theme and layout.

use eframe::egui::accesskit::Role;
use eframe::egui::{
    Event, Key, Modifiers, PointerButton, Pos2, Rect, TouchDeviceId, TouchId, TouchPhase, pos2, vec2,
};
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use super::{
    RESTING_PLACE, TALL, Window, canvas, choose_within, document, entries, in_world, key, on_screen,
    open_popup, open_tab, press_at, release_at, send, settings, wheel, window, window_of,
};
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_render::colormap::Ground;

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
fn two_fingers_move_and_zoom_the_view_and_take_back_the_stroke_of_the_first() {
    let mut window = window();
    let touch = |window: &mut Window, id: u64, phase: TouchPhase, pos: Pos2| {
        window.event(Event::Touch { device_id: TouchDeviceId(0), id: TouchId(id), phase, pos, force: None });
    };
    let from = [-60.0, 60.0].map(|x| canvas(&window).center() + vec2(x, 0.0));
    let to = [vec2(-20.0, 30.0), vec2(80.0, 30.0)];
    touch(&mut window, 1, TouchPhase::Start, from[0]);
    press_at(&mut window, from[0], PointerButton::Primary, Modifiers::NONE);
    window.event(Event::PointerMoved(from[0] + vec2(3.0, 3.0)));
    window.run();
    assert!(document(&window).stroke().is_some(), "one finger paints");
    touch(&mut window, 2, TouchPhase::Start, from[1]);
    press_at(&mut window, from[0], PointerButton::Primary, Modifiers::NONE);
    let held = from.map(|at| in_world(&window, at));
    for (n, by) in to.into_iter().enumerate() {
        touch(&mut window, n as u64 + 1, TouchPhase::Move, from[n] + by);
    }
    window.event(Event::PointerMoved(from[0] + to[0]));
    window.run();
    let px = window.state().view().camera.unwrap().px_per_world();
    for (n, by) in to.into_iter().enumerate() {
        let off = in_world(&window, from[n] + by).distance(held[n]) * px;
        assert!(off < 0.5, "finger {n} is {off} pixels off its place");
    }
    for (n, by) in to.into_iter().enumerate() {
        touch(&mut window, n as u64 + 1, TouchPhase::End, from[n] + by);
        release_at(&mut window, from[0] + to[0], PointerButton::Primary);
    }
    assert!(document(&window).stroke().is_none());
    assert_eq!(entries(&window), 0, "nothing was painted");
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

    // Not beyond the rim of the domain, where the view ends.
    key(&mut window, Modifiers::NONE, Key::Home);
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
fn ctrl_b_hides_the_panels_and_brings_them_back() {
    let mut window = window();
    let narrow = canvas(&window);
    key(&mut window, Modifiers::COMMAND, Key::B);
    assert!(!window.state().view().panels);
    assert!(canvas(&window).width() > narrow.width() + 300.0);
    assert!(window.query_by_label("Levels").is_none());
    key(&mut window, Modifiers::COMMAND, Key::B);
    assert_eq!(canvas(&window), narrow);
}

#[test]
fn a_hovered_level_is_shown_alone_and_hiding_the_panels_ends_that() {
    let mut window = window_of(TALL);
    let legend = |window: &Window, level: u32| {
        let count = window.state().session().level_counts()[level as usize];
        let count = meshbrush_ui::widgets::format::count(count as u64);
        window.get_by_label(&format!("Level {level}: {count} triangles")).rect().center()
    };
    open_tab(&mut window, Tab::Mesh);
    let style = |window: &Window| window.state().view().style(settings(window), 0, 1.0).shown_levels;
    assert_eq!(style(&window), u64::MAX);
    for level in [4, 7] {
        window.hover_at(legend(&window, level));
        window.run();
        assert_eq!(style(&window), 1 << level);
    }
    key(&mut window, Modifiers::COMMAND, Key::B);
    assert_eq!(style(&window), u64::MAX, "no legend, no lone level");
    key(&mut window, Modifiers::COMMAND, Key::B);
    window.hover_at(RESTING_PLACE);
    window.run();
    assert_eq!(style(&window), u64::MAX);
}

#[test]
fn the_theme_switches_by_menu_and_by_the_view_options() {
    let mut window = window_of(TALL);
    assert_eq!(window.state().view().ground, Ground::Dark);
    choose_within(&mut window, "View", "Theme", "Light theme");
    assert_eq!(window.state().view().ground, Ground::Light);
    open_popup(&mut window, "View options");
    window.get_by_role_and_label(Role::RadioButton, "Dark").click();
    window.run();
    assert_eq!(window.state().view().ground, Ground::Dark);
}

#[test]
fn the_bars_have_room_for_what_they_show_at_any_width() {
    for width in [800.0, 900.0, 940.0, 1000.0, 1100.0, 1440.0] {
        for zoom in [1.0, 1e6] {
            let mut window = window_of(vec2(width, 600.0));
            window.hover_at(canvas(&window).center());
            send(&mut window, Command::from(ViewCommand::Zoom(zoom)));
            let screen = Rect::from_min_size(Pos2::ZERO, vec2(width, 600.0));
            // Rows of the side panel that are scrolled out of sight lie below the screen.
            let is_in_bar = |cell: &egui_kittest::Node<'_>| (570.0..600.0).contains(&cell.rect().top());
            let bottom = window.get_all_by_role(Role::Definition).filter(is_in_bar);
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

#[test]
fn a_fitted_view_is_fitted_to_another_size_at_once() {
    use meshbrush_kit::kit::view::View;
    let window = window();
    let lattice = window.state().session().mesh().lattice();
    let mut view = View::default();
    let mut fitted = |size: [u32; 2]| {
        view.fit_camera(lattice, size, 20.0, 0.0);
        view.camera.unwrap()
    };
    for size in [[800, 600], [400, 300], [1600, 300]] {
        let seen = fitted(size).visible_world();
        let bounds = lattice.bounds();
        assert_eq!(fitted(size), fitted(size));
        assert!(seen.contains(bounds.min) && seen.contains(bounds.max), "{size:?}: {seen:?}");
        let px = fitted(size).px_per_world() * bounds.size().max_element();
        assert!((px - f64::from(size[0].min(size[1])) + 40.0).abs() < 1.0, "as large as there is room: {px}");
    }
}
