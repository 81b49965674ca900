//! Opening and exporting files.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::dvec2;

use super::{
    Window, fingerprint, has_raster, key, notice, scratch, send, stroke, wait_for_notice, wait_until, window,
};
use meshbrush_core::document::Example;
use meshbrush_core::layers::RasterReading;
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand, ShellCommand};

#[test]
fn an_export_writes_the_file_and_tells() {
    let mut window = window();
    for ending in ["vtu", "msh", "svg", "png"] {
        let file = scratch(&format!("app-export.{ending}"));
        let _ = std::fs::remove_file(&file); // absent at the first run
        send(&mut window, Command::from(FileCommand::Export(file.clone())));
        let message = wait_for_notice(&mut window);
        assert!(message.contains("triangles written to") && message.contains(ending), "{message}");
        assert!(std::fs::metadata(&file).unwrap().len() > 100_000);
        send(&mut window, Command::from(ShellCommand::Escape));
    }
    send(&mut window, Command::from(FileCommand::Export(scratch("app-export.doc"))));
    assert!(wait_for_notice(&mut window).contains(".vtu"));
    send(&mut window, Command::from(ShellCommand::Escape));
    send(&mut window, Command::from(FileCommand::Export(scratch("no such folder/mesh.vtu"))));
    assert!(wait_for_notice(&mut window).contains("could not be written: there is no folder"));
    stroke(&mut window, dvec2(0.1, 0.1), dvec2(0.2, 0.1));
    assert!(notice(&window).contains("no folder"), "what failed stays");
}

#[test]
fn an_export_counts_the_triangles_of_the_file() {
    let mut window = window();
    send(&mut window, Command::from(FileCommand::OpenExample(Example::Aegean)));
    wait_until(&mut window, |window| window.state().session().derived().is_some());
    let file = scratch("app-export-coast.obj");
    let _ = std::fs::remove_file(&file); // absent at the first run
    send(&mut window, Command::from(FileCommand::Export(file.clone())));
    let message = wait_for_notice(&mut window);
    let written =
        std::fs::read_to_string(&file).unwrap().lines().filter(|line| line.starts_with("f ")).count();
    assert_ne!(written, window.state().session().mesh().triangle_count(), "nodes are on the coast");
    let count = meshbrush_ui::widgets::format::count(written as u64);
    assert!(message.starts_with(&format!("{count} triangles written to")), "{written}: {message}");
}

#[test]
fn an_export_asks_before_it_replaces_any_of_its_files() {
    let mut window = window();
    let [nodes, elements] = ["node", "ele"].map(|ending| scratch(&format!("app-replace.{ending}")));
    for ending in ["node", "neigh", "edge"] {
        let _ = std::fs::remove_file(nodes.with_extension(ending)); // absent at the first run
    }
    std::fs::write(&elements, "of another mesh").unwrap();
    let button = |window: &mut Window, label: &str| {
        window.get_by_role_and_label(Role::Button, label).click();
        window.run();
    };
    send(&mut window, Command::from(FileCommand::ExportAs(nodes.clone())));
    button(&mut window, "Cancel");
    assert_eq!((notice(&window).as_str(), nodes.exists()), ("", false));
    send(&mut window, Command::from(FileCommand::ExportAs(nodes.clone())));
    assert!(window.query_by_label_contains("app-replace.ele?").is_some(), "the one that is there");
    button(&mut window, "Replace");
    assert!(wait_for_notice(&mut window).contains("triangles written to"));
    assert!(nodes.exists() && std::fs::read_to_string(&elements).unwrap() != "of another mesh");
    stroke(&mut window, dvec2(0.1, 0.1), dvec2(0.2, 0.1));
    assert_eq!(notice(&window), "", "news disappear when work continues");
}

#[test]
fn the_export_dialog_takes_a_path() {
    let mut window = window();
    let file = scratch("app-dialog.obj");
    let _ = std::fs::remove_file(&file); // absent at the first run
    key(&mut window, Modifiers::COMMAND, Key::E);
    window.run_steps(3);
    window.event(Event::Text(file.display().to_string()));
    window.run();
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!(wait_for_notice(&mut window).contains("written"));
    assert!(file.exists());
}

#[test]
fn a_bad_picture_is_told_and_a_good_one_becomes_risk() {
    let mut window = window();
    let before = fingerprint(&window);
    let bad = scratch("app-bad.png");
    std::fs::write(&bad, b"no picture").unwrap();
    send(&mut window, Command::from(LayerCommand::OpenImage(bad)));
    let message = wait_for_notice(&mut window);
    assert!(message.contains("app-bad.png"), "{message}");
    assert_eq!(fingerprint(&window), before);
    send(&mut window, Command::from(ShellCommand::Escape));

    let good = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/jacksboro_slope.png");
    send(&mut window, Command::from(LayerCommand::OpenImage(good.into())));
    wait_until(&mut window, |window| fingerprint(window) != before);
    assert!(has_raster(&window, &RasterReading::Risk));
}
