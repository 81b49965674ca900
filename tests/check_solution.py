"""Checks a certificate of `meshbrush solve --certificate FILE`: check_solution.py FILE.

Needs nothing but Python, and shares no code with the program. Arithmetic is exact (fractions), and roots are rounded up.

 1. The triangles are anticlockwise, and an edge has at most one triangle on either side.
 2. The flux through an edge is the same on both sides of it.
 3. The root of the integral of |s + a grad v|^2 / a, plus what f - div s leaves, is at most the bound. For the latter, |w| <= W/pi |grad w|
    for functions that are 0 on the boundary of a domain in a strip of width W, with pi > 3.14.

That v has the values of u at the ends of the edges of the boundary is printed, and is not checked: they are part of the problem.
"""

import json
import math
import sys
from fractions import Fraction


def root(square):
    """A fraction that is not below the root, and hardly above it."""
    scale = 10**30
    return Fraction(math.isqrt(math.ceil(square * scale * scale)) + 1, scale)


def refuse(sentence):
    sys.exit(f"refused: {sentence}")


def integral(corners, out, a, gradient):
    """The integral of |s + a grad v|^2 / a over a triangle: s is the sum of out[k] (x - corner k) / (2 area)."""
    (ax, ay), (bx, by), (cx, cy) = corners
    area = ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2
    # The flux is linear; the square is integrated by the midpoints of the edges, which is exact for degree 2.
    total = 0
    for i, j in ((0, 1), (1, 2), (2, 0)):
        x = (corners[i][0] + corners[j][0]) / 2
        y = (corners[i][1] + corners[j][1]) / 2
        sx = sum(out[k] * (x - corners[k][0]) for k in range(3)) / (2 * area) + a * gradient[0]
        sy = sum(out[k] * (y - corners[k][1]) for k in range(3)) / (2 * area) + a * gradient[1]
        total += sx * sx + sy * sy
    return total * area / 3 / a


def main(file):
    found = json.loads(open(file, encoding="utf-8").read())
    if (found["format"], found["version"]) != ("Meshbrush solution certificate", 1):
        refuse("it is no certificate of this kind")
    nodes = [(Fraction(x), Fraction(y)) for x, y in found["nodes"]]
    values = [Fraction(value) for value in found["v"]]
    through, square, defects = {}, Fraction(0), Fraction(0)
    least = min(Fraction(a) for a in found["a"])
    for triangle, a, f, out in zip(found["triangles"], found["a"], found["f"], found["out"], strict=True):
        a, f, out = Fraction(a), Fraction(f), [Fraction(flux) for flux in out]
        corners = [nodes[n] for n in triangle]
        (ax, ay), (bx, by), (cx, cy) = corners
        doubled = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if doubled <= 0 or a <= 0:
            refuse(f"triangle {triangle} has no area, or its diffusion is not positive")
        for k in range(3):
            edge = (triangle[(k + 1) % 3], triangle[(k + 2) % 3])
            if edge in through:
                refuse(f"edge {edge} has two triangles on one side")
            through[edge] = out[k]
        u, v, w = (values[n] for n in triangle)
        gradient = (
            ((v - u) * (cy - ay) - (w - u) * (by - ay)) / doubled,
            ((w - u) * (bx - ax) - (v - u) * (cx - ax)) / doubled,
        )
        square += integral(corners, out, a, gradient)
        defects += (f * doubled / 2 - sum(out)) ** 2 / (doubled / 2)
    boundary = 0
    for (i, j), flux in through.items():
        if (j, i) not in through:
            boundary += 1
        elif through[(j, i)] != -flux:
            refuse(f"the flux through edge {i}, {j} differs on both sides")
    width = min(max(axis) - min(axis) for axis in zip(*nodes))
    total = root(square) + root(defects) * width / Fraction("3.14") * root(1 / least)
    if total > Fraction(found["bound"]):
        refuse(f"it proves {float(total)!r}, and {found['bound']!r} is claimed")
    print(f"the energy error is at most {found['bound']!r}, for values given on {boundary} edges of the boundary")


if __name__ == "__main__":
    main(sys.argv[1])
