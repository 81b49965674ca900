"""Interrupts, threads, processes, progress."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import meshbrush as mb
from coasts import bay


def large(diameter: float = 0.0008) -> mb.Document:
    document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), max_triangles=20_000_000)
    document.layers.formula(f"{diameter} + 0.0003*sin(40*x)*sin(30*y)")
    return document


def small() -> mb.Document:
    document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.1)
    document.layers.formula("0.012 + 0.2*hypot(x - 0.3, y - 0.4)")
    return document


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_ctrl_c_is_heard_within_a_tenth_of_a_second() -> None:
    # A job in the background of a shell ignores the signal, and so would Python.
    former = signal.signal(signal.SIGINT, signal.default_int_handler)
    document = large()
    layers = len(document.layers)
    sent: list[float] = []

    def send() -> None:
        time.sleep(0.4)
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    sender = threading.Thread(target=send)
    sender.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            document.mesh()
        heard = time.monotonic()
        sender.join()
    finally:
        signal.signal(signal.SIGINT, former)
    assert sent and heard - sent[0] < 0.1
    # The document is as it was, and works.
    assert len(document.layers) == layers
    document.layers[0].visible = False
    assert len(document.mesh()) > 0


def test_an_update_that_was_ended_begins_again() -> None:
    document = small()
    before = document.mesh().fingerprint
    document.layers.formula("0.0008 + 0.0003*sin(40*x)*sin(30*y)")

    def stop(stage: str, done: int) -> None:
        raise LookupError(stage)

    with pytest.raises(LookupError):
        document.update(progress=stop)
    document.undo()
    document.update()
    assert document.mesh().fingerprint == before == document.mesh(fresh=True).fingerprint
    with document.stroke(mb.Brush(radius=0.05, diameter=0.01)) as stroke:
        stroke.dot((0.8, 0.8))
    document.update()
    assert document.mesh().fingerprint == document.mesh(fresh=True).fingerprint != before
    document.set(max_triangles=500)
    for _ in range(2):
        with pytest.raises(mb.MeshError, match="max_triangles"):
            document.update()
    document.set(max_triangles=100_000)
    assert document.update().triangles == len(document.mesh(fresh=True))


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_work_that_nobody_waits_for_ends() -> None:
    def stop(stage: str, done: int) -> None:
        raise LookupError(stage)

    def follow() -> None:
        document = small()
        document.mesh()
        document.layers.formula("0.0008 + 0.0003*sin(40*x)*sin(30*y)")
        document.update(progress=stop)

    def locate() -> None:
        mesh, points = small().mesh(), np.random.default_rng(1).random((3_000_000, 2))
        former = signal.signal(signal.SIGALRM, lambda *_: stop("alarm", 0))
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        try:
            mesh.locate(points)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, former)

    for work in (lambda: large().mesh(progress=stop), follow, locate):
        with pytest.raises(LookupError):
            work()
        # A slice of the work is finished; all of it would take some seconds.
        time.sleep(0.3)
        busy = time.process_time()
        time.sleep(0.5)
        assert time.process_time() - busy < 0.1


def test_progress_is_told(tmp_path: Path) -> None:
    told: list[tuple[str, int, float]] = []

    def note(stage: str, done: int) -> None:
        told.append((stage, done, time.monotonic()))

    large(0.0015).mesh(progress=note)
    assert any(stage == "refining" and done > 0 for stage, done, _ in told)
    # No more often than ten times a second.
    times = np.array([at for _, _, at in told])
    assert (np.diff(times) > 0.09).all()
    told.clear()
    large(0.003).mesh().write(tmp_path / "mesh.vtu", progress=note)
    assert {stage for stage, _, _ in told} == {"writing"} and max(done for _, done, _ in told) > 0
    small().mesh(progress=True)


def test_stages_of_the_work_are_told() -> None:
    told: list[tuple[str, int]] = []

    def note(stage: str, done: int) -> None:
        told.append((stage, done))

    # A stage is told once it takes a tenth of a second: finer, until the machine needs that long.
    for diameter in (0.003, 0.0015, 0.0007, 0.0003):
        mesh = mb.Document(bay(), boundary="outline", boundary_diameter=diameter).mesh(progress=note)
        fitting = [done for stage, done in told if stage == "fitting the mesh to its domain"]
        if fitting:
            break
    assert max(fitting) > len(mesh)
    for target in (0.02, 0.01, 0.005):
        document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.1)
        document.layers.formula(target)
        told.clear()
        document.path((0.1, 0.1), (0.9, 0.8), cost="1 + x*y + risk", within=1e-5, progress=note)
        if told and told[0] == ("finding the path", 0):
            break
    assert told[0] == ("finding the path", 0) and {stage for stage, _ in told} == {"finding the path", "proving"}
    # The width of the interval around the least cost, in millionths: less than a hundredth.
    proved = [done for stage, done in told if stage == "proving"]
    assert proved == sorted(proved, reverse=True) and 0 < proved[-1] and proved[0] < 10_000


def test_other_threads_run_meanwhile() -> None:
    counted, done = 0, False

    def count() -> None:
        nonlocal counted
        while not done:
            counted += 1
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    begun = time.monotonic()
    large(0.0015).mesh()
    took = time.monotonic() - begun
    done = True
    counter.join()
    assert counted > 100 * took


def test_eight_threads_with_documents_of_their_own_and_with_one() -> None:
    expected = small().mesh().fingerprint
    with ThreadPoolExecutor(8) as pool:
        assert {mesh.fingerprint for mesh in pool.map(lambda _: small().mesh(threads=2), range(8))} == {expected}
        shared = small()

        def work(number: int) -> str:
            with shared.stroke(mb.Brush(radius=0.05, diameter=0.006)) if number % 4 == 0 else threading.Lock() as s:
                if number % 4 == 0:
                    s.line(np.random.default_rng(number).random((3, 2)))
            if number % 3 == 0:
                shared.update()
            mesh = shared.mesh(fresh=number % 2 == 0)
            assert mesh.violations() == 0 and mesh.locate(mesh.nodes[:10]).triangle.min() >= 0
            return mesh.fingerprint

        list(pool.map(work, range(16)))
        shared.update()
        assert shared.mesh().fingerprint == shared.mesh(fresh=True).fingerprint
        mesh = shared.mesh()
        assert len({id(nodes.base) and nodes.ctypes.data for nodes in pool.map(lambda _: mesh.nodes, range(8))}) == 1


def test_any_number_of_threads_gives_the_same_arrays() -> None:
    one, three = small().mesh(threads=1), small().mesh(threads=3)
    assert np.array_equal(one.nodes, three.nodes) and np.array_equal(one.triangles, three.triangles)
    with pytest.raises(mb.MeshError, match="1 thread at least"):
        small().mesh(threads=0)


def _on_several_threads() -> tuple[str, int]:
    mesh = small().mesh()
    return mesh.fingerprint, int(mesh.locate(np.tile(mesh.nodes, (20, 1))).triangle.min())


def _in_child(queue: Any) -> None:
    queue.put(_on_several_threads())


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are started anew here")
def test_a_forked_process_meshes_too() -> None:
    # The threads of this process, which the other one does not have.
    expected = _on_several_threads()
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=_in_child, args=(queue,))
    child.start()
    try:
        assert queue.get(timeout=30) == expected
    finally:
        child.kill()
        child.join()


def test_the_import_brings_numpy_and_nothing_else() -> None:
    code = "import sys, numpy; before = set(sys.modules); import meshbrush; print(*(set(sys.modules) - before))"
    new = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    own = {name.split(".")[0] for name in new} - set(sys.stdlib_module_names)
    assert own <= {"meshbrush", "numpy"}, own
