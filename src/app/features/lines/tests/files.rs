use std::path::PathBuf;

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;

use crate::app::features::lines::LinesCommand;
use crate::app::tests::{
    Window, entries, folder, open_section, send, settings, wait_for_notice, wait_until, window,
};
use meshbrush_kit::kit::command::{Command, EditCommand, FileCommand};

/// Writes a file with a breakwater that leaves the domain.
fn breakwater(name: &str) -> PathBuf {
    let file = folder("app-lines", name).join("breakwater.geojson");
    let text = r#"{"type": "LineString", "coordinates": [[0.2, 0.3], [0.55, 0.41], [1.4, 0.75]]}"#;
    std::fs::write(&file, text).unwrap();
    file
}

/// Returns a new document with the breakwater, and its mesh.
fn with_breakwater(name: &str) -> Window {
    let mut window = window();
    send(&mut window, Command::from(FileCommand::New));
    send(&mut window, Command::from(LinesCommand::Open(breakwater(name))));
    let message = wait_for_notice(&mut window);
    assert!(message.contains("Added: 1 line."), "{message}");
    wait_until(&mut window, |window| {
        window.state().session().derived().is_some_and(|derived| derived.line_fits.len() == 1)
    });
    window
}

#[test]
fn lines_of_a_file_are_on_edges_and_undone() {
    let mut window = with_breakwater("file");
    let lines = settings(&window).lines.clone();
    assert_eq!(
        (lines.len(), &*lines[0].name, lines[0].points.len(), entries(&window)),
        (1, "breakwater", 3, 1)
    );
    let fit = window.state().session().derived().unwrap().line_fits[0].clone();
    let inside = fit.length - fit.unresolved.iter().map(|part| part.length).sum::<f64>();
    assert!((fit.length_on_edges - inside).abs() < 1e-9 && fit.length_on_edges > 0.5 * fit.length, "{fit:?}");
    let extract = window.state().session().derived().unwrap().shared_extract();
    assert!(extract.nodes().len() > 625, "the grid has 25 nodes a side");
    send(&mut window, Command::from(EditCommand::Undo));
    assert!(settings(&window).lines.is_empty());
    wait_until(&mut window, |window| window.state().session().derived().is_none());
    send(&mut window, Command::from(EditCommand::Redo));
    assert_eq!(settings(&window).lines.len(), 1);
}

#[test]
fn the_panel_says_how_much_of_a_line_is_on_edges() {
    let mut window = with_breakwater("panel");
    send(&mut window, Command::from(LinesCommand::Open(breakwater("panel"))));
    wait_until(&mut window, |window| settings(window).lines.len() == 2);
    send(&mut window, Command::from(LinesCommand::Remove(7)));
    send(&mut window, Command::from(LinesCommand::Remove(1)));
    assert_eq!(settings(&window).lines.len(), 1);
    window.get_by_role_and_label(Role::Tab, "Domain").click();
    window.run();
    open_section(&mut window, "Lines");
    assert!(window.query_by_label("breakwater").is_some());
    window.get_by_role_and_label(Role::Button, "Delete all lines").click();
    window.run();
    assert!(settings(&window).lines.is_empty());
}
