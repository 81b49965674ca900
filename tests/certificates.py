"""Certificates of paths and meshes, checked by programs that share no code with the program that writes them; and those with
one number changed, which must be refused. Called by tests/run with the program to test: certificates.py PROGRAM. Needs only Python.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
COAST = HERE.parent / "assets" / "aegean_sea.geojson"
HILL = "1 + 3*gauss(hypot(x - 0.5, y - 0.5), 0.2)"
SQUARE = {"type": "Polygon", "coordinates": [[[0.3, 0.2], [0.6, 0.3], [0.5, 0.6], [0.3, 0.2]]]}
ENDS = ["--from", "0.1,0.1", "--to", "0.9,0.8"]
PLAIN = ["--spacing", "0.1", *ENDS]
CASES = {
    "a hill": [*PLAIN, "--cost", HILL, "--within", "1%"],
    "a risk, and a place on the way": [*PLAIN, "--risk", "0.4*x", "--h-min", "0.05", "--via", "0.4,0.9", "--within", "2%"],
    "a jump of the cost": [*PLAIN, "--cost", "if(x < 0.43, 1, 2)", "--within", "3%"],
    "a region to stay out of": [*PLAIN, "--cost", "1 + x", "--keep-out", "SQUARE", "--within", "5%"],
    "and 0.05 away from": [*PLAIN, "--cost", "1 + x", "--keep-out", "SQUARE", "--clearance", "0.05", "--within", "5%"],
    "a domain of a formula": [*PLAIN, "--inside", "r > 0.05 and hypot(x - 0.5, y - 0.4) > 0.15", "--cost", "1", "--within", "5%"],
    "a coast": "--spacing 0.5 --cost 1+2*gauss(hypot(x-25,y-37.5),0.6) --from 23.5,37.5 --to 26.5,38.7 --within 12%".split()
    + ["--region", str(COAST)],
}


def certificate(program, folder, arguments):
    file = folder / "certificate.json"
    square = folder / "square.geojson"
    square.write_text(json.dumps(SQUARE))
    arguments = [str(square) if argument == "SQUARE" else argument for argument in arguments]
    subprocess.run([program, "path", *arguments, "--certificate", file], check=True, capture_output=True)
    return json.loads(file.read_text())


def solution(program, folder, arguments):
    file = folder / "solution.json"
    subprocess.run([program, "solve", *arguments, "--certificate", file], check=True, capture_output=True)
    return json.loads(file.read_text())


SOLUTIONS = {
    "a square": "--spacing 0.2 --target 0.1 --source 3 --dirichlet all=1+2*x-y".split(),
    "a disc": ["--domain", "-1,-1,1,1", "--inside", "r<0.9", "--spacing", "0.25", "--diffusion", "0.01", "--source", "1", "--dirichlet", "all=0"],
    "an L by its error": ["--domain", "-1,-1,1,1", "--inside", "not (x>0 and y<0)", "--spacing", "0.25", "--source", "1", "--dirichlet", "all=0"]
    + ["--at-most", "600"],
}


def check_solutions(program, folder):
    """Certificates of solutions hold, and not with one number changed."""
    for name, arguments in SOLUTIONS.items():
        good = solution(program, folder, arguments)
        answer = check(folder, good, checker="check_solution.py")
        assert answer.returncode == 0, f"{name}: {answer.stderr}"
        middle = len(good["out"]) // 2

        def bad(change):
            copy = json.loads(json.dumps(good))
            change(copy)
            assert check(folder, copy, checker="check_solution.py").returncode != 0, f"{name}: {change.__name__}"

        def smaller_bound(copy):
            copy["bound"] *= 0.999

        def other_flux(copy):
            copy["out"][middle][1] += 1e-3

        def other_value(copy):
            copy["v"][copy["triangles"][middle][2]] += 0.5

        def other_source(copy):
            copy["f"][middle] += 50.0

        def turned(copy):
            copy["triangles"][middle].reverse()

        for change in (smaller_bound, other_flux, other_value, other_source, turned):
            bad(change)
    print(f"{len(SOLUTIONS)} certificates of solutions hold, and are refused with one number changed")


def check(folder, certificate, *options, checker="check_certificate.py"):
    file = folder / "checked.json"
    file.write_text(json.dumps(certificate))
    command = [sys.executable, HERE / checker, file, *options]
    return subprocess.run(command, capture_output=True, text=True)


def changed(certificate, change):
    copy = json.loads(json.dumps(certificate))
    change(copy, copy["legs"][0])
    return copy


def on_the_path(leg):
    """The number of the triangle in whose middle the function rises most: it has no slack."""

    def steepness(triangle):
        (ax, ay), (bx, by), (cx, cy) = (leg["nodes"][n] for n in triangle[:3])
        a, b, c = (leg["values"][n] for n in triangle[:3])
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        across, along = (b - a) * (cy - ay) - (c - a) * (by - ay), (c - a) * (bx - ax) - (b - a) * (cx - ax)
        return (across**2 + along**2) / area**2

    ratios = [steepness(t) / (sum(m) / 3) ** 2 for t, m in zip(leg["triangles"], leg["minorants"])]
    return ratios.index(max(ratios))


def raise_minorant(_, leg):
    leg["minorants"][on_the_path(leg)] = [9.0, 9.0, 9.0]


def move_value(_, leg):
    leg["values"][leg["triangles"][on_the_path(leg)][0]] *= 1.2


def drop_triangle(_, leg):
    number = on_the_path(leg)
    del leg["triangles"][number], leg["minorants"][number]


def split_value(_, leg):
    triangle = leg["triangles"][on_the_path(leg)]
    leg["values"].append(leg["values"][triangle[3]])
    triangle[3] = len(leg["values"]) - 1


CHANGES = {
    "a greater scale": lambda _, leg: leg.update(scale=1.01 * leg["scale"]),
    "a greater bound": lambda _, leg: leg.update(lower=1.0001 * leg["lower"]),
    "a greater sum": lambda file, _: file.update(lower=1.0001 * file["lower"]),
    "a cheaper path": lambda _, leg: leg.update(upper=0.99 * leg["upper"]),
    "a path elsewhere": lambda _, leg: leg["path"][-1].__setitem__(0, leg["path"][-1][0] - 0.05),
    "a minorant above the cost": raise_minorant,
    "another value": move_value,
    "a triangle less": drop_triangle,
    "two values on an edge": split_value,
}


BUMP = "gauss(hypot(x - 0.4, y - 0.6), 0.1)"
CONE = "0.02 + 0.3*hypot(x - 0.3, y - 0.3)"
MESHES = {
    "a surface": (["--surface", BUMP, "--max-error", "0.005"], ["--surface", BUMP]),
    "a target": (["--target", CONE], ["--target", CONE]),
    "a surface and a target": (["--surface", BUMP, "--max-error", "0.005", "--target", CONE], ["--surface", BUMP, "--target", CONE]),
}


def coarser_demand(file):
    """The mesh has bisections that nothing forces then."""
    del file["demands"][:]


def other_place(file):
    file["demands"][0]["at"] = file["demands"][-1]["at"]


def further_triangle(file):
    """A bisection more: a leaf in its two halves."""
    apex, p, q = file["triangles"].pop()
    middle = [(p[0] + q[0]) // 2, (p[1] + q[1]) // 2]
    file["triangles"] += [[middle, p, apex], [middle, q, apex]]


def check_meshes(program, folder):
    refused = 0
    for title, (arguments, options) in MESHES.items():
        file = folder / "certificate.json"
        command = [program, "mesh", "--spacing", "0.25", *arguments, "--certificate", file]
        subprocess.run(command, check=True, capture_output=True)
        found = json.loads(file.read_text())
        checked = check(folder, found, *options, checker="check_mesh_certificate.py")
        assert checked.returncode == 0, f"{title}: {checked.stderr}"
        assert len(found["triangles"]) > 300 and len(found["demands"]) > 100, title
        print(f"{title}: {checked.stdout.strip()}")
        for change in [coarser_demand, other_place, further_triangle]:
            copy = json.loads(json.dumps(found))
            change(copy)
            checked = check(folder, copy, *options, checker="check_mesh_certificate.py")
            assert "AssertionError: " in checked.stderr, f"{title}, {change.__name__}: {checked.stdout}{checked.stderr}"
            refused += 1
    return refused


def main():
    program = sys.argv[1]
    refused = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for title, arguments in CASES.items():
            found = certificate(program, folder, arguments)
            options = ["--risk", arguments[arguments.index("--risk") + 1]] if "--risk" in arguments else []
            checked = check(folder, found, *options)
            assert checked.returncode == 0, f"{title}: {checked.stderr}"
            assert found["lower"] > 0.85 * found["upper"], title
            print(f"{title}: {checked.stdout.strip()}")
            # All changes of the first, and of a coast what concerns the area.
            changes = CHANGES.items() if refused == 0 else [("a triangle less", drop_triangle)]
            for what, change in changes if title in ["a hill", "a coast"] else []:
                checked = check(folder, changed(found, change), *options)
                assert "AssertionError: " in checked.stderr, f"{title}, {what}: {checked.stdout}{checked.stderr}"
                refused += 1
        refused += check_meshes(program, folder)
        check_solutions(program, folder)
    print(f"{len(CASES) + len(MESHES)} certificates hold, and {refused} with one change are refused")


if __name__ == "__main__":
    main()
