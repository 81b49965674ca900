//! The rules of solvers in the window.

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::figures::row;
use crate::app::features::statistics::StatisticsCommand;
use crate::app::tests::{TALL, Window, open_section, send, set, wait_for_jobs, wait_until, window_of};
use meshbrush_core::document::{Example, Setting};
use meshbrush_io::io::solver_rules::Solver;
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand};

fn choose_solver(window: &mut Window, solver: Solver) {
    send(window, Command::from(StatisticsCommand::ChooseSolver(solver)));
    wait_for_jobs(window);
    wait_until(window, |window| row(window, "Rules") != "being checked …");
}

#[test]
fn a_solver_takes_the_mesh_or_its_rules_lead_to_the_places() {
    let mut window = window_of(TALL);
    open_section(&mut window, "Solver rules");
    // Every side of the plain is open: FVCOM refuses the triangles in two corners.
    choose_solver(&mut window, Solver::Fvcom);
    assert!(row(&window, "Rules").ends_with("of 6 broken"), "{}", row(&window, "Rules"));
    let found = row(&window, "two open nodes and shore");
    assert!(found.ends_with(" places"), "{found}");
    let place = window.get_by_role_and_label(Role::Button, "Place 1");
    let text = place.accesskit_node().value().unwrap_or_default();
    place.click();
    window.run();
    let middle = window.state().view().camera.unwrap().visible_world().center();
    let near = |at: f64| text.contains(&format!("{at:.2}")[..3]);
    assert!(near(middle.x) && near(middle.y), "{text} is in the middle: {middle}");
    choose_solver(&mut window, Solver::Delft3dFm);
    assert!(row(&window, "Rules").contains("kept: ready for Delft3D-FM"), "{}", row(&window, "Rules"));
    assert!(window.query_by_role_and_label(Role::Button, "Place 1").is_none());
}

#[test]
fn places_of_a_sea_on_the_earth_are_in_its_plane() {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(FileCommand::OpenExample(Example::CelticSea)));
    wait_for_jobs(&mut window);
    set(&mut window, Setting::SmallestDiameter(15_000.0));
    wait_until(&mut window, |window| window.state().session().derived().is_some());
    open_section(&mut window, "Solver rules");
    choose_solver(&mut window, Solver::Telemac);
    let first = window.get_all_by_role_and_label(Role::Button, "Place 1").next();
    first.expect("a rule is broken").click();
    window.run();
    let session = window.state().session();
    let middle = window.state().view().camera.unwrap().visible_world().center();
    assert!(session.document().settings().domain.bounds.contains(middle), "{middle}");
    assert!(session.locate(middle).triangle().is_some(), "a triangle is there");
}

#[test]
fn repair_has_triangles_bisected_by_layers_and_undo_takes_them_away() {
    let mut window = window_of(TALL);
    open_section(&mut window, "Solver rules");
    choose_solver(&mut window, Solver::Fvcom);
    let settings = |window: &Window| window.state().session().document().settings().clone();
    let before = settings(&window);
    window.get_by_role_and_label(Role::Button, "Repair").click();
    window.run();
    wait_for_jobs(&mut window);
    wait_until(&mut window, |window| row(window, "Rules").contains("kept: ready for FVCOM"));
    let after = settings(&window);
    let added: Vec<&str> = after.layers[before.layers.len()..].iter().map(|layer| &*layer.name).collect();
    assert!(added.iter().any(|name| name.starts_with("Repair for FVCOM")), "{added:?}");
    assert!(window.query_by_label_contains("bisected once more for FVCOM").is_some());
    send(&mut window, Command::from(EditCommand::Undo));
    wait_until(&mut window, |window| row(window, "Rules").ends_with("of 6 broken"));
    assert_eq!(settings(&window), before, "one entry of the history");
}
