#!/usr/bin/env python3
"""Frame times of the real window on a virtual display.

    cargo build --release
    python3 tests/frame_times.py [PROGRAM [TRIANGLES...]]

PROGRAM is target/release/meshbrush if none is named. TRIANGLES choose among the meshes below, as in `34k 2.4M`;
`layers` has eight layers, the last one painted, and `coast` nodes on an outline of 40,000 corners.
Needs Xvfb and xdotool. A frame takes the time from the end of one frame's drawing to the end of the next while the
pointer reports 250 positions a second (120 while painting). Printed: the median and the 95th percentile in
milliseconds; for a fast stroke the time from its end until the mesh is at rest, and that of the frames meanwhile.
"""

import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
import time


def wave(fine, height):
    """A square that is fine below a wave, so that strokes cross fine and coarse parts."""
    return f"if(y < {height} + 0.1 * sin(7 * x), {fine}, 0.2)"


def write_recipe(folder, text):
    path = os.path.join(folder, "mesh.toml")
    with open(path, "w") as file:
        file.write(text)
    return path


def fine_below(height, fine=0.0011):
    """The part of a recipe that decides how large the mesh is."""
    return f"""
[mesh]
spacing = 0.05
[limits]
h_min = {0.7 * fine}
h_risk = {fine}
h_max = 0.2
[[layer]]
kind = "formula"
quantity = "diameter"
formula = "{wave(fine, height)}"
"""


def write_plain(folder, fine, height):
    return write_recipe(folder, fine_below(height, fine))


def write_layers(folder):
    """A recipe of seven layers, to which one is added to be painted on."""
    side = 512
    shares = [(n + 0.5) / side for n in range(side)]
    rows = [" ".join(f"{0.5 + 0.5 * math.sin(9 * x) * math.cos(11 * y):.4f}" for x in shares) for y in shares]
    with open(os.path.join(folder, "hills.asc"), "w") as file:
        header = f"ncols {side}\nnrows {side}\nxllcorner 0\nyllcorner 0\ncellsize {1 / side}\n"
        file.write(header + "\n".join(rows) + "\n")
    threats = ", ".join(
        "{ x = %.3f, y = %.3f, range = 0.02, peak = 0.7 }" % (n * 0.618 % 1, n * 0.414 % 1) for n in range(1, 100))
    return write_recipe(folder, fine_below(0.45) + f"""
[[layer]]
kind = "raster"
file = "hills.asc"
curve = [[0.5, 0.2], [1.0, 0.01]]
[[layer]]
kind = "band"
file = "hills.asc"
between = [0.9, 0.95]
diameter = 0.02
[[layer]]
kind = "distance"
shapes = [{{ line = [[0.05, 0.9], [0.4, 0.7], [0.95, 0.85]] }}]
at_zero = 0.005
slope = 0.3
range = 0.2
[[layer]]
kind = "threats"
threats = [{threats}]
[[layer]]
kind = "formula"
quantity = "diameter"
formula = "0.01"
combine = "floor"
mask = [[[[0.7, 0.1], [0.9, 0.12], [0.85, 0.3], [0.72, 0.25]]]]
[[layer]]
kind = "formula"
quantity = "risk"
formula = "0.5 * exp(-40 * ((x - 0.5)^2 + (y - 0.8)^2))"
""")


def write_coast(folder):
    """A lake with an island, and bays of several sizes."""
    def ring(radius):
        angles = [n / 20_000 * math.tau for n in range(20_000)]
        radii = [radius + 0.01 * math.sin(99 * a) + 0.0005 * math.sin(4999 * a) for a in angles]
        ring = [[0.5 + r * math.cos(a), 0.5 + r * math.sin(a)] for a, r in zip(angles, radii)]
        return [*ring, ring[0]]

    with open(os.path.join(folder, "lake.geojson"), "w") as file:
        json.dump({"type": "Polygon", "coordinates": [ring(0.48), ring(0.25)]}, file)
    return write_recipe(folder, fine_below(0.65) + """
[domain]
region = "lake.geojson"
boundary = "outline"
boundary_diameter = 0.0011
""")


# Diameter and height of the fine part; a stroke asks for less.
MESHES = {
    "34k": lambda folder: write_plain(folder, 0.00625, 0.3),
    "1.5M": lambda folder: write_plain(folder, 0.00125, 0.45),
    "2.4M": lambda folder: write_plain(folder, 0.00088, 0.36),
    "layers": write_layers,
    "coast": write_coast,
}

SIZE = (1440, 900)
# Within the canvas, whatever the exact sizes of the panels.
LEFT, RIGHT, TOP, BOTTOM = 250, 950, 130, 770
PATIENCE_S = 30


class Window:
    """The program on a display of its own, and the frames that it has told of."""

    def __init__(self, program, project, scratch):
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", "1", "-nolisten", "tcp", "-noreset", "-screen", "0", "%dx%dx24" % SIZE],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        display = ":" + self.server.stdout.readline().strip()
        self.environment = {k: v for k, v in os.environ.items() if not k.startswith(("WAYLAND", "XDG"))}
        self.environment |= {"DISPLAY": display, "MESHBRUSH_FRAMES": "1", "WINIT_X11_SCALE_FACTOR": "1"}
        for variable in ("DATA_HOME", "CONFIG_HOME", "CACHE_HOME", "RUNTIME_DIR"):
            self.environment["XDG_" + variable] = scratch
        self.frames = []
        self.program = subprocess.Popen([program, project], env=self.environment, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.PIPE, text=True)
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        for line in self.program.stderr:
            words = line.split(maxsplit=3)
            if words[:1] == ["frame"]:
                self.frames.append((float(words[1]), int(words[2]), words[3].strip() == "at rest"))
            elif "panicked" in line:
                print(line, file=sys.stderr)

    def xdotool(self, *words):
        return subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True,
                              capture_output=True, text=True).stdout

    def focus(self):
        deadline = time.time() + PATIENCE_S
        while time.time() < deadline:
            try:
                found = self.xdotool("search", "--onlyvisible", "--name", "Meshbrush$").split()
                self.xdotool("windowfocus", found[0])
                return
            except (subprocess.CalledProcessError, IndexError):
                time.sleep(0.2)
        sys.exit("the window did not open")

    def settle(self):
        """Waits until nothing was drawn for half a second; the mesh is then at rest."""
        deadline = time.time() + PATIENCE_S
        while time.time() < deadline:
            last, triangles, rests = (self.frames or [(0, 0, False)])[-1]
            # Before the project is read, the window shows fewer.
            if rests and triangles > 10_000 and time.time() - last > 0.5:
                return
            time.sleep(0.1)
        sys.exit("the mesh did not come to rest")

    def during(self, *words):
        """Runs xdotool, and returns the times of the frames meanwhile."""
        start = time.time()
        self.xdotool(*words)
        end = time.time()
        return [at for at, _, _ in self.frames if start <= at <= end]

    def at_rest_after(self, moment):
        """The time at which the first frame with the complete mesh was drawn, and the frames until then."""
        deadline = time.time() + PATIENCE_S
        while time.time() < deadline:
            rests = next((at for at, _, rests in self.frames if at > moment and rests), None)
            if rests is not None:
                return rests, [at for at, _, _ in self.frames if moment <= at <= rests]
            time.sleep(0.02)
        sys.exit("the mesh did not come to rest")

    def close(self):
        self.program.kill()
        self.program.wait()
        self.server.kill()
        self.server.wait()


def moves(points, pause_s):
    return [word for x, y in points for word in ("mousemove", round(x), round(y), "sleep", pause_s)]


def zigzag(count, across):
    """Points from left to right and back, `across` times, downwards all the while."""
    for i in range(count):
        share = i / (count - 1)
        phase = share * across % 2
        yield LEFT + (RIGHT - LEFT) * min(phase, 2 - phase), TOP + (BOTTOM - TOP) * share


def line(start, end, count):
    return [tuple(a + (b - a) * i / count for a, b in zip(start, end)) for i in range(count + 1)]


def intervals_ms(times):
    return [1e3 * (b - a) for a, b in zip(times, times[1:])]


def measured(name, times_ms):
    ordered = sorted(times_ms)
    median = statistics.median(ordered) if ordered else float("nan")
    late = ordered[int(0.95 * (len(ordered) - 1))] if ordered else float("nan")
    print(f"  {name:12} {median:6.1f} ms   95 %: {late:6.1f} ms   {len(ordered)} frames", flush=True)


def undo(window):
    window.xdotool("key", "ctrl+z")
    time.sleep(0.2)
    window.settle()


def add_paint_layer(window):
    """Through the palette, as a person would: a recipe has no paint."""
    window.xdotool("key", "ctrl+p", "sleep", 0.5, "type", "--delay", 5, "add layer: paint as risk")
    window.xdotool("sleep", 0.5, "key", "Return")
    time.sleep(0.5)
    window.settle()


def measure(window):
    add_paint_layer(window)
    window.xdotool("key", "b")
    window.xdotool("mousemove", LEFT, TOP)
    window.settle()
    measured("hover", intervals_ms(window.during(*moves(zigzag(500, 3), 0.004))))
    window.settle()
    middle = ((LEFT + RIGHT) / 2, (TOP + BOTTOM) / 2)
    pan = moves(line(middle, (middle[0] - 200, middle[1] - 150), 250), 0.004)
    pan += moves(line((middle[0] - 200, middle[1] - 150), middle, 250), 0.004)
    window.xdotool("mousemove", *map(round, middle))
    measured("pan", intervals_ms(window.during("mousedown", 2, *pan, "mouseup", 2)))
    window.settle()
    stroke = list(zigzag(240, 3))
    window.xdotool("mousemove", *map(round, stroke[0]))
    triangles = window.frames[-1][1]
    measured("paint", intervals_ms(window.during("mousedown", 1, *moves(stroke, 0.008), "mouseup", 1)))
    window.settle()
    if window.frames[-1][1] == triangles:
        sys.exit("the stroke painted nothing")
    undo(window)
    measure_fast_strokes(window)


def measure_fast_strokes(window):
    rests_ms, frames_ms = [], []
    for height in (0.2, 0.5, 0.8):
        y = TOP + height * (BOTTOM - TOP)
        stroke = line((LEFT, y), (RIGHT, y - 60), 20)
        window.xdotool("mousemove", *map(round, stroke[0]))
        window.settle()
        window.xdotool("mousedown", 1, *moves(stroke, 0.008), "mouseup", 1)
        end = time.time()
        rests, frames = window.at_rest_after(end)
        rests_ms.append(1e3 * (rests - end))
        frames_ms += intervals_ms([end, *frames])
        window.settle()
        undo(window)
    each = ", ".join(f"{ms:.0f}" for ms in rests_ms)
    print(f"  fast stroke  at rest after {statistics.median(rests_ms):.0f} ms ({each})", flush=True)
    measured("  meanwhile", frames_ms)


def main():
    for tool in ("Xvfb", "xdotool"):
        if shutil.which(tool) is None:
            sys.exit(f"{tool} is missing")
    program = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "target/release/meshbrush")
    for name in sys.argv[2:] or MESHES:
        with tempfile.TemporaryDirectory() as scratch:
            window = Window(program, MESHES[name](scratch), scratch)
            try:
                window.focus()
                window.settle()
                print(f"{name}: {window.frames[-1][1]} triangles", flush=True)
                measure(window)
            finally:
                window.close()


if __name__ == "__main__":
    main()
