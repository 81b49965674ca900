//! Nothing in the docks and bars is cut: no text is longer than its room, none covers another, and no control
//! ends outside the panel that shows it.

use std::collections::BTreeSet;

use eframe::egui::accesskit::Role;
use eframe::egui::epaint::ClippedShape;
use eframe::egui::{Rect, Shape, Vec2, vec2};

use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::{Window, canvas, open_tab, send, set, settings, wait_for_jobs, window_of};
use meshbrush_core::document::{Example, Setting};
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand};

/// A window of 1280 × 720 pixels at scales of 1, 1.5 and 2: its sizes in points.
const SIZES: [Vec2; 3] = [vec2(1280.0, 720.0), vec2(1280.0 / 1.5, 480.0), vec2(640.0, 360.0)];

/// A height with room for every section of a tab, in points.
const TALL: f32 = 8000.0;
/// More sections than a tab has.
const MOST_SECTIONS: usize = 40;

/// A text as it was painted.
struct PaintedText {
    text: String,
    /// Its ink, in points.
    rect: Rect,
    /// What is seen of the panel that has it.
    clip: Rect,
    /// Whether it ends in `…` because its room is too small.
    is_elided: bool,
}

fn texts(window: &Window) -> Vec<PaintedText> {
    let mut texts = Vec::new();
    for ClippedShape { clip_rect, shape, .. } in &window.output().shapes {
        collect(shape, *clip_rect, &mut texts);
    }
    texts
}

fn collect(shape: &Shape, clip: Rect, texts: &mut Vec<PaintedText>) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| collect(shape, clip, texts)),
        Shape::Text(text) => {
            let rect = text.galley.mesh_bounds.translate(text.pos.to_vec2());
            let elided = text.galley.elided;
            let text = text.galley.text().to_owned();
            if rect.is_positive() {
                texts.push(PaintedText { text, rect, clip, is_elided: elided });
            }
        }
        _ => {}
    }
}

/// Returns what is wrong with the texts of the docks and bars of a window.
fn faults(window: &Window) -> Vec<String> {
    // A person's own names can be of any length; a tooltip has all of them.
    let settings = settings(window);
    let is_of_person = |text: &str| {
        let title = [settings.name.clone(), format!("{} — edited", settings.name)];
        title.iter().any(|title| title == text) || settings.layers.iter().any(|layer| layer.name == text)
    };
    let canvas = canvas(window);
    let texts: Vec<_> =
        texts(window).into_iter().filter(|text| !canvas.contains(text.rect.center())).collect();
    let mut faults = Vec::new();
    for (i, text) in texts.iter().enumerate() {
        // What is scrolled out of view is not cut.
        if text.rect.top() < text.clip.top() || text.rect.bottom() > text.clip.bottom() {
            continue;
        }
        if text.is_elided && !is_of_person(&text.text) {
            faults.push(format!("“{}” has no room", text.text));
        }
        if text.rect.left() < text.clip.left() - 0.5 || text.rect.right() > text.clip.right() + 0.5 {
            faults.push(format!("“{}” is cut", text.text));
        }
        let covered = texts[..i].iter().find(|other| {
            let [seen, other_seen] = [text, other].map(|text| text.rect.intersect(text.clip).shrink(1.0));
            seen.is_positive() && other_seen.is_positive() && seen.intersects(other_seen)
        });
        if let Some(other) = covered {
            faults.push(format!("“{}” covers “{}”", text.text, other.text));
        }
    }
    faults
}

fn report(window: &Window, what: &str, found: &mut BTreeSet<String>) {
    found.extend(faults(window).into_iter().map(|fault| format!("{what}: {fault}")));
}

/// Opens every section of the docks that is in the window.
fn open_sections(window: &mut Window) {
    for _ in 0..MOST_SECTIONS {
        let closed = window.query_all_by_role(Role::Button).find(|node| {
            node.accesskit_node().data().is_expanded() == Some(false)
                && node.rect().left() > canvas(window).right()
        });
        let Some(header) = closed else { return };
        header.click();
        window.run();
    }
    panic!("a section stays closed: its header is out of sight");
}

/// Looks at every tab and every layer of an example, in a window of a size and in one that is as wide and has
/// room for all sections at once.
fn check(size: Vec2, example: Example) {
    let mut found = BTreeSet::new();
    let mut window = window_of(size);
    send(&mut window, Command::from(FileCommand::OpenExample(example)));
    wait_for_jobs(&mut window);
    // A coarse mesh is measured soon.
    let coarse = 8.0 * settings(&window).transfer.h_min;
    set(&mut window, Setting::SmallestDiameter(coarse));
    wait_for_jobs(&mut window);
    for height in [size.y, TALL] {
        window.set_size(vec2(size.x, height));
        window.run();
        for tab in Tab::LOWER.into_iter().filter(|tab| *tab != Tab::Method) {
            open_tab(&mut window, tab);
            if height == TALL {
                open_sections(&mut window);
            }
            wait_for_jobs(&mut window);
            report(&window, &format!("tab {}", tab.name()), &mut found);
        }
        let layers: Vec<_> = settings(&window).layers.iter().map(|layer| layer.id).collect();
        for id in layers {
            send(&mut window, Command::from(LayerCommand::Select(id)));
            let name = settings(&window).layer(id).unwrap().name.clone();
            report(&window, &format!("layer {name}"), &mut found);
        }
    }
    let faults = found.into_iter().collect::<Vec<_>>().join("\n");
    assert!(faults.is_empty(), "{example:?} at {size}:\n{faults}");
}

#[test]
fn no_control_is_cut_at_the_normal_scale() {
    check(SIZES[0], Example::Layers);
}

#[test]
fn no_control_is_cut_at_one_and_a_half_times_the_scale() {
    check(SIZES[1], Example::Layers);
}

#[test]
fn no_control_is_cut_at_twice_the_scale() {
    check(SIZES[2], Example::Layers);
}

#[test]
fn no_number_of_a_sea_on_the_earth_is_cut_at_twice_the_scale() {
    check(SIZES[2], Example::CelticSea);
}
