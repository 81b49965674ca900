"""Makes the heights of the example of a surface: python3 assets/make_jacksboro_heights.py jacksboro_dem.asc

The grid has 403 x 344 heights in metres, as an ASCII grid of Esri. The example has the 257 x 257 at the lower left: with a power
of two of steps along each side, all nodes of a mesh are at heights.
"""

import pathlib
import sys

import geotiff

FOLDER = pathlib.Path(__file__).parent
SIDE = 257


def main():
    lines = pathlib.Path(sys.argv[1]).read_text().splitlines()
    head = {name: float(value) for name, value in (line.split() for line in lines[:6])}
    step = head["cellsize"]
    west, south = (head[name] + 0.5 * step for name in ("xllcorner", "yllcorner"))
    rows = [[int(height) for height in line.split()[:SIDE]] for line in lines[6:] if line.strip()]
    geotiff.write(west, south + (SIDE - 1) * step, step, rows[-SIDE:], FOLDER / "jacksboro_heights.tif")


main()
