"""Progress of long work."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from ._errors import MeshError

#: None or False for none; True for a bar of tqdm, or a line on standard error where there is no tqdm; or a function of
#: the stage and of what is done of it.
Progress = bool | Callable[[str, int], Any] | None


@contextmanager
def watching(progress: Progress, threads: int | None = None) -> Iterator[dict[str, Any]]:
    """Gives the compiled module what watches its work."""
    if threads is not None and not (isinstance(threads, int) and not isinstance(threads, bool) and 0 <= threads < 2**31):
        raise MeshError(f"threads = {threads!r}: write how many threads may work, from 1.")
    if progress is True:
        show, close = _bar()
        try:
            yield {"progress": show, "threads": threads}
        finally:
            close()
    else:
        yield {"progress": progress or None, "threads": threads}


def _bar() -> tuple[Callable[[str, int], None], Callable[[], None]]:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _line()
    bar = tqdm(unit="", unit_scale=True, leave=False)

    def show(stage: str, done: int) -> None:
        bar.set_description_str(stage, refresh=False)
        bar.n = done
        bar.refresh()

    return show, bar.close


def _line() -> tuple[Callable[[str, int], None], Callable[[], None]]:
    shown = False

    def show(stage: str, done: int) -> None:
        nonlocal shown
        shown = True
        sys.stderr.write(f"\r\x1b[K{stage}{f', {done:,}' if done else ''} …")
        sys.stderr.flush()

    def close() -> None:
        if shown:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()

    return show, close
