"""Coasts for tests: a bay with two islands, around a place in degrees or in metres."""

from __future__ import annotations

from typing import Any

import numpy as np


def ring(centre: tuple[float, float], radius: float, count: int, waves: int, seed: int) -> np.ndarray:
    """Returns a closed wavy line without the repeated last point."""
    rng = np.random.default_rng(seed)
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    wave = 1 + 0.15 * np.sin(waves * angle + rng.random()) + 0.05 * rng.random(count)
    return np.column_stack([centre[0] + radius * wave * np.cos(angle), centre[1] + radius * wave * np.sin(angle)])


def bay(scale: float = 1.0, at: tuple[float, float] = (0.0, 0.0)) -> list[np.ndarray]:
    """Returns rings: the coast, then the islands."""
    x, y = at
    return [
        ring((x, y), scale, 60, 5, 1),
        ring((x - 0.3 * scale, y + 0.2 * scale), 0.15 * scale, 16, 3, 2),
        ring((x + 0.35 * scale, y - 0.1 * scale), 0.2 * scale, 24, 4, 3),
    ]


def feature(rings: list[np.ndarray], name: str = "bay") -> dict[str, Any]:
    """Returns GeoJSON with one polygon that has a name."""
    closed = [[*ring.tolist(), ring[0].tolist()] for ring in rings]
    geometry = {"type": "Polygon", "coordinates": closed}
    return {
        "type": "FeatureCollection",
        "features": [{"type": "Feature", "properties": {"name": name}, "geometry": geometry}],
    }
