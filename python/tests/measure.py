"""Prints what docs/python.md says about times and memory: python python/tests/measure.py [PROGRAM]

PROGRAM is the program in release, to compare with; without one, the command line of the module.
"""

from __future__ import annotations

import json
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

RECIPE = """
domain = { bounds = [0, 0, 1, 1] }
mesh = { max_triangles = 20000000 }
layer = [{ kind = "formula", quantity = "diameter", formula = "0.0009 + 0.002*hypot(x - 0.3, y - 0.4)" }]
"""


def import_time() -> None:
    def seconds(code: str) -> float:
        begun = time.perf_counter()
        subprocess.run([sys.executable, "-c", code], check=True)
        return time.perf_counter() - begun

    both = [(seconds("import numpy"), seconds("import numpy, meshbrush")) for _ in range(15)]
    print(f"import beyond numpy: {1e3 * statistics.median(b - a for a, b in both):.0f} ms")


def mesh_time(program: list[str]) -> None:
    import meshbrush as mb

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "recipe.toml"
        file.write_text(RECIPE)
        own, line = [], []
        for _ in range(5):
            begun = time.perf_counter()
            answer = json.loads(subprocess.check_output([*program, "mesh", str(file), "--json"]))
            whole, refining = time.perf_counter() - begun, answer["seconds"]
            line.append((whole, refining))
            begun = time.perf_counter()
            mesh = mb.read_recipe(file).mesh()
            made = time.perf_counter() - begun
            assert mesh.nodes.size and mesh.triangles.size
            own.append((made, time.perf_counter() - begun))
            assert mesh.fingerprint == answer["hash"]
    count = answer["triangles"]
    print(f"{count} triangles: mesh() {min(own)[0]:.2f} s, with arrays {min(o[1] for o in own):.2f} s;", end=" ")
    print(f"command line: refining {min(n[1] for n in line):.2f} s, in all {min(line)[0]:.2f} s")


def raster_memory() -> None:
    import numpy as np

    import meshbrush as mb

    def peak() -> float:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6

    values = np.full((10_000, 10_000), 0.5, dtype=np.float32)
    values[4000:6000, 4000:6000] = 0.01
    before = peak()
    document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), h_max=0.05)
    begun = time.perf_counter()
    document.layers.raster(values, reads="diameter")
    seconds = time.perf_counter() - begun
    print(f"raster of {values.size:.0e} pixels: {seconds:.1f} s, {peak() - before:.2f} GB beside the array")
    print(f"its mesh: {len(document.mesh())} triangles, {peak() - before:.2f} GB at most")


def location_time() -> None:
    """The two meshes and the square of the bench `locate`, which says what one thread finds in Rust without weights."""
    import numpy as np

    import meshbrush as mb

    for diameter in (0.0625, 0.015625):
        document = mb.Document(mb.Domain.rectangle(-10, -10, 10, 10), spacing=1, rule="vertex", h_max=20)
        document.layers.formula(f"if(abs(x) + abs(y) < 8, {diameter}, 20)")
        mesh, points = document.mesh(), 20 * np.random.default_rng(1).random((10_000_000, 2)) - 10
        begun, cpu = time.perf_counter(), time.process_time()
        mesh.locate(points)
        wall, cpu = time.perf_counter() - begun, time.process_time() - cpu
        rate = len(points) / cpu / 1e6
        print(f"1e7 points in {len(mesh)} triangles: {wall:.2f} s, {cpu:.2f} s CPU: {rate:.1f} million a second of one processor")


if __name__ == "__main__":
    import_time()
    mesh_time(sys.argv[1:2] or [sys.executable, "-m", "meshbrush"])
    location_time()
    raster_memory()
