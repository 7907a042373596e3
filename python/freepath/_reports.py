"""What reports have in common: data frames, figures and files."""

from __future__ import annotations

import importlib
import os
import tempfile
from typing import Any

from ._freepath import Error


def library(name: str) -> Any:
    """Return a module that is needed for reports alone.

    Raises:
        Error: where it is not installed, saying how to get it.
    """
    try:
        return importlib.import_module(name)
    except ImportError:
        package = name.partition(".")[0]
        raise Error(
            f"data frames and figures need {package}, which is not installed: "
            "pip install 'freepath[reports]'"
        ) from None


def empty_figure(width: float, height: float) -> Any:
    """Return a matplotlib.figure.Figure [inches] that no window and no global state knows of."""
    return library("matplotlib.figure").Figure(figsize=(width, height), layout="constrained")


def listed(names: Any) -> list[str]:
    """Return names as a list, of which a text is one."""
    return [names] if isinstance(names, str) else [str(name) for name in names]


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write a text file aside and rename it, so that there is never a part of it under its name.

    Raises:
        Error: naming the file, if it can't be written.
    """
    path = os.fspath(path)
    aside = None
    try:
        with tempfile.NamedTemporaryFile(
            "w", dir=os.path.dirname(path) or ".", prefix=".", encoding="utf-8", delete=False
        ) as file:
            aside = file.name
            file.write(text)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(aside, 0o666 & ~mask)
        os.replace(aside, path)
    except OSError as error:
        if aside is not None:
            os.unlink(aside)
        raise Error(f"{path}: can't be written: {error.strerror}") from None
