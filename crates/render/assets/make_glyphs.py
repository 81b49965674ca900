#!/usr/bin/env python3
"""Makes glyphs.txt: the letters of exported pictures as outlines, from the font of the window.

    python3 make_glyphs.py            needs fontTools
"""

import pathlib

from fontTools.pens.basePen import BasePen
from fontTools.ttLib import TTFont

HERE = pathlib.Path(__file__).parent
FONT = HERE.parents[1] / "ui/assets/fonts/Inter-Regular.ttf"
# Of furniture, and of the names of layers: Latin and Greek letters, marks of punctuation and the bar of h̄.
RANGES = [(0x20, 0x7E), (0xA1, 0x17F), (0x386, 0x3CE), (0x2010, 0x2027), (0x2032, 0x2033)]
OTHERS = "\u0304−≈≤≥→"
HEAD = """\
# Outlines of Inter Regular, Copyright 2016 The Inter Project Authors, SIL Open Font License 1.1.
# Written by make_glyphs.py. A line has a letter as a number, its advance, and its outline: M x y, L x y,
# Q x y x y and Z as in SVG, in thousandths of the height of the font, y downwards from the baseline.
"""


class Outline(BasePen):
    """Collects an outline in thousandths of an em."""

    def __init__(self, glyphs, scale):
        super().__init__(glyphs)
        self.scale, self.parts = scale, []

    def add(self, letter, *points):
        numbers = [f"{round(x * self.scale)} {round(-y * self.scale)}" for x, y in points]
        self.parts.append(" ".join([letter, *numbers]))

    def _moveTo(self, point):
        self.add("M", point)

    def _lineTo(self, point):
        self.add("L", point)

    def _qCurveToOne(self, control, point):
        self.add("Q", control, point)

    def _closePath(self):
        self.add("Z")


def main():
    font = TTFont(FONT)
    glyphs, names = font.getGlyphSet(), font.getBestCmap()
    scale = 1000 / font["head"].unitsPerEm
    lines = []
    codes = {code for first, last in RANGES for code in range(first, last + 1)} | set(map(ord, OTHERS))
    for code in sorted(codes & names.keys()):
        glyph = glyphs[names[code]]
        pen = Outline(glyphs, scale)
        glyph.draw(pen)
        lines.append(f"{code} {round(glyph.width * scale)} {' '.join(pen.parts)}".rstrip())
    (HERE / "glyphs.txt").write_text(HEAD + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
