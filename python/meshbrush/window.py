"""The window: the program on a copy of a document."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from ._errors import MeshError

# What starts processes takes a third of the time of the import, and few scripts open a window.
if TYPE_CHECKING:
    from .document import Document


def _file_name(name: str) -> str:
    """Returns the name of the copy of a document, which the title of the window shows."""
    kept = "".join(letter for letter in name if letter.isalnum() or letter in " -_").strip()
    return f"{kept[:60] or 'document'}.meshbrush"


def bundled_program() -> str | None:
    """Returns the program with its window, if it came with the package."""
    name = "meshbrush.exe" if os.name == "nt" else "meshbrush"
    program = os.path.join(os.path.dirname(__file__), "bin", name)
    return program if os.path.isfile(program) else None


def _program() -> str:
    """Returns the program: that of the package, or the first on the PATH that is no script of a Python package."""
    import shutil
    import sysconfig

    bundled = bundled_program()
    if bundled is not None:
        return bundled
    scripts = os.path.realpath(sysconfig.get_path("scripts"))
    for folder in os.get_exec_path():
        found = shutil.which("meshbrush", path=folder)
        if found is not None and os.path.realpath(os.path.dirname(found)) != scripts and not _is_script(found):
            return found
    raise MeshError(
        "There is no window: this package was built without the program, and there is no program meshbrush on the PATH. "
        "Install it, for example with `cargo install --path .` in the source, or save the document and open it elsewhere."
    )


def _is_script(file: str) -> bool:
    with open(file, "rb") as start:
        return start.read(2) == b"#!"


def edited(document: bytes, name: str) -> bytes | None:
    """Opens the window on a document, waits, and returns the file if it was saved."""
    import subprocess
    import tempfile

    program = _program()
    with tempfile.TemporaryDirectory(prefix="meshbrush-") as folder:
        file = os.path.join(folder, _file_name(name))
        with open(file, "wb") as out:
            out.write(document)
        before = os.stat(file)
        status = subprocess.call([program, file])
        if status != 0:
            raise MeshError(f"The window ended with status {status}; what it says is above.")
        after = os.stat(file)
        if (before.st_mtime_ns, before.st_size, before.st_ino) == (after.st_mtime_ns, after.st_size, after.st_ino):
            return None
        with open(file, "rb") as saved:
            return saved.read()


class View:
    """A window on a copy of a document. It stays open when the script ends."""

    def __init__(self, document: Document) -> None:
        import subprocess
        import tempfile

        program = _program()
        self._document = document
        self._folder = tempfile.mkdtemp(prefix="meshbrush-")
        self._file = os.path.join(self._folder, _file_name(document.options["name"]))
        self.reload()
        # Ctrl+C in the terminal of the script is not for the window.
        self._process = subprocess.Popen([program, self._file], start_new_session=True)

    def reload(self) -> None:
        """Saves the document as it is now into the file of the window, for *Open* there."""
        self._document.save(self._file)

    @property
    def is_open(self) -> bool:
        """Whether the window is open."""
        return self._process.poll() is None

    def close(self) -> None:
        """Closes the window, without saving, and removes its copy."""
        import shutil

        if self.is_open:
            self._process.terminate()
        self._process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)


def shown(document: Document) -> View:
    """Opens the window on a copy of a document."""
    return View(document)
