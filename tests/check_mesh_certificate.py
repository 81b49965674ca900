"""Checks a certificate of `meshbrush mesh --certificate FILE`: check_mesh_certificate.py FILE [--surface EXPR] [--target EXPR].

Needs nothing but Python, and shares no code with the program but the evaluation of formulas with check_certificate.py.

 1. The triangles of the mesh are the leaves of a bisection of the coarse triangles, each through the middle of its longest edge.
 2. At the place of each demand, the surface is farther from the triangle than allowed, or the target below its diameter.
 3. With each triangle that must be bisected, its parent must be, and the one across its longest edge: this gives all
    bisected triangles. So every conforming mesh of these bisections that meets the demands has them, and none is smaller.
"""

import argparse
import json
import math
import sys

from check_certificate import barycentric, formula

DEEPEST = 64


def key(triangle):
    apex, *ends = triangle
    return apex, frozenset(ends)


def children(triangle):
    apex, p, q = triangle
    middle = ((p[0] + q[0]) // 2, (p[1] + q[1]) // 2)
    return [(middle, p, apex), (middle, q, apex)]


def bisected_triangles(coarse, leaves):
    """The parent of each triangle that is bisected; None of a coarse one."""
    parents, seen, waiting = {}, set(), [(triangle, None, 0) for triangle in coarse]
    while waiting:
        triangle, parent, depth = waiting.pop()
        if key(triangle) in leaves:
            assert key(triangle) not in seen, "a triangle is there twice"
            seen.add(key(triangle))
            continue
        assert depth < DEEPEST, f"the triangles of the mesh do not cover {triangle}"
        parents[key(triangle)] = parent
        waiting += [(child, key(triangle), depth + 1) for child in children(triangle)]
    assert seen == leaves, "a triangle of the mesh comes from no bisection"
    return parents


def across(triangle):
    """The mirror image across the longest edge, by its key."""
    apex, ends = triangle
    p, q = ends
    return (p[0] + q[0] - apex[0], p[1] + q[1] - apex[1]), ends


def forced(demanded, parents):
    found, waiting = set(), list(demanded)
    while waiting:
        triangle = waiting.pop()
        if triangle in found or triangle is None:
            continue
        assert triangle in parents, f"{triangle} must be bisected, and is not"
        found.add(triangle)
        waiting.append(parents[triangle])
        if across(triangle) in parents:
            waiting.append(across(triangle))
    return found


def check_demand(demand, world, surface, target):
    corners = [world(corner) for corner in demand["triangle"]]
    if demand["by"] == "outline":
        return "outline"
    x, y = demand["at"]
    shares = barycentric(corners, x, y)
    assert min(shares) > -1e-9, f"({x}, {y}) is not in its triangle"
    if demand["by"] == "target":
        diameter = max(math.dist(a, b) for a, b in [corners[:2], corners[1:], corners[::2]])
        assert demand["target"] < diameter, f"the target at ({x}, {y}) is not below the diameter"
        assert not target or math.isclose(target(x, y), demand["target"], rel_tol=1e-6), f"another target at ({x}, {y})"
        return "target" if target else "target, as the file says"
    error = demand["error"]
    if surface:
        error = abs(surface(x, y) - sum(share * surface(*corner) for share, corner in zip(shares, corners)))
        # Heights may be of single precision.
        assert math.isclose(error, demand["error"], rel_tol=1e-3), f"the difference at ({x}, {y}) is {error}"
    assert error > demand["most"], f"the difference at ({x}, {y}) is allowed"
    return "surface" if surface else "surface, as the file says"


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("file")
    arguments.add_argument("--surface", help="the height of the surface, a formula of x and y")
    arguments.add_argument("--target", help="the target diameter, a formula of x and y")
    given = arguments.parse_args()
    with open(given.file, encoding="utf-8") as text:
        file = json.load(text)
    assert (file["format"], file["version"]) == ("Meshbrush mesh certificate", 1), "another kind of file"
    (left, low), (width, height) = file["lattice_origin"], file["lattice_step"]

    def world(corner):
        return left + width * corner[0], low + height * corner[1]

    def triangles(name):
        return [tuple(map(tuple, triangle)) for triangle in file[name]]

    surface, target = (text and formula(text) for text in [given.surface, given.target])
    leaves = {key(triangle) for triangle in triangles("triangles")}
    parents = bisected_triangles(triangles("coarse"), leaves)
    for triangle in parents:
        image = across(triangle)
        assert image not in leaves, f"the mesh is not conforming at {triangle}"
    counts = {}
    for demand in file["demands"]:
        by = check_demand(demand, world, surface, target)
        counts[by] = counts.get(by, 0) + 1
    demanded = {key(tuple(map(tuple, demand["triangle"]))) for demand in file["demands"]}
    found = forced(demanded, parents)
    missing = set(parents) - found
    assert not missing, f"{len(missing)} bisections are not forced, the first of {next(iter(missing))}"
    said = ", ".join(f"{count} by {by}" for by, count in sorted(counts.items())) or "none"
    print(f"{len(leaves)} triangles, {len(parents)} bisections, all forced by {len(demanded)} demands ({said})")


if __name__ == "__main__":
    sys.exit(main())
