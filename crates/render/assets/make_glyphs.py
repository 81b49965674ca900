#!/usr/bin/env python3
"""Makes glyphs.txt: the letters of exported pictures as outlines, from the font of the window.

    python3 make_glyphs.py            needs fontTools
"""

import pathlib

from fontTools.pens.basePen import BasePen
from fontTools.ttLib import TTFont

HERE = pathlib.Path(__file__).parent
FONT = HERE.parents[1] / "ui/assets/fonts/Inter-Regular.ttf"
LETTERS = sorted(chr(code) for code in [*range(0x20, 0x7F), *map(ord, "°²µ·×–′″−≈")])
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
    for letter in LETTERS:
        glyph = glyphs[names[ord(letter)]]
        pen = Outline(glyphs, scale)
        glyph.draw(pen)
        lines.append(f"{ord(letter)} {round(glyph.width * scale)} {' '.join(pen.parts)}".rstrip())
    (HERE / "glyphs.txt").write_text(HEAD + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
