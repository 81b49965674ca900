//! The real program in a real window: painted in and queried with the mouse, and judged by its picture.
//!
//! `sh tests/run` installs what this needs (Xvfb, xdotool, xclip, a software Vulkan driver) and runs it. By hand:
//!
//! ```sh
//! cargo test --test window -- --ignored
//! ```
//!
//! The pictures are left in `target/tmp/window`, for a look.
#![cfg(all(feature = "gui", target_os = "linux"))]

use std::fs;
use std::io::{BufRead, BufReader, Write as _};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use meshbrush_io::io::journal::{self, Left};

/// The window's default size, which is also the display's: the window fills it.
const SIZE: (usize, usize) = (1440, 900);
/// Where the canvas and the panel beside it surely are, whatever the bars' exact sizes.
const CANVAS: Area = Area { x: 60..1140, y: 84..860 };
const PANEL: Area = Area { x: 1170..1430, y: 50..860 };
/// In the corner of the canvas where a row shows the progress of long work, below the domain.
const PROGRESS: Area = Area { x: 800..940, y: 836..852 };
/// The pointer rests here, off the canvas, while a picture is taken.
const RESTING_PLACE: (usize, usize) = (720, 890);
/// The fill of level 0 where edges are far, and how much a driver may be off.
const LEVEL_0: ([u8; 3], u8) = ([0x1d, 0x21, 0x2b], 3);
/// What a desktop finds the menu entry by.
const WINDOW_CLASS: &str = "org.meshbrush.Meshbrush";
const BRUSH_KEY: &str = "b";
const QUERY_KEY: &str = "q";
const UNDO_KEYS: &str = "ctrl+z";
const DUPLICATE_KEYS: &str = "ctrl+j";
const NEW_KEYS: &str = "ctrl+n";
const QUIT_KEYS: &str = "ctrl+q";
const GO_TO_KEYS: &str = "ctrl+g";
const COPY_KEYS: &str = "ctrl+c";
const CUT_KEYS: &str = "ctrl+x";
const PASTE_KEYS: &str = "ctrl+v";
/// Places in the domain, as fractions from its upper left corner. The first example leaves them free of
/// paint.
const STROKE: [(f64, f64); 2] = [(0.84, 0.50), (0.96, 0.56)];
const STROKE_MOVES: i64 = 10;
const FAR_FROM_STROKE: [(f64, f64); 2] = [(0.02, 0.02), (0.65, 0.98)];
const CLICK: (f64, f64) = (0.06, 0.50);
/// For the slowest thing a window does: starting on a busy machine without a GPU.
const PATIENCE: Duration = Duration::from_secs(60);

#[test]
#[ignore = "needs a virtual display: sh tests/run starts one"]
fn a_stroke_refines_the_mesh_under_it_and_a_click_reads_a_triangle() {
    paint_query_and_undo("window", "gpu");
}

#[test]
#[ignore = "needs a virtual display: sh tests/run starts one"]
fn a_stroke_refines_the_mesh_under_it_where_the_mesh_is_drawn_in_software() {
    paint_query_and_undo("window-software", "software");
}

fn paint_query_and_undo(name: &str, draw: &str) {
    let scratch = Scratch::new(name);
    let display = Display::start(&scratch);
    let variables = [("DISPLAY", display.name.as_str()), ("MESHBRUSH_DRAW", draw)];
    let mut program = Program::start(&scratch, &variables);
    program.wait_for_window(&display);

    display.point_at(RESTING_PLACE);
    let example = display.settled_picture(&scratch, "1-example");
    let domain = example.domain();
    assert!(
        domain.x.len() > 400 && domain.y.len() > 400,
        "the domain is fitted into the canvas, but level 0 covers {domain:?} only"
    );

    display.xdotool(&["key", BRUSH_KEY]);
    display.drag(domain.at(STROKE[0]), domain.at(STROKE[1]));
    display.point_at(RESTING_PLACE);
    let painted = display.settled_picture(&scratch, "2-painted");
    let stroke = Area::between(domain.at(STROKE[0]), domain.at(STROKE[1]));
    let [refined, deep] =
        [Rgb::is_refined, Rgb::is_deep].map(|is| (example.count(&stroke, is), painted.count(&stroke, is)));
    assert!(
        refined.0 == 0 && refined.1 > stroke.size() * 9 / 10,
        "pixels of refined triangles round the stroke: {} before, {} after, of {}",
        refined.0,
        refined.1,
        stroke.size()
    );
    assert!(
        deep.1 > stroke.size() / 4,
        "pixels of deep levels round the stroke: {} before, {} after, of {}",
        deep.0,
        deep.1,
        stroke.size()
    );
    let far = Area::between(domain.at(FAR_FROM_STROKE[0]), domain.at(FAR_FROM_STROKE[1]));
    assert!(example.count(&far, Rgb::is_refined) > far.size() / 4, "the example is drawn in {far:?}");
    assert_eq!(example.differences(&painted, &far), 0, "pixels changed far from the stroke, in {far:?}");

    let click = domain.at(CLICK);
    display.xdotool(&["key", QUERY_KEY]);
    display.point_at(click);
    display.xdotool(&["click", "1"]);
    display.point_at(RESTING_PLACE);
    let queried = display.settled_picture(&scratch, "3-queried");
    let round_click = Area { x: click.0 - 50..click.0 + 50, y: click.1 - 50..click.1 + 50 };
    let white = [&painted, &queried].map(|picture| picture.count(&round_click, Rgb::is_white));
    assert!(
        white[1] > white[0] + 40,
        "a white outline round the triangle at {click:?}: {} white pixels before, {} after",
        white[0],
        white[1]
    );
    let changed = painted.differences(&queried, &PANEL);
    assert!(
        changed > 400,
        "the inspector shows the triangle, but only {changed} pixels of the panel changed"
    );

    display.xdotool(&["key", UNDO_KEYS]);
    let undone = display.settled_picture(&scratch, "4-undone");
    assert_eq!(example.differences(&undone, &stroke), 0, "undo takes the stroke and its refinement away");

    display.xdotool(&["key", QUIT_KEYS]);
    let status = program.wait_for_exit();
    assert!(status.success(), "{QUIT_KEYS} ended the program with {status}: {}", program.said());
    assert!(!program.said().contains("panicked"), "{}", program.said());
}

#[test]
#[ignore = "needs a virtual display: sh tests/run starts one"]
fn copy_and_paste_reach_other_programs() {
    let scratch = Scratch::new("clipboard");
    let display = Display::start(&scratch);
    let mut program = Program::start(&scratch, &[("DISPLAY", display.name.as_str())]);
    program.wait_for_window(&display);
    display.point_at(RESTING_PLACE);
    let domain = display.settled_picture(&scratch, "1-example").domain();

    display.copy("of another program");
    display.xdotool(&["key", QUERY_KEY]);
    display.point_at(domain.at(CLICK));
    display.xdotool(&["click", "1"]);
    display.xdotool(&["key", COPY_KEYS]);
    wait_for("the values of the triangle in the clipboard", || {
        display.copied().filter(|text| text.starts_with("Triangle: ") && text.contains("\nQuantity: h̄\n"))
    });

    display.copy("0.25, ");
    display.xdotool(&["key", GO_TO_KEYS]);
    display.point_at(RESTING_PLACE);
    display.picture_with_cursor(&scratch, "2-go to");
    display.xdotool(&["key", PASTE_KEYS]);
    display.xdotool(&["type", "0.75"]);
    display.picture_with_cursor(&scratch, "3-pasted");
    display.xdotool(&["key", "ctrl+a", COPY_KEYS]);
    wait_for("the text of the field in the clipboard", || {
        display.copied().filter(|text| text == "0.25, 0.75")
    });
    display.xdotool(&["key", CUT_KEYS, PASTE_KEYS, PASTE_KEYS, "ctrl+a", COPY_KEYS]);
    wait_for("the text that was cut and pasted twice", || {
        display.copied().filter(|text| text == "0.25, 0.750.25, 0.75")
    });

    display.xdotool(&["key", "Escape", QUIT_KEYS]);
    assert!(program.wait_for_exit().success(), "{}", program.said());
}

/// `MESHBRUSH_KILLS=20 cargo test --test window -- --ignored killed --nocapture` says more about more of
/// them.
#[test]
#[ignore = "needs a virtual display: sh tests/run starts one"]
fn killed_at_a_random_moment_it_loses_no_more_than_the_stroke_under_way() {
    let kills = std::env::var("MESHBRUSH_KILLS").map_or(2, |kills| kills.parse().expect("a count"));
    let scratch = Scratch::new("killed");
    let display = Display::start(&scratch);
    let variables = [("DISPLAY", display.name.as_str())];
    let journals = scratch.path("meshbrush/journals");
    let mut random = fastrand::Rng::new();
    let mut all_lost = Vec::new();
    for _ in 0..kills {
        let _ = fs::remove_dir_all(&journals); // absent at the first run
        let mut program = Program::start(&scratch, &variables);
        program.wait_for_window(&display);
        display.xdotool(&["key", NEW_KEYS]);
        display.point_at(RESTING_PLACE);
        display.settled_picture(&scratch, "0-page of a new document");
        display.xdotool(&["key", "Return"]); // the rectangle
        let domain = display.settled_picture(&scratch, "1-blank").domain();
        let moment = Duration::from_millis(random.u64(100..4000));
        let (ended, last_seen) = display.paint_until_killed(&mut program, &domain, moment);
        drop(program);

        let mut program = Program::start(&scratch, &variables);
        program.wait_for_window(&display);
        let offered = display.settled_picture(&scratch, "2-offered");
        display.xdotool(&["key", "Return"]);
        let restored = display.settled_picture(&scratch, "3-restored");
        let is_on = |picture: &Picture, n| {
            let (x, y) = domain.at(dab(n)[0]);
            picture.count(&Area { x: x - 4..x + 4, y: y - 4..y + 4 }, Rgb::is_refined) > 40
        };
        // The stroke under way is on the screen too.
        let seen = (0..DABS).filter(|&n| is_on(&last_seen, n)).count();
        // Where no stroke was whole, nothing is offered, and the example stays.
        let anything = restored.differences(&offered, &CANVAS) > 0;
        let there = (0..DABS).filter(|&n| anything && is_on(&restored, n)).count();
        let lost = seen.saturating_sub(there);
        eprintln!(
            "killed after {moment:?}: {ended} strokes ended, {seen} were on the screen, {there} came back"
        );
        assert!(lost <= 1, "killed after {moment:?}: {there} of {seen} strokes came back");
        assert!((0..there).all(|n| is_on(&restored, n)), "those that came back are the first");
        // What was restored goes once its new place is on the disk.
        let kept = || fs::read_dir(&journals).map_or(0, Iterator::count);
        wait_for("what was restored to be kept once", || (kept() <= 1).then_some(()));
        all_lost.push(lost);
    }
    eprintln!("{kills} kills, lost each time: {all_lost:?}");
}

/// `MESHBRUSH_REST=60 cargo test --test window -- --ignored quick_succession --nocapture` looks for longer.
#[test]
#[ignore = "needs a virtual display: sh tests/run starts one"]
fn gestures_in_quick_succession_are_kept_and_nothing_is_done_after_them() {
    const COPIES: usize = 80;
    let rest = std::env::var("MESHBRUSH_REST").map_or(2, |rest| rest.parse().expect("seconds"));
    let scratch = Scratch::new("succession");
    let display = Display::start(&scratch);
    let journals = scratch.path("meshbrush/journals");
    let mut program = Program::start(&scratch, &[("DISPLAY", &display.name)]);
    program.wait_for_window(&display);
    display.point_at(RESTING_PLACE);
    display.settled_picture(&scratch, "1-example");
    let layers = || kept_layers(&journals, &scratch.path("copy"));
    // The example alone is no unsaved work.
    display.xdotool(&["key", DUPLICATE_KEYS]);
    let (layers_before, written_before) = (wait_for("the first copy to be kept", layers), program.written());
    display.xdotool(&[&["key", "--delay", "40"][..], &[DUPLICATE_KEYS; COPIES]].concat());
    wait_for("every copy to be kept", || (layers()? == layers_before + COPIES).then_some(()));
    wait_for("the program to rest", || {
        let before = program.processor_seconds();
        sleep(Duration::from_secs(1));
        (program.processor_seconds() - before < 0.1).then_some(())
    });
    let written = program.written();
    let seconds = program.processor_seconds();
    sleep(Duration::from_secs(rest));
    let (seconds, more) = (program.processor_seconds() - seconds, program.written() - written);
    program.child.kill().expect("it still runs");
    drop(program);
    eprintln!(
        "{COPIES} copies: {} bytes written; at rest for {rest} s: {seconds:.2} s of processor time, {more} bytes",
        written - written_before
    );
    assert_eq!(layers(), Some(layers_before + COPIES), "after the kill");
    assert!(written - written_before < 1_000_000 && more < 100_000);
    assert!(seconds < 0.1 * rest as f64);
}

/// Returns the number of layers in the journal of a program, which may be running.
fn kept_layers(journals: &Path, copy: &Path) -> Option<usize> {
    let _ = fs::remove_dir_all(copy); // absent at the first time
    fs::create_dir_all(copy).ok()?;
    for entry in fs::read_dir(journals).ok()?.flatten() {
        // The lock is on the file, and a copy has none.
        fs::copy(entry.path(), copy.join(entry.file_name())).ok()?;
    }
    match journal::left(copy).next()? {
        Left::Work(work) => Some(work.project.settings.layers.len()),
        Left::Unreadable { .. } => None,
    }
}

/// Strokes that are painted before the program is killed, and where the n-th begins and ends.
const DABS: usize = 16;

fn dab(n: usize) -> [(f64, f64); 2] {
    let (column, row) = ((n % 4) as f64, (n / 4) as f64);
    let (x, y) = (0.14 + 0.24 * column, 0.14 + 0.24 * row);
    [(x, y), (x + 0.03, y)]
}

#[test]
fn without_a_display_it_says_so_in_one_sentence() {
    let scratch = Scratch::new("no-display");
    let mut program = Program::start(&scratch, &[]);
    assert_eq!(program.wait_for_exit().code(), Some(1), "{}", program.said());
    let said = program.said();
    assert!(said.contains("display"), "{said}");
    assert_eq!(said.trim().lines().count(), 1, "{said}");
    assert!(!said.contains("panicked"), "{said}");
}

#[test]
#[ignore = "needs a virtual display: sh tests/run starts one"]
fn without_a_graphics_driver_it_says_so_in_one_sentence() {
    let scratch = Scratch::new("no-driver");
    let display = Display::start(&scratch);
    // Vulkan only, and no Vulkan driver: as on a machine that has neither, without taking OpenGL away from
    // this one.
    let no_driver = scratch.path("no-such-driver.json");
    let mut program = Program::start(
        &scratch,
        &[
            ("DISPLAY", &display.name),
            ("WGPU_BACKEND", "vulkan"),
            ("VK_DRIVER_FILES", &no_driver.to_string_lossy()),
            ("VK_ICD_FILENAMES", &no_driver.to_string_lossy()),
            ("VK_LOADER_DEBUG", "none"),
        ],
    );
    assert_eq!(program.wait_for_exit().code(), Some(1), "{}", program.said());
    let said = program.said();
    assert!(said.contains("driver"), "{said}");
    assert_eq!(said.trim().lines().count(), 1, "{said}");
    assert!(!said.contains("panicked"), "{said}");
}

/// A folder of its own under `target/tmp`, emptied at the start and kept for a look at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = fs::remove_dir_all(&folder); // absent at the first run
        fs::create_dir_all(&folder).expect("target/tmp is ours to write");
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

/// The program under test, ended when dropped.
struct Program {
    child: Child,
    stderr: PathBuf,
}

impl Program {
    /// Starts it knowing no display, no saved state and no settings but `variables`.
    fn start(scratch: &Scratch, variables: &[(&str, &str)]) -> Self {
        let stderr = scratch.path("stderr.txt");
        let mut command = Command::new(env!("CARGO_BIN_EXE_meshbrush"));
        for variable in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET", "WGPU_BACKEND", "RUST_LOG"] {
            command.env_remove(variable);
        }
        for variable in ["XDG_DATA_HOME", "XDG_CONFIG_HOME", "XDG_CACHE_HOME", "XDG_RUNTIME_DIR"] {
            command.env(variable, &scratch.0);
        }
        let child = command
            .env("WINIT_X11_SCALE_FACTOR", "1")
            .envs(variables.iter().copied())
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(fs::File::create(&stderr).expect("the scratch folder is ours to write"))
            .spawn()
            .expect("cargo has built the program");
        Self { child, stderr }
    }

    /// Waits until the window is there and the keyboard goes to it: without a window manager nobody else sees
    /// to that.
    fn wait_for_window(&mut self, display: &Display) {
        let window = wait_for("a window named … Meshbrush", || {
            if let Some(status) = self.child.try_wait().expect("the program is our child") {
                panic!("the program ended with {status} before it had a window: {}", self.said());
            }
            let found = display.try_xdotool(&["search", "--onlyvisible", "--name", "Meshbrush$"])?;
            found.lines().next().map(str::to_owned)
        });
        let of_class = display.try_xdotool(&["search", "--onlyvisible", "--class", WINDOW_CLASS]);
        assert!(
            of_class.is_some_and(|found| found.lines().any(|own| own == window)),
            "no class {WINDOW_CLASS}"
        );
        wait_for("the keyboard to go to the window", || {
            display.try_xdotool(&["windowfocus", &window])?;
            (display.try_xdotool(&["getwindowfocus"])?.trim() == window).then_some(())
        });
    }

    fn wait_for_exit(&mut self) -> ExitStatus {
        wait_for("the program to end", || self.child.try_wait().expect("the program is our child"))
    }

    /// Returns the processor time of all its threads so far.
    fn processor_seconds(&self) -> f64 {
        let stat = fs::read_to_string(format!("/proc/{}/stat", self.child.id())).expect("it runs");
        // The name of the program is in brackets, and can have spaces; ticks are hundredths of a second.
        let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
        fields[11..13].iter().map(|ticks| ticks.parse::<f64>().expect("a number") / 100.0).sum()
    }

    /// Returns the bytes that it has written to files so far, in whole pages.
    fn written(&self) -> u64 {
        let io = fs::read_to_string(format!("/proc/{}/io", self.child.id())).expect("it runs");
        let bytes = io.lines().find_map(|line| line.strip_prefix("write_bytes: "));
        bytes.expect("Linux counts them").parse().expect("a number")
    }

    fn said(&self) -> String {
        String::from_utf8_lossy(&fs::read(&self.stderr).unwrap_or_default()).into_owned()
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.child.kill(); // it may have ended by itself
        let _ = self.child.wait();
    }
}

/// A virtual display of [`SIZE`] without a window manager, ended when dropped.
struct Display {
    server: Child,
    name: String,
    frame_buffer: PathBuf,
}

impl Display {
    fn start(scratch: &Scratch) -> Self {
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-nolisten", "tcp", "-noreset"])
            .args(["-screen", "0", &format!("{}x{}x24", SIZE.0, SIZE.1)])
            // The server keeps the screen in a file that anyone may read: no tool is needed for a picture of
            // it.
            .arg("-fbdir")
            .arg(&scratch.0)
            .stdout(Stdio::piped())
            .stderr(
                fs::File::create(scratch.path("server.txt")).expect("the scratch folder is ours to write"),
            )
            .spawn()
            .unwrap_or_else(|e| panic!("Xvfb does not start ({e}): sh tests/run installs it"));
        let mut number = String::new();
        let answers = server.stdout.take().expect("it is piped");
        BufReader::new(answers).read_line(&mut number).expect("a pipe can be read");
        assert!(!number.trim().is_empty(), "Xvfb found no free display: see {}", scratch.0.display());
        Self { server, name: format!(":{}", number.trim()), frame_buffer: scratch.path("Xvfb_screen0") }
    }

    /// What xdotool answers, or `None` when it fails, as `search` does when nothing is found.
    fn try_xdotool(&self, arguments: &[&str]) -> Option<String> {
        let output = Command::new("xdotool")
            .args(arguments)
            .env("DISPLAY", &self.name)
            .output()
            .unwrap_or_else(|e| panic!("xdotool does not start ({e}): sh tests/run installs it"));
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
    }

    fn xdotool(&self, arguments: &[&str]) {
        assert!(self.try_xdotool(arguments).is_some(), "xdotool {} failed", arguments.join(" "));
        sleep(Duration::from_millis(50)); // a person is no faster, and every event gets its frame
    }

    /// Copies a text in another program, which keeps it in the background.
    fn copy(&self, text: &str) {
        let mut xclip = self.xclip("-i");
        xclip.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
        let mut xclip = xclip.spawn().unwrap_or_else(|e| lacks_xclip(&e));
        let mut input = xclip.stdin.take().expect("it is piped");
        input.write_all(text.as_bytes()).expect("xclip reads all of it");
        drop(input);
        assert!(xclip.wait().expect("it is our child").success());
    }

    /// Returns the text that another program would paste.
    fn copied(&self) -> Option<String> {
        let output = self.xclip("-o").output().unwrap_or_else(|e| lacks_xclip(&e));
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
    }

    fn xclip(&self, direction: &str) -> Command {
        let mut command = Command::new("xclip");
        command.args(["-selection", "clipboard", direction]).env("DISPLAY", &self.name);
        command
    }

    fn point_at(&self, (x, y): (usize, usize)) {
        self.xdotool(&["mousemove", &x.to_string(), &y.to_string()]);
    }

    fn drag(&self, from: (usize, usize), to: (usize, usize)) {
        self.point_at(from);
        self.xdotool(&["mousedown", "1"]);
        let part = |from: usize, to: usize, i: i64| (to as i64 - from as i64) * i / STROKE_MOVES;
        for i in 1..=STROKE_MOVES {
            let step = |from, to| (part(from, to, i) - part(from, to, i - 1)).to_string();
            self.xdotool(&["mousemove_relative", "--", &step(from.0, to.0), &step(from.1, to.1)]);
        }
        self.xdotool(&["mouseup", "1"]);
    }

    /// Paints one stroke after the other until the program is killed, and returns how many had ended by then,
    /// and the last picture before.
    fn paint_until_killed(&self, program: &mut Program, domain: &Area, moment: Duration) -> (usize, Picture) {
        let start = Instant::now();
        let child = &mut program.child;
        std::thread::scope(|scope| {
            let painter = scope.spawn(|| {
                let mut ends = Vec::new();
                for [from, to] in (0..DABS).map(dab) {
                    let [from, to] =
                        [from, to].map(|at| domain.at(at)).map(|(x, y)| [x.to_string(), y.to_string()]);
                    let press = ["mousemove", &from[0], &from[1], "mousedown", "1", "sleep", "0.06"];
                    let release = ["mousemove", &to[0], &to[1], "sleep", "0.06", "mouseup", "1"];
                    if self.try_xdotool(&[&press[..], &release].concat()).is_none() {
                        break;
                    }
                    ends.push(start.elapsed());
                    sleep(Duration::from_millis(90));
                }
                ends
            });
            sleep(moment.saturating_sub(start.elapsed()));
            let last_seen = Picture::read_xwd(&self.frame_buffer);
            child.kill().expect("it still runs");
            child.wait().expect("it is our child");
            let killed = start.elapsed();
            let ends = painter.join().expect("painting does not fail");
            (ends.into_iter().filter(|&end| end < killed).count(), last_seen)
        })
    }

    /// Takes a picture a while after an input, where a cursor blinks and the picture never settles.
    fn picture_with_cursor(&self, scratch: &Scratch, name: &str) {
        sleep(Duration::from_secs(1));
        Picture::read_xwd(&self.frame_buffer).write_png(&scratch.path(&format!("{name}.png")));
    }

    /// Returns the screen once it has not changed for a while and no work is in progress, kept as `name`.png.
    fn settled_picture(&self, scratch: &Scratch, name: &str) -> Picture {
        sleep(Duration::from_millis(300));
        let mut last = Picture::default();
        let mut alike = 0;
        let picture = wait_for("the picture to settle", || {
            let picture = Picture::read_xwd(&self.frame_buffer);
            let rests = picture.rgb == last.rgb && !picture.shows_progress();
            alike = if rests { alike + 1 } else { 0 };
            last = picture;
            (alike == 3).then(|| std::mem::take(&mut last))
        });
        picture.write_png(&scratch.path(&format!("{name}.png")));
        picture
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill(); // it may have died by itself
        let _ = self.server.wait();
    }
}

fn lacks_xclip<T>(error: &std::io::Error) -> T {
    panic!("xclip does not start ({error}): sh tests/run installs it")
}

/// Asks until there is an answer, but not for ever.
fn wait_for<T>(what: &str, mut answer: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(answer) = answer() {
            return answer;
        }
        assert!(start.elapsed() < PATIENCE, "waited {} s for {what}", PATIENCE.as_secs());
        sleep(Duration::from_millis(100));
    }
}

/// A rectangle of pixels.
#[derive(Debug)]
struct Area {
    x: Range<usize>,
    y: Range<usize>,
}

impl Area {
    fn between(a: (usize, usize), b: (usize, usize)) -> Self {
        Self { x: a.0.min(b.0)..a.0.max(b.0), y: a.1.min(b.1)..a.1.max(b.1) }
    }

    fn at(&self, (x, y): (f64, f64)) -> (usize, usize) {
        let part = |range: &Range<usize>, at: f64| range.start + (range.len() as f64 * at) as usize;
        (part(&self.x, x), part(&self.y, y))
    }

    fn size(&self) -> usize {
        self.x.len() * self.y.len()
    }

    fn pixels(&self) -> impl Iterator<Item = (usize, usize)> {
        self.y.clone().flat_map(|y| self.x.clone().map(move |x| (x, y)))
    }
}

#[derive(Clone, Copy, PartialEq)]
struct Rgb([u8; 3]);

impl Rgb {
    fn is_level_0(self) -> bool {
        let (color, tolerance) = LEVEL_0;
        self.0.iter().zip(color).all(|(&a, b)| a.abs_diff(b) <= tolerance)
    }

    /// Any level's colour from 1 on, darkened by an edge or not: all are colourful, while level 0 and the
    /// ground are grey.
    fn is_refined(self) -> bool {
        let [r, g, b] = self.0;
        r.max(g).max(b) - r.min(g).min(b) > 40
    }

    /// Returns a colour of the upper half of viridis, green to yellow.
    fn is_deep(self) -> bool {
        let [_, g, b] = self.0;
        g > b.saturating_add(20)
    }

    fn is_white(self) -> bool {
        self.0.iter().all(|&c| c > 220)
    }
}

/// The screen: rows from the top, three bytes a pixel.
#[derive(Default)]
struct Picture {
    width: usize,
    rgb: Vec<u8>,
}

impl Picture {
    /// Reads an X window dump, as the server keeps it: a header of 32-bit words, most significant byte first,
    /// a colour map that true colour does not need, and rows of four bytes a pixel.
    fn read_xwd(file: &Path) -> Self {
        let bytes = fs::read(file).expect("Xvfb keeps its screen there");
        let word =
            |i: usize| u32::from_be_bytes(bytes[4 * i..][..4].try_into().expect("four bytes")) as usize;
        let [header, version, width, height] = [word(0), word(1), word(4), word(5)];
        let [order, bits, row, colors] = [word(7), word(11), word(12), word(19)];
        let masks = [word(14), word(15), word(16)];
        assert_eq!(
            (version, bits, masks),
            (7, 32, [0xff0000, 0xff00, 0xff]),
            "Xvfb was asked for true colour"
        );
        let rows = bytes[header + 12 * colors..].chunks(row).take(height);
        let pixels = rows.flat_map(|row| row[..4 * width].as_chunks().0);
        let rgb = pixels.flat_map(|&[a, b, c, d]| if order == 0 { [c, b, a] } else { [b, c, d] }).collect();
        Self { width, rgb }
    }

    fn write_png(&self, file: &Path) {
        let file = fs::File::create(file).expect("the scratch folder is ours to write");
        let mut encoder =
            png::Encoder::new(file, self.width as u32, (self.rgb.len() / 3 / self.width) as u32);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("the size is not zero");
        writer.write_image_data(&self.rgb).expect("the disk has room");
    }

    fn pixel(&self, (x, y): (usize, usize)) -> Rgb {
        Rgb(self.rgb[3 * (y * self.width + x)..][..3].try_into().expect("three bytes"))
    }

    fn count(&self, area: &Area, is: fn(Rgb) -> bool) -> usize {
        area.pixels().filter(|&at| is(self.pixel(at))).count()
    }

    fn shows_progress(&self) -> bool {
        let ground = self.pixel((PROGRESS.x.start, PROGRESS.y.start));
        PROGRESS.pixels().any(|at| self.pixel(at) != ground)
    }

    fn differences(&self, other: &Self, area: &Area) -> usize {
        area.pixels().filter(|&at| self.pixel(at) != other.pixel(at)).count()
    }

    /// Returns the part of the canvas that the coarse grid covers, by its colour: rows and columns that
    /// mostly show level 0.
    fn domain(&self) -> Area {
        let mostly = |line: Area| 3 * self.count(&line, Rgb::is_level_0) > line.size();
        let columns = CANVAS.x.filter(|&x| mostly(Area { x: x..x + 1, y: CANVAS.y }));
        let rows = CANVAS.y.filter(|&y| mostly(Area { x: CANVAS.x, y: y..y + 1 }));
        Area { x: ends(columns), y: ends(rows) }
    }
}

/// From the first to behind the last; empty when there is none.
fn ends(mut numbers: impl Iterator<Item = usize>) -> Range<usize> {
    let Some(first) = numbers.next() else {
        return 0..0;
    };
    first..numbers.last().unwrap_or(first) + 1
}
