"""Mesh generation by local bisection: say where detail matters, and the mesh follows.

    >>> import meshbrush as mb
    >>> document = mb.Document(mb.Domain.rectangle(0, 0, 1, 1), spacing=0.1, h_min=0.005)
    >>> layer = document.layers.formula("0.01 + 0.2*hypot(x - 0.3, y - 0.4)")
    >>> mesh = document.mesh()
    >>> mesh.nodes.shape[1], mesh.triangles.shape[1]
    (2, 3)

A `Document` is what is edited: a `Domain`, layers that say how large triangles may be, and limits. Its `mesh()` is a
`Mesh`, whose attributes are arrays.
"""

from ._core import Change, __version__
from ._errors import FileError, FormulaError, MeshbrushWarning, MeshError
from .document import Brush, Document, open, read_recipe
from .domain import Domain
from .layers import Layer, Layers
from .mesh import Located, Mesh, Place, Why
from .paths import Path
from .rasters import sample
from .solution import Solution
from .window import View

__all__ = [
    "Brush",
    "Change",
    "Document",
    "Domain",
    "FileError",
    "FormulaError",
    "Layer",
    "Layers",
    "Located",
    "Mesh",
    "MeshError",
    "MeshbrushWarning",
    "Path",
    "Place",
    "Solution",
    "View",
    "Why",
    "__version__",
    "open",
    "read_recipe",
    "sample",
]
