//! The colours of overlays on the canvas are those of their legends, in both themes and at any zoom.

use eframe::egui::{Pos2, Rect, ThemePreference, pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use super::pictures::{Picture, drawn_window, drawn_window_of, picture, pixel, write_for_a_look};
use super::{
    FREE, RESTING_PLACE, Window, canvas, in_world, on_screen, open_section, send, stroke, wait_for_jobs,
    wait_until,
};
use meshbrush_core::document::{Example, Setting};
use meshbrush_kit::kit::DockPlace;
use meshbrush_kit::kit::command::{Command, FileCommand, ViewCommand};
use meshbrush_kit::kit::view::FieldOverlay;

/// The middle of a place with painted risk in the first example.
const PAINTED: DVec2 = dvec2(0.72, 0.74);

fn show(window: &mut Window, theme: ThemePreference, overlay: FieldOverlay) -> Picture {
    send(window, Command::from(ViewCommand::Theme(theme)));
    send(window, Command::from(ViewCommand::SetOverlay(overlay)));
    window.hover_at(RESTING_PLACE);
    window.run();
    // Its colours are computed on another thread.
    wait_for_jobs(window);
    picture(window)
}

/// Returns the colour that most pixels around a point have: none of an edge.
fn default_color(image: &Picture, middle: Pos2) -> [u8; 3] {
    let offsets = (-3..=3).flat_map(|y| (-3..=3).map(move |x| vec2(x as f32, y as f32)));
    let colors: Vec<[u8; 3]> = offsets.map(|offset| pixel(image, middle + offset)).collect();
    let count = |color: &[u8; 3]| colors.iter().filter(|other| *other == color).count();
    *colors.iter().max_by_key(|color| count(color)).unwrap()
}

/// Returns the content of the legend whose spoken text begins so, in points.
fn legend(window: &Window, spoken: &str) -> Rect {
    let place = window.get_by_label_contains(spoken).rect();
    Rect::from_min_max(place.min + vec2(10.0, 27.0), place.max - vec2(10.0, 7.0))
}

/// Returns the colours of a scale of so many cells.
fn cells(window: &Window, image: &Picture, spoken: &str, count: usize) -> Vec<[u8; 3]> {
    let bar = legend(window, spoken);
    let x = |cell: usize| bar.left() + bar.width() * (cell as f32 + 0.5) / count as f32;
    (0..count).map(|cell| pixel(image, pos2(x(cell), bar.top() + 6.0))).collect()
}

#[track_caller]
fn assert_same(found: [u8; 3], expected: [u8; 3], tolerance: u8, what: &str) {
    let differs = |i: usize| found[i].abs_diff(expected[i]) > tolerance;
    assert!(!(0..3).any(differs), "{what}: {found:?} on the canvas, {expected:?} in the legend");
}

const THEMES: [ThemePreference; 2] = [ThemePreference::Dark, ThemePreference::Light];

#[test]
fn the_legends_of_fields_have_the_colours_of_the_canvas() {
    let mut window = drawn_window();
    let [free, painted] = [FREE + dvec2(0.004, 0.002), PAINTED].map(|point| on_screen(&window, point));
    for theme in THEMES {
        let image = show(&mut window, theme, FieldOverlay::Layer);
        let rows = legend(&window, "Legend: layers");
        let row = |number: f32| pixel(&image, pos2(rows.left() + 9.0, rows.top() + 18.0 * number + 9.0));
        assert_same(default_color(&image, painted), row(0.0), 1, "painted risk");
        assert_same(default_color(&image, free), row(2.0), 1, "the base");

        let image = show(&mut window, theme, FieldOverlay::Risk);
        let scale = cells(&window, &image, "Legend: risk", 17);
        let risk = window.state().session().document().risk_at(PAINTED).unwrap();
        assert!(risk > 0.5, "{risk}");
        assert_same(default_color(&image, painted), scale[(16.0 * risk).round() as usize], 10, "risk");
        assert_same(default_color(&image, free), scale[0], 1, "no risk");

        let image = show(&mut window, theme, FieldOverlay::Target);
        let rows = legend(&window, "Legend: diameters");
        let deepest = meshbrush_kit::kit::view::deepest_level(window.state().session().document().settings());
        let height = rows.height() / (f32::from(deepest) + 1.0);
        let session = window.state().session();
        let target = session.decision_at(PAINTED).target;
        let level = session.follower().field().level_of_diameter(target, PAINTED).unwrap();
        let row =
            |level: u32| pixel(&image, pos2(rows.left() + 9.0, rows.top() + height * (level as f32 + 0.5)));
        assert_same(default_color(&image, painted), row(level), 1, "h̄");
        assert_same(default_color(&image, free), row(0), 1, "h̄ of the base");
    }
}

#[test]
fn the_legends_of_triangles_have_the_colours_of_the_canvas() {
    let mut window = drawn_window();
    let far = dvec2(0.9, 0.12);
    stroke(&mut window, FREE, FREE);
    let [free, far_px] = [FREE, far].map(|point| on_screen(&window, point));
    for theme in THEMES {
        let image = show(&mut window, theme, FieldOverlay::Age);
        let scale = cells(&window, &image, "Legend: edits ago", 11);
        assert_same(default_color(&image, free), scale[0], 1, "the last edit");
        assert_same(default_color(&image, far_px), scale[10], 1, "before the first edit");

        let image = show(&mut window, theme, FieldOverlay::Slack);
        let scale = cells(&window, &image, "Legend: slack", 16);
        let mesh = window.state().session().mesh();
        let triangle = mesh.locate(far).triangle().unwrap();
        let middle = mesh.view().world_corners(triangle).iter().sum::<DVec2>() / 3.0;
        let target = window.state().session().decision_at(middle).target;
        let slack = (target / mesh.diameter(mesh.triangle(triangle).level())).log2();
        assert_same(default_color(&image, far_px), scale[(4.0 * slack) as usize], 10, "slack");

        let image = show(&mut window, theme, FieldOverlay::Forced);
        let rows = legend(&window, "Legend: triangles that only");
        let forced = pixel(&image, rows.min + vec2(9.0, 9.0));
        let inner = canvas(&window).shrink(150.0);
        let columns = inner.left() as i32..inner.right() as i32;
        let all = columns.flat_map(|x| (inner.top() as i32..inner.bottom() as i32).map(move |y| (x, y)));
        let count = all.filter(|&(x, y)| pixel(&image, pos2(x as f32, y as f32)) == forced).count();
        assert!(count > 200, "{count} pixels of forced triangles");
    }
}

/// Triangles on the coast, which the mesh before its outline does not have, have the colour of their shape.
#[test]
fn the_legends_of_shapes_have_the_colours_of_the_canvas() {
    let mut window = drawn_window_of(vec2(1280.0, 720.0), |_, _| {});
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    wait_until(&mut window, |window| window.state().session().derived().is_some());
    let derived = window.state().session().derived().unwrap().shared_extract();
    let nodes: Vec<DVec2> = derived.world_nodes().collect();
    let shapes = derived.cells().map(|cell| {
        let [a, b, c] = cell.corners.map(|node| nodes[node]);
        let angle = |at: DVec2, p: DVec2, q: DVec2| (p - at).angle_to(q - at).abs().to_degrees();
        let mut edges = [a.distance(b), b.distance(c), c.distance(a)];
        edges.sort_by(f64::total_cmp);
        let smallest = angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b));
        ((a + b + c) / 3.0, smallest, edges)
    });
    let sliver = shapes.min_by(|one, other| one.1.total_cmp(&other.1));
    let (middle, smallest, [shortest, _, longest]) = sliver.expect("the sea has triangles");
    assert!((10.0..35.0).contains(&smallest), "{smallest}");
    open_section(&mut window, "Quality");
    send(&mut window, Command::from(ViewCommand::GoTo(middle, 0.2 * shortest)));
    for theme in THEMES {
        for (overlay, spoken, share) in [
            (FieldOverlay::SmallestAngle, "Legend: Smallest angle", (smallest - 15.0) / 30.0),
            (FieldOverlay::EdgeRatio, "Legend: Longest / shortest", (longest / shortest - 1.5) / 2.0),
        ] {
            let image = show(&mut window, theme, overlay);
            let scale = cells(&window, &image, spoken, 16);
            let at = default_color(&image, on_screen(&window, middle));
            write_for_a_look(&mut window, &format!("{overlay:?}-{theme:?}"));
            assert_same(at, scale[((16.0 * share) as usize).min(15)], 12, spoken);
        }
    }
}

/// Each pixel has the colour of the triangle that it lies in, also where one covers much of the canvas.
#[test]
fn the_ages_of_triangles_are_exact_at_any_zoom() {
    let mut window = drawn_window();
    stroke(&mut window, FREE, FREE);
    // The rim of what was painted.
    let rim = FREE + dvec2(0.058, 0.0);
    send(&mut window, Command::from(ViewCommand::LookAt(rim)));
    for zoom in [1.0, 8.0, 30.0] {
        send(&mut window, Command::from(ViewCommand::Zoom(zoom)));
        let image = show(&mut window, ThemePreference::Dark, FieldOverlay::Age);
        let scale = cells(&window, &image, "Legend: edits ago", 11);
        let (inner, mut seen) = (canvas(&window).shrink(160.0), [0; 2]);
        for (x, y) in (0..40).flat_map(|x| (0..30).map(move |y| (x, y))) {
            let at = (inner.min + vec2(x as f32 / 40.0, y as f32 / 30.0) * inner.size()).round();
            let session = window.state().session();
            let Some(id) = session.mesh().locate(in_world(&window, at + vec2(0.5, 0.5))).triangle() else {
                continue;
            };
            let is_new = session.ages().of(id) == Some(0);
            let [red, ..] = pixel(&image, at);
            let [new, old] = [scale[0], scale[10]].map(|color| color[0]);
            // An edge is half as bright; one of a new triangle is brighter than an old triangle.
            assert_eq!(red > (new / 2 - 20).max(old), is_new, "{at} at {zoom}: {red}, {new}, {old}");
            seen[usize::from(is_new)] += 1;
        }
        assert!(seen.iter().sum::<usize>() > 500, "{seen:?}");
    }
}

/// The panel says what the legend of time steps compares with, once it has measured.
#[test]
fn the_legend_of_time_steps_has_the_smallest_one() {
    let mut window = drawn_window_of(vec2(1280.0, 720.0), |_, _| {});
    send(&mut window, Command::from(FileCommand::OpenExample(Example::CelticSea)));
    wait_for_jobs(&mut window);
    // A coarse sea is measured soon.
    super::set(&mut window, Setting::SmallestDiameter(15_000.0));
    open_section(&mut window, "Quality");
    wait_for_jobs(&mut window);
    show(&mut window, ThemePreference::Dark, FieldOverlay::TimeStep);
    static PLACE: DockPlace = DockPlace::new("quality", "Quality", "Time step");
    window.get_by_label_contains("Legend: Time step / smallest 1 to ≥ 16");
    write_for_a_look(&mut window, "TimeStep");
    send(&mut window, Command::from(ViewCommand::Reveal(&PLACE)));
    write_for_a_look(&mut window, "TimeStep-panel");
}
