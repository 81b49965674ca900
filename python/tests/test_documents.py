"""Documents: layers, options, strokes, undo, files, pickles, paths, errors."""

from __future__ import annotations

import copy
import errno
import json
import pickle
import re
import types
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import meshbrush as mb
from coasts import bay, feature
from conftest import run_program


def square(**options: Any) -> mb.Document:
    document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.1, **options)
    document.layers.formula("0.012 + 0.2*hypot(x - 0.3, y - 0.4)", name="near")
    return document


def test_layers_are_a_sequence_that_can_be_changed() -> None:
    document = square(h_min=0.01)
    before = document.mesh().fingerprint
    layer = document.layers.formula(0.01, name="fine")
    assert [l.name for l in document.layers] == ["near", "fine"] and len(document.layers) == 2
    assert layer in document.layers and document.layers.index(layer) == 1 and layer != document.layers[0]
    assert document.layers["fine"].kind == "formula" and document.layers[-1].name == "fine"
    assert document.mesh().fingerprint != before
    layer.visible = False
    assert document.mesh().fingerprint == before and not document.layers[1].visible
    layer.visible, layer.combine, layer.name, layer.locked = True, "floor", "floor", True
    assert (layer.visible, layer.combine, layer.name, layer.locked) == (True, "floor", "floor", True)
    layer.move_to(0)
    assert document.layers[0].name == "floor" and [l.name for l in document.layers[:1]] == ["floor"]
    layer.remove()
    assert document.mesh().fingerprint == before
    with pytest.raises(mb.MeshError, match="no longer"):
        layer.visible = True
    with pytest.raises(KeyError, match="“near”"):
        document.layers["far"]
    with pytest.raises(mb.MeshError, match="finest, floor, replace"):
        document.layers[0].combine = "best"
    assert repr(document) == "<meshbrush.Document “Untitled”: 1 layer>"
    del document.layers["near"]
    assert "none" in repr(document.layers) and repr(document).endswith("0 layers>")


def test_files_of_every_program_for_maps_are_read() -> None:
    files = Path(__file__).parents[2] / "crates/io/src/io/gpkg"
    document = mb.Document(mb.Domain(files / "land.gpkg"), boundary="outline", boundary_diameter=0.2, h_max=0.5)
    before = document.mesh()
    assert {"Big", "Big island 1"} <= before.boundary.keys()
    document.layers.distance(files / "land.gpkg", at_zero=0.1, slope=0.3)
    assert len(document.mesh()) > 2 * len(before)
    with pytest.raises(mb.FileError, match="a domain needs a Polygon"):
        mb.Document(mb.Domain(files / "two.gpkg"))


def test_a_surface_that_asks_for_too_few_triangles_warns() -> None:
    document = mb.Document(mb.Domain.rectangle(0, 0, 8, 8), spacing=1)
    document.layers.surface(formula="x*y", at_most=60)
    with pytest.warns(mb.MeshbrushWarning, match="at most 60 triangles.*128 already"):
        mesh = document.mesh()
    assert len(mesh.triangles) == 128


def test_every_kind_of_layer_can_be_added(tmp_path: Path) -> None:
    document = mb.Document(bay(1000.0), h_min=20, h_max=300, unit="m")
    grid = np.linspace(-50, 0, 200).reshape(10, 20)
    place = (-1300, -1300, 1300, 1300)
    added = [
        document.layers.formula("100 + r/10"),
        document.layers.formula("0.1", quantity="risk"),
        document.layers.raster(grid, place, curve=[(-50, 200), (0, 50)]),
        document.layers.raster(-grid / 100, place, reads="risk"),
        document.layers.band(grid, (-20, -10), 40, place),
        document.layers.depth(grid, place),
        document.layers.depth(grid, place, size="wavelength", period=60, triangles=10, positive="up"),
        document.layers.depth(grid, place, size="slope", triangles=10, smoothing=100),
        document.layers.depth(grid, place, size="courant", time_step=2, courant=0.5),
        document.layers.sample(lambda x, y: 60 + np.hypot(x, y) / 10, pixels=64),
        document.layers.threats(x=[0, 100], y=0, range=200, law=["disc", "radar"]),
        document.layers.distance("outline", at_zero=30, slope=0.2),
        document.layers.distance("coasts", at_zero=30, slope=0.2, range=500),
        document.layers.distance(feature(bay(100.0)), at_zero=30, slope=0.2),
        document.layers.corridor([(-500, 0), (500, 100)], width=50, at_zero=30, slope=0.2),
        document.layers.straits(across=3, width_from=50, width_to=400),
        document.layers.feature_size(across=3, width_from=50, width_to=400),
        document.layers.surface(grid, place, within=30),
        document.layers.surface(formula="20*sin(x/300)", at_most=20_000),
        document.layers.distance(types=["land"], at_zero=30, slope=0.2),
        document.layers.formula("60 + depth"),
        document.layers.paint("risk"),
        document.layers.add("formula", quantity="diameter", formula="90"),
    ]
    kinds = [layer.kind for layer in added]
    assert kinds == [layer.kind for layer in document.layers]
    assert {"formula", "raster", "band", "depth", "threats", "distance", "corridor", "straits", "paint"} == set(kinds) - {
        "feature-size",
        "surface",
    }
    mesh = document.mesh()
    assert mesh.violations() == 0
    document.save(tmp_path / "all.meshbrush")
    answer = json.loads(run_program("mesh", "--project", "all.meshbrush", "--json", cwd=tmp_path))
    assert answer["hash"] == mesh.fingerprint


def test_a_sampled_function_is_near_its_formula() -> None:
    exact, sampled = square(), mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.1)
    calls = []

    def function(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        calls.append(x.shape)
        return 0.012 + 0.2 * np.hypot(x - 0.3, y - 0.4)

    sampled.layers.sample(function, pixels=1024)
    assert len(calls) == 4 and sum(rows for rows, _ in calls) == 1024
    assert len(sampled.mesh()) == pytest.approx(len(exact.mesh()), rel=0.05)


def test_options_are_changed_and_undone() -> None:
    document = square()
    first = document.mesh()
    document.set(h_min=0.05, gradation=0.2)
    assert document.options["h_min"] == 0.05 and document.options["gradation"] == 0.2
    coarse = document.mesh()
    assert len(coarse) < len(first)
    assert document.undo() and document.undo()
    assert document.mesh().fingerprint == first.fingerprint
    assert document.redo() and document.redo() and document.mesh().fingerprint == coarse.fingerprint
    document.set(spacing=0.2, rule="vertex", max_triangles=5000, max_memory="10MB", shape=2, h_max=0.1, h_risk=0.06)
    now = document.options
    assert (now["spacing"], now["rule"], now["max_triangles"], now["max_memory"]) == (0.2, "vertex", 5000, 10_000_000)
    assert (now["h_max"], now["h_risk"], now["shape"]) == (0.1, 0.06, 2)
    with pytest.raises(TypeError, match="spcaing"):
        document.set(spcaing=1)
    with pytest.raises(mb.MeshError, match="^h_max: -1 cannot be used"):
        document.set(h_max=-1)
    with pytest.raises(TypeError):
        mb.Document([[0, 0], [1, 0], [1, 1]], spcaing=1)  # type: ignore[call-arg]


def test_options_that_cannot_be_met_change_nothing() -> None:
    good = [dict(max_level=3), dict(gradation=0.2), dict(h_max=0.3), dict(keep_pinches=True), dict(improve_boundary=True), dict(parts="all"), dict(h_min=0.02)]
    bad = [dict(h_max=-1), dict(h_min=0.5, h_max=0.1), dict(spacing=1e-9), dict(boundary="fitted"), dict(max_triangles=1), dict(rule="other")]
    random = np.random.default_rng(17)
    for number in range(60):
        document = square()
        before, revision, mesh = document.options, document._core.revision(), document.mesh().fingerprint
        options = {key: value for n in random.permutation(len(good))[:3] for key, value in good[n].items()} | bad[number % len(bad)]
        with pytest.raises(mb.MeshError):
            document.set(**options)
        assert (document.options, document._core.revision()) == (before, revision), options
        assert document.mesh(fresh=True).fingerprint == mesh
        with pytest.raises(mb.MeshError, match="h_min"):
            document.layers.paint("risk")


def test_parts_and_pinches_are_changed_and_undone() -> None:
    # Two squares that meet in a node, and a smaller one beside them.
    squares = [[[(x, y), (x + side, y), (x + side, y + side), (x, y + side)]] for x, y, side in ((0, 0, 2), (2, 2, 2), (3, 0, 1))]
    domain = mb.Domain({"type": "MultiPolygon", "coordinates": [[[*ring, ring[0]] for ring in polygon] for polygon in squares]})
    for boundary, default in (("fitted", 4), ("report", 9)):
        document = mb.Document(domain, spacing=0.5, boundary=boundary, unit="none")
        meshes = [document.mesh()]
        assert round(meshes[0].statistics["area"]) == default
        for parts, area in (("all", 9), (0.2, 8), ("largest", 4)):
            document.set(parts=parts, keep_pinches=parts == 0.2)
            meshes.append(document.mesh())
            assert round(meshes[-1].statistics["area"]) == area, (boundary, parts)
        document.set(parts="all", keep_pinches=True)
        kept = document.mesh()
        document.set(keep_pinches=False)
        assert len(document.mesh()) < len(kept), boundary
        if boundary == "report":
            continue
        assert document.undo() and len(document.mesh()) == len(kept)
        document.undo()
        for mesh in meshes[-2::-1]:
            assert document.undo() and len(document.mesh()) == len(mesh), boundary
        for mesh in meshes[1:]:
            assert document.redo() and len(document.mesh()) == len(mesh), boundary


def test_risk_can_be_painted_where_the_smallest_diameter_is_known(tmp_path: Path) -> None:
    document = square()
    with pytest.raises(mb.MeshError, match="h_min"), document.stroke(mb.Brush(radius=0.1, risk=0.5)) as stroke:
        stroke.dot((0.5, 0.5))
    document.save(tmp_path / "square.meshbrush")
    told = square()
    told.set(h_min=0.01)
    # A project has a smallest diameter in any case.
    for other in (told, mb.open(tmp_path / "square.meshbrush")):
        with other.stroke(mb.Brush(radius=0.1, risk=0.5)) as stroke:
            stroke.dot((0.8, 0.8))
        assert [layer.kind for layer in other.layers] == ["formula", "paint"]


def test_a_stroke_goes_on_after_another_edit_and_goes_to_the_newest_layer(tmp_path: Path) -> None:
    document = square()
    plain = len(document.mesh())
    brush = mb.Brush(radius=0.05, diameter=0.006)
    with document.stroke(brush) as stroke:
        stroke.dot((0.8, 0.8))
        document.set(gradation=0.5)
        first = len(document.mesh())
        stroke.dot((0.8, 0.2))
    assert plain < first < len(document.mesh())
    # Of two paint layers, the one that was added last is painted on, and not the one that was painted on before.
    layer = document.layers.paint("diameter", name="new")
    document.layers["new"].move_to(0)
    with document.stroke(brush) as stroke:
        stroke.dot((0.2, 0.8))
    painted = len(document.mesh())
    layer.remove()
    assert len(document.mesh()) < painted
    # The paint of another project is not added.
    document.save(tmp_path / "painted.meshbrush")
    name = document.layers[-1].name
    with pytest.raises(mb.MeshError, match="has painted cannot be added"):
        square().layers.add("paint", quantity="diameter", file=str(tmp_path / "painted.meshbrush"), layer=name)


def test_strokes_update_the_mesh_in_place() -> None:
    document = square()
    before = document.mesh()
    with document.stroke(mb.Brush(radius=0.08, diameter=0.006)) as stroke:
        stroke.line([(0.6, 0.6), (0.8, 0.9)])
        stroke.dot((0.9, 0.5))
    change = document.update()
    assert not change.replaced and change.triangles > change.before == len(before) and "in place" in repr(change)
    painted = document.mesh()
    # The mesh that follows was not made at once.
    assert before.statistics["seconds"] > 0 and painted.statistics["seconds"] == 0
    again = document.update()
    assert not again.replaced and again.triangles == again.before == len(painted)
    fresh = square()
    assert fresh.update().replaced and not fresh.update().replaced
    fresh.set(spacing=0.15)
    changed = fresh.update()
    assert changed.replaced and "made again" in repr(changed)
    assert painted.fingerprint == document.mesh(fresh=True).fingerprint and painted.violations() == 0
    # Nodes and triangles have the same numbers.
    from_scratch = document.mesh(fresh=True)
    assert np.array_equal(painted.nodes, from_scratch.nodes) and np.array_equal(painted.triangles, from_scratch.triangles)
    assert document.undo() and document.update().triangles == len(before)
    assert document.mesh().fingerprint == before.fingerprint
    assert document.redo() and document.mesh().fingerprint == painted.fingerprint
    # An error within takes the stroke back.
    with pytest.raises(ZeroDivisionError), document.stroke(mb.Brush(radius=0.1, erase=True)) as stroke:
        stroke.line([(0, 0), (1, 1)])
        raise ZeroDivisionError
    assert document.mesh().fingerprint == painted.fingerprint
    for brush in (dict(radius=0.1), dict(radius=0.1, diameter=1, risk=1), dict(radius=0, diameter=1),
                  dict(radius=1, risk=2), dict(radius=1, diameter=-1), dict(radius=1, diameter=1, hardness=2),
                  dict(radius=1, diameter=1, change="better")):
        with pytest.raises(mb.MeshError), document.stroke(mb.Brush(**brush)) as stroke:
            stroke.dot((0.5, 0.5))
    document.layers[-1].locked = True
    with pytest.raises(mb.MeshError, match="locked"), document.stroke(mb.Brush(radius=0.1, diameter=0.01)) as stroke:
        stroke.dot((0.5, 0.5))


def test_layers_are_followed_in_place_too() -> None:
    document = square()
    document.mesh()
    document.layers.distance([(0.9, 0.1)], at_zero=0.005, slope=0.4)
    change = document.update()
    assert not change.replaced
    assert document.mesh().fingerprint == document.mesh(fresh=True).fingerprint
    capped = square(max_level=4)
    assert capped.mesh().levels.max() == 4 and capped.mesh().statistics["capped"] > 0
    capped.update()
    capped.layers.distance([(0.9, 0.1)], at_zero=0.005, slope=0.4)
    assert not capped.update().replaced
    assert capped.mesh().levels.max() == 4 and capped.mesh().fingerprint == capped.mesh(fresh=True).fingerprint
    capped.set(max_level=5)
    assert capped.update().replaced and capped.mesh().levels.max() == 5
    capped.undo()
    assert capped.options["max_level"] == 4


def test_documents_are_pickled_copied_saved_and_opened(tmp_path: Path) -> None:
    document = square(name="square", max_level=7, h_min=0.01)
    with document.stroke(mb.Brush(radius=0.1, risk=0.5)) as stroke:
        stroke.dot((0.7, 0.7))
    expected = document.mesh().fingerprint
    for other in (pickle.loads(pickle.dumps(document)), copy.copy(document), copy.deepcopy(document)):
        assert other.mesh().fingerprint == expected and repr(other) == repr(document)
        assert len(other.layers) == 2 and other.options == document.options
    for name in ("a.meshbrush", "a.toml"):
        document.save(tmp_path / name)
        again = mb.open(tmp_path / name)
        assert again.options["max_level"] == 7 and again.mesh().fingerprint == expected
    with pytest.raises(TypeError, match="document"):
        pickle.dumps(document.mesh())


def test_why_and_path() -> None:
    document = square(h_min=0.01)
    why = document.why((0.3, 0.4))
    assert why.cause in ("rule", "compatibility") and why.layer == "near"
    assert np.hypot(why.place[0] - 0.3, why.place[1] - 0.4) < 0.05 and len(why.chain) >= 1
    assert "the layer “near” asks for" in str(why) and str(why) in repr(why)
    with pytest.raises(mb.MeshError, match="No triangle is at 2"):
        document.why((2, 2))
    document.layers.threats(x=0.5, y=0.5, range=0.3)
    path = document.path((0.1, 0.5), (0.9, 0.5), via=[(0.5, 0.95)], risk_weight=20, within=0.02)
    assert path.lower <= path.cost <= path.upper * (1 + 1e-9) and path.upper <= path.lower * 1.05
    assert np.allclose(path.points[path.stops], [(0.1, 0.5), (0.5, 0.95), (0.9, 0.5)])
    steps = np.hypot(*np.diff(path.points, axis=0).T)
    assert steps.sum() == pytest.approx(path.length)
    around = document.path((0.1, 0.1), (0.9, 0.1), keep_out=[[(0.4, -0.1), (0.6, -0.1), (0.5, 0.3)]], length_weight=1)
    assert around.length > 0.85 and around.points[:, 1].max() > 0.29
    free = document.path((0.1, 0.1), (0.9, 0.1), cost="1 + 0*risk")
    assert free.length == pytest.approx(0.8, rel=1e-6) and free.note is None
    with pytest.raises(mb.FormulaError) as caught:
        document.path((0.1, 0.1), (0.9, 0.1), cost="1 + risc")
    assert caught.value.position == 4 and "^^^^" in str(caught.value)
    for within in (3, 1, 0.99e-7, 0, -0.1, float("nan")):
        with pytest.raises(mb.MeshError, match="within"):
            document.path((0.1, 0.1), (0.9, 0.1), within=within)
    wide, close = (document.path((0.1, 0.1), (0.9, 0.8), cost="1 + x*y + risk", within=within) for within in (0.999, 1e-3))
    assert wide.note is close.note is None and wide.lower < close.lower <= close.cost <= wide.cost
    assert document.path((0.1, 0.1), (0.9, 0.1), cost="1 + 0*risk", within=1e-7).note is None


@pytest.mark.parametrize("fault, kind, part", [
    (lambda d: d.layers.formula("1 +"), mb.FormulaError, "formula: "),
    (lambda d: d.layers.formula("-1"), mb.MeshError, "must be positive"),
    (lambda d: d.layers.formula("1", quantity="speed"), mb.MeshError, '"speed" is not possible here'),
    (lambda d: d.layers.add("formla"), mb.MeshError, 'did you mean "formula"?'),
    (lambda d: d.layers.add("formula", quantty="risk"), mb.MeshError, "did you mean `quantity`?"),
    (lambda d: d.layers.raster(np.ones((2, 2))), mb.MeshError, "what its values mean"),
    (lambda d: d.layers.raster(np.ones(3), reads="diameter"), mb.MeshError, "two dimensions"),
    (lambda d: d.layers.raster(np.ones((2, 2)), (0, 0, -1, 1), reads="diameter"), mb.MeshError, "no rectangle"),
    (lambda d: d.layers.raster(-np.ones((2, 2)), reads="diameter"), mb.MeshError, "it must be positive"),
    (lambda d: d.layers.raster(np.full((2, 2), 1e300), reads="diameter"), mb.MeshError, "single precision"),
    (lambda d: d.layers.raster(np.ones((1, 70_000)), reads="diameter"), mb.MeshError, "70,000 × 1 pixels are too many"),
    (lambda d: d.layers.raster(np.ones((0, 3)), reads="diameter"), mb.MeshError, "3 × 0 pixels are too many or none"),
    (lambda d: d.layers.raster(np.array([["a"]]), reads="diameter"), mb.MeshError, "is no raster"),
    (lambda d: d.layers.raster("none.tif", reads="diameter"), mb.FileError, "none.tif"),
    (lambda d: d.layers.threats(x=1, y=1, range=-1), mb.MeshError, "range"),
    (lambda d: d.layers.distance("outline", at_zero=0, slope=1), mb.MeshError, "at_zero: 0 cannot be used"),
    (lambda d: d.layers.distance(np.ones((3, 3)), at_zero=1, slope=1), mb.MeshError, "rows of two numbers"),
    (lambda d: d.layers.formula("x", quantity="risk"), mb.MeshError, "need `h_min`"),
    (lambda d: d.layers.paint("risk"), mb.MeshError, "need `h_min`"),
    (lambda d: d.stroke(mb.Brush(radius=1, risk=1)).dot((0.5, 0.5)), mb.MeshError, "needs h_min"),
    (lambda d: (d.set(max_triangles=300), d.mesh()), mb.MeshError, "or raise max_triangles"),
    (lambda d: d.layers.add("paint", quantity="risk", layer="a"), mb.MeshError, "`layer` names a layer"),
    (lambda d: mb.Document([[0, 0], [1, 1]]), mb.MeshError, "."),
    (lambda d: mb.Document("nothing.geojson"), mb.FileError, "nothing.geojson"),
    (lambda d: mb.Document(mb.Domain.formula("x >", (0, 0, 1, 1))), mb.FormulaError, "inside"),
    (lambda d: mb.Document(mb.Domain.rectangle(1, 0, 0, 1)), mb.MeshError, "no rectangle"),
    (lambda d: mb.Document(object()), mb.MeshError, "no shapes"),
    (lambda d: mb.open("nothing.meshbrush"), mb.FileError, "nothing.meshbrush"),
    (lambda d: mb.open("nothing.toml"), mb.FileError, "nothing.toml"),
    (lambda d: d.mesh().write("a.doc"), mb.MeshError, "the ending chooses the format"),
    (lambda d: d.mesh().write("no/such/folder/a.msh"), mb.FileError, "a.msh cannot be written"),
    (lambda d: d.save("no/such/folder/a.meshbrush"), mb.FileError, "cannot be written"),
    (lambda d: d.mesh().write("a.msh", values={"a b": [1]}), mb.MeshError, "letters, digits"),
    (lambda d: d.mesh().write("a.msh", values={"a": [1]}), mb.MeshError, "nodes"),
    (lambda d: d.mesh().nodes_in("lonlat"), mb.MeshError, "projection"),
    (lambda d: d.mesh().write("a.msh", crs="EPSG:32635"), mb.MeshError, "projection"),
    (lambda d: d.mesh().write("a.msh", crs="lonlat"), mb.MeshError, "projection"),
    (lambda d: d.mesh().write("a.msh", quantities=["a = 1/(x-x)"]), mb.MeshError, "finite number at every node"),
    (lambda d: d.mesh().write("a.png", quantities=["a = 1"]), mb.MeshError, "no values at the nodes"),
    (lambda d: d.to_world([[1, 2]]), mb.MeshError, "projection"),
])
def test_errors_are_sentences_of_their_class(fault: Any, kind: type[Exception], part: str) -> None:
    document = square()
    before = len(document.layers)
    with pytest.raises(kind) as caught:
        fault(document)
    assert type(caught.value) is kind and part in str(caught.value), str(caught.value)
    assert isinstance(caught.value, OSError if kind is mb.FileError else ValueError)
    assert len(document.layers) == before
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value) and vars(again) == vars(caught.value)


def test_a_mistake_in_a_formula_has_its_place() -> None:
    with pytest.raises(mb.FormulaError) as caught:
        square().layers.formula("θ + größe")
    assert (caught.value.position, caught.value.formula) == (4, "θ + größe")
    assert str(caught.value).endswith("θ + größe\n        ^^^^^")
    # Wherever a formula is written: one that may use the depth, or not, or has a name.
    random = np.random.default_rng(5)
    places = [
        lambda d, text: d.layers.formula(text),
        lambda d, text: d.layers.formula(text, quantity="risk"),
        lambda d, text: d.layers.surface(formula=text, within=0.1),
        lambda d, text: mb.Document(mb.Domain.formula(text, (0, 0, 1, 1))),
        lambda d, text: d.path((0.1, 0.1), (0.9, 0.9), cost=text),
        lambda d, text: d.mesh().write("a.msh", quantities=[text]),
        lambda d, text: d.mesh().write("a.msh", quantities=[f"name = {text}"]),
    ]
    document = square(h_min=0.01)
    for number in range(70):
        wrong = ["größe", "depth" if number % len(places) in range(1, 5) else "depht"][random.integers(2)]
        terms = [str(term) for term in random.choice(["x", "2.5", "sin(y)", "(1 + x)", "θ", "r"], random.integers(1, 5))]
        terms.insert(random.integers(len(terms) + 1), wrong)
        with pytest.raises(mb.FormulaError) as caught:
            places[number % len(places)](document, " + ".join(terms))
        formula, position = caught.value.formula, caught.value.position
        assert " + ".join(terms) in formula and formula.index(wrong) == position, (terms, formula, position)


@pytest.mark.filterwarnings("ignore::meshbrush.MeshbrushWarning")
def test_documents_on_the_earth() -> None:
    document = mb.Document(feature(bay(0.4, (24.0, 38.0))), projection="auto", h_min=500, h_max=9000)
    assert document.options["unit"] == "m" and "+proj=" in document.options["projection"] and document.notes
    at = document.to_world([[24.0, 38.0]])
    document.layers.distance(np.array([[24.0, 38.0]]), at_zero=500, slope=0.2)
    mesh = document.mesh()
    lonlat = mesh.nodes_in("lonlat")
    assert np.all(np.abs(lonlat - [24, 38]) < 0.6)
    nearest = np.argmin(mesh.h)
    assert np.hypot(*(mesh.nodes[nearest] - at[0])) < 1000
    assert np.allclose(document.to_world(lonlat), mesh.nodes, atol=1e-6)
    # Grids without a place cover the domain's rectangle; grids in degrees are projected.
    coarse = len(mesh)
    layer = document.layers.raster(np.full((4, 4), 700.0), (23.9, 37.9, 24.1, 38.1), reads="diameter")
    finer = len(document.mesh())
    assert finer > coarse
    # In the plane of the document, or the system that is named; without a word only where they can be degrees.
    layer.remove()
    low, high = document.to_world([[23.9, 37.9], [24.1, 38.1]])
    document.layers.raster(np.full((4, 4), 700.0), (*low, *high), reads="diameter", crs="plane")
    assert coarse < len(document.mesh()) and abs(len(document.mesh()) - finer) < 0.2 * finer
    for bounds in ((23.9, 37.9, 24.1, 92), (23.9, -92, 24.1, 38.1), (23.9, 37.9, 362, 38.1), (-182, 37.9, 24.1, 38.1)):
        with pytest.raises(mb.MeshError, match="coordinate system"):
            document.layers.raster(np.full((4, 4), 700.0), bounds, reads="diameter")
    for bounds in ((23.9, 37.9, 24.1, 90), (-180, 37.9, 24.1, 38.1), (23.9, 37.9, 360, 38.1)):
        document.layers.raster(np.full((4, 4), 700.0), bounds, reads="diameter")


def test_lengths_may_have_a_unit() -> None:
    region = feature(bay(0.4, (24.0, 38.0)))
    numbers = mb.Document(region, projection="auto", spacing=9260, h_min=500, h_max=9000)
    units = mb.Document(region, spacing="5 nmi", h_min="500 m", h_max="9 km")
    for document, lengths in ((numbers, [800, 20_000, 6000]), (units, ["800 m", "20 km", "6000m"])):
        at_zero, farthest, h_max = lengths
        document.layers.distance("outline", at_zero=at_zero, slope=0.2, range=farthest)
        document.set(h_max=h_max)
    assert units.mesh().fingerprint == numbers.mesh().fingerprint
    ends = [[*units.mesh().nodes[5]], [*units.mesh().nodes[500]]]
    assert units.path(*ends, clearance="10 m").cost == numbers.path(*ends, clearance=10).cost
    for fault, part in (
        (lambda: mb.Document(region, projection="none", h_min="500 m"), "h_min: \"500 m\" cannot be used: lengths of this"),
        (lambda: square(h_min="500 m"), "lengths of this domain are plain numbers"),
        (lambda: units.set(h_min="1 apple"), "“apple” cannot be converted to m"),
        (lambda: units.set(h_min=""), "this text is empty"),
        (lambda: units.set(h_min="-1 km"), "\"-1 km\" cannot be used: a length must be positive"),
        (lambda: square().set(h_min="1 km"), "lengths of this domain are plain numbers"),
        (lambda: square().layers.distance("outline", at_zero="1 km", slope=0.1), "at_zero: \"1 km\" cannot be used"),
        (lambda: units.path(*ends, clearance="0.1°"), "are in metres"),
    ):
        with pytest.raises(mb.MeshError, match=re.escape(part)):
            fault()


def test_a_brush_has_its_radius_on_the_earth() -> None:
    # In this plane, lengths at 60° N are twice those on the Earth.
    domain = mb.Domain(feature(bay(2.0, (10.0, 60.0))))
    options = dict(crs="lonlat", projection="+proj=merc +lon_0=10", h_min="100 m", h_max="50 km")
    hashes = []
    for radius in ("10 km", 10_000, "10000"):
        document = mb.Document(domain, **options)
        at = document.to_world([[10.0, 60.0]])[0]
        with document.stroke(mb.Brush(radius=radius, diameter="1 km", hardness=1)) as stroke:
            stroke.dot(at)
        mesh = document.mesh()
        fine = mesh.nodes[mesh.h <= 1000]
        farthest = np.hypot(*(fine - at).T).max()
        assert 19_000 < farthest < 22_000, farthest
        hashes.append(mesh.fingerprint)
    assert len(set(hashes)) == 1
    for brush, part in (
        (dict(radius="10°", diameter=1), "radius: \"10°\" cannot be used: lengths of this domain are in metres"),
        (dict(radius="far", diameter=1), "radius: “far” is not a number"),
        (dict(radius="-1 km", diameter=1), "a radius is positive and finite"),
        (dict(radius=1, diameter="0 m"), "a length must be positive and finite"),
    ):
        with pytest.raises(mb.MeshError, match=re.escape(part)), document.stroke(mb.Brush(**brush)) as stroke:
            stroke.dot(at)


def test_data_of_other_libraries(tmp_path: Path) -> None:
    geometry = pytest.importorskip("shapely.geometry")
    xarray = pytest.importorskip("xarray")
    rings = bay()
    polygon = geometry.Polygon(rings[0], rings[1:])
    expected = mb.Document(rings).mesh().fingerprint
    assert mb.Document(polygon).mesh().fingerprint == expected
    (tmp_path / "bay.geojson").write_text(json.dumps(feature(rings)))
    assert mb.Document(tmp_path / "bay.geojson").mesh().fingerprint == expected
    assert list(mb.Document(str(tmp_path / "bay.geojson")).mesh().markers)[0] == "bay"

    values = 0.02 + np.add.outer(np.arange(20.0), np.arange(30.0)) / 500
    place, x, y = (0, 0, 1.5, 1.0), 0.025 + 0.05 * np.arange(30), 0.025 + 0.05 * np.arange(20)
    plain = mb.Document(mb.Domain.rectangle(0, 0, 1.5, 1))
    plain.layers.raster(values, place, reads="diameter", origin="lower")
    for array in (
        xarray.DataArray(values, coords={"y": y, "x": x}, dims=("y", "x")),
        xarray.DataArray(values[::-1], coords={"lat": y[::-1], "lon": x}, dims=("lat", "lon")),
        xarray.DataArray(values.T[None, ::-1], coords={"x": x[::-1], "y": y}, dims=("time", "x", "y")),
    ):
        document = mb.Document(mb.Domain.rectangle(0, 0, 1.5, 1))
        document.layers.raster(array, reads="diameter")
        assert document.mesh().fingerprint == plain.mesh().fingerprint
    # rasterio, by its names; a masked array; and whole numbers.
    masked = np.ma.masked_equal(np.where(values > 0.1, -9999, values)[::-1], -9999)
    (height, width), (x0, y0, x1, y1) = masked.shape, place
    transform = types.SimpleNamespace(a=(x1 - x0) / width, b=0, c=x0, d=0, e=(y0 - y1) / height, f=y1)
    dataset = types.SimpleNamespace(
        read=lambda band, masked: data, transform=transform, width=width, height=height, nodata=-9999, crs=None,
        colorinterp=["gray"], scales=(1.0,), offsets=(0.0,), units=(None,),
    )
    data = masked
    one, two = (mb.Document(mb.Domain.rectangle(0, 0, 1.5, 1)) for _ in range(2))
    one.layers.raster(dataset, reads="diameter")
    two.layers.raster(masked.filled(np.nan), place, reads="diameter")
    assert one.mesh().fingerprint == two.mesh().fingerprint
    found = set()
    for kind in (np.uint8, np.int16, np.int32, np.int64, np.float32, np.dtype(">i2"), np.float16):
        whole = mb.Document(mb.Domain.rectangle(0, 0, 4, 2), spacing=1)
        whole.layers.raster((1 + np.arange(8).reshape(2, 4)).astype(kind), curve=[(1, 0.05), (8, 1)])
        found.add(whole.mesh().fingerprint)
    assert len(found) == 1
    with pytest.warns(mb.MeshbrushWarning, match="does not meet the domain"):
        plain.layers.raster(values, (5, 5, 6, 6), reads="diameter")


def test_values_of_a_grid_at_points() -> None:
    values = np.add.outer(np.arange(4.0)[::-1], 10 * np.arange(5.0))  # y + 10 x at pixels of 1
    at = mb.sample(values, [[0.5, 0.5], [2.25, 1.75], [0.1, 3.9], [6, 1]], bounds=(0, 0, 5, 4))
    assert np.allclose(at, [0, 17.5 + 1.25 - 0.0, 3, np.nan], equal_nan=True)


def test_pictures_and_files(tmp_path: Path) -> None:
    mesh = square().mesh()
    picture = mesh.picture(size=(120, 100), edges=False, light=True, colormap="magma")
    assert picture.shape == (100, 120, 4) and picture.dtype == np.uint8 and picture[..., 3].min() == 255
    assert len(np.unique(picture.reshape(-1, 4), axis=0)) >= 5
    assert mesh._repr_png_().startswith(b"\x89PNG")
    with pytest.raises(mb.MeshError, match="needs heights"):
        mesh.picture(view="space")
    hills = square()
    hills.layers.surface(formula="sin(9 * x) * cos(7 * y)", within=0.05)
    views = [hills.mesh().picture(size=(120, 100), view="space", azimuth=azimuth) for azimuth in (20, 200)]
    assert views[0].shape == (100, 120, 4) and not np.array_equal(views[0], views[1])
    depth = 3 + mesh.nodes[:, 0]
    for ending in ("msh", "vtu", "2dm", "csv", "obj", "stl", "node", "14", "gr3", "slf", "svg", "png"):
        values = {"depth": depth} if ending not in ("svg", "png") else None
        files = mesh.write(tmp_path / f"mesh.{ending}", values=values)
        assert files and all(Path(file).stat().st_size > 100 for file in files), ending
    assert mesh.write(tmp_path / "b.msh", binary=True, quantities=["twice = 2*x"])
    assert b"twice" in (tmp_path / "b.msh").read_bytes()
    # The same document by the command line gives the same arrays.
    square().save(tmp_path / "square.meshbrush")
    run_program("mesh", "--project", "square.meshbrush", "-o", "line.csv", cwd=tmp_path)
    mesh.write(tmp_path / "own.csv")
    assert (tmp_path / "own.csv").read_bytes() == (tmp_path / "line.csv").read_bytes()


def test_files_say_what_their_coordinates_are(tmp_path: Path) -> None:
    domain = mb.Domain(feature(bay(0.5, (20.0, 40.0))))
    document = mb.Document(domain, projection="auto", h_min=5_000)
    mesh = document.mesh()
    mesh.write(tmp_path / "degrees.node")
    mesh.write(tmp_path / "plane.node", crs="plane")
    said = [
        next(line for line in (tmp_path / name).read_text().splitlines() if "coordinates" in line)
        for name in ("degrees.node", "plane.node")
    ]
    assert "longitude" in said[0] and "longitude" not in said[1] and "x, y in +proj=" in said[1]


def test_a_mesh_within_an_error_of_an_array() -> None:
    y, x = np.mgrid[0:65, 0:65] / 64
    heights = np.sin(6 * x) * np.cos(4 * y)
    document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.25)
    half = 0.5 / 64
    bounds = (-half, -half, 1 + half, 1 + half)
    layer = document.layers.surface(heights, bounds, within=0.01, origin="lower")
    mesh = document.mesh()
    assert mesh.statistics["max_error"] <= 0.01 and mesh.statistics["rms_error"] > 0
    at_nodes = np.sin(6 * mesh.nodes[:, 0]) * np.cos(4 * mesh.nodes[:, 1])
    at_samples = mesh.interpolate(at_nodes, np.c_[x.ravel(), y.ravel()])
    assert np.abs(at_samples - heights.ravel()).max() <= 0.01 + 1e-6
    layer.remove()
    document.layers.surface(heights, bounds, at_most=len(mesh.triangles), origin="lower")
    assert document.mesh().fingerprint == mesh.fingerprint


def test_the_curve_of_errors_has_the_mesh() -> None:
    document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.25)
    layer = document.layers.surface(formula="exp(-9*(x*x + y*y))", within=1e-3, norm="l2")
    mesh = document.mesh()
    least, uniform = mesh.error_curve(20_000)
    assert (np.diff(least[:, 0]) > 0).all() and least[-1, 0] <= 20_000
    first = least[least[:, 1] <= 1e-3][0]
    assert abs(first[0] - len(mesh.triangles)) <= 0.03 * first[0]
    assert list(uniform[:3, 0]) == [32, 64, 128] and mesh.statistics["rms_error"] <= 1e-3
    layer.remove()
    with pytest.raises(mb.MeshError, match=r"layers\.surface"):
        document.mesh().error_curve()


def test_errors_by_place_and_missing_values() -> None:
    rows, columns = np.mgrid[0:40, 0:40]
    heights = 5 * np.sin(columns / 4.0) * np.cos(rows / 5.0)
    heights[10:20, 30:] = np.nan
    bounds = (0, 0, 40, 40)

    def document() -> mb.Document:
        made = mb.Document(mb.Domain.rectangle(*bounds), spacing=8)
        made.layers.surface(heights, bounds, within=2, origin="lower")
        return made

    plain = document().mesh()
    assert plain.statistics["missing_samples"] == 100
    assert plain.statistics["missing_share"] == pytest.approx(100 / 1600)
    painted = document()
    with painted.stroke(mb.Brush(radius=6, error=0.1, hardness=1.0)) as stroke:
        stroke.line([(10, 10)])
    assert [layer.kind for layer in painted.layers][-1] == "paint"
    formula = document()
    formula.layers.formula("if(hypot(x - 10, y - 10) < 5, 0.1, inf)", quantity="error")
    for finer in (painted, formula):
        mesh = finer.mesh()
        assert len(mesh) > len(plain)
        within = np.hypot(*(mesh.nodes[mesh.triangles].mean(axis=1) - 10).T) < 5
        assert within.sum() > 50
    with pytest.raises(mb.MeshError):
        mb.Brush(radius=1, error=1.0, risk=0.5)._medium()


def test_heights_in_files(tmp_path: Path) -> None:
    document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.25)
    document.layers.surface(formula="3*x + y*y", within=0.01)
    mesh = document.mesh()

    def third(**options: bool) -> np.ndarray:
        mesh.write(tmp_path / "m.obj", **options)
        rows = [line.split() for line in (tmp_path / "m.obj").read_text().splitlines() if line.startswith("v ")]
        return np.array([float(row[3]) for row in rows])

    x, y = mesh.nodes.T
    assert np.allclose(third(), 3 * x + y * y, atol=1e-12)
    assert (third(flat=True) == 0).all()
    mesh.write(tmp_path / "m.glb")
    assert (tmp_path / "m.glb").read_bytes()[:4] == b"glTF"


def area(mesh: mb.Mesh) -> float:
    a, b, c = (mesh.nodes[mesh.triangles[:, corner]] for corner in range(3))
    return float(((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum() / 2)


def test_the_sea_beside_land() -> None:
    shapely = pytest.importorskip("shapely")
    island = np.array([[-5.5, 47.5], [-4.5, 47.5], [-4.5, 48.5], [-5.5, 48.5], [-5.5, 47.5]])
    polygon = {"type": "Polygon", "coordinates": [island.tolist()]}
    frame = (-6.0, 47.0, -2.0, 49.0)
    for land in (polygon, [island], shapely.LineString(island)):
        document = mb.Document(mb.Domain.sea(land, bounds=frame), spacing=0.25)
        assert abs(area(document.mesh()) - 7) < 1e-9
        assert document.options["bounds"] == frame
    coast = np.array([[-4.0, 46.0], [-4.0, 50.0]])
    for place in ((-5, 48), (-3, 48)):
        document = mb.Document(mb.Domain.sea(coast, bounds=frame, place=place), spacing=0.25)
        assert abs(area(document.mesh()) - 4) < 1e-9
        assert (document.mesh().nodes[:, 0].mean() < -4) == (place[0] < -4)
    part = mb.Document(mb.Domain(polygon, bounds=(-5.0, 47.0, -2.0, 48.0)), spacing=0.25, parts="all")
    assert abs(area(part.mesh()) - 0.25) < 1e-9
    with pytest.raises(mb.MeshError, match="end inside the frame, at -4, 48"):
        mb.Document(mb.Domain.sea(np.array([[-4.0, 46.0], [-4.0, 48.0]]), bounds=frame))


def test_values_of_python_are_taken_or_refused_with_a_sentence() -> None:
    document = square()
    assert document.mesh().locate([]).triangle.size == 0
    document.set(max_triangles=1e6)
    assert document.options["max_triangles"] == 1_000_000
    layer = document.layers.formula(0.05)
    with pytest.raises(AttributeError):
        layer.visibel = False  # type: ignore[attr-defined]
    for fault, part in (
        (lambda: document.mesh(threads="two", fresh=True), "threads = 'two': write how many"),
        (lambda: document.layers.sample(lambda x, y: x, pixels=0), "pixels = 0: write how many"),
        (lambda: document.layers.sample(lambda x, y: None), "The function returns None"),
    ):
        with pytest.raises(mb.MeshError, match=re.escape(part)):
            fault()
    for missing in (
        lambda: mb.Document("nothing.geojson"),
        lambda: document.layers.raster("nothing.tif", reads="diameter"),
        lambda: document.layers.threats("nothing.csv"),
        lambda: document.layers.formula(1, mask="nothing.geojson"),
    ):
        with pytest.raises(mb.FileError, match="nothing") as raised:
            missing()
        assert raised.value.errno == errno.ENOENT


@pytest.mark.parametrize("west", [-6.0, 178.0])
@pytest.mark.parametrize("projection", [None, "auto"])
@pytest.mark.parametrize("layer", ["distance", "straits"])
def test_a_sea_beside_land_is_saved(west: float, projection: str | None, layer: str, tmp_path: Path) -> None:
    unit = 111e3 if projection else 1.0

    def island(x: float, y: float, half: float) -> list[list[float]]:
        corners = [(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half), (x - half, y - half)]
        return [[(x + 180) % 360 - 180, y] for x, y in corners]

    places = [(1, 46.6), (1.8, 47.2), (0, 47), (4, 47)]
    land = {"type": "MultiPolygon", "coordinates": [[island(west + x, y, 0.2)] for x, y in places]}
    east = west + 4 if west + 4 <= 180 else west - 356
    document = mb.Document(
        mb.Domain.sea(land, bounds=(west, 46, east, 48)),
        projection=projection,
        spacing=0.25 * unit,
        h_min=0.01 * unit,
        gradation=0.2,
    )
    if layer == "distance":
        document.layers.distance("coasts", at_zero=0.05 * unit, slope=0.2)
    else:
        document.layers.add("straits", across=3, width_from=0.03 * unit, width_to=0.9 * unit)
    document.layers.formula(0.1 * unit, mask={"type": "Polygon", "coordinates": [island(2.5, 47, 0.3)]} if west < 0 else None)
    mesh = document.mesh()
    assert [name for name in mesh.markers if name.startswith("open")][:2] == ["open south", "open east"]
    for name in ("a.meshbrush", "a.toml"):
        document.save(tmp_path / name)
        again = mb.open(tmp_path / name).mesh()
        assert (again.fingerprint, list(again.markers)) == (mesh.fingerprint, list(mesh.markers)), name


def test_rules_of_solvers_are_checked_and_repaired() -> None:
    document = mb.Document(mb.Domain.rectangle(0, 0, 40_000, 40_000), spacing=10_000)
    answer = document.mesh().check("fvcom", values={"depth": np.full(25, 50.0)})
    assert [found["rule"] for found in answer["violations"]] == 2 * ["two_open_nodes_and_shore"]
    before = document.mesh().fingerprint
    assert document.repair("fvcom") == (2, 0)
    mesh = document.mesh()
    assert mesh.check("fvcom")["violations"] == []
    assert [layer.name for layer in document.layers][-1] == "Repair for FVCOM 1"
    assert mesh.fingerprint != before
    document.undo()
    assert document.mesh().fingerprint == before
    with pytest.raises(mb.MeshError, match="is no solver whose rules are known"):
        mesh.check("roms")
    with pytest.raises(mb.MeshError) as refused:
        mesh.check("fvcom", crs="EPSG:32630")
    assert "--out-crs" not in str(refused.value)


def test_strips_along_the_frame_are_cut_off() -> None:
    bay = [(0, 0), (40, 0), (40, 20), (24, 20), (24, 1), (0, 1)]
    document = mb.Document(mb.Domain(np.array(bay), bounds=(0, 0, 60, 21)), spacing=4, boundary_diameter=1.2, open="frame")
    document.layers.formula(1.5)

    def strips() -> int:
        return [note["rule"] for note in document.mesh().check("adcirc")["notes"]].count("strip_along_frame")

    before = document.mesh().fingerprint
    assert strips() == 1
    assert document.cut_strips("adcirc") == (1, 0)
    assert strips() == 0
    assert document.mesh().triangles.shape[0] > 100
    document.undo()
    assert document.mesh().fingerprint == before
    with pytest.raises(mb.MeshError, match="SWAN has no rule on strips"):
        document.cut_strips("swan")


def test_quantities_may_use_the_depth_and_grids(tmp_path: Path) -> None:
    for name, value in (("depth.asc", "-5"), ("cover.asc", "11")):
        head = "ncols 4\nnrows 4\nxllcorner -1\nyllcorner -1\ncellsize 1\n"
        (tmp_path / name).write_text(head + 4 * (4 * f"{value} " + "\n"))
    (tmp_path / "n.csv").write_text("class,value\n11,0.02\n")
    document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.5)
    document.layers.depth(tmp_path / "depth.asc")
    mesh = document.mesh()
    path = tmp_path / "a.node"
    grids = [{"name": "manning", "file": tmp_path / "cover.asc", "table": tmp_path / "n.csv"}]
    mesh.write(path, quantities=["half = depth/2"], grids=grids)
    rows = [line.split() for line in path.read_text().splitlines() if not line.startswith("#")]
    assert {tuple(map(float, row[4:6])) for row in rows[1:]} == {(2.5, 0.02)}, rows[1]
    found = [mesh.check("adcirc", quantities=quantities) for quantities in ([], ["depth = depth - 6"])]
    dry = [[rule["count"] for rule in answer["rules"] if rule["rule"] == "dry_node"] for answer in found]
    assert dry == [[0], [len(mesh.nodes)]]
    with pytest.raises(mb.MeshError, match="there is no such file"):
        mesh.check("adcirc", grids=[{"name": "depth", "file": tmp_path / "none.asc"}])


def test_depths_in_files_have_a_least_depth_and_a_slope(tmp_path: Path) -> None:
    mesh = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.25).mesh()
    depth = 10 * mesh.nodes[:, 0] - 1

    def written(**options: Any) -> list[float]:
        mesh.write(tmp_path / "a.14", **options)
        rows = (tmp_path / "a.14").read_text().splitlines()[2 : 2 + len(mesh.nodes)]
        return [float(row.split()[3]) for row in rows]

    assert written(values={"depth": depth}) == pytest.approx(depth)
    assert written(values={"depth": depth}, least_depth=2) == pytest.approx(np.maximum(depth, 2))
    assert written(quantities=["depth = 10*x - 1"], least_depth=2) == pytest.approx(np.maximum(depth, 2))
    smooth = written(values={"depth": depth}, least_depth=1, depth_slope=0.05)
    assert min(smooth) >= 1
    assert smooth != pytest.approx(np.maximum(depth, 1))
    dry = [mesh.check("adcirc", values={"depth": depth}, least_depth=least) for least in (None, 2)]
    assert [len(answer["notes"]) > 0 for answer in dry] == [True, False]
    with pytest.raises(mb.MeshError, match="an r-factor is a number between 0 and 1"):
        mesh.write(tmp_path / "a.14", depth_slope=2)
    with pytest.warns(mb.MeshbrushWarning, match="has no depths"):
        mesh.write(tmp_path / "a.vtu", least_depth=2)
    mesh.write(tmp_path / "a.png", size=100, color_by="smallest_angle", ground="white")
    # In a mesh of one level, nothing has a color.
    graded = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.25)
    graded.layers.formula("0.1 + 0.3*x")
    levels, angles = (graded.mesh().picture(size=100, ground="white", color_by=by) for by in (None, "smallest_angle"))
    assert not np.array_equal(angles, levels)
