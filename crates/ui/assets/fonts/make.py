#!/usr/bin/env python3
"""Makes the window's fonts: see assets/README.md.

    python3 make.py FOLDER ICONS      FOLDER holds the unpacked packages of Debian, ICONS is
                                      MaterialSymbolsRounded-Regular.ttf
"""

import pathlib
import re
import sys

from fontTools import subset
from fontTools.pens.cu2quPen import Cu2QuPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont, newTable

# What the window, its formulas and its file names may hold. Combining marks for h̄ and δ̄, sub- and superscripts
# for ζ₁ and x², arrows and keys for hints and shortcuts, shapes for lists and legends.
RANGES = [
    (0x0020, 0x007E), (0x00A0, 0x017F),     # Latin-1, Latin Extended-A
    (0x02C6, 0x02DD), (0x0300, 0x036F),     # modifiers, combining marks
    (0x0370, 0x03FF),                       # Greek
    (0x2000, 0x206F), (0x2070, 0x209F),     # punctuation, super- and subscripts
    (0x20AC, 0x20AC), (0x2100, 0x218F),     # euro, letterlike, number forms
    (0x2190, 0x21FF), (0x2200, 0x22FF),     # arrows, mathematical operators
    (0x2300, 0x23FF), (0x2423, 0x2423),     # technical, open box
    (0x25A0, 0x25FF), (0x2600, 0x27BF),     # geometric shapes, symbols
    (0xFFFD, 0xFFFD),
]

# No `calt`: it would turn -> and >= in a formula into arrows and signs that nobody typed.
FEATURES = ["ccmp", "kern", "locl", "mark", "mkmk"]

FONTS = {
    "opentype/inter/Inter-Regular.otf": "Inter-Regular.ttf",
    "opentype/inter/Inter-SemiBold.otf": "Inter-SemiBold.ttf",
    "truetype/jetbrains-mono/JetBrainsMono-Regular.ttf": "JetBrainsMono-Regular.ttf",
}

ICON_SOURCE = pathlib.Path(__file__).parents[2] / "src/widgets/display/icon.rs"


def quadratic(font):
    """Replaces cubic outlines by quadratic ones, at most 1/1000 em away."""
    glyphs = font.getGlyphSet()
    glyf = newTable("glyf")
    glyf.glyphOrder, glyf.glyphs = font.getGlyphOrder(), {}
    for name in glyf.glyphOrder:
        pen = TTGlyphPen(glyphs)
        glyphs[name].draw(Cu2QuPen(pen, font["head"].unitsPerEm / 1000, reverse_direction=True))
        glyf.glyphs[name] = pen.glyph()
    font["glyf"], font["loca"] = glyf, newTable("loca")
    del font["CFF "]
    glyf.compile(font)
    for name in glyf.glyphOrder:        # left side bearings follow the new outlines
        advance, _ = font["hmtx"][name]
        font["hmtx"][name] = advance, getattr(glyf[name], "xMin", 0)
    maxp = font["maxp"] = newTable("maxp")
    maxp.tableVersion, maxp.numGlyphs = 0x00010000, len(glyf.glyphs)
    for field in ("maxTwilightPoints", "maxStorage", "maxFunctionDefs", "maxInstructionDefs",
                  "maxStackElements", "maxSizeOfInstructions"):
        setattr(maxp, field, 0)
    maxp.maxZones = 1
    maxp.maxComponentElements = max((len(g.components) for g in glyf.glyphs.values() if g.isComposite()), default=0)
    font["post"].formatType = 2.0
    font["post"].extraNames, font["post"].mapping, font["post"].glyphOrder = [], {}, glyf.glyphOrder
    font.sfntVersion = "\000\001\000\000"


def icons(path):
    """Keeps the icons that the window names."""
    font = TTFont(path, recalcTimestamp=False)
    subsetter = subset.Subsetter(subset.Options(layout_features=[], name_IDs=["*"], notdef_outline=True))
    subsetter.populate(unicodes=[int(point, 16) for point in re.findall(r"\\u\{([0-9a-f]+)\}", ICON_SOURCE.read_text())])
    subsetter.subset(font)
    target = pathlib.Path(__file__).with_name("MaterialSymbols.ttf")
    font.save(target)
    print(f"{target.name}: {len(font.getBestCmap())} icons, {target.stat().st_size} bytes")


def main(folder, icon_font):
    icons(icon_font)
    source = pathlib.Path(folder, "usr/share/fonts")
    for path, name in FONTS.items():
        font = TTFont(source / path, recalcTimestamp=False)
        options = subset.Options(layout_features=FEATURES, name_IDs=["*"], notdef_outline=True)
        subsetter = subset.Subsetter(options)
        subsetter.populate(unicodes=[u for low, high in RANGES for u in range(low, high + 1)])
        subsetter.subset(font)
        if "CFF " in font:
            quadratic(font)
        target = pathlib.Path(__file__).with_name(name)
        font.save(target)
        print(f"{name}: {len(font.getBestCmap())} characters, {target.stat().st_size} bytes")


if __name__ == "__main__":
    main(*sys.argv[1:])
