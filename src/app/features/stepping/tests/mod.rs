//! Steps through the refinement.

mod lecture;

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::{DVec2, dvec2};

use super::StepCommand;
use super::export::MOST_FILES;
use super::steps::MOST_TRIANGLES;
use crate::app::features::inspection::InspectCommand;
use crate::app::features::painting::BRUSH;
use crate::app::features::report::FigureCommand;
use crate::app::tests::pictures::drawn_window;
use crate::app::tests::{
    CTRL_SHIFT, FREE, Window, canvas, click, entries, fingerprint, key, notice, on_screen, painted_shapes,
    painted_texts, send, set, settings, triangles, wait_until, window, window_of,
};
use meshbrush_core::document::{Example, Setting};
use meshbrush_core::outline::DerivationAction;
use meshbrush_kit::kit::command::{Command, FileCommand, ViewCommand};
use meshbrush_kit::kit::tools::PAN;
use meshbrush_mesh::geometry::LatticePoint;
use meshbrush_mesh::mesh::{NodeId, fingerprint_of};
use meshbrush_study::report::ReportFigure;
use meshbrush_study::steps::{Algorithm, StepAction, StepPlayer};
use meshbrush_ui::theme::tokens_of;

fn player(window: &Window) -> &StepPlayer {
    window.state().stepping().expect("the mode is on").player().expect("the steps are recorded")
}

fn begin(window: &mut Window) {
    key(window, Modifiers::NONE, Key::F10);
    wait_until(window, |window| window.state().stepping().is_none_or(|stepping| stepping.player().is_some()));
}

fn press_button(window: &mut Window, name: &str) {
    window.get_by_role_and_label(Role::Button, name).click();
    window.run();
}

/// A document with few triangles.
fn coarse(window: &mut Window) {
    set(window, Setting::SmallestDiameter(0.06));
    set(window, Setting::Spacing(0.25));
}

#[test]
fn the_last_step_has_the_mesh_of_the_document_and_escape_shows_it_again() {
    let mut window = window();
    coarse(&mut window);
    let (before, history) = (fingerprint(&window), entries(&window));
    begin(&mut window);
    assert!(window.query_by_label("The coarse grid, before the first step.").is_some());
    assert!(window.query_by_label("Step through the refinement").is_some(), "the title of the panel");
    assert!(window.query_by_role_and_label(Role::Button, "Layers").is_none(), "the panel makes room");
    let coarse = player(&window).rows().to_vec();
    press_button(&mut window, "Last step");
    let shown = player(&window);
    assert_eq!(shown.position(), shown.len());
    assert!(!shown.recording().is_cut_short && shown.rows().len() > coarse.len());
    let corners = (1..=shown.rows().len() as u32).map(|number| shown.corners(number));
    assert_eq!(fingerprint_of(corners), before);
    assert!(window.query_by_label("No triangle exceeds its target.").is_some());
    press_button(&mut window, "First step");
    assert!(player(&window).rows() == coarse);
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.state().stepping().is_none());
    assert!(window.query_by_role_and_label(Role::Button, "Layers").is_some());
    assert_eq!((fingerprint(&window), entries(&window)), (before, history));
}

#[test]
fn arrows_go_from_step_to_step_and_the_panel_says_what_happens() {
    let mut window = window();
    coarse(&mut window);
    begin(&mut window);
    let mut seen = Vec::new();
    for position in 1..60 {
        key(&mut window, Modifiers::NONE, Key::ArrowRight);
        let shown = player(&window);
        assert_eq!(shown.position(), position);
        let step = *shown.step().unwrap();
        let count = shown.len();
        assert!(window.query_by_label(&step.sentence()).is_some());
        let of = meshbrush_ui::widgets::format::count(count as u64);
        assert!(window.query_by_label(&format!("Step {position} of {of}")).is_some());
        let (algorithm, lines) = step.lines();
        let line = lines.start;
        let current = format!("Current line {line}: {}", algorithm.lines()[line - 1]);
        assert!(window.query_by_label(&current).is_some(), "{current}");
        if let Some(change) = player(&window).changes().first() {
            let row = format!("T[{}]: ", change.number);
            assert!(window.query_by_label_contains(&row).is_some(), "{row}");
        }
        seen.push(std::mem::discriminant(&step.action));
    }
    let bisects = std::mem::discriminant(&StepAction::Bisect);
    assert!(seen.contains(&bisects));
    key(&mut window, Modifiers::NONE, Key::ArrowLeft);
    assert_eq!(player(&window).position(), 58);
    key(&mut window, Modifiers::SHIFT, Key::ArrowRight);
    assert_eq!(player(&window).position(), player(&window).len());
    key(&mut window, Modifiers::SHIFT, Key::ArrowLeft);
    assert_eq!(player(&window).position(), 0);
}

#[test]
fn it_goes_forwards_by_itself_and_stops_when_asked() {
    let mut window = window();
    coarse(&mut window);
    begin(&mut window);
    send(&mut window, Command::from(StepCommand::Speed(10.0)));
    key(&mut window, Modifiers::NONE, Key::Space);
    assert!(window.state().stepping().unwrap().is_playing());
    window.run_steps(20);
    let position = player(&window).position();
    assert!(position > 2, "{position}");
    press_button(&mut window, "Pause the steps");
    let position = player(&window).position();
    window.run_steps(20);
    assert_eq!(player(&window).position(), position);
}

#[test]
fn the_view_comes_closer_only_where_the_queried_triangle_is_too_small_for_its_numbers() {
    for (zoom, comes_closer) in [(0.3, true), (3.0, false)] {
        let mut window = window();
        coarse(&mut window);
        send(&mut window, Command::from(InspectCommand::Query(dvec2(0.31, 0.44))));
        send(&mut window, Command::from(ViewCommand::LookAt(dvec2(0.31, 0.44))));
        send(&mut window, Command::from(ViewCommand::Zoom(zoom)));
        let id = window.state().session().queried_triangle().unwrap();
        let corners = window.state().session().mesh().view().world_corners(id);
        let middle = corners.iter().sum::<DVec2>() / 3.0;
        let reach = corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
        let reach_px = |window: &Window| reach * window.state().view().camera.unwrap().px_per_world();
        let before = reach_px(&window);
        assert_eq!(before < 40.0, comes_closer, "{before}");
        begin(&mut window);
        let after = reach_px(&window);
        assert!(after > 40.0 && (after > before) == comes_closer, "{zoom}: {before} to {after}");
    }
}

#[test]
fn the_bar_of_the_steps_has_room_for_all_its_controls() {
    let mut window = window_of(vec2(1000.0, 640.0));
    coarse(&mut window);
    begin(&mut window);
    let slider = window.get_by_role_and_label(Role::Slider, "Step").rect();
    let speeds: Vec<_> = window
        .query_all_by_role(Role::RadioButton)
        .map(|node| node.rect())
        .filter(|rect| (rect.center().y - slider.center().y).abs() < 15.0)
        .collect();
    assert!(speeds.len() >= 3, "{speeds:?}");
    assert!(slider.width() > 100.0 && speeds.iter().all(|speed| speed.left() > slider.right()), "{slider:?}");
    assert!(speeds.iter().all(|speed| speed.right() < 1000.0), "{speeds:?}");
}

#[test]
fn the_steps_begin_where_the_queried_triangle_was_made() {
    let mut window = window();
    coarse(&mut window);
    send(&mut window, Command::from(InspectCommand::Query(dvec2(0.31, 0.44))));
    let id = window.state().session().queried_triangle().unwrap();
    let queried = window.state().session().mesh().corners(id);
    begin(&mut window);
    let shown = player(&window);
    assert_eq!(shown.step().map(|step| step.action), Some(StepAction::Bisect));
    let sorted = |mut corners: [LatticePoint; 3]| {
        corners.sort_by_key(|corner| (corner.x, corner.y));
        corners
    };
    let is_there =
        (1..=shown.rows().len() as u32).any(|number| sorted(shown.corners(number)) == sorted(queried));
    assert!(is_there, "the triangle is in the mesh after this step");
    let parts = shown.parts();
    assert!(parts.iter().any(|(number, _)| sorted(shown.corners(*number)) == sorted(queried)), "{parts:?}");
}

#[test]
fn only_bisections_are_stepped_through_on_request() {
    let mut window = window();
    coarse(&mut window);
    begin(&mut window);
    window.get_by_role_and_label(Role::CheckBox, "Only bisections").click();
    window.run();
    let mut last = 0;
    for _ in 0..5 {
        key(&mut window, Modifiers::NONE, Key::ArrowRight);
        let shown = player(&window);
        assert_eq!(shown.step().unwrap().action, StepAction::Bisect);
        assert!(shown.position() > last);
        last = shown.position();
    }
    key(&mut window, Modifiers::NONE, Key::ArrowLeft);
    assert!(player(&window).position() < last);
    assert_eq!(player(&window).step().unwrap().action, StepAction::Bisect);
    for _ in 0..5 {
        key(&mut window, Modifiers::NONE, Key::ArrowLeft);
    }
    assert_eq!(player(&window).position(), 0);
}

/// A coast of which all steps are recorded.
fn coast(window: &mut Window) {
    send(window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    let coarser = settings(window).boundary.with_diameter(0.4);
    set(window, Setting::Boundary(coarser));
    set(window, Setting::SmallestDiameter(0.5));
    wait_until(window, |window| window.state().session().derived().is_some());
}

/// Returns triangles by the positions of their corners, in ascending order.
fn in_order(triangles: impl Iterator<Item = [LatticePoint; 3]>) -> Vec<[[u32; 2]; 3]> {
    let sorted = |corners: [LatticePoint; 3]| {
        let mut corners = corners.map(|corner| [corner.x, corner.y]);
        corners.sort_unstable();
        corners
    };
    let mut all: Vec<_> = triangles.map(sorted).collect();
    all.sort_unstable();
    all
}

#[test]
fn the_last_steps_on_a_coast_remove_triangles_and_move_nodes_until_the_mesh_is_that_of_the_document() {
    let mut window = window();
    coast(&mut window);
    let extract = window.state().session().derived().unwrap().shared_extract();
    begin(&mut window);
    let stages = player(&window).recording().stages().len();
    assert!(stages > 4, "{stages}");
    let announced = format!("The last {stages} steps remove triangles outside");
    assert!(window.query_by_label_contains(&announced).is_some());
    press_button(&mut window, "Last step");
    let shown = player(&window);
    assert!(!shown.recording().is_cut_short);
    let node = |node: usize| extract.node(NodeId::from_index(node));
    let of_document = in_order(extract.cells().map(|cell| cell.corners.map(node)));
    assert!(in_order(shown.triangles().map(|one| one.corners(shown.nodes()))) == of_document);
    let mut actions = Vec::new();
    for _ in 0..stages {
        let step = *player(&window).step().unwrap();
        let StepAction::Derive(change) = step.action else { panic!("{step:?}") };
        assert!(window.query_by_label(&step.sentence()).is_some(), "{}", step.sentence());
        let (algorithm, lines) = step.lines();
        let current = format!("Current line {}: {}", lines.start, algorithm.lines()[lines.start - 1]);
        assert!(window.query_by_label(&current).is_some(), "{current}");
        actions.push(change.action);
        key(&mut window, Modifiers::NONE, Key::ArrowLeft);
    }
    assert!(actions.contains(&DerivationAction::RemoveByCorners));
    assert!(actions.contains(&DerivationAction::MoveToOutline));
    assert_eq!(player(&window).step().unwrap().action, StepAction::Finish);
    assert_eq!(player(&window).triangles().count(), player(&window).rows().len());
    // Stages change the mesh, as bisections do.
    send(&mut window, Command::from(StepCommand::OnlyBisections(true)));
    key(&mut window, Modifiers::NONE, Key::ArrowRight);
    assert_eq!(player(&window).position() + stages, player(&window).len() + 1);
    key(&mut window, Modifiers::NONE, Key::ArrowLeft);
    assert_eq!(player(&window).step().unwrap().action, StepAction::Bisect);
}

#[test]
fn steps_on_a_coast_are_exported_like_the_others() {
    let mut window = window();
    coast(&mut window);
    begin(&mut window);
    let last = player(&window).len();
    let folder = crate::app::tests::folder("app-steps", "coast");
    send(&mut window, Command::from(StepCommand::ExportRange(last, last)));
    send(&mut window, Command::from(StepCommand::Export(folder.join("coast.svg"))));
    wait_until(&mut window, |window| notice(window).contains("1 steps written"));
    let file = std::fs::read_dir(&folder).unwrap().next().unwrap().unwrap().path();
    let drawing = std::fs::read_to_string(file).unwrap();
    let count = window.state().session().triangle_count();
    let drawn = drawing.split("<g id=\"triangles\"").nth(1).unwrap().split("</g>").next().unwrap();
    assert_eq!(drawn.matches("<path").count(), count, "the mesh of the document");
    assert!(drawing.contains("Not in the report: "));
}

/// Several events of the pointer in one frame, as where frames are slow.
#[test]
fn after_a_fast_drag_the_number_is_that_of_the_slider_in_the_same_frame_and_steps_follow_by_themselves() {
    let mut window = window();
    coarse(&mut window);
    begin(&mut window);
    let slider = window.get_by_role_and_label(Role::Slider, "Step").rect();
    window.drag_at(slider.left_center() + vec2(8.0, 0.0));
    window.run();
    let count = player(&window).len();
    let shown = |window: &Window| -> usize {
        let counter = window.query_all_by_label_contains("Step ").find_map(|node| {
            let label = node.accesskit_node().label().or_else(|| node.accesskit_node().value())?;
            label.strip_prefix("Step ")?.split(" of ").next()?.replace(',', "").parse().ok()
        });
        counter.expect("the number of the step")
    };
    for share in [0.7, 0.3, 0.9] {
        let to = slider.left_center() + vec2(share * slider.width(), 0.0);
        for way in [0.2, 0.5] {
            window.input_mut().events.push(Event::PointerMoved(slider.left_center().lerp(to, way)));
        }
        window.event(Event::PointerMoved(to));
        window.step();
        let at_once = shown(&window);
        assert!(at_once.abs_diff((share * count as f32) as usize) < count / 20, "{at_once} of {count}");
        // No further event: the window draws the step by itself.
        window.run();
        assert_eq!((player(&window).position(), shown(&window)), (at_once, at_once));
        if let Some(step) = player(&window).step() {
            assert!(window.query_by_label(&step.sentence()).is_some());
        }
    }
    // The last move and the release in one frame.
    let to = slider.left_center() + vec2(0.5 * slider.width(), 0.0);
    window.input_mut().events.push(Event::PointerMoved(to));
    window.drop_at(to);
    window.run();
    let position = player(&window).position();
    assert!(position.abs_diff(count / 2) < count / 20, "{position} of {count}");
    assert_eq!(shown(&window), position);
}

#[test]
fn text_and_code_need_no_scrolling_in_a_low_window() {
    let mut window = window_of(vec2(1280.0, 720.0));
    send(&mut window, Command::from(FigureCommand::Open(ReportFigure::Neighbours)));
    wait_until(&mut window, |window| window.state().stepping().is_some_and(|steps| steps.player().is_some()));
    let mut seen = algorithms_in_sight(&mut window);
    key(&mut window, Modifiers::NONE, Key::Escape);
    coast(&mut window);
    begin(&mut window);
    seen.extend(algorithms_in_sight(&mut window));
    seen.sort();
    seen.dedup();
    assert!(seen.len() >= 8 && seen.contains(&Algorithm::FitToOutline), "{seen:?}");
}

/// Checks that sentence and code of a step of each algorithm are in sight, and returns the algorithms.
fn algorithms_in_sight(window: &mut Window) -> Vec<Algorithm> {
    let below = window.get_by_role_and_label(Role::Slider, "Step").rect().top();
    let mut seen = Vec::new();
    // Most lines run in the last steps.
    for position in (1..=player(window).len()).rev() {
        let (algorithm, lines) = player(window).recording().steps()[position - 1].lines();
        if seen.contains(&algorithm) {
            continue;
        }
        seen.push(algorithm);
        send(window, Command::from(StepCommand::GoTo(position)));
        let last = format!("Current line {}: {}", lines.end - 1, algorithm.lines()[lines.end - 2]);
        let rect = window.get_by_label(&last).rect();
        assert!(rect.bottom() < below, "{algorithm:?}: {rect:?} and {below}");
        assert!(window.get_by_label(&player(window).step().unwrap().sentence()).rect().top() > 0.0);
        assert!(canvas(window).width() > 600.0);
    }
    seen
}

#[test]
fn the_slider_goes_to_any_step() {
    let mut window = window();
    coarse(&mut window);
    begin(&mut window);
    let slider = window.get_by_role_and_label(Role::Slider, "Step").rect();
    let is_beside = |speed: egui_kittest::Node<'_>| speed.rect().left() >= slider.right();
    assert!(window.query_all_by_label("Steps per second").all(is_beside), "nothing covers the slider");
    window.drag_at(slider.left_center() + vec2(8.0, 0.0));
    window.run();
    window.drop_at(slider.center());
    window.run();
    let (position, count) = (player(&window).position(), player(&window).len());
    assert!(position > count / 3 && position < 2 * count / 3, "{position} of {count}");
}

#[test]
fn the_pointer_does_not_paint_and_an_edit_ends_the_mode() {
    let mut window = window();
    coarse(&mut window);
    let history = entries(&window);
    begin(&mut window);
    click(&mut window, FREE, Modifiers::NONE);
    assert_eq!(entries(&window), history);
    assert!(window.state().stepping().is_some());
    assert_eq!(window.state().tools().tool, &PAN);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(window.state().stepping().is_none());
    assert!(notice(&window).contains("was edited"), "{}", notice(&window));
    assert_eq!(window.state().tools().tool, &BRUSH, "the tool that was selected before");
    begin(&mut window);
    key(&mut window, Modifiers::NONE, Key::B);
    assert!(window.state().stepping().is_none(), "a tool acts on the mesh of the document");
}

#[test]
fn a_large_mesh_is_shown_up_to_a_limit() {
    let mut window = window();
    set(&mut window, Setting::Spacing(0.02));
    assert!(triangles(&window) > MOST_TRIANGLES);
    begin(&mut window);
    press_button(&mut window, "Last step");
    let shown = player(&window).rows().len();
    assert!((MOST_TRIANGLES..MOST_TRIANGLES + 100).contains(&shown), "{shown}");
    assert!(window.query_by_label_contains("the steps end here").is_some());
    press_button(&mut window, "First step");
    assert!(window.query_by_label_contains("more triangles than the 20,000 that are recorded").is_some());
    set(&mut window, Setting::Spacing(0.005));
    begin(&mut window);
    assert!(window.state().stepping().is_none());
    assert!(notice(&window).contains("larger grid spacing"), "{}", notice(&window));
}

#[test]
fn the_step_is_seen_on_the_canvas() {
    let mut window = drawn_window();
    coarse(&mut window);
    begin(&mut window);
    let steps = player(&window).recording().steps();
    let updates =
        |step: &meshbrush_study::steps::RecordedStep| matches!(step.action, StepAction::UpdateNeighbours(_));
    let deep = steps.iter().position(|step| updates(step) && step.level >= 3).unwrap();
    send(&mut window, Command::from(StepCommand::GoTo(deep + 1)));
    let numbers = painted_texts(window.output());
    let lattice = window.state().session().mesh().lattice();
    let middle = |number: u32| {
        let corners = player(&window).corners(number).map(|corner| lattice.world_from_lattice(corner));
        on_screen(&window, corners.into_iter().sum::<DVec2>() / 3.0)
    };
    let is_numbered = |&number: &u32| {
        numbers.iter().any(|(text, rect)| *text == number.to_string() && rect.contains(middle(number)))
    };
    let numbered = (1..=player(&window).rows().len() as u32).filter(is_numbered).count();
    assert!(numbered > 10, "{numbered} triangles have their numbers in their middles");
    let (_, lines) = player(&window).step().unwrap().lines();
    let current = window.get_by_label_contains(&format!("Current line {}:", lines.start)).rect();
    let is_mark = |shape: &&eframe::egui::Shape| match shape {
        eframe::egui::Shape::Rect(mark) => {
            mark.fill == tokens_of(&window.ctx).accent && current.expand(1.0).contains_rect(mark.rect)
        }
        _ => false,
    };
    assert!(painted_shapes(window.output()).iter().any(is_mark), "the line that runs is marked");
    let image = window.render().unwrap();
    if let Some(path) = std::env::var_os("MESHBRUSH_STEP_PICTURE") {
        image.save(path).unwrap();
    }
    let at = on_screen(&window, dvec2(0.999, 0.999));
    let [r, g, b, _] = image.get_pixel(at.x as u32, at.y as u32).0;
    assert!(r.max(g).max(b) > 30, "the mesh covers the domain: {r} {g} {b}");
}

#[test]
fn chosen_steps_are_written_as_numbered_drawings() {
    let mut window = window();
    coarse(&mut window);
    begin(&mut window);
    let folder = crate::app::tests::folder("app-steps", "drawings");
    send(&mut window, Command::from(StepCommand::ExportRange(3, 6)));
    key(&mut window, CTRL_SHIFT, Key::E);
    let path = folder.join("lesson.svg");
    key(&mut window, Modifiers::COMMAND, Key::A);
    window.event(Event::Text(path.display().to_string()));
    window.run();
    key(&mut window, Modifiers::NONE, Key::Enter);
    wait_until(&mut window, |window| notice(window).contains("4 steps written"));
    let files = || std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name());
    let mut names: Vec<_> = files().map(|name| name.into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names, ["lesson-0003.svg", "lesson-0004.svg", "lesson-0005.svg", "lesson-0006.svg"]);
    let drawing = std::fs::read_to_string(folder.join(&names[1])).unwrap();
    assert!(drawing.contains(&format!("Step 4 of {}", player(&window).len())));
    send(&mut window, Command::from(StepCommand::ExportAs(path.clone())));
    assert!(window.query_by_label("Replace 4 files?").is_some());
    press_button(&mut window, "Replace");
    // The message of the first export is still shown.
    wait_until(&mut window, |window| window.state().background.rows(true).is_empty());
    assert!(notice(&window).contains("4 steps written"));
    send(&mut window, Command::from(StepCommand::ExportRange(0, 100_000)));
    if player(&window).len() > MOST_FILES {
        send(&mut window, Command::from(StepCommand::ExportAs(path)));
        assert!(notice(&window).contains("at most 500"), "{}", notice(&window));
    }
}

#[cfg(unix)]
#[test]
fn a_cancelled_export_of_steps_removes_what_it_wrote_and_says_what_it_replaced() {
    let folder = crate::app::tests::folder("app-steps", "cancelled");
    let [first, second, last] = [3, 4, 5].map(|step| folder.join(format!("lesson-000{step}.svg")));
    std::fs::write(&second, "former").unwrap();
    assert!(std::process::Command::new("mkfifo").arg(&last).status().unwrap().success());
    let mut window = window();
    coarse(&mut window);
    begin(&mut window);
    send(&mut window, Command::from(StepCommand::ExportRange(3, 5)));
    send(&mut window, Command::from(StepCommand::Export(folder.join("lesson.svg"))));
    let replaced = || std::fs::read_to_string(&second).unwrap().starts_with("<svg");
    wait_until(&mut window, |_| replaced());
    // The last drawing waits for somebody who reads it.
    let work = window.state().background.rows(true)[0].id;
    send(&mut window, Command::from(FileCommand::CancelWork(work)));
    std::fs::read(&last).unwrap();
    wait_until(&mut window, |window| notice(window).contains("lesson-0004.svg"));
    assert!(notice(&window).contains("was replaced before that"), "{}", notice(&window));
    assert!(!first.exists() && replaced());
}
