"""Recipes in which one name, point, layer or option hits nothing: each is said, on the command line and as a warning."""

from __future__ import annotations

import json
import os
import subprocess
import warnings
from pathlib import Path

import pytest

import meshbrush as mb

PROGRAM = os.environ.get("MESHBRUSH_PROGRAM", "meshbrush")

BOX = {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]], [[1, 1], [1, 2], [2, 2], [2, 1], [1, 1]]]}
FAR = [[40, 40], [41, 40], [41, 41], [40, 41], [40, 40]]
GRID = "ncols 4\nnrows 3\nxllcorner {x}\nyllcorner {y}\ncellsize 1\nnodata_value -9999\n{rows}\n"

FILES = {
    "sea.geojson": json.dumps(BOX),
    "far.geojson": json.dumps({"type": "Polygon", "coordinates": [FAR]}),
    "far_line.geojson": json.dumps({"type": "LineString", "coordinates": FAR[:3]}),
    "far_points.geojson": json.dumps({"type": "MultiPoint", "coordinates": FAR[:3]}),
    "far.csv": "x,y,range,peak\n40,40,1,1\n",
    "far.asc": GRID.format(x=40, y=40, rows="\n".join(["0.1 0.1 0.1 0.1"] * 3)),
    "risk.asc": GRID.format(x=0, y=0, rows="\n".join(["0.1 0.1 0.1 0.1"] * 3)),
    "empty.asc": GRID.format(x=0, y=0, rows="\n".join(["-9999 -9999 -9999 -9999"] * 3)),
    "coarse.asc": GRID.format(x=0, y=0, rows="\n".join(["50 50 50 50"] * 3)),
    "heights.asc": GRID.format(x=0, y=0, rows="\n".join(["10 20 10 20"] * 3)),
    "depths.asc": GRID.format(x=0, y=0, rows="\n".join(["-10 -20 -10 -20"] * 3)),
}
DOMAINS = ['region = "sea.geojson"\nunit = "m"', "bounds = [0, 0, 4, 3]", 'bounds = [0, 0, 4, 3]\ninside = "x > y"']
SQUARE = "[[[[40, 40], [41, 40], [41, 41]]]]"

#: Layers that ask for nothing, whatever the domain is.
LAYERS = [
    'kind = "formula"\nquantity = "diameter"\nformula = "50"',
    'kind = "formula"\nquantity = "diameter"\nformula = "50 + x"',
    'kind = "formula"\nquantity = "diameter"\nformula = "if(x > 90, 0.1, inf)"',
    'kind = "formula"\nquantity = "diameter"\nformula = "20 + abs(y)"\ncombine = "finest"',
    'kind = "formula"\nquantity = "risk"\nformula = "0"',
    f'kind = "formula"\nquantity = "diameter"\nformula = "0.1"\nmask = {SQUARE}',
    'kind = "raster"\nfile = "far.asc"\nas = "diameter"',
    'kind = "raster"\nfile = "empty.asc"\nas = "diameter"',
    'kind = "raster"\nfile = "coarse.asc"\nas = "diameter"',
    f'kind = "raster"\nfile = "risk.asc"\nas = "risk"\nmask = {SQUARE}',
    'kind = "band"\nfile = "heights.asc"\nbetween = [100, 200]\ndiameter = 0.1',
    'kind = "band"\nfile = "heights.asc"\nbetween = [0, 100]\ndiameter = 50',
    'kind = "band"\nfile = "depths.asc"\nbetween = [0, 5]\ndiameter = 0.1',
    'kind = "band"\nfile = "far.asc"\nbetween = [0, 1]\ndiameter = 0.1',
    'kind = "depth"\nfile = "heights.asc"\nsize = "wavelength"\nperiod = 1\ntriangles = 10',
    'kind = "depth"\nfile = "far.asc"\nsize = "wavelength"\nperiod = 1\ntriangles = 10',
    'kind = "depth"\nfile = "depths.asc"\nsize = "wavelength"\nperiod = 10000\ntriangles = 1',
    'kind = "threats"\nfile = "far.csv"',
    'kind = "threats"\nthreats = [{ x = 40, y = 40, range = 1, peak = 1, law = "disc" }]',
    'kind = "distance"\nfile = "far.geojson"\nat_zero = 0.1\nslope = 0.5',
    'kind = "distance"\nfile = "far_line.geojson"\nat_zero = 0.1\nslope = 0.2\nrange = 2',
    'kind = "distance"\nfile = "far_points.geojson"\nat_zero = 0.1\nslope = 0.5',
    'kind = "distance"\nfile = "far_points.geojson"\nat_zero = 50\nslope = 0.5',
]
#: What hits nothing on the outline of a region.
ON_OUTLINE = [
    'names = [{ at = [40, 40], name = "harbour" }]',
    'names = [{ at = [2.5, 2.5], name = "harbour" }]',
    'types = [{ at = [40, 40], type = "inflow" }]',
    'types = [{ at = [2.5, 2.5], type = "open" }]',
    "splits = [[40, 40]]",
    "splits = [[2.5, 2.5]]",
    'open = "far.geojson"',
    "open = [40, 40, 41, 41]",
]
#: Layers on the outline that ask for nothing.
TO_OUTLINE = [
    'kind = "distance"\nto = "outline"\nat_zero = 50\nslope = 0.5',
    'kind = "distance"\npieces = ["harbour"]\nat_zero = 0.1\nslope = 0.5',
    'kind = "straits"\nacross = 3\nwidth_from = 1e-6\nwidth_to = 2e-6',
    'kind = "feature-size"\nacross = 3\nwidth_from = 1e-6\nwidth_to = 2e-6',
]


#: Words of the sentences.
NOTHING = ("nothing", "no piece", "does not meet", "no path", "not measure")


def recipes() -> list[str]:
    tables = "[mesh]\nspacing = 0.5\n[limits]\nh_min = 0.01\n"
    of_layers = [f"[domain]\n{domain}\n{tables}[[layer]]\nname = \"idle\"\n{layer}\n" for layer in LAYERS for domain in DOMAINS]
    region = DOMAINS[0]
    of_outline = [f"[domain]\n{region}\n{entry}\n{tables}" for entry in ON_OUTLINE]
    to_outline = [f"[domain]\n{region}\n{tables}[[layer]]\nname = \"idle\"\n{layer}\n" for layer in TO_OUTLINE]
    in_places = [f"[domain]\n{domain}\n{tables}{places}\n" for domain in DOMAINS for places in (
        "[pins]\nat = [[40, 40]]",
        "[paths]\nroutes = [[[40, 40], [41, 41]]]",
        f"[[keep_out]]\nname = \"zone\"\npolygons = {SQUARE}",
        "[[keep_out]]\nname = \"zone\"\nfile = \"far.geojson\"",
    )]
    cleaning = ["improve_boundary = true", "keep_pinches = true"]
    on_rectangle = [f"[domain]\n{DOMAINS[1]}\n{entry}\n{tables}" for entry in ON_OUTLINE + cleaning]
    return of_layers + of_outline + to_outline + in_places + on_rectangle


def sentences_of_program(folder: Path) -> str:
    ran = subprocess.run([PROGRAM, "mesh", "r.toml"], cwd=folder, capture_output=True, text=True)
    return "\n".join(line for line in ran.stderr.splitlines() if line.startswith("meshbrush: "))


def warnings_of_module(folder: Path) -> str:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            mb.open(folder / "r.toml")
        except mb.MeshError as error:
            return str(error)
    return "\n".join(str(warning.message) for warning in caught)


@pytest.mark.parametrize("number", range(len(recipes())))
def test_what_hits_nothing_is_said(number: int, tmp_path: Path) -> None:
    recipe = recipes()[number]
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    (tmp_path / "r.toml").write_text(recipe)
    said = sentences_of_program(tmp_path)
    assert said.startswith("meshbrush: note: "), f"{recipe}\n{said}"
    assert any(word in said for word in NOTHING), f"{recipe}\n{said}"
    assert warnings_of_module(tmp_path), f"{recipe}\n{said}"


def test_there_are_a_hundred() -> None:
    assert len(recipes()) >= 100
