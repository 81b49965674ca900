"""The package: types, command line, window, documentation."""

from __future__ import annotations

import os
import re
import stat
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import meshbrush as mb
from meshbrush import window

ROOT = Path(__file__).parents[2]


def run(*arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, **options)


def test_stubs_are_those_of_the_module() -> None:
    pytest.importorskip("mypy")
    environment = {**os.environ, "MYPYPATH": str(Path(mb.__file__).parents[1])}
    command = ("-m", "mypy.stubtest", "meshbrush._core", "--mypy-config-file", "pyproject.toml")
    done = run(*command, cwd=ROOT, env=environment)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Success" in done.stdout


def test_types_are_strict() -> None:
    pytest.importorskip("mypy")
    done = run("-m", "mypy", cwd=ROOT)
    assert done.returncode == 0, done.stdout + done.stderr


def test_all_names_are_documented() -> None:
    for name in mb.__all__:
        thing = getattr(mb, name)
        if isinstance(thing, type) and name not in ("Change",):
            assert thing.__doc__, name
            for member, value in vars(thing).items():
                is_public = not member.startswith("_") and (callable(value) or isinstance(value, property))
                assert not is_public or value.__doc__, f"{name}.{member}"


def test_the_command_line_runs() -> None:
    shown = run("-m", "meshbrush", "--version")
    assert shown.returncode == 0 and shown.stdout.strip() == f"meshbrush {mb.__version__}"
    wrong = run("-m", "meshbrush", "mesh", "--spacing", "-1")
    assert wrong.returncode == 2 and "--spacing -1" in wrong.stderr
    if window.bundled_program() is None:
        without = run("-m", "meshbrush")
        assert without.returncode == 2 and "without its window" in without.stderr
    script = Path(sys.executable).with_name("meshbrush.exe" if os.name == "nt" else "meshbrush")
    done = subprocess.run([script, "--version"], capture_output=True, text=True)
    assert done.stdout == shown.stdout


@pytest.fixture
def program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A program in place of the window: it makes the layers of the document half as fine, and saves it."""
    file = tmp_path / "program"
    file.write_text(
        f"#!{sys.executable}\nimport sys, meshbrush as mb\nd = mb.open(sys.argv[1])\n"
        "d.layers.formula(0.04, name='by hand')\n"
        "if d.options['name'] != 'leave':\n    d.save(sys.argv[1])\nsys.exit(d.options['name'] == 'fail')\n"
    )
    file.chmod(file.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setattr(window, "_program", lambda: str(file))
    return file


def document(name: str) -> mb.Document:
    return mb.Document(mb.Domain.rectangle(0, 0, 1, 1), name=name)


@pytest.mark.skipif(os.name == "nt", reason="the stand-in is a script")
def test_a_document_is_edited_in_the_window(program: Path) -> None:
    edited = document("change").edit()
    assert edited is not None and [layer.name for layer in edited.layers] == ["by hand"]
    assert document("leave").edit() is None
    with pytest.raises(mb.MeshError, match="status 1"):
        document("fail").edit()


@pytest.mark.skipif(os.name == "nt", reason="the stand-in is a script")
def test_a_document_is_shown_in_the_window(program: Path) -> None:
    shown = document("leave")
    view = shown.show()
    shown.layers.formula(0.5, name="later")
    view.reload()
    file = view._file
    assert [layer.name for layer in mb.open(file).layers][0] == "later"
    view.close()
    assert not view.is_open and not Path(file).exists()


def test_without_a_window_a_sentence_says_so(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    if window.bundled_program() is not None:
        pytest.skip("the package has its program")
    # The script of the package on the PATH has no window.
    script = tmp_path / "meshbrush"
    script.write_text("#!/usr/bin/python3\n")
    script.chmod(0o755)
    monkeypatch.setenv("PATH", os.pathsep.join([str(Path(sys.executable).parent), str(tmp_path)]))
    for open_window in (document("a").edit, document("a").show):
        with pytest.raises(mb.MeshError, match="There is no window"):
            open_window()


def examples() -> list[Any]:
    """Returns the examples of the pages: every block of Python, with the heading above it."""
    found = []
    for page in ("docs/python.md", "README.md"):
        text = (ROOT / page).read_text()
        for block in re.finditer(r"^```python\n(.*?)^```$", text, re.DOTALL | re.MULTILINE):
            headings = re.findall(r"^#+ (.*)$", text[: block.start()], re.MULTILINE)
            found.append(pytest.param(block.group(1), id=f"{page}: {headings[-1] if headings else page}"))
    return found


@pytest.mark.parametrize("code", examples())
def test_examples_of_the_documentation_run(code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for package in re.findall(r"^(?:import|from) (\w+)", code, re.MULTILINE):
        pytest.importorskip(package)
    (tmp_path / "assets").symlink_to(ROOT / "assets")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    exec(compile(code, "example", "exec"), {"__name__": "example"})


def test_the_example_of_the_module_runs() -> None:
    import doctest

    assert doctest.testmod(mb).failed == 0
