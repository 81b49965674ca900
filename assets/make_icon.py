#!/usr/bin/env python3
"""Draws the program's icon, as icon.png and icon.svg: one brush stroke over a coarse grid, refined by bisection.

See README.md here.
"""

import math
import pathlib
import sys

SIZE, OVER = 256, 8                     # pixels; oversampling
MARGIN, RADIUS, GAP = 8, 56, 1.8        # of the rounded square; width of an edge
COARSE, DEEPEST = 4, 6                  # squares a side; levels
WIDTH, GRADE = 0.04, 3                  # half width of the stroke; levels less for every doubling of the distance
STROKE = [(0.19, 0.79), (0.44, 0.00), (0.56, 1.00), (0.81, 0.21)]
GROUND, LEVEL_0 = (11, 13, 16), (29, 33, 43)
VIRIDIS = [(68, 1, 84), (72, 40, 120), (62, 74, 137), (49, 104, 142), (38, 130, 142), (31, 158, 137),
           (53, 183, 121), (110, 206, 88), (181, 222, 43), (253, 231, 37)]


def mix(a, b, t):
    return tuple(round(x + (y - x) * t) for x, y in zip(a, b))


def bezier(t):
    return tuple(sum(math.comb(3, k) * (1 - t) ** (3 - k) * t ** k * p[axis] for k, p in enumerate(STROKE))
                 for axis in (0, 1))


PATH = [bezier(i / 300) for i in range(301)]


def wanted(triangle, k=8):
    """The level asked for, from the triangle's distance to the stroke."""
    points = [tuple((a * i + b * j + c * (k - i - j)) / k for a, b, c in zip(*triangle))
              for i in range(k + 1) for j in range(k + 1 - i)]
    away = min(math.dist(p, q) for p in points for q in PATH)
    return min(DEEPEST, DEEPEST - GRADE * math.log2(max(away, WIDTH) / WIDTH))


def mesh():
    """Triangles (newest vertex, ends of the bisection edge) with their levels, without hanging nodes."""
    leaves = []
    for i in range(COARSE):
        for j in range(COARSE):
            a, b, c, d = [(x / COARSE, y / COARSE) for x, y in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))]
            leaves += [((b, a, c), 0), ((d, c, a), 0)]
    while True:
        nodes = {p for triangle, _ in leaves for p in triangle}
        finer = []
        for (newest, p, q), level in leaves:
            middle = ((p[0] + q[0]) / 2, (p[1] + q[1]) / 2)
            if middle in nodes or level < wanted((newest, p, q)):
                finer += [((middle, newest, p), level + 1), ((middle, q, newest), level + 1)]
            else:
                finer.append(((newest, p, q), level))
        if len(finer) == len(leaves):
            return leaves
        leaves = finer


def colour(level):
    """The window's colours: level 0 near the ground, then viridis from 12 %."""
    if level == 0:
        return LEVEL_0
    at = (0.12 + 0.88 * (level - 1) / (DEEPEST - 1)) * (len(VIRIDIS) - 1)
    i = min(int(at), len(VIRIDIS) - 2)
    return mix(VIRIDIS[i], VIRIDIS[i + 1], at - i)


def inset(corners, by):
    """The triangle with every side moved inwards."""
    a, b, c = corners
    weights = math.dist(b, c), math.dist(a, c), math.dist(a, b)
    centre = [sum(w * p[axis] for w, p in zip(weights, corners)) / sum(weights) for axis in (0, 1)]
    twice_area = abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    keep = max(0.0, 1 - by * sum(weights) / twice_area)
    return [tuple(m + (x - m) * keep for x, m in zip(p, centre)) for p in corners]


def edge(level):
    """The colour of edges: they fade with the size of triangles."""
    return mix(GROUND, colour(level), 0.40 + 0.42 * level / DEEPEST)


def write_png(triangles, target):
    from PIL import Image, ImageDraw

    low, side = MARGIN * OVER, (SIZE - 2 * MARGIN) * OVER
    picture = Image.new("RGB", (SIZE * OVER, SIZE * OVER), GROUND)
    draw = ImageDraw.Draw(picture)
    for triangle, level in triangles:
        corners = [(low + x * side, low + y * side) for x, y in triangle]
        draw.polygon(corners, fill=edge(level))
        draw.polygon(inset(corners, GAP * OVER / 2), fill=colour(level))
    mask = Image.new("L", picture.size, 0)
    ImageDraw.Draw(mask).rounded_rectangle([low, low, low + side - 1, low + side - 1], RADIUS * OVER, fill=255)
    picture.putalpha(mask)
    picture.resize((SIZE, SIZE), Image.LANCZOS).save(target, optimize=True)


def write_svg(triangles, target):
    """One path for each level, the coarsest first; corners are multiples of a unit."""
    units, side = COARSE * 2 ** math.ceil(DEEPEST / 2), SIZE - 2 * MARGIN
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{SIZE}" height="{SIZE}" viewBox="0 0 {SIZE} {SIZE}">',
             f'<clipPath id="rounded"><rect x="{MARGIN}" y="{MARGIN}" width="{side}" height="{side}" rx="{RADIUS}"/>',
             '</clipPath>',
             '<g clip-path="url(#rounded)">',
             f'<g transform="translate({MARGIN} {MARGIN}) scale({side / units:g})" stroke-linejoin="round"'
             f' stroke-width="{GAP * units / side:g}">']
    hexadecimal = "#{:02x}{:02x}{:02x}".format
    for level in range(DEEPEST + 1):
        outlines = ("M" + "L".join(f"{x * units:g} {y * units:g}" for x, y in triangle) + "z"
                    for triangle, own in triangles if own == level)
        colours = f'fill="{hexadecimal(*colour(level))}" stroke="{hexadecimal(*edge(level))}"'
        lines.append('<path %s d="%s"/>' % (colours, "".join(outlines)))
    pathlib.Path(target).write_text("\n".join([*lines, "</g>", "</g>", "</svg>", ""]))


def main(folder):
    triangles = mesh()
    write_svg(triangles, folder / "icon.svg")
    write_png(triangles, folder / "icon.png")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]) if sys.argv[1:] else pathlib.Path(__file__).parent)
