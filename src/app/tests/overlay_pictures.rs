//! Exported pictures have the colours and the legend of the overlay that the canvas shows.

use std::path::PathBuf;

use eframe::egui::{ThemePreference, pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use super::pictures::{drawn_window, drawn_window_of, picture, pixel};
use super::{
    FREE, RESTING_PLACE, Window, canvas, on_screen, scratch, send, set, settings, stroke, wait_for_jobs,
    wait_until, window,
};
use meshbrush_core::document::{Example, Picture, Setting};
use meshbrush_io::io::Meter;
use meshbrush_io::io::png::read_picture;
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand, SpaceCommand, ViewCommand};
use meshbrush_kit::kit::picture_choices::{PictureChoices, PictureColors};
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_render::render::furniture::Furniture;

fn export(window: &mut Window, name: &str) -> PathBuf {
    let file = scratch(name);
    send(window, Command::from(FileCommand::Export(file.clone())));
    wait_for_jobs(window);
    file
}

fn choose(window: &mut Window, change: impl FnOnce(&mut PictureChoices)) {
    let mut choices = window.state().view().picture;
    change(&mut choices);
    send(window, Command::from(ViewCommand::Picture(choices)));
}

fn show(window: &mut Window, overlay: FieldOverlay) {
    send(window, Command::from(ViewCommand::SetOverlay(overlay)));
    wait_for_jobs(window);
}

/// Returns the colour of a bare picture at a point of the world.
fn at(image: &Picture, window: &Window, world: DVec2) -> [u8; 3] {
    let bounds = settings(window).domain.bounds;
    let [width, height] = image.size;
    let px = (world - bounds.min) / bounds.size() * dvec2(f64::from(width), f64::from(height));
    let (x, y) = (px.x as usize, height as usize - 1 - px.y as usize);
    let begin = 4 * (y * width as usize + x);
    image.rgba[begin..begin + 3].try_into().unwrap()
}

/// Returns at how many places a picture has the colour of the canvas, and at how many of them both were
/// looked at.
fn compared(window: &mut Window, image: &Picture, places: &[DVec2]) -> [usize; 2] {
    let shown = picture(window);
    let inner = canvas(window).shrink(4.0);
    let (mut same, mut all) = (0, 0);
    for &world in places {
        let on_canvas = on_screen(window, world);
        // Not below legend, scale or hints.
        if !inner.contains(on_canvas) || on_canvas.x > inner.right() - 160.0 {
            continue;
        }
        let [a, b] = [pixel(&shown, pos2(on_canvas.x - 0.5, on_canvas.y - 0.5)), at(image, window, world)];
        all += 1;
        same += usize::from((0..3).all(|n| a[n].abs_diff(b[n]) <= 8));
    }
    [same, all]
}

#[test]
fn an_exported_picture_has_the_colours_of_the_canvas() {
    let mut window = drawn_window();
    stroke(&mut window, FREE, FREE);
    send(&mut window, Command::from(ViewCommand::ToggleEdges));
    choose(&mut window, |choices| (choices.furniture, choices.width_px) = (Furniture::NONE, 1000));
    let grid = (1..40).flat_map(|x| (1..30).map(move |y| dvec2(f64::from(x) / 40.3, f64::from(y) / 30.7)));
    let places: Vec<DVec2> = grid.collect();
    let mut seen = Vec::new();
    for (theme, overlays) in [
        (ThemePreference::Dark, &[FieldOverlay::Risk, FieldOverlay::TargetRatio][..]),
        (ThemePreference::Light, &[FieldOverlay::None, FieldOverlay::Layer, FieldOverlay::Age][..]),
    ] {
        send(&mut window, Command::from(ViewCommand::Theme(theme)));
        for &overlay in overlays {
            window.hover_at(RESTING_PLACE);
            show(&mut window, overlay);
            let file = export(&mut window, "overlay_as_on_canvas.png");
            let image = read_picture(&file, &Meter::default()).unwrap();
            let [same, all] = compared(&mut window, &image, &places);
            assert!(all > 300 && same * 100 >= 90 * all, "{overlay:?} {theme:?}: {same} of {all}");
            seen.push(std::fs::read(file).unwrap());
        }
    }
    let different: std::collections::BTreeSet<_> = seen.iter().collect();
    assert_eq!(different.len(), 5, "each overlay has its own picture");
}

#[test]
fn the_legend_of_the_overlay_is_in_both_formats_unless_levels_are_chosen() {
    let mut window = window();
    choose(&mut window, |choices| choices.width_px = 500);
    let plain = [export(&mut window, "levels.png"), export(&mut window, "levels.svg")];
    let plain = plain.map(|file| std::fs::read(file).unwrap());
    assert!(String::from_utf8_lossy(&plain[1]).contains("<title>Level, diameter, count</title>"));
    for (overlay, title, is_picture) in [
        (FieldOverlay::Risk, "Risk", true),
        (FieldOverlay::Target, "h̄ by level", true),
        (FieldOverlay::Layer, "Deciding layer", true),
        (FieldOverlay::Forced, "Cause", false),
        (FieldOverlay::SmallestAngle, "Smallest angle", false),
        (FieldOverlay::TargetRatio, "Longest edge / h̄", false),
        (FieldOverlay::Valence, "Triangles at a node", false),
        (FieldOverlay::TimeStep, "Time step", true),
    ] {
        show(&mut window, overlay);
        let svg = std::fs::read_to_string(export(&mut window, "overlay.svg")).unwrap();
        assert!(svg.contains(&format!("<title>{title}</title>")), "{overlay:?}");
        assert!(!svg.contains("<title>Level, diameter"), "{overlay:?} has one legend");
        assert_eq!(svg.contains("<image "), is_picture, "{overlay:?}");
        assert!(std::fs::read(export(&mut window, "overlay.png")).unwrap() != plain[0], "{overlay:?}");
    }
    let svg = std::fs::read_to_string(scratch("overlay.svg")).unwrap();
    assert!(svg.contains("<title>no layer of depths</title>"), "a legend says why there is nothing");
    choose(&mut window, |choices| choices.colors = PictureColors::Levels);
    let levels = [export(&mut window, "levels.png"), export(&mut window, "levels.svg")];
    assert!(levels.map(|file| std::fs::read(file).unwrap()) == plain);
}

#[test]
fn the_dialog_says_which_colours_pictures_have() {
    let mut window = window();
    send(&mut window, Command::from(ShellCommand::AskPicture));
    window.run();
    assert!(window.query_by_label_contains("with its own legend").is_none());
    show(&mut window, FieldOverlay::EdgeRatio);
    window.get_by_label("Shows “Edge ratio” with its own legend.");
    window.get_by_label("Levels").click();
    window.run();
    assert_eq!(window.state().view().picture.colors, PictureColors::Levels);
    assert!(window.query_by_label_contains("with its own legend").is_none());
    choose(&mut window, |choices| choices.colors = PictureColors::AsShown);
    send(&mut window, Command::from(ViewCommand::Space(SpaceCommand::Toggle)));
    window.run();
    window.get_by_label_contains("A view in space shows levels");
}

/// Writes the pictures of all overlays of two examples, for a look.
#[test]
#[ignore = "writes pictures into the folder MESHBRUSH_SCREENS"]
fn exported_pictures_for_a_look() {
    let Some(folder) = std::env::var_os("MESHBRUSH_SCREENS").map(PathBuf::from) else { return };
    let mut window = drawn_window_of(vec2(1280.0, 720.0), |_, _| {});
    for example in [Example::ALL[0], Example::Heights, Example::CelticSea] {
        send(&mut window, Command::from(FileCommand::OpenExample(example)));
        wait_for_jobs(&mut window);
        if example == Example::CelticSea {
            set(&mut window, Setting::SmallestDiameter(8_000.0));
            wait_until(&mut window, |window| window.state().session().derived().is_some());
        }
        for space in [false, true] {
            let is_on = window.state().view().space.is_on;
            if is_on != space {
                send(&mut window, Command::from(ViewCommand::Space(SpaceCommand::Toggle)));
            }
            let overlays: &[FieldOverlay] = if space { &[FieldOverlay::None] } else { FieldOverlay::ALL };
            for &overlay in overlays {
                show(&mut window, overlay);
                for ending in ["png", "svg"] {
                    let name = format!("{}-{overlay:?}-{space}.{ending}", example.name().replace(' ', "-"));
                    let file = export(&mut window, &name);
                    _ = std::fs::copy(file, folder.join(name));
                }
            }
        }
    }
}
