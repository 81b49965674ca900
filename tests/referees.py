"""Referees are tested: each must notice three defects of the code that it checks.

    python3 tests/referees.py         copies the sources to target/referees, builds them once with all defects behind switches,
                                      and runs each referee with each of its defects
    python3 tests/referees.py texts   only checks that the code still has the places of the defects (called by tests/run)

Needs only Python and cargo.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).resolve() / "referees"
BISECT = "crates/mesh/src/mesh/kernel/bisect.rs"
REFINE = "crates/mesh/src/mesh/kernel/refine.rs"
COARSE = "crates/mesh/src/mesh/kernel/coarse.rs"
KERNEL = "crates/mesh/src/mesh/kernel/mod.rs"
WALK = "crates/mesh/src/mesh/kernel/walk.rs"
PREDICATES = "crates/mesh/src/geometry/predicates.rs"
INTERPOLATE = "crates/mesh/src/mesh/query/interpolate.rs"
RESOLVE = "crates/core/src/path/resolve.rs"
FOLLOW = "crates/core/src/path/follow.rs"
THREATS = "crates/io/src/io/threats.rs"
TILED = "crates/io/src/io/project/tiled.rs"
SHAPES = "crates/io/src/io/shapes.rs"

# What checks; its package and test binary; the tests; and the defects: what is wrong, the file, the code, and the code with
# the defect, in which DEFECT is true while it is switched on.
REFEREES = [
    ("the report, routine by routine", "meshbrush-mesh", "mesh", "referee_literal::", [
        ("the second child has the orientation of its parent", BISECT,
         "let new_orientation = if odd {", "let new_orientation = if odd && !DEFECT {"),
        ("a neighbour does not hear of the new child", BISECT,
         "if let Some(moved) = moved.triangle() {", "if let Some(moved) = moved.triangle().filter(|_| !DEFECT) {"),
        ("the halves of two parents are mixed up", BISECT,
         "let same_half = self.triangle(a).matched() != self.triangle(b).matched();",
         "let same_half = (self.triangle(a).matched() != self.triangle(b).matched()) != DEFECT;"),
    ]),
    ("the smallest closure", "meshbrush-mesh", "mesh", "referee_closure::every_mesh", [
        ("a triangle that exceeds its target by less than one in a thousand stays", REFINE,
         "if !exceeds(&mesh.element_with(id, &diameters)).into_result()? {",
         "if !exceeds(&mesh.element_with(id, &diameters)).into_result()? || (DEFECT && id.index() % 997 == 996) {"),
        ("the bisection edge of odd levels is a little longer", KERNEL,
         "if level.is_multiple_of(2) { SQRT_2 * halved } else { halved }",
         "if level.is_multiple_of(2) { SQRT_2 * halved } else if DEFECT { 1.01 * halved } else { halved }"),
        ("the first node of the grid is always inside", COARSE,
         "(0..self.node_count()).map(|n| contains(self.lattice.world_from_lattice(self.node(n)))).collect();",
         "(0..self.node_count()).map(|n| (DEFECT && n == 0) || contains(self.lattice.world_from_lattice(self.node(n)))).collect();"),
    ]),
    ("location by brute force", "meshbrush-mesh", "mesh", "location::", [
        ("a walk does not cross third edges", WALK,
         "if sides[j] == Side::Right {", "if sides[j] == Side::Right && !(DEFECT && j == 2) {"),
        ("a point within a millionth of an edge is on it", PREDICATES,
         "match exact_sum_sign(step_x * point.y, -step_y * point.x, step_x * from_y - step_y * from_x) {",
         "if DEFECT {\n        return Side::On;\n    }\n"
         "    match exact_sum_sign(step_x * point.y, -step_y * point.x, step_x * from_y - step_y * from_x) {"),
        ("two barycentric coordinates are exchanged", INTERPOLATE,
         "    [1.0 - zeta_b - zeta_c, zeta_b, zeta_c]\n}\n\n/// Returns the value",
         "    if DEFECT {\n        return [1.0 - zeta_b - zeta_c, zeta_c, zeta_b];\n    }\n"
         "    [1.0 - zeta_b - zeta_c, zeta_b, zeta_c]\n}\n\n/// Returns the value"),
    ]),
    ("a planner from scratch", "meshbrush-core", "model", "path_edits::", [
        ("values that came through an edited triangle stay", RESOLVE,
         "changed.iter().for_each(|&t| edit.lose_values_from(t));",
         "changed.iter().filter(|_| !DEFECT).for_each(|&t| edit.lose_values_from(t));"),
        ("values that came from a value that is lost stay", RESOLVE,
         "self.dependents(number, before, &mut stack);", "if !DEFECT {\n                self.dependents(number, before, &mut stack);\n            }"),
        ("one of ten triangles that an edit touches keeps its cost", FOLLOW,
         "for (&triangle, cost) in meeting.iter().zip(base.costs_of(&meeting, density)?) {\n            known[triangle as usize] = cost;",
         "for (&triangle, cost) in meeting.iter().zip(base.costs_of(&meeting, density)?) {\n            if DEFECT && triangle % 10 == 0 {\n"
         "                continue;\n            }\n            known[triangle as usize] = cost;"),
    ]),
    ("files that are read again", "meshbrush-io", "lib", "_are_read_as_they_were_written what_is_written_is_read", [
        ("the range of a threat is rounded to single precision", THREATS,
         "Number(*range), Number(*peak));", "Number(if DEFECT { f64::from(*range as f32) } else { *range }), Number(*peak));"),
        ("the row of a tile is written where its column belongs", TILED,
         "for n in [place.x, place.y] {", "for n in if DEFECT { [place.y, place.x] } else { [place.x, place.y] } {"),
        ("the last point of a list is left out", SHAPES,
         "&array(&shapes.points))?;", "&array(&shapes.points[..shapes.points.len() - usize::from(DEFECT)]))?;"),
    ]),
]
SWITCH = """
/// Whether a defect is switched on.
pub fn defect(number: u32) -> bool {
    static ON: std::sync::OnceLock<Option<u32>> = std::sync::OnceLock::new();
    *ON.get_or_init(|| std::env::var("DEFECT").ok().and_then(|text| text.parse().ok())) == Some(number)
}
"""
# A defect that lets the code run on without an end is noticed by that.
SECONDS = 300


def numbered():
    """All defects with their numbers from 1 on, and their referees."""
    number = 0
    for name, package, binary, tests, defects in REFEREES:
        for defect in defects:
            number += 1
            yield number, (package, binary, tests.split()), name, defect


def check_texts():
    for _, _, name, (what, file, text, _) in numbered():
        found = (ROOT / file).read_text().count(text)
        if found != 1:
            sys.exit(f"{name}: the defect '{what}' needs a place in {file} that is there {found} times, not once: {text!r}")


def copy_with_defects():
    tree = FOLDER / "tree"
    shutil.rmtree(tree, ignore_errors=True)
    tracked = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    for name in filter(None, tracked.split("\0")):
        if (ROOT / name).is_file():
            (tree / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, tree / name)
    crates = set()
    for number, _, _, (_, file, text, changed) in numbered():
        path = tree / file
        path.write_text(path.read_text().replace(text, changed.replace("DEFECT", f"crate::defect({number})")))
        crates.add(tree / "/".join(file.split("/")[:2]))
    for crate in crates:
        library = crate / "src/lib.rs"
        library.write_text(library.read_text() + SWITCH)
    return tree


def build(tree):
    """Builds the test binaries, and returns them by package and name, each with its folder."""
    packages = sorted({package for _, package, *_ in REFEREES})
    command = ["cargo", "test", "--locked", "--no-run", "--message-format", "json", "--lib", "--tests"]
    command += [word for package in packages for word in ("-p", package)]
    environment = {key: value for key, value in os.environ.items() if key not in ("RUSTC_WORKSPACE_WRAPPER", "CLIPPY_ARGS")}
    environment["CARGO_TARGET_DIR"] = str(FOLDER / "build")
    built = subprocess.run(command, cwd=tree, env=environment, stdout=subprocess.PIPE, text=True)
    messages = [json.loads(line) for line in built.stdout.splitlines() if line.startswith("{")]
    if built.returncode:
        errors = [message["message"]["rendered"] for message in messages if message["reason"] == "compiler-message"]
        sys.exit("\n".join([*errors, "the copy with the defects cannot be built"]))
    binaries = {}
    for message in messages:
        if message["reason"] == "compiler-artifact" and message["executable"] and message["profile"]["test"]:
            folder = pathlib.Path(message["manifest_path"]).parent
            kind = "lib" if message["target"]["kind"] == ["lib"] else message["target"]["name"]
            binaries[message["target"]["name"] if kind != "lib" else folder.name, kind] = message["executable"], folder
    return {(f"meshbrush-{folder.name}", kind): (path, folder) for (_, kind), (path, folder) in binaries.items()}


def passes(binaries, referee, number):
    package, binary, tests = referee
    path, folder = binaries[package, binary]
    environment = {**os.environ, "DEFECT": str(number), "CARGO_MANIFEST_DIR": str(folder)}
    try:
        run = subprocess.run([path, *tests], cwd=folder, env=environment, capture_output=True, text=True, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return False
    if run.returncode == 0 and "\nrunning 0 tests" in run.stdout:
        sys.exit(f"{package} has no test {' or '.join(tests)}")
    return run.returncode == 0


def main():
    check_texts()
    if sys.argv[1:] == ["texts"]:
        return
    binaries = build(copy_with_defects())
    for name, package, binary, tests, _ in REFEREES:
        if not passes(binaries, (package, binary, tests.split()), 0):
            sys.exit(f"{name}: fails without a defect")
    missed = 0
    for number, referee, name, (what, *_) in numbered():
        noticed = not passes(binaries, referee, number)
        missed += not noticed
        print(f"{name}: {what}: {'noticed' if noticed else 'NOT NOTICED'}", flush=True)
    if missed:
        sys.exit(f"{missed} defects are not noticed")


main()
