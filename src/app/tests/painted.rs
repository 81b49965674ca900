//! What is painted: texts and marks are where they belong.

use std::sync::Arc;

use eframe::egui::accesskit::Role;
use eframe::egui::{Color32, Event, Modifiers, Rect, Shape, Ui, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::dvec2;

use super::{
    FREE, TALL, Window, canvas, key, move_to, on_screen, open_tab, painted_radii, painted_shapes,
    painted_texts, send, window, window_of,
};
use crate::app::features::paths::PathCommand;
use meshbrush_core::document::{Background, Picture, Setting};
use meshbrush_kit::kit::Tab;
use meshbrush_kit::kit::command::{Command, FileCommand, ViewCommand};
use meshbrush_kit::kit::view::FieldOverlay;
use meshbrush_study::plot::{Axis, Mark, Plot, Scale, Series};
use meshbrush_ui::theme;
use meshbrush_ui::theme::{metrics, tokens_of};
use meshbrush_ui::widgets::*;

fn texts(window: &Window) -> Vec<(String, Rect)> {
    painted_texts(window.output())
}

/// Returns the texts that are painted within a rectangle.
fn texts_in(window: &Window, place: Rect) -> Vec<String> {
    let place = place.expand(1.0);
    texts(window).into_iter().filter(|(_, rect)| place.contains_rect(*rect)).map(|(text, _)| text).collect()
}

#[test]
fn coordinates_along_the_canvas_are_beside_their_places() {
    let window = window();
    let canvas = canvas(&window);
    let mut seen = [0; 2];
    for (text, rect) in texts(&window) {
        let Ok(value) = text.replace('−', "-").parse::<f64>() else { continue };
        if canvas.contains_rect(rect) && rect.bottom() < canvas.top() + 30.0 {
            let at = on_screen(&window, dvec2(value, 0.0)).x;
            assert!((rect.center().x - at).abs() < 2.0, "{text} is at {}, and not at {at}", rect.center());
            seen[0] += 1;
        } else if canvas.contains_rect(rect) && rect.left() < canvas.left() + 30.0 {
            let at = on_screen(&window, dvec2(0.0, value)).y;
            assert!((rect.center().y - at).abs() < 2.0, "{text} is at {}, and not at {at}", rect.center());
            seen[1] += 1;
        }
    }
    assert!(seen.iter().all(|count| *count >= 4), "{seen:?}");
}

/// The names that screen readers hear are those that are painted.
#[test]
fn layers_tabs_and_choices_have_their_names_within_their_places() {
    let mut window = window_of(TALL);
    let mut seen = 0;
    for tab in Tab::LOWER.into_iter().filter(|tab| *tab != Tab::Method) {
        open_tab(&mut window, tab);
        for role in [Role::Tab, Role::RadioButton, Role::ListBoxOption] {
            for node in window.query_all_by_role(role) {
                let name = node.accesskit_node().label().unwrap_or_default();
                let painted = texts_in(&window, node.rect());
                assert!(painted.contains(&name), "{role:?} {name} has {painted:?}");
                seen += 1;
            }
        }
    }
    assert!(seen > 30, "{seen}");
    for layer in window.query_all_by_role(Role::ListBoxOption) {
        let value = layer.value().unwrap_or_default();
        let (_, combine) = value.split_once(", ").expect("kind and combination");
        assert!(texts_in(&window, layer.rect()).iter().any(|text| text == combine), "{value}");
    }
}

#[test]
fn tools_are_in_the_middle_of_their_strip() {
    let window = window();
    let tool = window.get_all_by_role_and_label(Role::Button, "Query").map(|tool| tool.rect());
    let tool = tool.min_by(|a, b| a.left().total_cmp(&b.left())).unwrap();
    assert_eq!(tool.width(), metrics::TOOL);
    assert!((tool.left() - (canvas(&window).left() - tool.right())).abs() < 2.0, "{tool:?}");
}

#[test]
fn fit_domain_is_a_button_below_the_tools() {
    let mut window = window();
    let before = window.state().view().camera;
    send(&mut window, Command::from(ViewCommand::Zoom(3.0)));
    assert_ne!(window.state().view().camera, before);
    let buttons = window.get_all_by_role_and_label(Role::Button, "Fit domain");
    buttons.min_by(|a, b| a.rect().left().total_cmp(&b.rect().left())).unwrap().click();
    window.run();
    assert_eq!(window.state().view().camera, before);
}

/// Returns the radii of the circles without a filling around a place.
fn rings(window: &Window, world: glam::DVec2) -> Vec<f32> {
    let at = on_screen(window, world);
    let circles = painted_shapes(window.output()).into_iter().filter_map(|shape| match shape {
        Shape::Circle(circle) if circle.fill == Color32::TRANSPARENT && circle.center.distance(at) < 1.0 => {
            Some(circle.radius)
        }
        _ => None,
    });
    circles.collect()
}

#[test]
fn the_brush_has_a_ring_and_with_alt_an_eyedropper_in_place_of_it() {
    let mut window = window();
    move_to(&mut window, FREE);
    let (tools, camera) = (window.state().tools(), window.state().view().camera.unwrap());
    let radius = (tools.radius * camera.px_per_world()) as f32 / window.ctx.pixels_per_point();
    let shown = rings(&window, FREE);
    assert!(shown.iter().any(|ring| (ring - radius).abs() < 0.1), "{radius}: {shown:?}");
    window.event(Event::ModifiersChanged(Modifiers::ALT));
    window.run();
    assert_eq!(rings(&window, FREE), [0.0; 0]);
    let (tip, pick) = (on_screen(&window, FREE), Icon::PICK.glyph());
    let has_eyedropper =
        texts(&window).iter().any(|(text, rect)| text == pick && rect.expand(8.0).contains(tip));
    assert!(has_eyedropper, "{tip}");
}

#[test]
fn the_ends_of_a_path_are_named_beside_them() {
    let mut window = window();
    let (start, goal) = (dvec2(0.3, 0.4), dvec2(0.7, 0.6));
    send(&mut window, Command::from(PathCommand::StartAt(start)));
    send(&mut window, Command::from(PathCommand::GoalAt(goal)));
    for (end, at) in [(": start", start), (": goal", goal)] {
        let label = window.get_by_label_contains(end).rect();
        let at = on_screen(&window, at);
        assert!(
            (label.left() - at.x - 14.0).abs() < 1.0 && (label.center().y - at.y).abs() < 1.0,
            "{label:?}"
        );
        assert!(texts_in(&window, label).iter().any(|text| text.ends_with(end)));
    }
}

fn with_points(ui: &mut Ui) {
    theme::install(ui.ctx());
    let series = |name: &str, mark, height: f64| Series {
        name: name.into(),
        mark,
        points: (0..5).map(|n| [f64::from(n), height * f64::from(n)]).collect(),
        spans: Vec::new(),
    };
    let plot = Plot {
        title: "Growth".into(),
        x: Axis::new("x", Scale::Linear),
        y: Axis::new("y", Scale::Linear),
        series: vec![series("measured", Mark::Points, 1.0), series("expected", Mark::Line, 2.0)],
        note: String::new(),
    };
    let _ = plot_picker(ui, "Growth", &plot, 200.0, |point| format!("point {point}"));
}

#[test]
fn a_plot_has_its_points_and_its_line_and_a_ring_around_the_point_under_the_pointer() {
    let mut harness = Harness::builder().with_size(vec2(360.0, 260.0)).build_ui(with_points);
    harness.run();
    let accent = tokens_of(&harness.ctx).accent;
    let other = tokens_of(&harness.ctx).neighbours[0];
    let plot = harness.get_by_role_and_label(Role::Image, "Growth").rect();
    let points = |harness: &Harness<'_>| -> Vec<eframe::egui::Pos2> {
        let circles = painted_shapes(harness.output()).into_iter().filter_map(|shape| match shape {
            Shape::Circle(circle) if circle.fill == accent && plot.contains(circle.center) => {
                Some(circle.center)
            }
            _ => None,
        });
        circles.collect()
    };
    let shown = points(&harness);
    assert_eq!(shown.len(), 5, "{shown:?}");
    let is_line = |shape: &&Shape| match shape {
        Shape::Path(path) => {
            path.points.len() > 1 && path.stroke.color == eframe::epaint::ColorMode::Solid(other)
        }
        Shape::LineSegment { stroke, points } => {
            stroke.color == other && points.iter().all(|at| plot.contains(*at))
        }
        _ => false,
    };
    assert!(painted_shapes(harness.output()).iter().filter(|shape| is_line(shape)).count() > 0);
    harness.hover_at(shown[2]);
    harness.run();
    let rings = painted_shapes(harness.output()).into_iter().filter(|shape| {
        matches!(shape, Shape::Circle(circle) if circle.fill == Color32::TRANSPARENT && circle.center.distance(shown[2]) < 1.0)
    });
    assert_eq!(rings.count(), 1);
}

#[test]
fn a_number_is_in_the_middle_of_its_ground() {
    let mut harness = Harness::builder().with_size(vec2(100.0, 60.0)).build_ui(|ui| {
        theme::install(ui.ctx());
        let [ground, ink] = [Color32::from_gray(3), Color32::from_gray(250)];
        meshbrush_kit::kit::marks::paint_number(
            ui.painter(),
            pos2(50.0, 30.0),
            1234,
            eframe::egui::FontId::monospace(12.0),
            ink,
            ground,
        );
    });
    harness.run();
    let (_, text) = painted_texts(harness.output()).into_iter().find(|(text, _)| text == "1234").unwrap();
    let grounds = painted_shapes(harness.output()).into_iter().filter_map(|shape| match shape {
        Shape::Rect(rect) if rect.fill == Color32::from_gray(3) => Some(rect.rect),
        _ => None,
    });
    let grounds: Vec<Rect> = grounds.collect();
    assert!(grounds.len() == 1 && grounds[0].contains_rect(text), "{text:?} {grounds:?}");
    assert!(grounds[0].center().distance(pos2(50.0, 30.0)) < 0.1);
}

#[test]
fn the_note_of_a_section_leaves_its_title_room() {
    let title = "A title that is much longer than there is room for";
    let mut harness = Harness::builder().with_size(vec2(240.0, 120.0)).build_ui(|ui| {
        theme::install(ui.ctx());
        Section::new(title).note("37,987 triangles").show(ui, |ui| ui.label("contents"));
    });
    harness.run();
    let texts = painted_texts(harness.output());
    let rect = |wanted: &str| {
        texts.iter().find(|(text, _)| text.eq_ignore_ascii_case(wanted)).map(|(_, rect)| *rect)
    };
    let (title, note) = (rect(title).unwrap(), rect("37,987 triangles").unwrap());
    assert!(title.right() + 10.0 < note.left() && note.right() <= 240.0, "{title:?} {note:?}");
}

#[test]
fn a_layer_of_the_coast_says_what_is_missing_where_there_is_none() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::New));
    super::click_button(&mut window, "Add layer");
    super::click_button(&mut window, "straits of the domain");
    assert!(window.query_by_label_contains("The domain has no coast").is_some());
    key(&mut window, Modifiers::NONE, eframe::egui::Key::Escape);
}

#[test]
fn the_palette_fits_into_a_narrow_window() {
    let mut window = window_of(vec2(420.0, 600.0));
    key(&mut window, Modifiers::COMMAND, eframe::egui::Key::P);
    let field = window.get_by_role_and_label(Role::TextInput, "Command").rect();
    assert!(field.left() >= 0.0 && field.right() <= 420.0, "{field:?}");
}

#[test]
fn legends_say_what_their_colours_mean() {
    let mut window = window();
    send(&mut window, Command::from(ViewCommand::SetOverlay(FieldOverlay::Forced)));
    let legend = window.get_by_label_contains("Legend: triangles that only compatibility").rect();
    assert!(texts_in(&window, legend).iter().any(|text| text == "compatibility"));
}

#[test]
fn a_picture_of_the_manual_is_no_wider_than_its_page() {
    let mut window = window();
    super::choose(&mut window, "Help", "How it works");
    let picture = window.query_all_by_role(Role::Image).map(|picture| picture.rect());
    let picture = picture.max_by(|a, b| a.width().total_cmp(&b.width())).unwrap();
    let page = window.get_by_role_and_label(Role::Heading, "How it works").rect();
    assert!(picture.width() > 200.0 && picture.left() - page.left() < 1.0, "{picture:?} {page:?}");
    assert!(picture.right() < window.ctx.content_rect().right() - 200.0, "{picture:?}");
}

#[test]
fn levels_that_are_hidden_are_faint_in_their_legend() {
    const COLORS: [Color32; 3] = [Color32::RED, Color32::GREEN, Color32::BLUE];
    let mut harness = Harness::builder().with_size(vec2(300.0, 200.0)).build_ui(|ui| {
        theme::install(ui.ctx());
        let row = |level: u32| LevelRow { level, color: COLORS[level as usize], count: 100, diameter: 0.1 };
        let _ = LevelLegend::new(&[row(0), row(1), row(2)]).hidden(0b010).show(ui);
    });
    harness.run();
    let has = |color: Color32| {
        let fills = painted_shapes(harness.output()).into_iter().filter_map(|shape| match shape {
            Shape::Rect(rect) => Some(rect.fill),
            _ => None,
        });
        fills.into_iter().any(|fill| fill == color)
    };
    assert_eq!(COLORS.map(has), [true, false, true]);
}

#[test]
fn the_line_under_the_open_tab_is_as_wide_as_the_tab_at_most() {
    let mut window = window_of(TALL);
    let accent = tokens_of(&window.ctx).accent;
    for tab in Tab::LOWER.into_iter().filter(|tab| *tab != Tab::Method) {
        open_tab(&mut window, tab);
        let place = window.get_by_role_and_label(Role::Tab, tab.name()).rect();
        let lines = painted_shapes(window.output()).into_iter().filter_map(|shape| match shape {
            Shape::Rect(line) if line.fill == accent && place.intersects(line.rect) => Some(line.rect),
            _ => None,
        });
        let lines: Vec<Rect> = lines.collect();
        assert!(lines.len() == 1 && place.contains_rect(lines[0]), "{tab:?} {place:?} {lines:?}");
        assert!(lines[0].width() > 0.5 * place.width());
    }
}

#[test]
fn a_legend_of_many_levels_scrolls_and_stays_low() {
    let mut harness = Harness::builder().with_size(vec2(300.0, 1500.0)).build_ui(|ui| {
        theme::install(ui.ctx());
        let row = |level: u32| LevelRow { level, color: Color32::RED, count: 100, diameter: 0.1 };
        let rows: Vec<LevelRow> = (0..60).map(row).collect();
        let before = ui.cursor().top();
        let _ = LevelLegend::new(&rows).show(ui);
        assert!(ui.cursor().top() - before < 400.0, "{}", ui.cursor().top() - before);
    });
    harness.run();
}

#[test]
fn the_thumb_of_a_slider_grows_under_the_pointer() {
    let mut harness = Harness::builder().with_size(vec2(400.0, 60.0)).build_ui(|ui| {
        theme::install(ui.ctx());
        let mut value = 0.5;
        SliderRow::new("Size", &mut value, 0.0..=1.0).show(ui);
    });
    harness.run();
    let thumb = tokens_of(&harness.ctx).thumb;
    let radius = |harness: &Harness<'_>| painted_radii(harness.output(), thumb);
    let at_rest = radius(&harness);
    let slider = harness.get_by_role_and_label(Role::Slider, "Size").rect().center();
    harness.hover_at(slider);
    harness.run();
    assert!(at_rest > 0.0 && radius(&harness) > at_rest, "{at_rest} {}", radius(&harness));
}

#[test]
fn a_mesh_that_lets_a_picture_through_is_on_the_ground_of_the_canvas() {
    let mut window = super::pictures::drawn_window();
    let ground = tokens_of(&window.ctx).canvas;
    let place = canvas(&window);
    let has_ground = |window: &Window| {
        painted_shapes(window.output()).into_iter().any(|shape| match shape {
            Shape::Rect(rect) => rect.fill == ground && rect.rect.expand(1.0).contains_rect(place),
            _ => false,
        })
    };
    let opaque = has_ground(&window);
    let picture = Arc::new(Picture { size: [1, 1], rgba: vec![9; 4] });
    let (name, bounds) = ("map".into(), meshbrush_mesh::geometry::Rect::UNIT);
    let background = Background { name, picture, bounds, opacity: 0.5 };
    super::set(&mut window, Setting::Background(Some(background)));
    assert_eq!([opaque, has_ground(&window)], [false, true]);
}
