//! The speed of the program on one machine, as a page: `cargo bench -p meshbrush-benches --bench speed`
//! writes `docs/speed.md`.
//!
//! Everything goes through the types of the window: document, follower and pricer, in slices of its pace.
//! With the words `--bench speed -- short` only small meshes are measured, and nothing is written.
//!
//! Where a C compiler and the library ALBERTA are installed, it refines the same mesh (`alberta.c`).

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use glam::{DVec2, dvec2};
use meshbrush_benches::documents::{SIDE, diameter, lake_document, layered, painted};
use meshbrush_benches::numbering::Numberings;
use meshbrush_benches::scene::{Scene, Times, figure_eight, move_threat, show_threats};
use meshbrush_benches::window::{BRUSH, Pool, median_ms, pools};
use meshbrush_benches::{diamond, field, memory, resident};
use meshbrush_core::document::Document;
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_mesh::mesh::{
    BlockRefiner, Limits, Mesh, Progress, Refiner, SharedRule, bisection_edge_length,
};

fn main() {
    if resident::answer() {
        return;
    }
    let is_short = std::env::args().any(|argument| argument == "short");
    let pools = pools();
    let mut page = String::new();
    heading(&mut page, &pools);
    generation(&mut page, &pools, if is_short { &[5, 9] } else { &[5, 13, 17] });
    dabs(&mut page, &pools, is_short);
    large_edits(&mut page, &pools, is_short);
    more_cores(&mut page, &pools, is_short);
    if !is_short {
        numbers_in_files(&mut page);
        memory_of_cases(&mut page);
    }
    print!("{page}");
    if !is_short {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/speed.md");
        std::fs::write(path, page).expect("the page can be written");
    }
}

fn heading(page: &mut String, pools: &[Pool]) {
    let output = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).args(arguments).output().ok()?;
        Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let commit = output("git", &["rev-parse", "--short", "HEAD"]).unwrap_or_default();
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let cpu = cpu.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let all = pools.last().map_or(1, |pool| pool.threads);
    *page += "# Speed\n\nWritten by `cargo bench -p meshbrush-benches --bench speed`; times are medians.\n\n";
    let cpu = cpu.map_or("an unknown processor", |(_, name)| name);
    write_line(page, format_args!("Commit {commit} on {cpu}, {all} threads.\n"));
}

fn write_line(page: &mut String, line: std::fmt::Arguments<'_>) {
    writeln!(page, "{line}").expect("a string can always be written");
}

/// Returns the median time of some rounds, in seconds.
fn median(rounds: usize, mut once: impl FnMut() -> Duration) -> f64 {
    median_ms((0..rounds).map(|_| once()).collect()) / 1e3
}

/// Meshes from scratch: the diamond of the report, in millions of triangles a second.
fn generation(page: &mut String, pools: &[Pool], levels: &[u32]) {
    *page += "## Meshes from scratch\n\nThe diamond of the report, in millions of triangles a second. *In order* is \
        Algorithm 12, one triangle after the other; *blocks* the way of the program; *pixels* the same, asked by the \
        area rule on a raster. *New* and *used* memory. *Writes* is the same number of bytes and nothing else: the limit \
        of this machine.\n\n";
    *page += "| triangles | threads | in order, used | blocks, new | blocks, used | pixels, used | writes, new | writes, used | ALBERTA |\n";
    *page += "|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
    let alberta = alberta();
    for &level in levels {
        let published =
            alberta.as_deref().filter(|_| level <= 13).and_then(|program| alberta_rate(program, level));
        for pool in pools {
            generation_row(page, pool, level, published);
        }
    }
    page.push('\n');
}

fn generation_row(page: &mut String, pool: &Pool, level: u32, alberta: Option<f64>) {
    let coarse = diamond::coarse();
    let within = diamond::rule_within(&coarse, level);
    let pixels = field::diamond(bisection_edge_length(1.0, level));
    let rounds = if level > 14 { 3 } else { 15 };
    let mut mesh = coarse.clone();
    in_blocks(&mut mesh, &within);
    let triangles = mesh.raw_triangle_count();
    let rate = |seconds: f64| format!("{:.1}", triangles as f64 / seconds / 1e6);
    let fresh = pool.run(|| {
        median(rounds, || {
            let began = Instant::now();
            let mut mesh = coarse.clone();
            in_blocks(&mut mesh, &within);
            began.elapsed()
        })
    });
    let reused = pool.run(|| again(rounds, &mut mesh, &coarse, &within));
    let by_pixels = pool.run(|| again(rounds, &mut mesh, &coarse, &field::rule(&pixels)));
    let one_by_one = (pool.threads == 1).then(|| {
        let mut refiner = Refiner::new(&coarse, Limits::default());
        let rule = diamond::rule(&coarse, level);
        median(rounds, || {
            let began = Instant::now();
            mesh.clone_from(&coarse);
            refiner.restart(&mesh);
            refiner.advance(&mut mesh, &rule, usize::MAX).expect("within the default limits");
            began.elapsed()
        })
    });
    let [write_new, write_used] = pool.run(|| writes(rounds, triangles));
    let optional = |seconds: Option<f64>| seconds.map_or(String::new(), rate);
    write_line(
        page,
        format_args!(
            "| {triangles} | {} | {} | {} | {} | {} | {} | {} | {} |",
            pool.threads,
            optional(one_by_one),
            rate(fresh),
            rate(reused),
            rate(by_pixels),
            rate(write_new),
            rate(write_used),
            alberta.filter(|_| pool.threads == 1).map_or(String::new(), |rate| format!("{rate:.2}")),
        ),
    );
}

fn in_blocks(mesh: &mut Mesh, rule: &impl SharedRule<Error: std::fmt::Debug>) {
    mesh.refine_in_blocks(&Limits::default(), rule).expect("within the default limits");
}

/// Makes a mesh again in its own memory. Returns the seconds.
fn again(
    rounds: usize,
    mesh: &mut Mesh,
    coarse: &Mesh,
    rule: &impl SharedRule<Error: std::fmt::Debug>,
) -> f64 {
    median(rounds, || {
        let began = Instant::now();
        mesh.clone_from(coarse);
        in_blocks(mesh, rule);
        began.elapsed()
    })
}

/// Writes the bytes of a mesh, to new memory and again. Returns the seconds.
fn writes(rounds: usize, triangles: usize) -> [f64; 2] {
    let new = median(rounds, || {
        let began = Instant::now();
        let mut memory = memory::unmapped(triangles);
        memory::write(&mut memory);
        let time = began.elapsed();
        std::hint::black_box(memory);
        time
    });
    let mut memory = memory::unmapped(triangles);
    memory::write(&mut memory);
    let used = median(rounds, || {
        let began = Instant::now();
        memory::write(&mut memory);
        began.elapsed()
    });
    [new, used]
}

/// Compiles the program for ALBERTA, if that is installed.
fn alberta() -> Option<PathBuf> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("alberta.c");
    let program = std::env::temp_dir().join("meshbrush-alberta");
    let mut compiler = Command::new("cc");
    compiler.args(["-O3", "-DDIM_OF_WORLD=2", "-DALBERTA_DEBUG=0", "-I/usr/include/alberta"]);
    compiler.arg(source).args(["-lalberta_2d", "-lalberta_utilities", "-lm", "-o"]).arg(&program);
    compiler.output().is_ok_and(|output| output.status.success()).then_some(program)
}

/// Returns the millions of triangles a second of ALBERTA.
fn alberta_rate(program: &Path, level: u32) -> Option<f64> {
    let output = Command::new(program).arg(level.to_string()).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let (triangles, seconds) = text.lines().last()?.split_once(' ')?;
    Some(triangles.parse::<f64>().ok()? / seconds.parse::<f64>().ok()? / 1e6)
}

/// The dab of the bench *update*, and one of as many triangles on layers.
fn dabs(page: &mut String, pools: &[Pool], is_short: bool) {
    *page += "## A dab\n\nMilliseconds until the mesh is up to date after a dab is painted and erased at the same place, \
        and until its price is known. *Pixels* is the time of drawing the dab alone, which each price contains and the \
        update does not. *Scratch* is the whole mesh made again.\n\n";
    *page += "| document | triangles | threads | changes | paint | erase | pixels | price of painting | price of erasing | scratch |\n";
    *page += "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
    let plain = |fine: f64| Brush {
        medium: Medium::Diameter(fine * (1.0 + 1e-6), DiameterChange::Finer),
        radius: 78.0 / f64::from(SIDE),
        hardness: 1.0,
        strength: 1.0,
    };
    let on_layers = |fine: f64| Brush { radius: 30.0 * fine, ..BRUSH };
    let sizes: &[(u8, u32)] = if is_short { &[(5, 2048)] } else { &[(5, 2048), (12, 1950), (17, 1220)] };
    for &(level, rows) in sizes {
        let scene = Scene::new(painted(level, rows));
        dab_rows(page, pools, "plain paint", scene, plain(diameter(12)), dvec2(0.39, 0.366));
    }
    let fines: &[f64] = if is_short { &[0.016] } else { &[0.016, 0.0011, 0.00035] };
    for (name, gradation) in [("eight layers", None), ("eight layers, gradation 0.5", Some(0.5))] {
        // With gradation, twenty million triangles take longer than the rest of the page.
        for &fine in fines.iter().filter(|&&fine| gradation.is_none() || fine > 0.001) {
            let scene = Scene::new(layered(fine, gradation));
            dab_rows(page, pools, name, scene, on_layers(fine), dvec2(0.5, 0.62));
        }
    }
    page.push('\n');
}

fn dab_rows(page: &mut String, pools: &[Pool], name: &str, mut scene: Scene, brush: Brush, at: DVec2) {
    let eraser = Brush { medium: Medium::Eraser, hardness: 1.0, strength: 1.0, radius: 1.01 * brush.radius };
    let rounds = if scene.triangles() > 4_000_000 { 7 } else { 25 };
    for pool in pools {
        let count = scene.triangles();
        let mut times: [Vec<Duration>; 5] = Default::default();
        let mut changes = 0;
        pool.run(|| {
            for _ in 0..rounds {
                times[2].push(scene.price(brush, at).0);
                let [follow, pixels] = scene.dab_and_pixels(brush, at);
                times[0].push(follow);
                times[4].push(pixels);
                changes = scene.triangles().abs_diff(count);
                times[3].push(scene.price(eraser, at).0);
                times[1].push(scene.dab(eraser, at));
            }
        });
        let [paint, erase, price, price_of_erasing, pixels] = times.map(median_ms);
        write_line(
            page,
            format_args!(
                "| {name} | {count} | {} | {changes} | {paint:.2} | {erase:.2} | {pixels:.2} | {price:.2} | {price_of_erasing:.2} | {:.1} |",
                pool.threads,
                1e3 * scene.scratch.as_secs_f64()
            ),
        );
    }
}

/// Edits of eight layers that concern large parts of the mesh.
fn large_edits(page: &mut String, pools: &[Pool], is_short: bool) {
    *page += "## Large edits\n\nEight layers: milliseconds until the mesh begins to change, and until it is up to date. \
        *Stroke* is the work of a frame in a stroke across the square at 60 frames a second, in the median and in 99 of \
        100 frames, and how far the mesh is behind when the pointer is lifted.\n\n";
    *page += "| gradation | triangles | threads | threat moved | layer hidden | layer shown | stroke, frame | behind | scratch |\n";
    *page += "|---|---:|---:|---:|---:|---:|---:|---:|---:|\n";
    for gradation in [None, Some(0.5)] {
        let mut scene = Scene::new(layered(if is_short { 0.004 } else { 0.0011 }, gradation));
        for pool in pools {
            pool.run(|| large_edits_row(page, &mut scene, pool.threads, gradation));
        }
    }
    page.push('\n');
}

fn large_edits_row(page: &mut String, scene: &mut Scene, threads: usize, gradation: Option<f64>) {
    let move_to = |share: f64| {
        move |document: &mut Document| {
            move_threat(document, share);
            document.end_gesture();
        }
    };
    let mut times: [Vec<Times>; 3] = Default::default();
    for _ in 0..5 {
        times[0].push(scene.edit(move_to(0.5)));
        times[1].push(scene.edit(|document| show_threats(document, false)));
        times[2].push(scene.edit(|document| show_threats(document, true)));
        scene.edit(move_to(0.0));
    }
    let [moved, hidden, shown] = times.map(|times| {
        let median = |time: fn(&Times) -> Duration| median_ms(times.iter().map(time).collect());
        format!("{:.1} / {:.1}", median(|times| times.first), median(|times| times.rest))
    });
    let (frames, behind) = scene.gesture(120, figure_eight(BRUSH));
    let of = |share: usize| 1e3 * frames[frames.len() * share / 100].as_secs_f64();
    let gradation = gradation.map_or("none".into(), |slope| slope.to_string());
    write_line(
        page,
        format_args!(
            "| {gradation} | {} | {threads} | {moved} | {hidden} | {shown} | {:.1} / {:.1} | {:.1} | {:.1} |",
            scene.triangles(),
            of(50),
            of(99),
            1e3 * behind.as_secs_f64(),
            1e3 * scene.scratch.as_secs_f64()
        ),
    );
}

/// The time of the steps of generation and of two large edits on one thread and on all, and what follows for
/// more cores by Amdahl's law.
fn more_cores(page: &mut String, pools: &[Pool], is_short: bool) {
    let [one, all] = pools else { return };
    *page += "## More cores\n\nMilliseconds on one thread and on all of this machine, the share of the work on one thread \
        that follows by Amdahl's law, and what it lets expect of 8 and of 64 cores: a model, for memory that serves all \
        of them. *Survey*, *skeleton* and *write* are the steps of the diamond in blocks.\n\n";
    write_line(
        page,
        format_args!(
            "| work | triangles | 1 thread | {} threads | serial | 8 cores | 64 cores |",
            all.threads
        ),
    );
    *page += "|---|---:|---:|---:|---:|---:|---:|\n";
    let mut row = |name: &str, triangles: usize, [one, many]: [f64; 2]| {
        let serial = serial_share(one, many, all.threads);
        let on = |cores: f64| one * (serial + (1.0 - serial) / cores);
        write_line(
            page,
            format_args!(
                "| {name} | {triangles} | {one:.1} | {many:.1} | {:.0} % | {:.1} | {:.1} |",
                100.0 * serial,
                on(8.0),
                on(64.0)
            ),
        );
    };
    let level = if is_short { 9 } else { 17 };
    let [(triangles, on_one), (_, on_all)] = [one, all].map(|pool| pool.run(|| steps_in_blocks(level)));
    for (n, name) in ["survey", "skeleton", "write"].into_iter().enumerate() {
        row(name, triangles, [on_one[n], on_all[n]]);
    }
    let fine = if is_short { 0.004 } else { 0.0011 };
    for (name, gradation) in [("eight layers", None), ("eight layers, gradation 0.5", Some(0.5))] {
        let [on_one, on_all] =
            [one, all].map(|pool| pool.run(|| scratch_and_shown(layered(fine, gradation))));
        row(&format!("{name}, from scratch"), on_one.0, [on_one.1, on_all.1]);
        row(&format!("{name}, layer shown"), on_one.0, [on_one.2, on_all.2]);
    }
    page.push('\n');
}

/// Returns the share of work that takes the same time on any number of threads.
fn serial_share(one: f64, many: f64, threads: usize) -> f64 {
    let threads = threads as f64;
    ((threads * many / one - 1.0) / (threads - 1.0)).clamp(0.0, 1.0)
}

/// Returns the triangles of the diamond of a level, and the milliseconds of the three steps of its blocks.
fn steps_in_blocks(level: u32) -> (usize, [f64; 3]) {
    let coarse = diamond::coarse();
    let within = diamond::rule_within(&coarse, level);
    let mut mesh = coarse.clone();
    in_blocks(&mut mesh, &within);
    let mut times: [Vec<Duration>; 3] = Default::default();
    for _ in 0..5 {
        mesh.clone_from(&coarse);
        let mut refiner = BlockRefiner::new(&mesh, Limits::default());
        let (mut step, mut is_done, mut took) = (0, false, [Duration::ZERO; 3]);
        while !is_done {
            let (began, count) = (Instant::now(), mesh.raw_triangle_count());
            let progress =
                refiner.advance(&mut mesh, &within, usize::MAX).expect("within the default limits");
            is_done = progress == Progress::Done;
            // The skeleton is the first to change the mesh, in one slice.
            step = match step {
                0 if mesh.raw_triangle_count() == count => 0,
                0 => 1,
                _ => 2,
            };
            took[step] += began.elapsed();
        }
        times.iter_mut().zip(took).for_each(|(times, took)| times.push(took));
    }
    (mesh.raw_triangle_count(), times.map(median_ms))
}

/// Returns the triangles of a document, and the milliseconds until it has a mesh and until it follows a layer
/// that is shown.
fn scratch_and_shown(document: Document) -> (usize, f64, f64) {
    let mut scene = Scene::new(document);
    let shown = (0..5).map(|_| {
        scene.edit(|document| show_threats(document, false));
        scene.edit(|document| show_threats(document, true)).rest
    });
    let shown = median_ms(shown.collect());
    (scene.triangles(), 1e3 * scene.scratch.as_secs_f64(), shown)
}

/// What meshes take of the memory of a process.
/// The numbers that files get: what they cost, and what they are worth to a solver.
fn numbers_in_files(page: &mut String) {
    *page += "## Numbers of nodes and triangles in files\n\nMilliseconds of a product with the matrix of linear elements on one \
        thread, by the numbers of the mesh as it was made and by those of files, along the Sierpiński curve; and of the \
        numbering.\n\n";
    *page += "| document | nodes | as made | in files | numbering |\n|---|---:|---:|---:|---:|\n";
    let documents = [
        ("eight layers", layered(0.0008, None)),
        ("nodes on an outline of 200,000 corners", lake_document()),
    ];
    for (name, document) in documents {
        let Numberings { nodes, products: [as_made, in_files], numbering } = Numberings::of(document);
        write_line(
            page,
            format_args!("| {name} | {nodes} | {as_made:.1} | {in_files:.1} | {numbering:.0} |"),
        );
    }
    *page += "\n";
}

fn memory_of_cases(page: &mut String) {
    *page += "## Memory\n\nBytes for each triangle of what belongs to the mesh, in a process of its own: once everything is \
        done, and the most while it is made. The pixels of documents are counted before, and not here.\n\n";
    *page += "| document | triangles | at rest | most |\n|---|---:|---:|---:|\n";
    for case in resident::Case::ALL {
        let Some(memory) = resident::measure(case) else { continue };
        let resident::Memory { triangles, at_rest, most } = memory;
        write_line(page, format_args!("| {} | {triangles} | {at_rest:.0} | {most:.0} |", case.name()));
    }
    page.push('\n');
}
