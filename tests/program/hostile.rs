//! Odd files, names, options and systems: the program ends soon, with a sentence.
#![cfg(unix)]

use std::io::Write as _;
use std::os::unix::fs::symlink;
use std::os::unix::process::CommandExt as _;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use flate2::Compression;
use flate2::write::DeflateEncoder;

use crate::folder::{Arguments, Folder, Ran};

const PROGRAM: &str = env!("CARGO_BIN_EXE_meshbrush");

/// Runs a command, which must end before somebody would lose patience.
fn ended(mut command: Command, what: &str) -> Ran {
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let (mut child, begun) = (command.spawn().unwrap(), Instant::now());
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > Duration::from_secs(60) {
            child.kill().unwrap();
            panic!("{what} does not end");
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    Ran::new(child.wait_with_output().unwrap())
}

/// Runs the program, which must fail with a sentence.
fn failed(folder: &Folder, arguments: impl Arguments, sentence: &str) {
    let words = arguments.words().join(" ");
    check_failed(&ended(folder.command(arguments), &words), &words, sentence);
}

fn check_failed(ran: &Ran, what: &str, sentence: &str) {
    let said = &ran.err;
    assert!(ran.status == 1 || ran.status == 2, "{what}: {ran:?}");
    assert!(said.contains(sentence) && !said.contains("panicked"), "{what}: {said}");
    let is_control = |c: char| c.is_control() && c != '\n';
    assert!(said.len() < 2500 && !said.contains(is_control), "{what}: {said:?}");
}

/// Runs a line of a shell in which `$P` is the program.
fn shell(folder: &Folder, line: &str) -> Command {
    let mut command = Command::new("sh");
    command.current_dir(&folder.0).env("P", PROGRAM).args(["-c", line]);
    command
}

#[test]
fn what_is_no_file_is_refused_by_every_reader() {
    let folder = Folder::new("no-file");
    let commands = [
        "mesh --h-min 0.1 --risk-raster @.png",
        "mesh --target-raster @.asc",
        "mesh --target-raster @.npy",
        "mesh --target-raster @.tif",
        "mesh --target-raster @.nc",
        "mesh --h-min 0.1 --threats @.csv",
        "mesh --region @.geojson",
        "mesh --region @.shp",
        "mesh --region @.gpkg",
        "mesh --project @.meshbrush",
        "mesh @.toml",
        "locate --points @.csv",
        "replay @.jsonl",
        "recipe @.meshbrush -o r.toml",
        "thumbnail @.meshbrush t.png",
    ];
    let refused = |n: usize, name: &str, said: &str| {
        let word = commands[n].split_whitespace().find(|word| word.starts_with('@')).unwrap();
        let file = format!("{name}{n}.{}", &word[2..]);
        let path = folder.0.join(&file);
        match name {
            "zero" => symlink("/dev/zero", path).unwrap(),
            "folder" => std::fs::create_dir(path).unwrap(),
            _ => assert!(Command::new("mkfifo").arg(path).status().unwrap().success()),
        }
        failed(&folder, commands[n].replace(word, &file), said);
    };
    for n in 0..commands.len() {
        refused(n, "zero", "a device");
        refused(n, "folder", "a folder");
    }
    // Each waits a second for a writer.
    std::thread::scope(|scope| {
        for n in 0..commands.len() {
            scope.spawn(move || refused(n, "pipe", "nobody writes to this pipe"));
        }
    });
    // The pipe of a shell is a file.
    folder.file("points.csv", "x,y\n0.3,0.2\n");
    let piped = ended(shell(&folder, "cat points.csv | $P locate --points /dev/stdin"), "a pipe");
    assert_eq!((piped.status, piped.out.lines().count()), (0, 2), "{}", piped.err);
}

#[test]
fn words_and_names_are_said_as_they_can_be_read() {
    let folder = Folder::new("words");
    let digits = "1".repeat(300);
    failed(&folder, "mehs", "There is no file mehs. Is the command `mesh` meant?");
    failed(
        &folder,
        "coast.meshbrush",
        "There is no file coast.meshbrush. `meshbrush --help` lists the commands.",
    );
    failed(
        &folder,
        ["mesh", "--project", "a\u{1b}[31m\u{202e}.meshbrush"],
        "a\\u{1b}[31m\\u{202e}.meshbrush",
    );
    failed(&folder, ["mesh", "-o", "\u{1b}]0;x\u{7}.xyz"], "\\u{1b}]0;x\\u{7}.xyz");
    failed(&folder, ["mesh", "--rule", "\u{1b}[2J"], "invalid value");
    for option in [
        "--spacing",
        "--max-level",
        "--max-triangles",
        "--threads",
        "--domain",
        "--rule",
        "--size",
        "--target",
    ] {
        let long = "1".repeat(100_000);
        failed(&folder, ["mesh", option, &format!("x{digits}")], "1111");
        failed(&folder, ["mesh", option, &format!("x{long}")], "1111");
    }
    assert_eq!(folder.names(), [""; 0]);
}

#[test]
fn names_of_files_are_checked_before_the_work() {
    let folder = Folder::new("long-names");
    let name = |length: usize| format!("{}.csv", "n".repeat(length - 4));
    for length in [100, 240, 255] {
        let ran = folder.run(["mesh", "--target", "0.5", "-o", &name(length)]);
        assert!(ran.status == 0 && folder.has(&name(length)), "{length}: {}", ran.err);
    }
    // The formula has no value anywhere: the work is not begun.
    failed(&folder, ["mesh", "--target", "0/0", "-o", &name(256)], "too long");
}

#[test]
fn counts_beyond_any_use_are_refused_or_limited() {
    let folder = Folder::new("counts");
    let many = |option: &str, value: &str, count: usize| [option, value].repeat(count).join(" ");
    failed(
        &folder,
        format!("mesh {}", many("-o", "a.csv", 10_000)),
        "-o names 10000 files, and the limit is 1000",
    );
    failed(&folder, format!("mesh -o a.vtu {}", many("--quantity", "x", 10_000)), "the limit is 100");
    failed(
        &folder,
        format!("mesh {}", many("--target", "1", 10_000)),
        "10,000 layers, and the limit is 1,000",
    );
    let ran = ended(folder.command("mesh --target 0.2 --json --threads 10000"), "threads");
    assert!(ran.status == 0 && ran.err.contains("--threads 10000: this machine has"), "{}", ran.err);
}

#[test]
fn without_threads_the_work_is_done_by_one() {
    let folder = Folder::new("threads");
    let mesh = "mesh --target 0.02 --json";
    let hash = folder.run(mesh).json()["hash"].clone();
    // Not every shell has `ulimit -u`.
    let limited = "if command -v prlimit >/dev/null; then exec prlimit --nproc=1 $P";
    let mut command = shell(&folder, &format!("{limited} {mesh}; fi; ulimit -u 1; exec $P {mesh}"));
    // The limit is for users who are not the superuser, and who may not see the superuser's folders.
    let is_root =
        std::fs::metadata("/proc/self").is_ok_and(|own| std::os::unix::fs::MetadataExt::uid(&own) == 0);
    let copy = std::env::temp_dir().join(format!("meshbrush-threads-{}", std::process::id()));
    if is_root {
        std::fs::copy(PROGRAM, &copy).unwrap();
        command.uid(65_534).current_dir("/").env("P", &copy);
    }
    let ran = ended(command, "one thread");
    _ = std::fs::remove_file(&copy);
    assert_eq!(ran.status, 0, "{}", ran.err);
    assert_eq!(ran.json()["hash"], hash);
}

#[test]
fn an_address_space_that_is_small_is_used_or_too_small() {
    let folder = Folder::new("address-space");
    for kilobytes in [150_000, 250_000, 400_000] {
        let line = format!("ulimit -v {kilobytes}; exec $P mesh --target 0.02 --threads 8 --json");
        let ran = ended(shell(&folder, &line), &line);
        let is_sentence =
            ran.err.contains("Memory ran out") || ran.err.contains("error while loading shared");
        assert!(ran.status == 0 || is_sentence, "{kilobytes} kB: {ran:?}");
        assert!(!ran.err.contains("panicked"), "{kilobytes} kB: {ran:?}");
    }
}

#[test]
fn a_closed_or_full_output_is_a_failure() {
    let folder = Folder::new("closed");
    folder.file("points.csv", "x,y\n0.3,0.2\n");
    for command in [
        "mesh --target 1 -o - --format csv",
        "mesh --target 1 --json",
        "locate --points points.csv",
        "why 0.5,0.3 --target 0.4",
        "completions bash",
    ] {
        let closed = ended(shell(&folder, &format!("exec $P {command} >&-")), command);
        check_failed(&closed, command, "standard output is closed");
        let full = ended(shell(&folder, &format!("exec $P {command} >/dev/full")), command);
        check_failed(&full, command, "cannot be printed");
    }
    let quiet = ended(shell(&folder, "exec $P mesh --target 1 -o a.csv >&-"), "a file");
    assert!(quiet.status == 0 && folder.has("a.csv"), "{}", quiet.err);
}

#[test]
fn lengths_that_cannot_be_calculated_with_are_refused() {
    let folder = Folder::new("subnormal");
    folder.file("ok.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0.5\n1 0\n0 1\n");
    let recipe = |domain: &str, bounds: &str| {
        format!(
            "[domain]\nbounds = [{domain}]\n[limits]\nh_min = 0.02\nh_max = 0.2\n[[layer]]\nkind = \"raster\"\nas = \"risk\"\n\
             file = \"ok.asc\"\nbounds = [{bounds}]\n"
        )
    };
    let odd = [
        "0, 0, 1e-320, 1",
        "0, 0, 1, 5e-324",
        "0, 0, 1e-130, 1",
        "0, 0, 1e200, 1",
        "1e300, 0, 1.1e300, 1",
        "-1e308, 0, 1e308, 1",
        "0, 0, nan, 1",
    ];
    for bounds in odd {
        folder.file("a.toml", recipe("0, 0, 1, 1", bounds));
        failed(&folder, "mesh a.toml", "sides between 1e-120 and 1e150");
        folder.file("b.toml", recipe(bounds, "0, 0, 1, 1"));
        failed(&folder, "mesh b.toml", "1e-120 and 1e150");
        failed(&folder, format!("mesh --domain {}", bounds.replace(' ', "")), "1e-120 and 1e150");
    }
    // What can be calculated with has a mesh, however thin it is and however far away.
    for bounds in [
        "0, 0, 1e-110, 1",
        "1e149, 0, 1.1e149, 1",
        "0.3, 0.2, 0.3000000000000001, 1",
        "-1e140, -1e140, 1e140, 1e140",
    ] {
        folder.file("c.toml", recipe("0, 0, 1, 1", bounds));
        let ran = ended(folder.command("mesh c.toml --json --max-level 30 --max-triangles 200000"), bounds);
        assert!(ran.status == 0 || ran.err.contains("triangles"), "{bounds}: {}", ran.err);
    }
    for cells in ["1e-320", "1e-200", "1e160", "1e308"] {
        folder.file(
            "d.asc",
            format!("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize {cells}\n1 0\n0 1\n"),
        );
        failed(&folder, "mesh --h-min 0.1 --risk-raster d.asc", "covers no rectangle");
    }
}

/// Returns a project whose settings are this text.
fn project(settings: &[u8]) -> Vec<u8> {
    let mut packed = DeflateEncoder::new(Vec::new(), Compression::fast());
    packed.write_all(settings).unwrap();
    let packed = packed.finish().unwrap();
    let sizes = [crc32fast::hash(settings), packed.len() as u32, settings.len() as u32];
    let sizes: Vec<u8> = sizes.iter().flat_map(|number| number.to_le_bytes()).collect();
    let name = b"settings.json";
    let common =
        [&[20, 0, 0, 0, 8, 0, 0, 0, 0x21, 0][..], &sizes, &(name.len() as u32).to_le_bytes()].concat();
    let local = [&b"PK\x03\x04"[..], &common, name, &packed].concat();
    let central = [&b"PK\x01\x02\x14\0"[..], &common, &[0; 14], name].concat();
    let [length, start] = [central.len() as u32, local.len() as u32].map(u32::to_le_bytes);
    [&local, &central, &b"PK\x05\x06\0\0\0\0\x01\0\x01\0"[..], &length, &start, &[0; 2]].concat()
}

/// Runs the program with little address space: a large answer to a small file fails otherwise.
fn within(folder: &Folder, megabytes: usize, arguments: &str) -> Ran {
    ended(shell(folder, &format!("ulimit -v {}; exec $P {arguments}", 1000 * megabytes)), arguments)
}

#[test]
fn small_projects_that_unpack_to_large_ones_take_little_memory() {
    let folder = Folder::new("bombs");
    let head = r#""format":"Meshbrush project","version":1"#;
    let zeros = "0,".repeat(16 << 20);
    for (name, text) in [
        ("unknown", format!("{{{head},\"odd\":[{zeros}0]}}")),
        ("layers", format!("{{{head},\"layers\":[{zeros}0]}}")),
        ("pins", format!("{{{head},\"pins\":[{zeros}0]}}")),
        ("array", format!("[{zeros}0]")),
    ] {
        let bytes = project(text.as_bytes());
        assert!(bytes.len() < 200_000, "{name} has {} bytes", bytes.len());
        folder.file(&format!("{name}.meshbrush"), bytes);
        check_failed(
            &within(&folder, 700, &format!("mesh --project {name}.meshbrush --threads 1")),
            name,
            "settings",
        );
        let thumbnail = within(&folder, 700, &format!("thumbnail {name}.meshbrush t.png --threads 1"));
        check_failed(&thumbnail, name, "");
    }
    assert!(!folder.has("t.png"));
}

#[test]
fn a_thumbnail_takes_little_time_and_memory() {
    let folder = Folder::new("thumbnail");
    let head = concat!(
        r#"{"format":"Meshbrush project","version":1,"written_by":"","name":"a","domain":"#,
        r#"{"bounds":[0,0,1,1],"shape":"whole"},"boundary":"report","cleaning":{"parts":"largest","keep_pinches":false},"#,
        r#""spacing":0.1,"transfer":{"h_min":0.0001,"h_max":0.2,"shape":1},"rule":"area","#,
        r#""max_triangles":20000000,"max_memory":2600000000,"layers":["#,
    );
    let layers = |formula: &str, count: usize| {
        let kind = format!(r#""kind":"formula","name":"f","quantity":"diameter","formula":"{formula}""#);
        let all: Vec<String> = (0..count).map(|id| format!(r#"{{"id":{id},"layer":{{{kind}}}}}"#)).collect();
        project(format!("{head}{}]}}", all.join(",")).as_bytes())
    };
    folder.file("good.meshbrush", layers("0.05 + x/10", 1));
    let ran = ended(folder.command("thumbnail good.meshbrush good.png --size 128"), "a thumbnail");
    assert_eq!(ran.status, 0, "{}", ran.err);
    let picture = png::Decoder::new(std::io::Cursor::new(std::fs::read(folder.0.join("good.png")).unwrap()));
    assert_eq!(picture.read_info().unwrap().info().size(), (128, 128));
    for (name, formula, count, said) in [
        ("fine", "0.0001", 1, "triangles"),
        ("many", "0.5", 2_000, "the limit is 1,000"),
        ("very-many", "0.5", 100_000, "limit"),
        ("slow", "0.004 + (sin(300*x*y)*sin(70*y))^2", 900, "longer than 2 s"),
    ] {
        folder.file(&format!("{name}.meshbrush"), layers(formula, count));
        let begun = Instant::now();
        let ran = ended(folder.command(format!("thumbnail {name}.meshbrush {name}.png")), name);
        // The clock runs from the start of the program; a busy machine starts it late.
        assert!(begun.elapsed() < Duration::from_secs(10), "{name}: {:?}", begun.elapsed());
        check_failed(&ran, name, said);
        assert!(!folder.has(&format!("{name}.png")), "{name}");
    }
}
