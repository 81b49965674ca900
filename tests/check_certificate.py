"""Checks a certificate of `meshbrush path --within SHARE --certificate FILE`: check_certificate.py FILE [--risk EXPR] [--cost EXPR].

Needs nothing but Python, and shares no code with the program. Where the numbers of the file are enough, arithmetic is exact
(fractions). The cost, which has functions such as exp, is evaluated in double precision on a dense grid in each triangle.

 1. v is continuous: values belong to nodes and edges, and each edge has at most one triangle on either side.
 2. |grad(scale v)| <= minorant at all corners of all triangles. The gradient is affine, so this holds everywhere.
 3. minorant <= cost at points within the triangles; on an edge, that of one of its two triangles.
 4. No path leaves the triangles: where they end there is no point of the domain.
 5. scale (v(goal) - v(start)) >= lower, and the path costs no more than upper.
"""

import argparse
import json
import math
import re
from collections import defaultdict
from fractions import Fraction

PARTS = 6  # a triangle is looked at in (PARTS - 1)(PARTS - 2)/2 points, and an edge in PARTS - 1
ROUNDING = 1e-9  # of the cost in double precision, as a share of it


def formula(text):
    """A function of x, y and risk: Python's own evaluation of a formula of docs/formulas.md."""
    text = re.sub(r"\bif\(", "where(", text.replace("^", "**").replace("||", " or ").replace("&&", " and "))
    names = {name: getattr(math, name) for name in dir(math) if not name.startswith("_")}
    names |= {"abs": abs, "min": min, "max": max, "ln": math.log, "where": lambda c, a, b: a if c else b}
    names |= {"gauss": lambda d, s: math.exp(-((d / s) ** 2) / 2), "sign": lambda v: (v > 0) - (v < 0)}
    names |= {"clamp": lambda v, low, high: max(low, min(v, high)), "step": lambda edge, v: float(v >= edge)}
    code = compile(text, "formula", "eval")
    polar = {"r", "theta"} & set(code.co_names)

    def at(x, y, risk=None):
        known = {"x": x, "y": y, "risk": risk}
        known |= {"r": math.hypot(x, y), "theta": math.atan2(y, x)} if polar else {}
        return eval(code, {"__builtins__": {}} | names | known)

    return at


def exact(points):
    return [(Fraction(x), Fraction(y)) for x, y in points]


def barycentric(corners, x, y):
    (ax, ay), (bx, by), (cx, cy) = corners
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    b = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
    c = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
    return 1 - b - c, b, c


def values_at(leg, point):
    """v at a point, in each triangle that contains it."""
    for triangle in leg["triangles"]:
        a, b, c = barycentric([leg["nodes"][n] for n in triangle[:3]], *point)
        if min(a, b, c) >= 0:
            weights = [a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * b * c, 4 * c * a, 4 * a * b]
            yield sum(weight * leg["values"][n] for weight, n in zip(weights, triangle))


def check_gradients(leg):
    for number, (triangle, minorant) in enumerate(zip(leg["triangles"], leg["minorants"], strict=True)):
        (ax, ay), (bx, by), (cx, cy) = (leg["nodes"][n] for n in triangle[:3])
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        assert area > 0, f"triangle {number} does not run anticlockwise"
        v = [leg["values"][n] for n in triangle]
        slopes = [((by - cy) / area, (cx - bx) / area), ((cy - ay) / area, (ax - cx) / area), ((ay - by) / area, (bx - ax) / area)]
        for at in range(3):
            to, other = (at + 1) % 3, (at + 2) % 3  # derivatives by the three barycentric coordinates at a corner
            by_corner = {at: 3 * v[at], to: 4 * v[3 + other] - v[to], other: 4 * v[3 + to] - v[other]}
            gradient = [sum(by_corner[n] * slopes[n][axis] for n in range(3)) for axis in range(2)]
            steepest, most = leg["scale"] ** 2 * sum(g * g for g in gradient), Fraction(minorant[at])
            assert most > 0 and steepest <= most * most, f"|grad v| > minorant at corner {at} of triangle {number}"


def check_minorants(leg, cost):
    """Returns the edges at which the triangles end."""
    edges, middles = defaultdict(list), {}
    for number, (triangle, minorant) in enumerate(zip(leg["triangles"], leg["minorants"])):
        corners = [tuple(map(float, leg["nodes"][n])) for n in triangle[:3]]
        for i in range(1, PARTS):
            for j in range(1, PARTS - i):
                shares = (i / PARTS, j / PARTS, 1 - (i + j) / PARTS)
                x, y = (sum(share * corner[axis] for share, corner in zip(shares, corners)) for axis in range(2))
                below = sum(share * value for share, value in zip(shares, minorant))
                assert below <= cost(x, y) * (1 + ROUNDING), f"minorant > cost at ({x}, {y}) in triangle {number}"
        for side in range(3):
            at, to = (side + 1) % 3, (side + 2) % 3
            edge = (triangle[at], triangle[to])
            assert middles.setdefault(frozenset(edge), triangle[3 + side]) == triangle[3 + side], f"edge {edge} has two values"
            edges[edge].append((minorant[at], minorant[to]))
    assert len(set(middles.values())) == len(middles), "two edges share a value"
    assert not set(middles.values()) & set(range(len(leg["nodes"]))), "an edge and a node share a value"
    for edge, own in edges.items():
        across = [(at, to) for to, at in edges.get(edge[::-1], [])]
        assert len(own) == 1 and len(across) <= 1, f"edge {edge} has two triangles on one side"
        (ax, ay), (bx, by) = (map(float, leg["nodes"][n]) for n in edge)
        for share in (i / PARTS for i in range(1, PARTS)):
            below = min(at + share * (to - at) for at, to in own + across)
            x, y = ax + share * (bx - ax), ay + share * (by - ay)
            assert below <= cost(x, y) * (1 + ROUNDING), f"minorant > cost at ({x}, {y}) on edge {edge}"
    return [edge for edge in edges if edge[::-1] not in edges]


def turns(a, b, c):
    side = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (side > 0) - (side < 0)


def rectangle(a, b):
    """Left, low, right and top of a segment in double precision, a little outside: a quick test before the exact one."""
    (left, right), (low, top) = sorted([float(a[0]), float(b[0])]), sorted([float(a[1]), float(b[1])])
    more = 1e-12 * max(abs(left), abs(right), abs(low), abs(top))
    return left - more, low - more, right + more, top + more


def sides(ring):
    ring = exact(ring)
    return [(rectangle(a, b), a, b) for a, b in zip(ring, ring[1:] + ring[:1])]


def covers(sides, x, y):
    """Whether an odd number of sides lies to the right of a point."""
    is_covered, near = False, float(y)
    for (_, low, _, top), a, b in sides:
        if low <= near <= top and (a[1] > y) != (b[1] > y):
            is_covered ^= (turns(a, b, (x, y)) > 0) == (b[1] > a[1])
    return is_covered


class Area:
    """Where paths may go, without its rim."""

    def __init__(self, file):
        (self.left, self.low), (self.right, self.top) = exact(file["bounds"])
        self.inside = file["inside"] and formula(file["inside"])
        self.domain = file["domain"] and [side for polygon in file["domain"] for ring in polygon for side in sides(ring)]
        self.keep_out = [[side for ring in polygon for side in sides(ring)] for polygon in file["keep_out"]]
        self.clearance = file["clearance"]
        self.sides = (self.domain or []) + [side for polygon in self.keep_out for side in polygon]

    def contains(self, x, y):
        return (
            self.left < x < self.right
            and self.low < y < self.top
            and (not self.inside or bool(self.inside(float(x), float(y))))
            and (self.domain is None or covers(self.domain, x, y))
            and not any(covers(polygon, x, y) for polygon in self.keep_out)
            and (self.clearance == 0 or self.distance(float(x), float(y)) > self.clearance * (1 - ROUNDING))
        )

    def distance(self, x, y):
        return min(from_side(x, y, *map(float, a + b)) for _, a, b in self.sides)

    def is_crossed(self, a, b):
        """Whether a side of the area's rim crosses an edge."""
        left, low, right, top = rectangle(a, b)
        for (p_left, p_low, p_right, p_top), p, q in self.sides:
            if p_right >= left and p_left <= right and p_top >= low and p_low <= top:
                if turns(a, b, p) * turns(a, b, q) < 0 and turns(p, q, a) * turns(p, q, b) < 0:
                    return True
        return False


def from_side(x, y, ax, ay, bx, by):
    dx, dy = bx - ax, by - ay
    along = max(0, min(1, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy or 1)))
    return math.hypot(x - ax - along * dx, y - ay - along * dy)


def check_rim(leg, rim, area):
    for edge in rim:
        (ax, ay), (bx, by) = a, b = [leg["nodes"][n] for n in edge]
        for share in (Fraction(i, PARTS) for i in range(PARTS + 1)):
            x, y = ax + share * (bx - ax), ay + share * (by - ay)
            assert not area.contains(x, y), f"paths leave the triangles at ({float(x)}, {float(y)})"
        on_frame = any({p, q} == {line} for p, q, lines in [(ax, bx, [area.left, area.right]), (ay, by, [area.low, area.top])] for line in lines)
        is_open = area.clearance == 0 and not on_frame and area.left < max(ax, bx) and min(ax, bx) < area.right
        assert not is_open or not area.is_crossed(a, b), f"the rim of the domain crosses edge {edge} where triangles end"


def check_path(leg, cost, area):
    """Returns what the path costs, by the midpoint rule. Steps across which the cost jumps are halved, again and again."""

    def of_step(place, start, end, halvings=0):
        ends, middle = [cost(*place(t)) for t in (start, end)], (start + end) / 2
        if halvings < 40 and max(ends) > 1.1 * min(ends):
            return of_step(place, start, middle, halvings + 1) + of_step(place, middle, end, halvings + 1)
        return (end - start) * cost(*place(middle))

    total, steps = 0.0, 64
    for (ax, ay), (bx, by) in zip(leg["path"], leg["path"][1:]):

        def place(t):
            return ax + t * (bx - ax), ay + t * (by - ay)

        total += math.hypot(bx - ax, by - ay) * sum(of_step(place, i / steps, (i + 1) / steps) for i in range(steps))
    return total


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("file")
    arguments.add_argument("--cost", help="what a unit of length costs, a formula of x, y and risk, in place of the file's")
    arguments.add_argument("--risk", help="the risk, a formula of x and y")
    given = arguments.parse_args()
    with open(given.file, encoding="utf-8") as text:
        file = json.load(text)
    assert (file["format"], file["version"]) == ("Meshbrush path certificate", 1), "another kind of file"
    assert given.cost or file["cost"], "on the Earth the cost depends on the projection: give --cost"
    of_risk, risk = formula(given.cost or file["cost"]), formula(given.risk) if given.risk else None
    assert risk or "risk" not in (given.cost or file["cost"]), "the cost depends on the risk: give --risk"

    def cost(x, y):
        return of_risk(x, y, risk(x, y) if risk else None)

    area, triangles = Area(file), 0
    for leg in file["legs"]:
        leg["nodes"], leg["values"] = exact(leg["nodes"]), [Fraction(value) for value in leg["values"]]
        leg["scale"] = Fraction(leg["scale"])
        check_gradients(leg)
        check_rim(leg, check_minorants(leg, cost), area)
        start, goal = exact([leg["path"][0], leg["path"][-1]])
        at_start, at_goal = list(values_at(leg, start)), list(values_at(leg, goal))
        assert at_start and at_goal, "start or goal lies beyond the triangles"
        assert leg["scale"] * (min(at_goal) - max(at_start)) >= Fraction(leg["lower"]), "the bound is higher than the function shows"
        costs = check_path(leg, cost, area)
        assert leg["lower"] <= costs * (1 + 1e-6) and costs <= leg["upper"] * (1 + 1e-6), f"the path costs {costs}"
        triangles += len(leg["triangles"])
    legs = file["legs"]
    assert Fraction(file["lower"]) <= sum(Fraction(leg["lower"]) for leg in legs), "the bound is more than its legs have"
    assert all(a["path"][-1] == b["path"][0] for a, b in zip(legs, legs[1:])), "legs do not follow each other"
    width = 100 * (1 - file["lower"] / file["upper"])
    print(f"no path costs less than {file['lower']}: checked in {triangles} triangles; the path is within {width:.3f} % of the best")


if __name__ == "__main__":
    main()
