"""The command line: `python -m meshbrush`, and the command `meshbrush`."""

from __future__ import annotations

import os
import signal
import sys

from . import _core
from .window import bundled_program


def main() -> int:
    """Runs the program of the package, or the command line where the package has none. Returns the exit status."""
    program = bundled_program()
    if program is not None:
        command = [program, *sys.argv[1:]]
        if os.name == "nt":
            import subprocess

            return subprocess.call(command)
        os.execv(command[0], command)
    # As every program: Ctrl+C ends it. Python would only note the signal.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _core.main(["meshbrush", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
