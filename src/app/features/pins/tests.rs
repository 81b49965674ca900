//! Pins: placed, moved, deleted, followed through edits, and written as a table.

use std::fs;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, OutputCommand, vec2};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, dvec2};

use crate::app::features::inspection::QUERY;
use crate::app::features::pins::{Pins, PinsCommand};
use crate::app::tests::{
    FREE, TALL, Window, click, document, entries, folder, key, move_to, notice, on_screen, press, release,
    send, settings, step_until, stroke, value_of, wait_for_notice, wait_until, window_of,
};
use meshbrush_io::io::Meter;
use meshbrush_io::io::located::write_of_document;
use meshbrush_kit::kit::command::{Command, EditCommand, ShellCommand};

const AT: DVec2 = dvec2(0.3, 0.6);

fn pins(window: &Window) -> Vec<DVec2> {
    settings(window).pins.to_vec()
}

fn is_near(a: DVec2, b: DVec2) -> bool {
    a.distance(b) < 2e-3
}

/// Returns a window with the query tool and two pins.
fn window_with_pins() -> Window {
    let mut window = window_of(TALL);
    send(&mut window, Command::from(ShellCommand::Use(&QUERY)));
    for point in [AT, FREE] {
        click(&mut window, point, Modifiers::NONE);
        key(&mut window, Modifiers::SHIFT, Key::P);
    }
    window
}

/// Returns what the last frame copied.
fn copied(window: &Window) -> Option<&String> {
    let commands = &window.output().platform_output.commands;
    commands.iter().find_map(|command| match command {
        OutputCommand::CopyText(text) => Some(text),
        _ => None,
    })
}

/// Returns the row of a pin in the table of the panel.
fn row(window: &Window, number: usize) -> Vec<String> {
    let text = value_of(window, Role::ListItem, &format!("Pin {number}"));
    text.split(' ').map(str::to_owned).collect()
}

/// Returns the table that the command line prints for the saved document.
fn expected_table(window: &Window) -> String {
    let (document, mut table) = (document(window), Vec::new());
    let (settings, paint) = (document.settings(), document.paint());
    write_of_document(&mut table, settings, paint, &settings.pins, &Meter::default()).unwrap();
    String::from_utf8(table).unwrap()
}

#[test]
fn a_query_is_pinned_by_key_and_button_and_undone() {
    let mut window = window_with_pins();
    let [a, b] = pins(&window)[..] else { panic!("{:?}", pins(&window)) };
    assert!(is_near(a, AT) && is_near(b, FREE));
    assert_eq!(entries(&window), 2);
    key(&mut window, Modifiers::SHIFT, Key::P);
    assert_eq!(pins(&window).len(), 2, "the same point is not pinned twice");
    click(&mut window, dvec2(0.5, 0.2), Modifiers::NONE);
    window.get_by_role_and_label(Role::Button, "Pin").click();
    window.run();
    assert_eq!(pins(&window).len(), 3);
    for left in [2, 1] {
        key(&mut window, Modifiers::COMMAND, Key::Z);
        assert_eq!(pins(&window).len(), left);
    }
    assert!(is_near(pins(&window)[0], AT));
}

#[test]
fn the_table_follows_every_edit() {
    let mut window = window_with_pins();
    let before = row(&window, 2);
    let readout = |window: &Window, at| {
        meshbrush_kit::kit::readout::Readout::triangle_at(
            at,
            window.state().session(),
            window.state().view().quantity,
        )
    };
    let check = |window: &Window| {
        for (number, at) in pins(window).into_iter().enumerate() {
            let triangle = readout(window, at).unwrap();
            let row = row(window, number + 1);
            assert_eq!(row.len(), 10, "{row:?}");
            assert_eq!(row[2], meshbrush_ui::widgets::format::count(triangle.id.index() as u64));
            assert_eq!(row[3], triangle.level.to_string());
            let zeta: f64 = row[4..7].iter().map(|zeta| zeta.parse::<f64>().unwrap()).sum();
            assert!((zeta - 1.0).abs() < 2e-3, "{row:?}");
        }
    };
    check(&window);
    send(&mut window, Command::from(ShellCommand::Use(&crate::app::features::painting::BRUSH)));
    stroke(&mut window, FREE, FREE + dvec2(0.0, 0.05));
    send(&mut window, Command::from(ShellCommand::Use(&QUERY)));
    assert_ne!(row(&window, 2), before, "paint refines around the second pin");
    check(&window);
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(row(&window, 2)[3], before[3]);
    check(&window);
}

#[test]
fn a_pin_is_dragged_as_one_gesture_and_deleted_by_key() {
    let mut window = window_with_pins();
    let to = dvec2(0.45, 0.3);
    press(&mut window, AT, Modifiers::NONE);
    for share in [0.3, 0.7, 1.0] {
        move_to(&mut window, AT.lerp(to, share));
    }
    release(&mut window, to);
    assert!(is_near(pins(&window)[0], to), "{:?}", pins(&window));
    assert_eq!(entries(&window), 3, "one gesture");
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert!(is_near(pins(&window)[0], AT));
    // A drag that begins beside all pins moves none.
    press(&mut window, dvec2(0.1, 0.1), Modifiers::NONE);
    move_to(&mut window, dvec2(0.2, 0.2));
    release(&mut window, dvec2(0.2, 0.2));
    assert_eq!(entries(&window), 2);
    window.get_by_role_and_label(Role::ListItem, "Pin 1").click();
    window.run();
    key(&mut window, Modifiers::NONE, Key::Delete);
    assert!(pins(&window).len() == 1 && is_near(pins(&window)[0], FREE));
    window.get_by_role_and_label(Role::Button, "Delete all pins").click();
    window.run();
    assert_eq!(pins(&window), []);
}

#[test]
fn the_table_is_copied_and_exported_as_the_command_line_prints_it() {
    let mut window = window_with_pins();
    send(&mut window, Command::from(ShellCommand::Use(&crate::app::features::painting::BRUSH)));
    stroke(&mut window, AT, AT + dvec2(0.1, 0.05));
    send(&mut window, Command::from(ShellCommand::Use(&QUERY)));
    let expected = expected_table(&window);
    assert_eq!(expected.lines().count(), 3);
    send(&mut window, Command::from(PinsCommand::Copy));
    step_until(&mut window, |window| copied(window).is_some());
    assert_eq!(copied(&window), Some(&expected));
    let file = folder("pins", "export").join("pins.csv");
    wait_until(&mut window, |window| notice(window).starts_with("Copied: the table of 2 pins"));
    send(&mut window, Command::from(ShellCommand::DismissNotice));
    send(&mut window, Command::from(PinsCommand::ExportAs(file.clone())));
    let notice = wait_for_notice(&mut window);
    assert!(notice.starts_with("2 pins written to"), "{notice}");
    assert_eq!(fs::read_to_string(file).unwrap(), expected);
}

#[test]
fn many_pins_are_read_over_several_frames_and_an_idle_window_reads_none() {
    let mut window = window_of(vec2(1440.0, 900.0));
    let many = (0..5000).map(|i| dvec2(f64::from(i) / 5000.0, 0.5)).collect();
    send(
        &mut window,
        Command::from(EditCommand::Set(meshbrush_core::document::Setting::Pins(std::sync::Arc::new(many)))),
    );
    send(&mut window, Command::from(EditCommand::EndGesture));
    send(&mut window, Command::from(ShellCommand::Use(&QUERY)));
    window.run();
    let is_current = |window: &Window| {
        let app = window.state();
        app.features.get::<Pins>().reader.is_current(app.session(), app.view().quantity)
    };
    assert!(is_current(&window));
    assert_eq!(window.state().features.get::<Pins>().reader.rows().len(), 5000);
    // The harness runs until no frame is asked for any more.
    assert!(window.try_run_realtime().is_ok());
}

#[test]
fn the_values_of_a_pin_are_beside_it_under_the_pointer() {
    let mut window = window_with_pins();
    move_to(&mut window, FREE);
    let values = window.get_by_label_contains("Pin 2 · triangle").rect();
    assert!((values.top() - on_screen(&window, FREE).y - 8.0).abs() < 1.0, "{values:?}");
    move_to(&mut window, dvec2(0.1, 0.1));
    assert!(window.query_by_label_contains("Pin 2 · triangle").is_none());
}
