//! The figures of the mesh.

use eframe::egui::accesskit::Role;
use eframe::egui::{Modifiers, OutputCommand};
use egui_kittest::kittest::Queryable as _;

use super::super::Measured;
use super::super::measuring::edges_at;
use crate::app::features::statistics::Statistics;
use crate::app::tests::{
    FREE, TALL, Window, fingerprint, notice, open_section, press, release, send, set, stroke, triangles,
    value_of, wait_for_jobs, wait_until, window_of,
};
use meshbrush_core::document::{Example, Setting};
use meshbrush_kit::kit::command::{Command, FileCommand};
use meshbrush_mesh::mesh::Mesh;
use meshbrush_ui::widgets::format;

/// Returns the shortest and the longest edge, by looking at each triangle.
fn edge_range(mesh: &Mesh) -> [f64; 2] {
    let mut range = [f64::INFINITY, 0.0_f64];
    for (id, _) in mesh.triangles() {
        let [a, b, c] = mesh.view().world_corners(id);
        for length in [a.distance(b), b.distance(c), c.distance(a)] {
            range = [range[0].min(length), range[1].max(length)];
        }
    }
    range
}

fn open_statistics(window: &mut Window) {
    open_section(window, "Statistics");
    wait_for_figures(window);
}

pub fn figures(window: &Window) -> Option<(&Measured, bool)> {
    let app = window.state();
    app.features().get::<Statistics>().figures(app.session())
}

pub fn wait_for_figures(window: &mut Window) {
    wait_until(window, |window| figures(window).is_some_and(|(_, current)| current));
    window.run();
}

pub fn row(window: &Window, name: &str) -> String {
    let links = window.query_by_role_and_label(Role::Button, name);
    let role = if links.is_some() { Role::Button } else { Role::Definition };
    value_of(window, role, name)
}

#[test]
fn the_figures_are_those_of_the_mesh_and_follow_it() {
    let mut window = window_of(TALL);
    open_statistics(&mut window);
    for _ in 0..2 {
        let mesh = window.state().session().mesh();
        let [shortest, longest] = edge_range(mesh).map(|length| format::digits(length, 3));
        assert_eq!([row(&window, "Shortest edge"), row(&window, "Longest edge")], [shortest, longest]);
        assert_eq!(row(&window, "Triangles"), format::count(triangles(&window) as u64));
        assert_eq!(row(&window, "Area"), "1");
        assert_eq!(row(&window, "Gradation"), "× 1.41");
        assert_eq!(row(&window, "h̄ honoured"), "everywhere");
        let (whole, shown) = (fingerprint(&window).to_string(), row(&window, "Fingerprint"));
        let (begin, end) = shown.split_once('…').expect("both ends");
        assert!(whole.starts_with(begin) && whole.ends_with(end) && begin.len() + end.len() == 16, "{shown}");
        set(&mut window, Setting::SmallestDiameter(0.01));
        wait_for_figures(&mut window);
    }
}

#[test]
fn figures_wait_for_the_end_of_a_stroke_and_of_an_update() {
    let mut window = window_of(TALL);
    open_statistics(&mut window);
    press(&mut window, FREE, Modifiers::NONE);
    wait_for_jobs(&mut window);
    assert!(
        figures(&window).is_some_and(|(_, is_current)| !is_current),
        "those of the mesh before the stroke"
    );
    release(&mut window, FREE);
    wait_for_figures(&mut window);
    assert_eq!(row(&window, "Triangles"), format::count(triangles(&window) as u64));
}

#[test]
fn triangles_that_are_too_coarse_are_counted_and_shown() {
    let mut window = window_of(TALL);
    let count = triangles(&window);
    set(&mut window, Setting::MaxTriangles(count + 100));
    stroke(&mut window, FREE, FREE);
    assert!(notice(&window).contains("limit"), "the mesh stopped short: {}", notice(&window));
    open_statistics(&mut window);
    let value = row(&window, "h̄ honoured");
    assert!(value.starts_with("not in ") && value.ends_with(" triangles"), "{value}");
    window.get_by_role_and_label(Role::Button, "h̄ honoured").click();
    window.run();
    let middle = window.state().view().camera.unwrap().visible_world().center();
    assert!(middle.distance(FREE) < 0.1, "{middle}");
}

#[test]
fn a_click_copies_the_fingerprint() {
    let mut window = window_of(TALL);
    open_statistics(&mut window);
    window.get_by_role_and_label(Role::Button, "Fingerprint").click();
    // The click is seen in one frame, its command runs in the next.
    let mut copied = Vec::new();
    for _ in 0..3 {
        window.step();
        copied.extend(window.output().platform_output.commands.clone());
    }
    let text = fingerprint(&window).to_string();
    assert!(copied.iter().any(|command| matches!(command, OutputCommand::CopyText(t) if *t == text)));
    assert_eq!(notice(&window), format!("Copied: {text}"));
}

#[test]
fn parts_and_moved_nodes_are_counted() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    wait_until(&mut window, |window| window.state().session().derived().is_some());
    open_statistics(&mut window);
    let session = window.state().session();
    assert_eq!(row(&window, "Triangles"), format::count(session.triangle_count() as u64));
    let (measured, _) = figures(&window).unwrap();
    let statistics = measured.statistics.unwrap();
    assert!(statistics.smallest_angle >= 12.0 && statistics.size_ratio < 4.0, "{statistics:?}");
    // The triangles that are explained are those with the edges.
    let derived = session.derived().unwrap().shared_extract();
    let nodes: Vec<_> = derived.world_nodes().collect();
    for (middle, inside) in edges_at(&statistics).into_iter().zip(measured.beside_edges) {
        let inside = inside.expect("a triangle has the edge");
        let has_edge = derived.cells().any(|cell| {
            let [a, b, c] = cell.corners.map(|node| nodes[node]);
            let is_inside = ((a + b + c) / 3.0).distance(inside) < 1e-9 * statistics.longest_edge;
            is_inside && [a.midpoint(b), b.midpoint(c), c.midpoint(a)].contains(&middle)
        });
        assert!(has_edge, "{middle}");
    }
    assert_eq!(measured.too_coarse.as_deref(), Some(&[][..]));
}
