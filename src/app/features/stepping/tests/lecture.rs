//! Steps before an audience: what is seen at once, in a presentation and on paper.

use eframe::egui::{Key, Modifiers, Pos2, Rect, Vec2, vec2};
use egui_kittest::kittest::Queryable as _;

use super::{begin, coarse, player};
use crate::app::features::report::FigureCommand;
use crate::app::features::stepping::StepCommand;
use crate::app::tests::{Window, canvas, folder, key, notice, painted_texts, send, wait_until, window_of};
use meshbrush_kit::kit::command::{Command, ViewCommand};
use meshbrush_kit::kit::marks::point_from_px;
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_render::colormap::Ground;
use meshbrush_study::report::ReportFigure;

/// Sizes of windows, in points: a small screen, and larger ones.
const SIZES: [Vec2; 3] = [vec2(1280.0, 720.0), vec2(1440.0, 900.0), vec2(1920.0, 1080.0)];

fn opened(size: Vec2, figure: ReportFigure) -> Window {
    let mut window = window_of(size);
    send(&mut window, Command::from(FigureCommand::Open(figure)));
    wait_until(&mut window, |window| window.state().stepping().is_some_and(|steps| steps.player().is_some()));
    window
}

/// Returns the position of a node on the screen, in points.
fn on_screen(window: &Window, node: LatticePoint) -> Pos2 {
    let px = window.state().view().camera.unwrap().screen_from_lattice(node);
    point_from_px(canvas(window), px, window.ctx.pixels_per_point())
}

/// Returns the texts on the canvas with a digit: names and numbers of triangles and nodes.
fn labels(window: &Window) -> Vec<(String, Rect)> {
    let (canvas, texts) = (canvas(window), painted_texts(window.output()));
    let is_label = |(text, rect): &(String, Rect)| {
        canvas.contains_rect(*rect) && text.contains(|c: char| c.is_ascii_digit())
    };
    texts.into_iter().filter(is_label).collect()
}

fn assert_apart(labels: &[(String, Rect)], where_: &str) {
    for (number, (text, rect)) in labels.iter().enumerate() {
        for (other, other_rect) in &labels[..number] {
            let both = rect.intersect(*other_rect);
            assert!(!both.is_positive(), "{where_}: “{text}” at {rect:?} and “{other}” at {other_rect:?}");
        }
    }
}

#[test]
fn labels_do_not_overlap_in_a_presentation_however_small_the_triangles_are() {
    for size in SIZES {
        let mut window = window_of(size);
        coarse(&mut window);
        begin(&mut window);
        key(&mut window, Modifiers::NONE, Key::F5);
        for zoom in [1.0, 0.4, 4.0, 4.0] {
            send(&mut window, Command::from(ViewCommand::Zoom(zoom)));
            let mut most = 0;
            for position in [0, 3, 47, 120, 300, 700, player(&window).len()] {
                send(&mut window, Command::from(StepCommand::GoTo(position)));
                let labels = labels(&window);
                most = most.max(labels.len());
                assert_apart(&labels, &format!("step {position} at {size} times {zoom}"));
            }
            assert!(most > 5, "{most} labels at {size} times {zoom}");
        }
    }
}

#[test]
fn the_sentence_is_in_view_in_a_presentation_above_the_canvas_and_wraps() {
    for size in SIZES {
        let mut window = window_of(size);
        coarse(&mut window);
        begin(&mut window);
        key(&mut window, Modifiers::NONE, Key::F5);
        let screen = window.ctx.content_rect();
        let mut shown = None;
        for position in 0..80 {
            send(&mut window, Command::from(StepCommand::GoTo(position)));
            let first = "The coarse grid, before the first step.".to_owned();
            let sentence = player(&window).step().map_or(first, |step| step.sentence());
            let rect = window.get_by_label(&sentence).rect();
            assert!(screen.contains_rect(rect) && rect.width() > 100.0, "{sentence}: {rect:?}");
            let canvas = canvas(&window);
            assert!(!canvas.intersect(rect).is_positive(), "{sentence}: {rect:?} over {canvas:?}");
            assert_eq!(*shown.get_or_insert(canvas), canvas, "the canvas keeps its size");
        }
        // The panel says it, where that is shown.
        key(&mut window, Modifiers::COMMAND, Key::B);
        let sentence = player(&window).step().unwrap().sentence();
        assert_eq!(window.query_all_by_label(&sentence).count(), 1);
        key(&mut window, Modifiers::NONE, Key::F5);
        assert_eq!(window.query_all_by_label(&sentence).count(), 1);
    }
}

#[test]
fn lines_of_algorithms_are_not_cut() {
    for (size, presents) in [(SIZES[0], false), (SIZES[0], true), (SIZES[2], true)] {
        let mut window = window_of(size);
        coarse(&mut window);
        begin(&mut window);
        if presents {
            key(&mut window, Modifiers::NONE, Key::F5);
            key(&mut window, Modifiers::COMMAND, Key::B);
        }
        let mut seen = Vec::new();
        for position in 1..300 {
            let algorithm = player(&window).recording().steps()[position - 1].lines().0;
            if seen.contains(&algorithm) {
                continue;
            }
            seen.push(algorithm);
            send(&mut window, Command::from(StepCommand::GoTo(position)));
            let right = window.ctx.content_rect().right();
            let panel = canvas(&window).right();
            let letters: String = painted_texts(window.output())
                .into_iter()
                .filter(|(_, rect)| rect.left() > panel)
                .map(|(text, rect)| {
                    assert!(rect.right() < right - 8.0, "“{text}” ends at {} of {right}", rect.right());
                    text.replace(' ', "")
                })
                .collect();
            let marked = player(&window).step().unwrap().lines().1;
            for line in &algorithm.lines()[marked.start - 1..marked.end - 1] {
                assert!(letters.contains(&line.replace(' ', "")), "all of “{line}” is shown");
            }
        }
        assert!(seen.len() >= 5, "{seen:?}");
    }
}

#[test]
fn the_legend_covers_no_node_and_counts_the_triangles_of_the_step() {
    let spoken = "Legend: levels of the mesh";
    let mut is_shown = [0, 0];
    for size in SIZES {
        for figure in [ReportFigure::CoarseGrid, ReportFigure::Descendants, ReportFigure::Neighbours] {
            let mut window = opened(size, figure);
            for presents in [false, true] {
                if presents {
                    key(&mut window, Modifiers::NONE, Key::F5);
                }
                let Some(legend) = window.query_by_label(spoken).map(|node| node.rect()) else {
                    is_shown[0] += 1;
                    continue;
                };
                is_shown[1] += 1;
                for node in player(&window).nodes() {
                    let at: Pos2 = on_screen(&window, *node);
                    assert!(legend.distance_to_pos(at) > 8.0, "{figure:?} at {size}: {at} and {legend:?}");
                }
                let counts: usize = player(&window).level_counts().iter().sum();
                assert_eq!(counts, player(&window).rows().len());
                let counts = player(&window).level_counts();
                let texts = painted_texts(window.output());
                let written = |count: usize| {
                    texts.iter().any(|(text, rect)| *text == count.to_string() && legend.contains_rect(*rect))
                };
                assert!(counts.iter().filter(|count| **count > 0).all(|&count| written(count)), "{counts:?}");
            }
        }
    }
    assert!(is_shown.iter().all(|&count| count > 0), "{is_shown:?}");
}

#[test]
fn figures_3_and_4_show_their_letters_at_once_and_uncover_the_triangles() {
    for size in SIZES {
        for figure in [ReportFigure::Descendants, ReportFigure::Neighbours] {
            for presents in [false, true] {
                let mut window = opened(size, figure);
                if presents {
                    key(&mut window, Modifiers::NONE, Key::F5);
                }
                let labels = labels(&window);
                assert_apart(&labels, &format!("{figure:?} at {size}"));
                for letter in ["a", "b", "c", "d"] {
                    let part = format!("{letter} = ");
                    assert!(labels.iter().any(|(text, _)| text.contains(&part)), "{figure:?}: no {letter}");
                }
                let number = player(&window).step().unwrap().triangle;
                let corners = player(&window).corners(number).map(|corner| on_screen(&window, corner));
                // Of a grid of the triangle, at least a half is uncovered.
                let (mut covered, mut all) = (0, 0);
                for i in 1..20 {
                    for j in 1..20 - i {
                        let [a, b, c] = corners.map(|corner| corner.to_vec2());
                        let (u, v) = (i as f32 / 20.0, j as f32 / 20.0);
                        let at = ((1.0 - u - v) * a + u * b + v * c).to_pos2();
                        all += 1;
                        covered += usize::from(labels.iter().any(|(_, rect)| rect.contains(at)));
                    }
                }
                assert!(2 * covered < all, "{figure:?} at {size}: {covered} of {all} are covered");
            }
        }
    }
}

#[test]
fn steps_are_exported_as_png_on_a_chosen_ground() {
    let mut window = window_of(SIZES[0]);
    coarse(&mut window);
    begin(&mut window);
    let folder = folder("app-steps", "pictures");
    send(&mut window, Command::from(StepCommand::ExportRange(40, 40)));
    let mut corner_of = |ground: Ground, name: &str| {
        send(&mut window, Command::from(StepCommand::ExportGround(ground)));
        let before = notice(&window);
        send(&mut window, Command::from(StepCommand::Export(folder.join(name))));
        wait_until(&mut window, |window| {
            let now = notice(window);
            now != before && now.contains("1 steps written")
        });
        let stem = name.split_once('.').unwrap().0;
        let ending = name.split_once('.').unwrap().1;
        std::fs::read(folder.join(format!("{stem}-0040.{ending}"))).unwrap()
    };
    for (ground, name) in [(Ground::Dark, "dark.png"), (Ground::Light, "light.png")] {
        let bytes = corner_of(ground, name);
        let decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!(info.width, 2400);
        assert!(info.height > 2400);
    }
    for (ground, name) in [(Ground::Dark, "dark.svg"), (Ground::Light, "light.svg")] {
        let text = String::from_utf8(corner_of(ground, name)).unwrap();
        let [r, g, b] = ground.canvas();
        assert!(text.contains(&format!("fill=\"#{r:02x}{g:02x}{b:02x}\"/>")), "{ground:?}");
        assert!(!text.contains("paint-order") && !text.contains("<text"), "letters are outlines");
        assert!(text.contains("aria-label=\"Step 40 of "));
    }
}
