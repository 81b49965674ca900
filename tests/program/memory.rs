//! The memory of the program: the budget is kept at the peak, and running out of memory is an error.
#![cfg(target_os = "linux")]

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::folder::Folder;
use meshbrush_mesh::mesh::MemoryLimit;

/// What large pages at the ends of arrays and the stacks of threads take, in bytes.
const ROUNDING: usize = 8 << 20;

fn mesh(folder: &Folder, options: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_meshbrush"));
    command.current_dir(&folder.0).args(["mesh", "--threads", "2"]);
    command.args(options.split_whitespace()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Returns the exit status, the most memory that the program had at a time in bytes, and the number of
/// triangles.
fn peak_of(folder: &Folder, options: &str) -> (i32, usize, usize) {
    let (output, peak) = watched(mesh(folder, options).arg("--json"));
    let summary = serde_json::from_slice::<serde_json::Value>(&output.stdout).ok();
    let triangles = summary.and_then(|summary| summary["triangles"].as_u64()).unwrap_or(0);
    (output.status.code().expect("no signal ends it"), peak, triangles as usize)
}

/// [`peak_of`] for a mesh that is made and counted: it is not numbered for files, and nothing is measured.
fn peak_of_made(folder: &Folder, options: &str) -> (i32, usize, usize) {
    let (output, peak) = watched(&mut mesh(folder, options));
    let said = String::from_utf8_lossy(&output.stderr).replace(',', "");
    let triangles =
        said.split_once(" triangles").and_then(|(before, _)| before.rsplit('\n').next()?.parse().ok());
    (output.status.code().expect("no signal ends it"), peak, triangles.unwrap_or(0))
}

/// Runs a command, and returns the most memory that it had at a time in bytes.
fn watched(command: &mut Command) -> (Output, usize) {
    let mut child = command.spawn().unwrap();
    let mut peak = 0;
    while child.try_wait().unwrap().is_none() {
        peak = peak.max(memory(&child));
        std::thread::sleep(Duration::from_micros(500));
    }
    (child.wait_with_output().unwrap(), peak)
}

/// Returns the memory that the program takes for a mesh of a few triangles, in bytes. It ends so soon that on
/// a busy machine a run can end long after it was last looked at: the largest of several counts.
fn base(folder: &Folder) -> usize {
    let few = "--domain 0,0,1,1 --spacing 0.1 --target 0.05";
    (0..8).map(|_| peak_of(folder, few).1).max().expect("there are some runs")
}

/// Returns the most memory that the program has had so far, in bytes; 0 once it has ended, and while the new
/// process is still a copy of the one that runs the tests.
fn memory(child: &Child) -> usize {
    let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
    if !status.starts_with("Name:\tmeshbrush\n") {
        return 0;
    }
    let most = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    most.map_or(0, |most| 1024 * most.trim().trim_end_matches(" kB").parse::<usize>().unwrap())
}

/// Returns diameters from `finest` to six times that, which differ from pixel to pixel.
fn noise(finest: f64) -> String {
    let mut random = fastrand::Rng::with_seed(1);
    let rows = (0..300).map(|_| {
        let row: Vec<String> =
            (0..300).map(|_| format!("{:.5}", finest * (1.0 + 5.0 * random.f64().powi(2)))).collect();
        row.join(" ")
    });
    let head = "ncols 300\nnrows 300\nxllcorner 0\nyllcorner 0\ncellsize 0.0033333333333\n".to_owned();
    head + &rows.collect::<Vec<_>>().join("\n")
}

#[test]
fn the_memory_budget_is_kept_at_the_peak() {
    let folder = Folder::new("budget");
    let hole = r#"{"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,1],[0,0]],[[0.4,0.4],[0.6,0.4],[0.6,0.6],[0.4,0.4]]]}"#;
    fs::write(folder.0.join("hole.geojson"), hole).unwrap();
    fs::write(folder.0.join("noise.asc"), noise(0.002)).unwrap();
    let base = base(&folder);
    let fields = [
        "--domain 0,0,1,1 --target 0.0028+0.02*abs(sin(90*x)*sin(80*y)) --rule area",
        "--domain 0,0,1,1 --target 0.0028+0.02*abs(sin(90*x)*sin(80*y)) --rule vertex",
        "--domain 0,0,1,1 --target 0.0035",
        "--domain 0,0,1,1 --target-raster noise.asc",
        "--region hole.geojson --target 0.002+0.004*hypot(x,y)",
    ];
    std::thread::scope(|scope| {
        for field in fields {
            let folder = &folder;
            scope.spawn(move || is_kept(folder, field, base));
        }
    });
}

#[test]
fn a_mesh_is_made_within_its_memory() {
    let folder = Folder::new("made");
    fs::write(folder.0.join("noise.asc"), noise(0.0008)).unwrap();
    let base = base(&folder);
    // Every triangle is a block of its own, or all are in the largest blocks.
    for field in ["--target-raster noise.asc --rule area", "--target 0.0008 --rule area"] {
        let options = format!("--domain 0,0,1,1 --spacing 0.05 {field}");
        let (status, peak, triangles) = peak_of_made(&folder, &options);
        assert!(status == 0 && triangles > 1_000_000, "{field}: {triangles}");
        let each = (peak - base) as f64 / triangles as f64;
        eprintln!("{field}: {each:.1} bytes for each of {triangles} triangles");
        let budget = triangles * MemoryLimit::ONE_MESH_MADE;
        assert!(peak <= base + budget + ROUNDING, "{field}: {each} bytes for each of {triangles} triangles");
    }
}

fn is_kept(folder: &Folder, field: &str, base: usize) {
    // All write to the same file: each write has a temporary file of its own.
    let options = format!("--spacing 0.05 {field} -o mesh.vtu");
    let (status, peak, triangles) = peak_of(folder, &options);
    assert!(status == 0 && triangles > 150_000, "{field}: {triangles}");
    let budget = triangles * MemoryLimit::ONE_MESH;
    assert!(peak <= base + budget + ROUNDING, "{field}: {peak} for {triangles} triangles, {base} without");
    // With a little less than the mesh needs, that is not passed either.
    let budget = budget * 9 / 10;
    let limited = format!("{options} --max-memory {:.3}MB", budget as f64 / 1e6);
    let (status, peak, _) = peak_of(folder, &limited);
    assert_eq!(status, 1, "{limited}");
    assert!(peak <= base + budget + ROUNDING, "{limited}: {peak}, {base} without");
}

/// Writes a classic NetCDF file as large as the grid of GEBCO, with 43,200 × 86,400 heights of 0. They take
/// no space on the disk.
fn write_globe(file: &Path) {
    let words = |list: &[u32]| list.iter().flat_map(|number| number.to_be_bytes()).collect::<Vec<u8>>();
    let (rows, columns) = (43_200u32, 86_400u32);
    let mut bytes = [b"CDF\x01\0\0\0\0".to_vec(), words(&[10, 2])].concat();
    for (name, length) in [(b"lat\0", rows), (b"lon\0", columns)] {
        bytes.extend([words(&[3]), name.to_vec(), words(&[length])].concat());
    }
    bytes.extend(words(&[0, 0, 11, 3]));
    let (start, of_lat) = (300, 8 * rows);
    for (name, dimension, begin) in [(b"lat\0", 0, start), (b"lon\0", 1, start + of_lat)] {
        bytes.extend([words(&[3]), name.to_vec(), words(&[1, dimension, 0, 0, 6, 0, begin])].concat());
    }
    let begin = start + of_lat + 8 * columns;
    bytes.extend([words(&[1]), b"z\0\0\0".to_vec(), words(&[2, 0, 1, 0, 0, 3, 0, begin])].concat());
    bytes.resize(start as usize, 0);
    for (count, low) in [(rows, -90.0), (columns, -180.0)] {
        let center = |n: u32| low + (f64::from(n) + 0.5) / 240.0;
        bytes.extend((0..count).flat_map(|n| center(n).to_be_bytes()));
    }
    let mut written = fs::File::create(file).unwrap();
    written.write_all(&bytes).unwrap();
    written.set_len(u64::from(begin) + 2 * u64::from(rows) * u64::from(columns)).unwrap();
}

#[test]
fn only_the_domain_of_a_grid_of_the_whole_earth_is_read() {
    let folder = Folder::new("globe");
    write_globe(&folder.0.join("globe.nc"));
    let recipe = "[domain]\nbounds = [10, 53, 30, 66]\n[mesh]\nspacing = 2\n[[layer]]\nkind = \"band\"\nfile = \"globe.nc\"\n\
                  between = [-20, 0]\ndiameter = 0.5\n";
    folder.file("globe.toml", recipe);
    let began = Instant::now();
    let (status, peak, triangles) = peak_of(&folder, "globe.toml");
    let (seconds, megabytes) = (began.elapsed().as_secs_f64(), peak / 1_000_000);
    if crate::runs::prints_table() {
        eprintln!("20° × 13° of 43,200 × 86,400 pixels: {seconds:.2} s, {megabytes} MB at the peak");
    }
    // 15 million pixels of four bytes, their ranges, and a block of the file.
    assert!(status == 0 && triangles > 1000 && megabytes < 300, "{triangles} triangles, {megabytes} MB");
    let even = folder.json("mesh", "--domain 10,53,30,66 --spacing 2 --target 0.5");
    assert_eq!(even["triangles"], triangles);
}

#[test]
fn running_out_of_memory_is_an_error() {
    let folder = Folder::new("out");
    let program = env!("CARGO_BIN_EXE_meshbrush");
    let mesh = "mesh --threads 2 --domain 0,0,1,1 --spacing 0.01 --target 0.001 -o mesh.vtu";
    for kilobytes in [150_000, 250_000, 350_000, 500_000] {
        let line = format!("ulimit -v {kilobytes}; exec {program} {mesh}");
        let output = Command::new("sh").current_dir(&folder.0).args(["-c", &line]).output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{kilobytes} kB: {told}");
        let last = told.trim_end().lines().last().unwrap_or_default();
        assert!(last.contains("meshbrush: Memory ran out") && last.ends_with('.'), "{kilobytes} kB: {told}");
        assert!(!folder.0.join("mesh.vtu").exists());
    }
}
