//! What jobs find comes when the test lets it come, in an order that is drawn.

use std::fs;
use std::path::{Path, PathBuf};

use eframe::egui::{Key, Modifiers};
use fastrand::Rng;

use super::{TALL, Window, document, folder, open_section, window, window_of};
use crate::app::features::domain::DomainCommand;
use crate::app::features::plots::{Plots, PlotsCommand};
use crate::app::features::statistics::Statistics;
use crate::app::features::threats::ThreatsCommand;

use meshbrush_io::io::project;
use meshbrush_kit::kit::command::{Command, FileCommand, LayerCommand, ViewCommand};
use meshbrush_kit::kit::jobs::JobKind;
use meshbrush_kit::kit::view::CanvasAid;

const SQUARE: &str =
    r#"{"type": "Polygon", "coordinates": [[[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.2, 0.2]]]}"#;
const THREATS: &str = "x,y,range,peak\n0.5,0.5,0.1,0.9\n";

/// Sends a command, and lets one frame pass: frames that follow would wait for what is held.
fn send_and_step(window: &mut Window, command: Command) {
    window.state_mut().send(command);
    window.step();
}

/// Shows contour lines, or hides them.
fn show_contours() -> Command {
    Command::from(ViewCommand::ToggleAid(CanvasAid::Contours))
}

/// Delivers all that jobs have sent and still send, each time from one of them.
fn release_all(window: &mut Window, random: &mut Rng) {
    loop {
        window.step();
        window.state().jobs.wait_for_threads();
        if !window.state().jobs.release(|count| random.usize(..count)) {
            return;
        }
    }
}

fn written(folder: &Path, name: &str, content: &str) -> PathBuf {
    let file = folder.join(name);
    fs::write(&file, content).unwrap();
    file
}

/// Work on files that begins in one document and ends in the next one.
#[test]
fn whatever_the_order_in_which_files_are_done_the_next_document_stays_new() {
    for seed in 0..6 {
        let (folder, mut random) = (folder("app-held", &format!("files-{seed}")), Rng::with_seed(seed));
        let mut window = window();
        let former = document(&window).settings().clone();
        window.state().jobs.hold();
        let (saved, table) = (folder.join("a.meshbrush"), written(&folder, "threats.csv", THREATS));
        let square = written(&folder, "square.geojson", SQUARE);
        let mut commands = [
            Command::from(FileCommand::SaveTo(saved.clone())),
            Command::from(FileCommand::Export(folder.join("mesh.csv"))),
            Command::from(ThreatsCommand::Open(table)),
            Command::from(LayerCommand::OpenMask(square.clone())),
            Command::from(LayerCommand::OpenShapes(square.clone())),
            Command::from(DomainCommand::AddOutline(square)),
        ];
        random.shuffle(&mut commands);
        commands.into_iter().for_each(|command| send_and_step(&mut window, command));
        window.key_press_modifiers(Modifiers::COMMAND, Key::N);
        window.step();
        let new = document(&window).settings().clone();
        assert_ne!(new, former, "seed {seed}: nothing was edited, so that nothing is asked");
        release_all(&mut window, &mut random);
        assert_eq!(*document(&window).settings(), new, "seed {seed}");
        assert!(document(&window).history().is_empty(), "seed {seed}");
        assert_eq!(window.state().project.path(), None, "seed {seed}: the file is that of the former one");
        assert_eq!(*project::read(&saved).unwrap().settings(), former, "seed {seed}");
    }
}

/// The same of what is computed for panels and canvas.
#[test]
fn whatever_the_order_in_which_jobs_are_done_the_next_document_shows_its_own_figures() {
    for seed in 0..6 {
        let mut random = Rng::with_seed(seed);
        let mut window = window_of(TALL);
        for section in ["Statistics", "Plots"] {
            open_section(&mut window, section);
        }
        window.state().jobs.hold();
        send_and_step(&mut window, show_contours());
        for _ in 0..random.usize(..5) {
            window.step();
        }
        send_and_step(&mut window, Command::from(FileCommand::New));
        release_all(&mut window, &mut random);
        let session = window.state().session();
        let features = window.state().features();
        let (figures, is_current) =
            features.get::<Statistics>().figures(session).expect("the statistics are shown");
        assert!(is_current, "seed {seed}");
        assert_eq!(figures.fingerprint, session.mesh().fingerprint().to_string(), "seed {seed}");
        assert!(
            features.get::<Plots>().plot(session).is_some_and(|(_, is_current)| is_current),
            "seed {seed}"
        );
    }
}

#[test]
fn a_key_that_is_held_starts_no_job_before_the_last_one_has_ended() {
    let mut window = window();
    window.state().jobs.hold();
    let started = window.state().jobs.started();
    for _ in 0..50 {
        for _shown in [true, false] {
            send_and_step(&mut window, show_contours());
            assert!(window.state().jobs.threads(JobKind::Compute) <= 1);
        }
    }
    assert_eq!(window.state().jobs.started(), started + 1);
    // Once it has ended, the next one may start.
    release_all(&mut window, &mut Rng::with_seed(1));
    send_and_step(&mut window, show_contours());
    assert_eq!(window.state().jobs.started(), started + 2);
}

#[test]
fn no_thread_outlives_the_window() {
    let mut window = window_of(TALL);
    for section in ["Statistics", "Plots"] {
        open_section(&mut window, section);
    }
    let jobs = window.state().jobs.clone();
    jobs.hold();
    send_and_step(&mut window, show_contours());
    send_and_step(&mut window, Command::from(PlotsCommand::Measure));
    drop(window);
    jobs.wait_for_threads();
}
