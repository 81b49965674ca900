"""A document made in Python has the mesh that the command line makes of a recipe."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Callable

import numpy as np
import pytest

import meshbrush as mb
from coasts import bay, feature

Made = tuple[str, mb.Document]
BAY = bay()


def formula(folder: Path) -> Made:
    recipe = """
        domain = { bounds = [0, 0, 2, 1] }
        mesh = { spacing = 0.2 }
        layer = [{ kind = "formula", quantity = "diameter", formula = "0.012 + 0.3*hypot(x - 0.7, y - 0.4)" }]
    """
    document = mb.Document(mb.Domain.rectangle(0, 0, 2, 1), spacing=0.2)
    document.layers.formula("0.012 + 0.3*hypot(x - 0.7, y - 0.4)")
    return recipe, document


def formula_domain(folder: Path) -> Made:
    recipe = """
        domain = { bounds = [-1, -1, 1, 1], inside = "r < 1 and r > 0.2" }
        mesh = { spacing = 0.1, rule = "vertex", max_level = 6 }
        layer = [{ kind = "formula", quantity = "diameter", formula = "0.02 + abs(x)/9" }]
    """
    domain = mb.Domain.formula("r < 1 and r > 0.2", bounds=(-1, -1, 1, 1))
    document = mb.Document(domain, spacing=0.1, rule="vertex", max_level=6)
    document.layers.formula("0.02 + abs(x)/9")
    return recipe, document


def outline(folder: Path) -> Made:
    (folder / "bay.geojson").write_text(json.dumps(feature(BAY)))
    recipe = """
        domain = { region = "bay.geojson", boundary = "outline", boundary_diameter = 0.05 }
        limits = { h_max = 0.2, gradation = 0.2 }
    """
    document = mb.Document(feature(BAY), boundary="outline", boundary_diameter=0.05, h_max=0.2, gradation=0.2)
    return recipe, document


def rings(folder: Path) -> Made:
    (folder / "bay.geojson").write_text(json.dumps(feature(BAY)))
    recipe = """
        domain = { region = "bay.geojson", boundary = "fitted" }
        limits = { h_max = 0.1 }
        layer = [{ kind = "distance", to = "outline", at_zero = 0.02, slope = 0.2, range = 0.4 }]
    """
    document = mb.Document(BAY, boundary="fitted", h_max=0.1)
    document.layers.distance("outline", at_zero=0.02, slope=0.2, range=0.4)
    return recipe, document


def raster(folder: Path) -> Made:
    values = np.random.default_rng(5).random((40, 60)) * 100
    values[5:9, 10:30] = np.nan
    np.save(folder / "values.npy", values)
    recipe = """
        domain = { bounds = [0, 0, 3, 2] }
        layer = [{ kind = "raster", file = "values.npy", bounds = [0.5, 0, 3.5, 1.8],
                   curve = [[0, 0.02], [50, 0.1], [100, 0.3]] },
                 { kind = "band", file = "values.npy", between = [90, 95], diameter = 0.01 }]
    """
    document = mb.Document(mb.Domain.rectangle(0, 0, 3, 2))
    document.layers.raster(values, bounds=(0.5, 0, 3.5, 1.8), curve=[(0, 0.02), (50, 0.1), (100, 0.3)])
    document.layers.band(values[::-1], (90, 95), 0.01, origin="lower")
    return recipe, document


def risk(folder: Path) -> Made:
    rng = np.random.default_rng(6)
    x, y, reach = rng.random(8), rng.random(8), 0.1 + 0.2 * rng.random(8)
    rows = "\n".join(f"{a!r},{b!r},{c!r},0.8,gaussian" for a, b, c in zip(x.tolist(), y.tolist(), reach.tolist()))
    (folder / "threats.csv").write_text(f"x,y,range,peak,law\n{rows}\n")
    recipe = """
        domain = { bounds = [0, 0, 1, 1] }
        limits = { h_min = 0.005, h_max = 0.2, shape = 1.5 }
        layer = [{ kind = "threats", file = "threats.csv" },
                 { kind = "formula", quantity = "risk", formula = "0.3*x", combine = "finest" }]
    """
    document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), h_min=0.005, h_max=0.2, shape=1.5)
    document.layers.threats(x=x, y=y, range=reach, peak=0.8, law="gaussian")
    document.layers.formula("0.3*x", quantity="risk")
    return recipe, document


def stack(folder: Path) -> Made:
    square = [[0.2, 0.2], [0.7, 0.2], [0.7, 0.9], [0.2, 0.9]]
    recipe = f"""
        domain = {{ bounds = [0, 0, 1, 1] }}
        limits = {{ h_min = 0.004 }}
        layer = [{{ kind = "formula", quantity = "diameter", formula = "0.03" }},
                 {{ kind = "corridor", shapes = [{{ line = [[0, 0], [0.5, 0.7], [1, 0.6]] }}], width = 0.05,
                    at_zero = 0.008, slope = 0.3, range = 0.2, mask = [[{square}]] }},
                 {{ kind = "distance", shapes = [{{ point = [0.9, 0.9] }}, {{ point = [0.1, 0.8] }}],
                    at_zero = 0.005, slope = 0.5 }},
                 {{ kind = "formula", quantity = "diameter", formula = "0.02", combine = "floor", mask = [[{square}]] }}]
    """
    document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), h_min=0.004)
    document.layers.formula(0.03)
    line = np.array([[0, 0], [0.5, 0.7], [1, 0.6]])
    document.layers.corridor(line, width=0.05, at_zero=0.008, slope=0.3, range=0.2, mask=square)
    document.layers.distance(np.array([[0.9, 0.9], [0.1, 0.8]]), at_zero=0.005, slope=0.5)
    document.layers.formula("0.02", combine="floor", mask=square)
    return recipe, document


def earth(folder: Path) -> Made:
    sea = feature(bay(0.4, (24.0, 38.0)))
    (folder / "sea.geojson").write_text(json.dumps(sea))
    rows, columns = 40, 50
    heights = -np.round(1500 * np.random.default_rng(8).random((rows, columns))) - 20
    heights[3:6, 7:20] = np.nan
    text = "\n".join(" ".join("-9999" if np.isnan(v) else f"{v:.0f}" for v in row) for row in heights)
    head = f"ncols {columns}\nnrows {rows}\nxllcorner 23.5\nyllcorner 37.6\ncellsize 0.02\nNODATA_value -9999\n"
    (folder / "heights.asc").write_text(head + text + "\n")
    recipe = """
        domain = { region = "sea.geojson", projection = "auto", boundary = "outline", boundary_diameter = 2000 }
        limits = { h_min = 800, h_max = 9000 }
        layer = [{ kind = "depth", file = "heights.asc", size = "wavelength", period = 600, triangles = 20 }]
    """
    document = mb.Document(
        sea, projection="auto", boundary="outline", boundary_diameter=2000, h_min=800, h_max=9000
    )
    place = (23.5, 37.6, 23.5 + 0.02 * columns, 37.6 + 0.02 * rows)
    document.layers.depth(heights, place, size="wavelength", period=600, triangles=20)
    return recipe, document


def straits(folder: Path) -> Made:
    (folder / "bay.geojson").write_text(json.dumps(feature(BAY)))
    recipe = """
        domain = { region = "bay.geojson", boundary = "outline", boundary_diameter = 0.1, parts = 0.01 }
        limits = { h_min = 0.01, h_max = 0.3 }
        layer = [{ kind = "straits", across = 4, width_from = 0.04, width_to = 0.6 },
                 { kind = "distance", to = "coasts", at_zero = 0.05, slope = 0.3, visible = false }]
    """
    document = mb.Document(
        BAY, boundary="outline", boundary_diameter=0.1, parts=0.01, h_min=0.01, h_max=0.3
    )
    document.layers.straits(across=4, width_from=0.04, width_to=0.6)
    document.layers.distance("coasts", at_zero=0.05, slope=0.3, visible=False)
    return recipe, document


def whole_rectangle(folder: Path) -> Made:
    recipe = """
        domain = { bounds = [0, 0, 30, 31.8], unit = "km" }
        mesh = { spacing = 1.5, max_triangles = 100000, max_memory = "50MB" }
        limits = { h_min = 0.25, h_max = 2.0 }
        layer = [{ kind = "raster", file = "grey.npy", as = "diameter" }]
    """
    grey = 0.5 + np.add.outer(np.arange(32.0), np.arange(30.0)) / 40
    np.save(folder / "grey.npy", grey)
    document = mb.Document(
        mb.Domain.rectangle(0, 0, 30, 31.8), unit="km", spacing=1.5, max_triangles=100_000, max_memory=50_000_000,
        h_min=0.25, h_max=2,
    )
    document.layers.raster(grey, reads="diameter")
    return recipe, document


KINDS: list[Callable[[Path], Made]] = [
    formula, formula_domain, outline, rings, raster, risk, stack, earth, straits, whole_rectangle,
]


@pytest.mark.filterwarnings("ignore::meshbrush.MeshbrushWarning")
@pytest.mark.parametrize("make", KINDS, ids=lambda make: make.__name__)
def test_fingerprints_are_those_of_the_command_line(make: Any, tmp_path: Path, summary_of: Any) -> None:
    recipe, document = make(tmp_path)
    said, mesh = summary_of(recipe), document.mesh()
    assert mesh.fingerprint == said["hash"]
    assert (len(mesh.triangles), len(mesh.nodes)) == (said["triangles"], said["nodes"])
    assert mesh.violations() == 0
    # The rest of the summary too, but for the time and for names from files.
    own = mesh.statistics
    for piece in (*own["boundary"], *own["lost_pieces"], *said["boundary"], *said["lost_pieces"]):
        del piece["name"]
    for key in said.keys() - {"seconds", "unit", "lost_islands"}:
        assert own[key] == said[key], key
    # The same recipe read in Python, and the document saved as a recipe, as a project, and pickled.
    assert mb.read_recipe(tmp_path / "recipe.toml").mesh().fingerprint == said["hash"]
    for file in ("saved.toml", "saved.meshbrush"):
        document.save(tmp_path / file)
        assert mb.open(tmp_path / file).mesh().fingerprint == said["hash"], file
