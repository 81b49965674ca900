//! The mode for a projector, and small windows.

use eframe::App as _;
use eframe::egui::accesskit::Role;
use eframe::egui::{Context, Key, Modifiers, Pos2, RawInput, Rect, pos2, vec2};
use egui_kittest::kittest::Queryable as _;

use super::pictures::{drawn_window, picture};
use super::{Kept, Window, canvas, choose_in_palette, key, window, window_of};
use crate::app::features::ROWS;
use crate::app::kept::end_last_presentation;
use meshbrush_kit::kit::all_tools;

/// Returns the button of a tool; a section of the side panel can have the same name.
fn tool_button(window: &Window, name: &str) -> Option<Rect> {
    let named = window.query_all_by_role_and_label(Role::Button, name).map(|button| button.rect());
    named.filter(|rect| rect.right() < 60.0).min_by(|a, b| a.left().total_cmp(&b.left()))
}

#[test]
fn keys_change_the_size_of_the_interface_once_a_press_and_the_palette_finds_them() {
    let mut window = window();
    for (pressed, scale) in
        [(Key::Plus, 1.1), (Key::Equals, 1.2), (Key::Minus, 1.1), (Key::Num0, 1.0), (Key::Minus, 0.9)]
    {
        key(&mut window, Modifiers::COMMAND, pressed);
        assert_eq!(window.ctx.zoom_factor(), scale, "{pressed:?}");
    }
    choose_in_palette(&mut window, "ui scale reset");
    assert_eq!(window.ctx.zoom_factor(), 1.0);
}

#[test]
fn a_presentation_is_larger_and_has_one_panel_at_most() {
    let mut window = window();
    let has_side_panel = |window: &Window| window.query_by_label("Size and risk").is_some();
    assert!(tool_button(&window, "Eraser").is_some() && has_side_panel(&window));
    key(&mut window, Modifiers::NONE, Key::F5);
    assert_eq!(window.ctx.zoom_factor(), 1.5);
    assert!(tool_button(&window, "Eraser").is_none() && !has_side_panel(&window));
    key(&mut window, Modifiers::COMMAND, Key::B);
    assert!(tool_button(&window, "Eraser").is_none() && has_side_panel(&window), "one panel");
    key(&mut window, Modifiers::COMMAND, Key::B);
    key(&mut window, Modifiers::NONE, Key::F5);
    assert_eq!(window.ctx.zoom_factor(), 1.0);
    assert!(tool_button(&window, "Eraser").is_some() && has_side_panel(&window), "as before");
}

/// Returns the middle of all pixels in the colour of the ring, in points; `None` where there are few.
fn ring(window: &mut Window) -> Option<Pos2> {
    let image = picture(window);
    let ring = image.rgba.chunks_exact(4).enumerate().filter(|(_, color)| color[..3] == [0xff, 0xd2, 0x3f]);
    let places: Vec<_> =
        ring.map(|(i, _)| pos2((i % image.width) as f32, (i / image.width) as f32)).collect();
    let sum = places.iter().fold(vec2(0.0, 0.0), |sum, place| sum + place.to_vec2());
    let px_per_point = window.ctx.pixels_per_point();
    (places.len() > 60).then(|| (sum / places.len() as f32 / px_per_point).to_pos2())
}

#[test]
fn in_a_presentation_a_ring_is_around_the_pointer() {
    let mut window = drawn_window();
    let at = pos2(480.0, 300.0);
    window.hover_at(at);
    window.run();
    assert_eq!(ring(&mut window), None);
    key(&mut window, Modifiers::NONE, Key::F5);
    let middle = ring(&mut window).expect("a ring");
    assert!(middle.distance(at) < 2.0, "{middle}");
    key(&mut window, Modifiers::NONE, Key::F5);
    assert_eq!(ring(&mut window), None);
}

#[test]
fn a_presentation_ends_with_the_program() {
    let (mut window, mut stored) = (window(), Kept::default());
    key(&mut window, Modifiers::NONE, Key::F5);
    window.state_mut().save(&mut stored);
    // egui keeps its zoom factor from run to run.
    let next = Context::default();
    let frame = |next: &Context| next.run_ui(RawInput::default(), |_| {}).textures_delta.clear();
    next.set_zoom_factor(1.5);
    frame(&next);
    end_last_presentation(&stored, &next);
    frame(&next);
    assert_eq!(next.zoom_factor(), 1.0);
    key(&mut window, Modifiers::NONE, Key::F5);
    window.state_mut().save(&mut stored);
    next.set_zoom_factor(1.2);
    frame(&next);
    end_last_presentation(&stored, &next);
    frame(&next);
    assert_eq!(next.zoom_factor(), 1.2, "a zoom factor of the user stays");
}

/// 1920 × 1080 pixels at 200 % are 960 × 540 points.
#[test]
fn nothing_is_off_the_screen_of_1080_pixels_at_200_percent() {
    for size in [vec2(960.0, 540.0), vec2(800.0, 460.0)] {
        let mut window = window_of(size);
        let screen = Rect::from_min_size(Pos2::ZERO, size);
        for tool in all_tools(ROWS) {
            let button =
                tool_button(&window, tool.name).unwrap_or_else(|| panic!("no button for {}", tool.name));
            assert!(screen.contains_rect(button), "{} at {button}", tool.name);
        }
        let shown = canvas(&window);
        assert!(screen.contains_rect(shown) && shown.width() > 400.0 && shown.height() > 340.0, "{shown}");
        key(&mut window, Modifiers::COMMAND, Key::B);
        assert!(screen.contains_rect(canvas(&window)));
    }
}
