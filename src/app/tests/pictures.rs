//! Checks of the drawing by its pictures.

use std::sync::Arc;

use eframe::egui::{Context, Key, Modifiers, Pos2, ThemePreference, Vec2, vec2};
use egui_kittest::Harness;
use glam::dvec2;

use super::{
    FREE, PAINTED_RISK, RESTING_PLACE, Window, canvas, key, on_screen, scratch, send, set, settings, stroke,
    wait_for_jobs,
};
use crate::app::App;
use meshbrush_core::document::{self, Setting};
use meshbrush_core::layers::{DistanceLayer, DistanceTo, LayerId, LayerKind, Mask, ShapeList, Shapes};
use meshbrush_kit::kit::command::{Command, LayerCommand, ViewCommand};
use meshbrush_kit::kit::view::FieldOverlay;

/// Returns a window whose canvas is drawn, on the software driver. Slower: only for what is judged by its
/// picture.
pub fn drawn_window() -> Window {
    window_drawn_by(|_, _| {})
}

/// Returns the window of [`drawn_window`], with an app that `ready` prepared.
pub fn window_drawn_by(ready: fn(&mut App, &Context)) -> Window {
    drawn_window_of(vec2(1100.0, 700.0), ready)
}

/// Returns a window of `size` points that is drawn, with an app that `ready` prepared.
pub fn drawn_window_of(size: Vec2, ready: fn(&mut App, &Context)) -> Window {
    let mut setup = egui_kittest::wgpu::default_wgpu_setup();
    if let eframe::egui_wgpu::WgpuSetup::CreateNew(create) = &mut setup {
        create.device_descriptor = Arc::new(meshbrush_render::render::gpu::device_descriptor);
    }
    let mut window = Harness::builder()
        .with_size(size)
        .with_max_steps(4000)
        .with_render_cursor(false)
        .wgpu_setup(setup)
        .build_eframe(move |cc| {
            let mut app = App::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref()).unwrap();
            ready(&mut app, &cc.egui_ctx);
            app
        });
    window.run();
    window
}

/// A picture of the window: rows from the top, four bytes per pixel.
pub struct Picture {
    pub width: usize,
    pub rgba: Vec<u8>,
}

pub fn picture(window: &mut Window) -> Picture {
    let image = window.render().unwrap();
    Picture { width: image.width() as usize, rgba: image.into_raw() }
}

/// Writes the window into the folder that `MESHBRUSH_SCREENS` names, for a look.
pub fn write_for_a_look(window: &mut Window, name: &str) {
    let Some(folder) = std::env::var_os("MESHBRUSH_SCREENS") else { return };
    let file = std::path::PathBuf::from(folder).join(name).with_extension("png");
    let image = window.render().unwrap();
    let size = [image.width(), image.height()];
    let written = meshbrush_io::io::write_file(&file, |mut out| {
        meshbrush_io::io::png::write_small(&mut out, size, &image.into_raw())
    });
    written.unwrap();
}

pub fn pixel(picture: &Picture, at: Pos2) -> [u8; 3] {
    let start = 4 * (at.y.round() as usize * picture.width + at.x.round() as usize);
    picture.rgba[start..start + 3].try_into().unwrap()
}

fn is_colorful([r, g, b]: [u8; 3]) -> bool {
    r.max(g).max(b) - r.min(g).min(b) > 40
}

/// Returns how many pixels within `radius` points of `middle` are coloured as a refined level.
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
fn the_ring_around_the_pointer_has_the_radius_of_the_brush() {
    let mut window = drawn_window();
    let at = on_screen(&window, FREE);
    window.hover_at(at);
    window.run();
    let scale = window.state().view().camera.unwrap().px_per_world();
    let radius = (window.state().tools().radius * scale) as f32;
    assert!(radius > 20.0);
    let image = picture(&mut window);
    let brightest = |distance: f32| {
        let ring = (-1..=1).map(|offset| pixel(&image, at - vec2(distance + offset as f32, 0.0))[0]);
        ring.max().unwrap()
    };
    assert!(brightest(radius) > 200, "{}", brightest(radius));
    assert!(brightest(radius - 8.0) < 150 && brightest(radius + 8.0) < 150);
}

#[test]
fn an_overlay_and_the_light_theme_are_seen_on_the_canvas() {
    let mut window = drawn_window();
    window.hover_at(RESTING_PLACE);
    window.run();
    let at = on_screen(&window, dvec2(0.72, 0.74));
    let plain = picture(&mut window);
    send(&mut window, Command::from(ViewCommand::SetOverlay(FieldOverlay::Risk)));
    // Its colours are computed on another thread.
    wait_for_jobs(&mut window);
    let [r, g, _] = pixel(&picture(&mut window), at);
    assert!(r > g, "risk is warm");
    send(&mut window, Command::from(ViewCommand::SetOverlay(FieldOverlay::None)));
    assert_eq!(pixel(&picture(&mut window), at), pixel(&plain, at));
    send(&mut window, Command::from(ViewCommand::Theme(ThemePreference::Light)));
    let light = picture(&mut window);
    let corner = canvas(&window).left_top() + vec2(3.0, 3.0);
    assert!(pixel(&plain, corner)[0] < 40 && pixel(&light, corner)[0] > 180);
}

#[test]
fn a_background_picture_shows_through_the_fill_and_edges_stay_dark() {
    let mut window = drawn_window();
    window.hover_at(RESTING_PLACE);
    window.run();
    let plain = picture(&mut window);
    let bounds = settings(&window).domain.bounds;
    let red = Arc::new(document::Picture { size: [1, 1], rgba: vec![240, 30, 20, 255] });
    let background =
        |opacity| document::Background { name: "red".into(), picture: red.clone(), bounds, opacity };
    let at = on_screen(&window, FREE) + vec2(3.0, 1.0);
    let mut shown = |opacity| {
        set(&mut window, Setting::Background(Some(background(opacity))));
        picture(&mut window)
    };
    assert_eq!(pixel(&shown(1.0), at), [240, 30, 20], "the picture alone");
    let half = pixel(&shown(0.5), at);
    let expected = (u32::from(pixel(&plain, at)[0]) + 240) / 2;
    assert!(u32::from(half[0]).abs_diff(expected) <= 2, "{half:?} is the mean of {expected}");
    // Edges keep their own colour: pixels along a row are not all the picture's.
    let image = shown(1.0);
    let row = (-40..40).map(|x| pixel(&image, at + vec2(x as f32, 0.0)));
    assert!(row.clone().any(|color| color[0] < 120), "{:?}", row.collect::<Vec<_>>());
}

#[test]
fn the_canvas_shows_the_mask_and_the_shapes_of_the_selected_layer() {
    let mut window = drawn_window();
    let corners = [dvec2(0.7, 0.3), dvec2(0.95, 0.3), dvec2(0.95, 0.7), dvec2(0.7, 0.7)];
    let mask = Mask::new(&[vec![corners.to_vec()]]).unwrap();
    send(&mut window, Command::from(LayerCommand::Mask(PAINTED_RISK, Some(mask))));
    window.hover_at(RESTING_PLACE);
    let at = on_screen(&window, dvec2(0.95, 0.5));
    let mut shown = |command| {
        send(&mut window, Command::from(command));
        picture(&mut window)
    };
    assert!(colorful(&shown(LayerCommand::Select(PAINTED_RISK)), at, 3) >= 7, "a line of the accent colour");
    assert_eq!(colorful(&shown(LayerCommand::Select(LayerId(0))), at, 3), 0, "another layer is selected");
    shown(LayerCommand::Select(PAINTED_RISK));
    assert_eq!(colorful(&shown(LayerCommand::Show(PAINTED_RISK, false)), at, 3), 0, "the layer is hidden");

    let points = vec![dvec2(0.8, 0.4)];
    let list = ShapeList { points, lines: vec![vec![corners[1], corners[2]]], ..ShapeList::default() };
    let to = DistanceTo::Shapes { name: String::new(), shapes: Shapes::new(list, true).unwrap() };
    let distance = LayerKind::Distance(DistanceLayer { to, at_zero: 1.0, slope: 0.0, range: 1.0 });
    let drawn = shown(LayerCommand::Add(Box::new(distance)));
    let plain = shown(LayerCommand::Select(LayerId(0)));
    for place in [at, on_screen(&window, dvec2(0.8, 0.4))] {
        let whitest = |image: &Picture| {
            (-2..=2).map(|x| pixel(image, place + vec2(x as f32, 0.0)).into_iter().min()).max().flatten()
        };
        assert!(whitest(&drawn) > Some(235) && whitest(&plain) < Some(200), "{:?}", whitest(&plain));
    }
}

#[test]
#[ignore = "draws all 20 twice: sh tests/long"]
fn the_screenshots_are_the_same_every_time() {
    let take = |name: &str| {
        let folder = scratch(name);
        let files = crate::app::write_screenshots(&folder).unwrap();
        files.iter().map(|file| std::fs::read(file).unwrap()).collect::<Vec<_>>()
    };
    let (first, second) = std::thread::scope(|scope| {
        let second = scope.spawn(|| take("screenshots-2"));
        (take("screenshots-1"), second.join().unwrap())
    });
    assert_eq!(first.len(), 20);
    assert!(first == second, "the same commands, another picture");
}
