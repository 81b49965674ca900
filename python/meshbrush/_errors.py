"""The errors of the package. Their texts are sentences for a person."""

from __future__ import annotations

from typing import Any


class MeshError(ValueError):
    """A value cannot be used, or there is no such mesh."""


class FormulaError(MeshError):
    """A formula has a mistake. The text ends with the formula and carets under the mistake."""

    formula: str
    """The formula as it was given."""
    position: int
    """The place of the mistake in it, counted in characters from 0."""

    def __init__(self, sentence: str, formula: str = "", position: int = 0) -> None:
        super().__init__(sentence)
        self.formula = formula
        self.position = position

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (self.args[0], self.formula, self.position))


class FileError(OSError):
    """A file cannot be read or written. `errno` is the number of the system, as `errno.ENOENT`, where it has one."""

    def __init__(self, sentence: str, errno: int | None = None) -> None:
        super().__init__(sentence)
        self.errno = errno

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (self.args[0], self.errno))


class MeshbrushWarning(UserWarning):
    """Something that a person should know, though the work goes well."""
