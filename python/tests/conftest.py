"""What the tests share: the command line, to compare with."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

#: The program that is compared with. Without one it is the command line of the module itself.
PROGRAM = os.environ.get("MESHBRUSH_PROGRAM")


def run_program(*arguments: Any, cwd: Path | None = None) -> str:
    """Runs the command line, and returns what it prints."""
    command = [PROGRAM] if PROGRAM else [sys.executable, "-m", "meshbrush"]
    done = subprocess.run([*command, *map(str, arguments)], cwd=cwd, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture
def summary_of(tmp_path: Path) -> Any:
    """Returns what `meshbrush mesh --json` says about a recipe, whose files are in `tmp_path`."""

    def summary(recipe: str) -> dict[str, Any]:
        (tmp_path / "recipe.toml").write_text(recipe)
        answer: dict[str, Any] = json.loads(run_program("mesh", "recipe.toml", "--json", cwd=tmp_path))
        return answer

    return summary
