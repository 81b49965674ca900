//! Links hold the document, and how it is looked at.

use std::path::PathBuf;

use eframe::egui::{self, vec2};

use super::{Window, canvas, fingerprint, notice, paint, send, wait_until, wheel, window, window_of};
use crate::app::features::stepping::StepCommand;
use meshbrush_core::document::Example;
use meshbrush_kit::kit::command::{Command, FileCommand, ShellCommand, ViewCommand};
use meshbrush_kit::kit::tools::PAN;

/// Copies a link, and returns it.
pub fn copied(window: &mut Window) -> String {
    window.state_mut().send(Command::from(FileCommand::CopyLink));
    (0..10)
        .find_map(|_| {
            window.step();
            window.output().platform_output.commands.iter().find_map(|command| match command {
                egui::OutputCommand::CopyText(text) => Some(text.clone()),
                _ => None,
            })
        })
        .expect("a link")
}

pub fn open(window: &mut Window, link: &str) {
    send(window, Command::from(FileCommand::Open(PathBuf::from(link))));
}

#[test]
fn a_link_opens_the_same_mesh_view_and_tool() {
    let mut first = window();
    paint(&mut first, 0.3);
    let at = canvas(&first).center() + vec2(70.0, 30.0);
    wheel(&mut first, at, 300.0);
    send(&mut first, Command::from(ShellCommand::Use(&PAN)));
    let link = copied(&mut first);
    assert!(link.starts_with("#1.") && link.len() < 30_000, "{} characters", link.len());
    assert!(notice(&first).contains("The link was copied"), "{}", notice(&first));
    let area = |window: &Window| window.state().view().camera.unwrap().visible_world();
    let mut second = window();
    send(&mut second, Command::from(FileCommand::OpenExample(Example::Diamond)));
    assert_ne!(fingerprint(&second), fingerprint(&first));
    open(&mut second, &link);
    assert_eq!(fingerprint(&second), fingerprint(&first));
    assert_eq!(second.state().tools().tool.name, PAN.name);
    let px = first.state().view().world_per_px();
    let moved =
        (area(&second).min - area(&first).min).length() + (area(&second).max - area(&first).max).length();
    assert!(moved < 0.01 * px, "the view moved by {} pixels", moved / px);
    // In a smaller window all of the area is in sight.
    let mut small = window_of(vec2(900.0, 600.0));
    open(&mut small, &link);
    let (shown, wanted) = (area(&small), area(&first));
    assert!((shown.min - wanted.min).max_element() < px && (wanted.max - shown.max).max_element() < px);
    // A view that was not moved shows the whole domain in every window.
    send(&mut first, Command::from(ViewCommand::Fit));
    let link = copied(&mut first);
    open(&mut small, &link);
    assert!(small.state().view().is_fitted);
}

#[test]
fn a_link_opens_at_the_step_that_was_shown() {
    let mut first = window();
    send(&mut first, Command::from(FileCommand::OpenExample(Example::Diamond)));
    let step = |window: &Window| window.state().stepping().and_then(|steps| Some(steps.player()?.position()));
    send(&mut first, Command::from(StepCommand::Begin(None)));
    wait_until(&mut first, |window| step(window).is_some());
    send(&mut first, Command::from(StepCommand::GoTo(37)));
    let link = copied(&mut first);
    let mut second = window();
    open(&mut second, &link);
    wait_until(&mut second, |window| step(window).is_some());
    assert_eq!(step(&second), Some(37));
    // More steps than there are lead to the last one.
    send(&mut second, Command::from(StepCommand::BeginAt(usize::MAX)));
    wait_until(&mut second, |window| step(window).is_some_and(|step| step > 37));
}

#[test]
fn a_link_that_is_damaged_leaves_an_empty_document_and_a_sentence() {
    let mut window = window();
    paint(&mut window, 0.3);
    let link = copied(&mut window);
    open(&mut window, &link[..link.len() - 30]);
    assert!(notice(&window).contains("The link is damaged"), "{}", notice(&window));
}
