"""The laboratory: trackers in one dimension, against exact free paths."""

from __future__ import annotations

import io
import json
import os
from collections.abc import Callable, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

from . import _freepath
from ._arrays import as_count
from ._freepath import Error
from ._reports import empty_figure, library, listed, write_text
from ._sampling import threads_of, walk_options


class Lab:
    """What was found out in the laboratory (docs/lab.md). Made by `lab`."""

    def __init__(self, core: _freepath.LabResult) -> None:
        self._core = core

    @cached_property
    def data(self) -> dict[str, Any]:
        """All findings, as lab.json of `freepath lab` has them; None: not a finite number."""
        return json.loads(self._core.json())  # type: ignore[no-any-return]

    @property
    def table(self) -> Any:
        """Data frame with a row for each number, as lab.csv: nine significant digits.

        Its columns are setting, tracker, channel, quantity, at (x, a weight, the value of an
        option), value, standard_error and exact; what there is not is NaN.
        """
        text = self._core.csv()
        return library("pandas").read_csv(io.StringIO(text))

    @property
    def verdicts(self) -> Any:
        """Data frame with a row for each tracker in each setting: its verdict, costs and variance."""
        keys = "tracker", "verdict", "biased", "paths", "lookups", "variance", "seconds"
        rows = [
            {"setting": setting["name"], **{key: measured.get(key) for key in keys}}
            for setting in self.data["settings"]
            for measured in setting["trackers"]
        ]
        return library("pandas").DataFrame(rows).set_index(["setting", "tracker"])

    def figure(
        self,
        setting: str,
        quantity: str = "scattered",
        *,
        trackers: str | Sequence[str] | None = None,
    ) -> Any:
        """Plot a quantity along the ray: each tracker's with its standard error, and what is exact.

        Args:
            setting: by its name.
            quantity: of `table`, one with values of `at`: "scattered", "collision_density",
                "weights_from", "sigma_s", ...
            trackers: those to show [all].

        Returns:
            A matplotlib.figure.Figure, with axes for each channel.

        Raises:
            Error: for a setting, quantity or tracker that there is nothing of.
        """
        table = self.table
        rows = table[(table["setting"] == setting) & table["at"].notna()]
        if not len(rows):
            raise Error(f"there is nothing of the setting {setting!r}")
        known = sorted(rows["quantity"].unique())
        rows = rows[rows["quantity"] == quantity]
        if not len(rows):
            raise Error(f"there is no quantity {quantity!r}; there are: {', '.join(known)}")
        if trackers is not None:
            rows = rows[rows["tracker"].isin(listed(trackers))]
            if not len(rows):
                raise Error(f"there is nothing of the trackers {', '.join(listed(trackers))}")
        channels = list(rows.groupby("channel", dropna=False))
        figure = empty_figure(4.5 * len(channels), 3.5)
        axes = figure.subplots(1, len(channels), squeeze=False)[0]
        for ax, (channel, of_channel) in zip(axes, channels):
            for tracker, line in of_channel.groupby("tracker", sort=False, dropna=False):
                error = line["standard_error"].fillna(0)
                label = tracker if isinstance(tracker, str) else quantity
                ax.plot(line["at"], line["value"], lw=1, label=label)
                ax.fill_between(
                    line["at"], line["value"] - error, line["value"] + error, alpha=0.3
                )
            if line["exact"].notna().any():
                ax.plot(line["at"], line["exact"], "k--", lw=1, label="exact")
            ax.set_title("" if len(channels) == 1 else f"channel {channel:g}")
            ax.set_xlabel("at")
        axes[0].set_ylabel(quantity)
        axes[0].legend(fontsize="small")
        return figure

    def save(self, folder: str | os.PathLike[str]) -> None:
        """Write the report of `freepath lab`: report.html, lab.json, lab.csv and the plots as .svg.

        Args:
            folder: made where it is missing.

        Raises:
            Error: if a file cannot be written.
        """
        try:
            Path(folder).mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise Error(f"{os.fspath(folder)}: can't be made: {error.strerror}") from None
        for name, content in self._core.files("freepath.lab"):
            write_text(Path(folder) / name, content)

    def _repr_html_(self) -> str:
        return self.verdicts.to_html()  # type: ignore[no-any-return]

    def __repr__(self) -> str:
        return f"<freepath.Lab of {', '.join(s['name'] for s in self.data['settings'])}>"


def lab(
    settings: str | Sequence[str] | None = None,
    *,
    trackers: str | Sequence[str] | None = None,
    paths: float = 4e5,
    absorption: str = "weighted",
    seed: int = 0,
    progress: Callable[[str, float], Any] | None = None,
    threads: int = 0,
) -> Lab:
    """Measure trackers where everything is known: in one dimension (docs/lab.md).

    The findings are those of `freepath lab` with the same options; but for times they depend on
    settings, trackers, paths, absorption and seed alone.

    Args:
        settings: by their names, as `lab_settings` lists them [all].
        trackers: methods with their options [all, and what [Kutz17] compares].
        paths: of each tracker, 1000 or more.
        absorption: "weighted" or "analog".
        seed: of the random numbers, 0 to 2^64 - 1.
        progress: called some times a second with what is being done and the fraction of all work
            that is done; False ends it with an Error.
        threads: to work on; 0: as many as the machine has.

    Returns:
        The findings: data frames, figures, a report.

    Raises:
        Error: for settings and trackers that do not exist, or are named twice.
        KeyboardInterrupt: at Ctrl-C; nothing is returned then.
    """
    names = [] if settings is None else listed(settings)
    for name in names:
        if name not in lab_settings():
            raise Error(f"there is no setting {name!r}; there are: {', '.join(lab_settings())}")
        if names.count(name) > 1:
            raise Error(f"the setting {name!r} is named twice")
    return Lab(
        _freepath.lab(
            names,
            [] if trackers is None else listed(trackers),
            as_count(paths, "paths", 1000, 10**12),
            walk_options(absorption=absorption, seed=seed),
            threads_of(threads),
            progress,
        )
    )


def lab_settings() -> dict[str, str]:
    """Return what `lab` can measure in: names, and what each shows."""
    return dict(_freepath.lab_settings())
