"""Showing how far a rendering is: on a terminal, and in Jupyter with a picture that grows."""

from __future__ import annotations

import sys
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _freepath
from ._render import Progress


def show_progress() -> Any:
    """Return a callback for `progress=` that suits where the program runs."""
    return _Notebook() if _in_notebook() else _Terminal()


def _in_notebook() -> bool:
    if "IPython" not in sys.modules:
        return False
    from IPython import get_ipython  # type: ignore[import-not-found]

    shell = get_ipython()
    return shell is not None and hasattr(shell, "kernel")


def _line(progress: Progress) -> str:
    total = f" of {progress.total:g}" if progress.total else ""
    return f"{progress.samples:.4g}{total} samples per pixel in {progress.seconds:.1f} s"


class _Terminal:
    """One line on standard error, where that is a terminal."""

    wants_pictures = False

    def __init__(self) -> None:
        self._is_shown = False

    def __call__(self, progress: Progress) -> None:
        if sys.stderr.isatty():
            print(f"\r{_line(progress)}\x1b[K", end="", file=sys.stderr, flush=True)
            self._is_shown = True

    def close(self) -> None:
        if self._is_shown:
            print(file=sys.stderr)


class _Notebook:
    """A line and the picture so far, in place of those before."""

    wants_pictures = True
    _SECONDS_BETWEEN = 0.5

    def __init__(self) -> None:
        from IPython.display import display  # type: ignore[import-not-found]

        self._handle = display({"text/plain": ""}, raw=True, display_id=True)
        self._image: NDArray[np.float32] | None = None
        self._last = 0.0

    def __call__(self, progress: Progress) -> None:
        if progress.image is not None:
            self._image = progress.image
        if time.monotonic() - self._last < self._SECONDS_BETWEEN:
            return
        self._last = time.monotonic()
        data: dict[str, Any] = {"text/plain": _line(progress)}
        if self._image is not None:
            data["image/png"] = _freepath.png_of_pixels(np.ascontiguousarray(self._image))
        else:
            data["text/html"] = _line(progress)
        self._handle.update(data, raw=True)

    def close(self) -> None:
        self._handle.update({"text/plain": ""}, raw=True)
