"""Writes the grids of the examples as GeoTIFF, without a library."""

import struct
import zlib


def packed(values):
    """Returns rows as 16-bit numbers less the one before, packed."""
    pairs = ((row, [0, *row[:-1]]) for row in values)
    steps = [(a - b) % 65536 for row, before in pairs for a, b in zip(row, before)]
    return zlib.compress(struct.pack(f"<{len(steps)}H", *steps), 9)


def write(west, north, step, values, file):
    """Writes a GeoTIFF of longitudes and latitudes (EPSG:4326) with one whole number at each node, rows from the north."""
    strip = packed(values)
    keys = [1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 2, 2048, 0, 1, 4326]
    entries = [
        (256, "H", [len(values[0])]),
        (257, "H", [len(values)]),
        (258, "H", [16]),
        (259, "H", [8]),  # Deflate
        (262, "H", [1]),
        (273, "I", [8]),
        (277, "H", [1]),
        (278, "H", [len(values)]),
        (279, "I", [len(strip)]),
        (317, "H", [2]),  # differences along rows
        (339, "H", [1]),
        (33550, "d", [step, step, 0.0]),
        (33922, "d", [0.0, 0.0, 0.0, west, north, 0.0]),
        (34735, "H", keys),
    ]
    strip += b"\0" * (len(strip) % 2)
    directory, data = [struct.pack("<H", len(entries))], b""
    behind = 8 + len(strip) + 2 + 12 * len(entries) + 4
    for tag, kind, numbers in entries:
        value = struct.pack(f"<{len(numbers)}{kind}", *numbers)
        if len(value) > 4:
            place, data = struct.pack("<I", behind + len(data)), data + value
        else:
            place = value.ljust(4, b"\0")
        directory.append(struct.pack("<HHI", tag, {"H": 3, "I": 4, "d": 12}[kind], len(numbers)) + place)
    head = struct.pack("<2sHI", b"II", 42, 8 + len(strip))
    file.write_bytes(head + strip + b"".join(directory) + struct.pack("<I", 0) + data)
