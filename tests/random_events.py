#!/usr/bin/env python3
"""Random pointer and key events for the real window on a virtual display.

    cargo build --release
    python3 tests/random_events.py [PROGRAM [MINUTES [SEED [DOCUMENT]]]]

PROGRAM is target/release/meshbrush if none is named. MINUTES (60) are shared among four documents: a painted one, a
sea with islands, one with every kind of layer, and threats with a path. DOCUMENT, a name among those below, takes
all of them. Needs Xvfb and xdotool.
Fails if the program ends, panics, does not come to rest within a minute after a burst of events, draws frames at rest,
or shows a failure that Escape does not dismiss; the window's picture is then in target/tmp/random_events.png, and
its journal, from which the document can be opened again, in target/tmp/random_events. Prints for each document the events, the longest wait, and the memory at the start, the
most and at the end.
"""

import os
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
import time
import zlib

SIZE = (1440, 900)
DOCUMENTS = ["Radar threats", "Aegean Sea", "Layers on a terrain", "Threats and a path"]
BURST = 12  # events
PATIENCE_S = 60
MEMORY_RETURNED_S = 5  # after the window came to rest
MOST_MEMORY_BYTES = 12 * 2**30
NOTED_GROWTH_BYTES = 300 * 2**20

PLAIN_KEYS = list("abcdefghijklmnopqrstuvwxyz0123456789") + [
    "bracketleft", "bracketright", "comma", "period", "slash", "plus", "minus", "space", "Tab", "Return", "Escape",
    "Escape", "Delete", "BackSpace", "Left", "Right", "Up", "Down", "Home", "End", "Prior", "Next",
    "F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "F9", "F10", "F11", "F12",
]
CHORDS = ["ctrl", "shift", "alt", "ctrl+shift"]
# These end the program or leave the window.
FORBIDDEN = {"ctrl+q", "alt+F4", "ctrl+alt+BackSpace"}
TEXTS = ["0.01", "2 km", "1e300", "-5", "nan", "x^2+y", "0.05+0.1*x", "ζ", "layer", "gradation", "", "9" * 400]


class Window:
    """The program on a display of its own, with what it reports on standard error."""

    def __init__(self, program, scratch):
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", "1", "-nolisten", "tcp", "-noreset", "-fbdir", scratch, "-screen", "0",
             "%dx%dx24" % SIZE],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        display = ":" + self.server.stdout.readline().strip()
        self.environment = {k: v for k, v in os.environ.items() if not k.startswith(("WAYLAND", "XDG"))}
        self.environment |= {"DISPLAY": display, "MESHBRUSH_FRAMES": "1", "WINIT_X11_SCALE_FACTOR": "1"}
        for variable in ("DATA_HOME", "CONFIG_HOME", "CACHE_HOME", "RUNTIME_DIR"):
            self.environment["XDG_" + variable] = scratch
        self.scratch = scratch
        self.screen = os.path.join(scratch, "Xvfb_screen0")
        self.last_frame, self.rests, self.message, self.said = 0.0, False, "none", []
        self.triangles, self.most_triangles = 0, 0
        self.program = subprocess.Popen([program], env=self.environment, cwd=scratch, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.PIPE, text=True)
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        for line in self.program.stderr:
            words = line.split(maxsplit=3)
            if words[:1] == ["frame"]:
                self.last_frame, self.rests = float(words[1]), words[3].strip() == "at rest"
                self.triangles = int(words[2])
                self.most_triangles = max(self.most_triangles, self.triangles)
            elif words[:1] == ["message"]:
                self.message = line[len("message "):].strip()
            else:
                self.said = (self.said + [line])[-50:]

    def xdotool(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True, capture_output=True)

    def wait_until_shown(self):
        deadline = time.time() + PATIENCE_S
        while time.time() < deadline:
            found = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "Meshbrush$"],
                                   env=self.environment, capture_output=True, text=True).stdout.split()
            if found:
                self.xdotool("windowsize", found[0], *SIZE, "windowfocus", found[0])
                return
            time.sleep(0.2)
        self.fail("the window did not open")

    def memory_bytes(self):
        try:
            with open(f"/proc/{self.program.pid}/status") as status:
                return next(int(line.split()[1]) * 1024 for line in status if line.startswith("VmRSS"))
        except (OSError, StopIteration):
            return 0

    def check_alive(self):
        if self.program.poll() is not None or any("panicked" in line for line in self.said):
            self.fail(f"the program ended with {self.program.poll()}")

    def settle(self):
        """Waits until the mesh agrees with the document. Returns how long that took, in seconds."""
        start = time.time()
        while time.time() - start < PATIENCE_S:
            self.check_alive()
            idle = time.time() - max(start, self.last_frame)
            # A mesh that stops short of its document says so. Something may be moving, such as played steps.
            if (self.rests or self.message != "none") and (idle > 0.5 or time.time() - start > 10):
                return time.time() - start
            time.sleep(0.05)
        self.fail(f"the mesh did not come to rest within {PATIENCE_S} s, at {self.triangles} triangles")

    def fail(self, why):
        print("".join(self.said), file=sys.stderr)
        os.makedirs("target/tmp", exist_ok=True)
        write_picture(self.screen, "target/tmp/random_events.png")
        shutil.copytree(self.scratch, "target/tmp/random_events", dirs_exist_ok=True)
        print(f"FAILED: {why}; message: {self.message}; the last events: {self.last_events}", file=sys.stderr)
        sys.exit(1)

    last_events = []

    def close(self):
        self.program.kill()
        self.program.wait()
        self.server.kill()
        self.server.wait()


def write_picture(screen, path):
    """Writes the display's memory (XWD format, 32 bits a pixel) as a PNG."""
    with open(screen, "rb") as file:
        data = file.read()
    header_size, colors, row_bytes = (struct.unpack_from(">I", data, at)[0] for at in (0, 76, 48))
    start = header_size + 12 * colors
    rows = []
    for y in range(SIZE[1]):
        row = data[start + y * row_bytes:][:4 * SIZE[0]]
        rgb = bytearray(3 * SIZE[0])
        rgb[0::3], rgb[1::3], rgb[2::3] = row[2::4], row[1::4], row[0::4]
        rows.append(b"\0" + bytes(rgb))

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", *SIZE, 8, 2, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(b"".join(rows))) + chunk(b"IEND", b""))


def place(rng):
    return rng.randrange(2, SIZE[0] - 2), rng.randrange(2, SIZE[1] - 2)


def canvas_place(rng):
    return rng.randrange(60, 1060), rng.randrange(100, 840)


def random_event(rng):
    """Words for xdotool that do one thing a person could do, and leave no button or key pressed."""
    kind = rng.choices(["click", "stroke", "drag", "wheel", "key", "chord", "text", "double"],
                       [25, 18, 8, 10, 18, 12, 3, 4])[0]
    if kind == "click":
        button = rng.choices([1, 2, 3], [8, 1, 2])[0]
        return ["mousemove", *place(rng), "click", button]
    if kind == "double":
        return ["mousemove", *place(rng), "click", "--repeat", 2, "--delay", 30, 1]
    if kind in ("stroke", "drag"):
        at = canvas_place if kind == "stroke" else place
        modifier = rng.choices([None, "ctrl", "shift", "alt", "space"], [12, 1, 1, 1, 1])[0]
        words = ["mousemove", *at(rng)] + (["keydown", modifier] if modifier else []) + ["mousedown", 1]
        for _ in range(rng.randrange(1, 6)):
            words += ["mousemove", *at(rng), "sleep", 0.01]
        if rng.random() < 0.2:
            words += ["key", rng.choice(PLAIN_KEYS)]
        return words + ["mouseup", 1] + (["keyup", modifier] if modifier else [])
    if kind == "wheel":
        modifier = ["keydown", "ctrl"] if rng.random() < 0.3 else []
        words = ["mousemove", *place(rng), *modifier, "click", "--repeat", rng.randrange(1, 5), rng.choice([4, 5])]
        return words + (["keyup", "ctrl"] if modifier else [])
    if kind == "key":
        return ["key", rng.choice(PLAIN_KEYS)]
    if kind == "chord":
        chord = rng.choice(CHORDS) + "+" + rng.choice(PLAIN_KEYS)
        return [] if chord in FORBIDDEN else ["key", chord]
    return ["type", "--delay", 2, "--", rng.choice(TEXTS)]


def open_example(window, name):
    """Through the palette, as a person would."""
    window.xdotool("key", "Escape", "key", "Escape", "key", "Escape")
    window.xdotool("key", "ctrl+p", "sleep", 0.5, "type", "--delay", 5, name)
    window.xdotool("sleep", 0.5, "key", "Return", "sleep", 1.0)
    window.settle()


def megabytes(size):
    return f"{size / 2**20:.0f} MB"


def torment(window, rng, document, seconds):
    open_example(window, document)
    first_memory, most_memory, longest, events = window.memory_bytes(), 0, 0.0, 0
    end = time.time() + seconds
    while time.time() < end:
        burst = [random_event(rng) for _ in range(BURST)]
        window.last_events = burst
        for event in filter(None, burst):
            window.check_alive()
            window.xdotool(*event)
            events += 1
        longest = max(longest, window.settle())
        memory = window.memory_bytes()
        if memory > most_memory + NOTED_GROWTH_BYTES and most_memory > 0:
            print(f"  memory {megabytes(most_memory)} to {megabytes(memory)} at {window.triangles} triangles, after "
                  f"{burst}", flush=True)
        most_memory = max(most_memory, memory)
        if most_memory > MOST_MEMORY_BYTES:
            window.fail(f"the program uses {megabytes(most_memory)}")
    for _ in range(12):
        window.xdotool("key", "Escape", "sleep", 0.2)
    window.xdotool("mousemove", SIZE[0] // 2, SIZE[1] // 2, "sleep", 1)
    window.settle()
    time.sleep(MEMORY_RETURNED_S)
    last_frame = window.last_frame
    time.sleep(MEMORY_RETURNED_S)
    if window.last_frame != last_frame:
        window.fail("frames are drawn while nothing happens")
    if window.message.startswith("failed"):
        window.fail("a message is left that Escape does not dismiss")
    print(f"{document:20} {events:6} events, longest wait {longest:.1f} s, at most {window.most_triangles} triangles, "
          f"memory {megabytes(first_memory)} at the start, {megabytes(most_memory)} at most, "
          f"{megabytes(window.memory_bytes())} at the end", flush=True)


def main():
    for tool in ("Xvfb", "xdotool"):
        if shutil.which(tool) is None:
            sys.exit(f"{tool} is missing")
    program = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "target/release/meshbrush")
    minutes = float(sys.argv[2]) if len(sys.argv) > 2 else 60.0
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else random.randrange(10**6)
    print(f"seed {seed}", flush=True)
    documents = [document for document in DOCUMENTS if document in (sys.argv[4:] or DOCUMENTS)]
    for number, document in enumerate(documents):
        with tempfile.TemporaryDirectory() as scratch:
            window = Window(program, scratch)
            try:
                window.wait_until_shown()
                torment(window, random.Random(seed + number), document, 60 * minutes / len(documents))
            finally:
                window.close()


if __name__ == "__main__":
    main()
