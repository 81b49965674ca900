//! Nothing in the docks and bars is cut: no text is longer than its room, none covers another, and no control
//! ends outside the panel that shows it.

use std::collections::BTreeSet;

use eframe::egui::epaint::ClippedShape;
use eframe::egui::{Rect, Shape, Vec2, vec2};

use super::{Window, canvas, open_tab, send, settings, wait_for_jobs, window_of};
use meshbrush_core::document::Example;
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand};

/// A window of 1280 × 720 pixels at scales of 1, 1.5 and 2: its sizes in points.
const SIZES: [Vec2; 3] = [vec2(1280.0, 720.0), vec2(1280.0 / 1.5, 480.0), vec2(640.0, 360.0)];

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
    let canvas = canvas(window);
    let texts: Vec<_> =
        texts(window).into_iter().filter(|text| !canvas.contains(text.rect.center())).collect();
    let mut faults = Vec::new();
    for (i, text) in texts.iter().enumerate() {
        // What is scrolled out of view is not cut.
        if text.rect.top() < text.clip.top() || text.rect.bottom() > text.clip.bottom() {
            continue;
        }
        if text.is_elided {
            faults.push(format!("“{}” has no room", text.text));
        }
        if text.rect.left() < text.clip.left() - 0.5 || text.rect.right() > text.clip.right() + 0.5 {
            faults.push(format!("“{}” is cut", text.text));
        }
        let covered = texts[..i].iter().find(|other| {
            other.rect.shrink(1.0).intersects(text.rect.shrink(1.0)) && other.clip.intersects(text.clip)
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

#[test]
fn no_control_is_cut_in_a_small_window_at_any_scale() {
    let mut found = BTreeSet::new();
    for size in SIZES {
        let mut window = window_of(size);
        for example in [Example::Layers, Example::CelticSea] {
            send(&mut window, Command::from(FileCommand::OpenExample(example)));
            wait_for_jobs(&mut window);
            for tab in Tab::LOWER.into_iter().filter(|tab| *tab != Tab::Method) {
                open_tab(&mut window, tab);
                wait_for_jobs(&mut window);
                report(&window, &format!("{example:?} at {size}, tab {}", tab.name()), &mut found);
            }
            let layers: Vec<_> = settings(&window).layers.iter().map(|layer| layer.id).collect();
            for id in layers {
                send(&mut window, Command::from(LayerCommand::Select(id)));
                let name = settings(&window).layer(id).unwrap().name.clone();
                report(&window, &format!("{example:?} at {size}, layer {name}"), &mut found);
            }
        }
    }
    assert!(found.is_empty(), "{} faults\n{}", found.len(), found.into_iter().collect::<Vec<_>>().join("\n"));
}
