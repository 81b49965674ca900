//! Plots: chosen, computed while they are shown, following edits, measured, cancelled and exported.

use std::fs;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, OutputCommand};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::{PlotKind, PlotsCommand};
use crate::app::features::plots::Plots;
use crate::app::tests::{
    FREE, TALL, Window, canvas, choose, folder, key, open_section, send, settings, stroke, triangles,
    wait_for_notice, wait_until, window_of,
};
use meshbrush_core::build::RefinementCriterion;
use meshbrush_core::document::{Example, Setting};
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand, ShellCommand};
use meshbrush_study::levels::Bisections;
use meshbrush_ui::widgets::format;

/// Returns the note below a plot.
fn note(window: &Window, plot: &str) -> Option<String> {
    let shown = window.query_by_role_and_label(Role::Image, plot)?;
    shown.accesskit_node().value()
}

fn is_current(window: &Window) -> bool {
    window
        .state()
        .features()
        .get::<Plots>()
        .plot(window.state().session())
        .is_some_and(|(_, is_current)| is_current)
}

#[test]
fn a_key_opens_the_plots_which_follow_the_mesh() {
    let mut window = window_of(TALL);
    assert!(window.query_by_role_and_label(Role::Image, "Triangles per level").is_none());
    assert!(!window.state().features().get::<Plots>().is_known(), "nothing is computed unless it is shown");
    key(&mut window, Modifiers::NONE, Key::F9);
    wait_until(&mut window, is_current);
    let of_mesh = |window: &Window| format!("{} triangles", format::count(triangles(window) as u64));
    assert_eq!(note(&window, "Triangles per level"), Some(of_mesh(&window)));
    let before = triangles(&window);
    stroke(&mut window, FREE, FREE + glam::dvec2(0.0, 0.1));
    wait_until(&mut window, is_current);
    assert_ne!(triangles(&window), before);
    assert_eq!(note(&window, "Triangles per level"), Some(of_mesh(&window)));
}

#[test]
fn the_closure_cost_is_that_of_the_library() {
    let mut window = window_of(TALL);
    choose(&mut window, "Method", "Plot closure cost");
    wait_until(&mut window, is_current);
    let session = window.state().session();
    let follower = session.follower();
    let criterion =
        RefinementCriterion::by_area(follower.domain(), follower.field(), session.document().paint());
    let counts = Bisections::by_level(session.mesh(), &criterion, &settings(&window).limits());
    let sum = |of: fn(&Bisections) -> usize| format::count(counts.iter().map(of).sum::<usize>() as u64);
    let expected = format!("{} required, {} forced", sum(|of| of.required), sum(|of| of.forced));
    let shown = note(&window, "Closure cost").unwrap();
    assert!(shown.starts_with(&expected), "{shown}: {expected}");
}

#[test]
fn the_plot_is_chosen_in_the_panel() {
    let mut window = window_of(TALL);
    open_section(&mut window, "Plots");
    window.get_by_role_and_label(Role::ComboBox, "Plot").click();
    window.run();
    window.get_by_label("h per level").click();
    window.run();
    wait_until(&mut window, is_current);
    let plot = window.get_by_role_and_label(Role::Image, "h per level").rect();
    assert!(plot.left() > canvas(&window).right() && plot.width() > 150.0, "{plot:?}");
    window.hover_at(plot.center());
    window.run_steps(8);
    assert!(window.query_by_label_contains("largest h").is_some(), "values beside the pointer");
}

#[test]
fn the_time_is_measured_when_the_button_is_clicked() {
    let mut window = window_of(TALL);
    choose(&mut window, "Method", "Plot time per triangle");
    assert!(!window.state().features().get::<Plots>().is_measuring(), "never by itself");
    send(&mut window, Command::from(PlotsCommand::SetUp { last_level: 6, runs: 2 }));
    window.get_by_role_and_label(Role::Button, "Measure").click();
    window.run();
    wait_until(&mut window, |window| !window.state().features().get::<Plots>().is_measuring());
    let meshes = &window.state().features().get::<Plots>().experiment().meshes;
    assert_eq!(meshes.iter().map(|mesh| mesh.level).collect::<Vec<_>>(), [1, 2, 3, 4, 5, 6]);
    assert_eq!(meshes[4].triangles, 9_560);
    assert!(meshes.iter().all(|mesh| mesh.runs.len() == 2), "{meshes:?}");
    let gradient = note(&window, "Time per triangle").unwrap();
    assert!(gradient.starts_with("Exponent of Figure 5 ") && gradient.contains("report: 1.01"), "{gradient}");
    choose(&mut window, "Method", "Plot figure 5 of the report");
    assert!(note(&window, "Figure 5 of the report").unwrap().contains("report: 1.01"));
    window.get_by_role_and_label(Role::Button, "Copy numbers").click();
    let mut copied = Vec::new();
    for _ in 0..3 {
        window.step();
        copied.extend(window.output().platform_output.commands.clone());
    }
    let is_table = |command: &OutputCommand| matches!(command, OutputCommand::CopyText(text) if text.contains("9,560        9,560"));
    assert!(copied.iter().any(is_table), "{copied:?}");
}

#[test]
fn measuring_is_cancelled() {
    let mut window = window_of(TALL);
    choose(&mut window, "Method", "Plot time per triangle");
    window.get_by_role_and_label(Role::Button, "Measure").click();
    window.run();
    window.get_by_role_and_label(Role::Button, "Cancel measuring").click();
    window.run();
    assert!(!window.state().features().get::<Plots>().is_measuring());
    assert!(window.state().features().get::<Plots>().experiment().meshes.len() < 13);
    assert!(window.query_by_role_and_label(Role::Button, "Measure").is_some());
}

#[test]
fn why_an_experiment_ended_is_said() {
    let mut window = window_of(TALL);
    let (job, output) = window.state().jobs.expect();
    window.state_mut().features.get_mut::<Plots>().measuring = Some(job);
    let problem = "There is no memory for this mesh.";
    output.send(Err(problem.into()));
    assert_eq!(wait_for_notice(&mut window), problem);
    assert!(!window.state().features().get::<Plots>().is_measuring());
}

#[test]
fn plots_are_exported_as_drawing_and_table() {
    let folder = folder("plots", "exported");
    let mut window = window_of(TALL);
    key(&mut window, Modifiers::COMMAND, Key::P);
    assert!(window.get_by_role_and_label(Role::MenuItem, "Export plot…").accesskit_node().is_disabled());
    key(&mut window, Modifiers::NONE, Key::Escape);
    send(&mut window, Command::from(PlotsCommand::Show(PlotKind::Bisections)));
    wait_until(&mut window, is_current);
    let mut written = |name: &str| {
        let path = folder.join(name);
        send(&mut window, Command::from(PlotsCommand::ExportAs(path.clone())));
        assert!(wait_for_notice(&mut window).starts_with("The plot was written to "));
        send(&mut window, Command::from(ShellCommand::DismissNotice));
        path
    };
    let table = fs::read_to_string(written("cost.csv")).unwrap();
    assert!(table.starts_with("level of the bisected triangle,Required,Forced\n0,"), "{table}");
    let drawing = fs::read_to_string(written("cost.svg")).unwrap();
    assert!(drawing.starts_with("<svg ") && drawing.contains(">Forced<"), "{drawing}");
    written("without ending");
    assert_eq!(fs::read_to_string(folder.join("without ending.svg")).unwrap(), drawing);
}

#[test]
fn every_control_of_the_plots_has_a_sentence() {
    let mut window = window_of(TALL);
    for (kind, _) in PlotKind::ALL {
        send(&mut window, Command::from(PlotsCommand::Show(kind)));
        window.run();
        assert_eq!(crate::app::tests::tips::unexplained(&window), [""; 0], "{}", kind.name());
    }
}

#[test]
fn the_curve_of_errors_is_that_of_the_document_also_where_its_mesh_was_given_up() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Heights)));
    wait_until(&mut window, is_current);
    let spacing = settings(&window).spacing;
    for setting in [Setting::MaxTriangles(5000), Setting::Spacing(0.5 * spacing)] {
        send(&mut window, Command::from(EditCommand::Set(setting)));
        send(&mut window, Command::from(EditCommand::EndGesture));
    }
    wait_until(&mut window, is_current);
    let (plot, _) = window.state().features().get::<Plots>().plot(window.state().session()).unwrap();
    let coarse = plot.series.iter().find(|series| series.name == "Uniform mesh").unwrap().points[0];
    assert_eq!(coarse[0], 2048.0, "four times the triangles of twice the spacing");
}
