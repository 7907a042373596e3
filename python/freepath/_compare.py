"""Methods measured against each other on one picture."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Sequence
from datetime import datetime, timezone
from functools import cached_property
from typing import Any

import numpy as np

from . import _freepath
from ._arrays import as_count
from ._freepath import Error
from ._picture_options import facts_of, picture_options
from ._reports import empty_figure, library, listed, write_text
from ._scene import Scene

Progress = Callable[[str, float], Any]
"""Called with the name of a step and the fraction of all work that is done; False ends it."""


class Comparison:
    """What came of methods that were measured against each other (docs/compare.md).

    Made by `compare`. In Jupyter it shows its table.
    """

    def __init__(self, core: _freepath.Comparison, target: str, machine: str, date: str) -> None:
        self._core = core
        self._origin = target, machine, date

    @cached_property
    def data(self) -> dict[str, Any]:
        """All that was measured, as compare.json of `freepath compare` has it; None: not known."""
        return json.loads(self._core.json(*self._origin))  # type: ignore[no-any-return]

    @property
    def findings(self) -> list[str]:
        """Short lines on what came out: the most efficient method, and which tests failed."""
        return list(self.data["findings"])

    @property
    def table(self) -> Any:
        """Data frame with a row for each method, by its name: means over runs.

        Beside `mse` stand `mse_low` and `mse_high`, the ends of its interval of 95 %, and so with
        the others. Efficiencies are over that of `data["baseline"]`.
        """
        rows = []
        for entry in self.data["configurations"]:
            row: dict[str, Any] = {}
            for key, value in entry.items():
                if key == "efficiency" or (isinstance(value, dict) and "low" in value):
                    value = value or {"value": None, "low": None, "high": None}
                    row[key] = value["value"]
                    row.update({f"{key}_{end}": value[end] for end in ("low", "high")})
                elif not isinstance(value, (dict, list)) and key != "reference":
                    row[key] = value
            row["bias_test"] = entry["bias_test"]["verdict"]
            rows.append(row)
        frame = library("pandas").DataFrame(rows).set_index("name")
        numbers = [key for key in frame if frame[key].dtype == object and key.endswith(_NUMBERS)]
        return frame.astype({key: float for key in numbers})

    @property
    def runs(self) -> Any:
        """Data frame with a row for each run of each method, by the method's name and its number."""
        rows = [
            {"name": entry["name"], "run": number, **_numbers_of(run)}
            for entry in self.data["configurations"]
            for number, run in enumerate(entry["runs"])
        ]
        return library("pandas").DataFrame(rows).set_index(["name", "run"])

    @property
    def convergence(self) -> Any:
        """Data frame of errors as runs went on: name, run, samples, seconds and mse."""
        rows = [
            {"name": entry["name"], "run": number, **point}
            for entry in self.data["configurations"]
            for number, run in enumerate(entry["runs"])
            for point in run["convergence"]
        ]
        columns = ["name", "run", "samples", "seconds", "mse"]
        return library("pandas").DataFrame(rows, columns=columns)

    def figure(self) -> Any:
        """Return a matplotlib.figure.Figure of efficiencies and of errors over time."""
        figure = empty_figure(10, 4)
        bars, lines = figure.subplots(1, 2)
        table = self.table.dropna(subset=["efficiency"])[::-1]
        middle = table["efficiency"]
        ends = [
            (sign * (table[f"efficiency_{end}"] - middle)).fillna(0)
            for sign, end in ((-1, "low"), (1, "high"))
        ]
        bars.errorbar(middle, table.index, xerr=np.array(ends), fmt="o", capsize=3)
        bars.axvline(1, color="0.7", zorder=0)
        bars.set_xscale("log")
        bars.set_xlabel(f"efficiency over {self.data['baseline']}")
        points = self.convergence
        points = points[points["mse"] > 0]
        for name, group in points[points["run"] == 0].groupby("name", sort=False):
            lines.loglog(group["seconds"], group["mse"], marker=".", label=name)
        lines.set_xlabel("time of the first run [s]")
        lines.set_ylabel("MSE")
        if len(points):
            lines.legend()
        return figure

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the report of `freepath compare`: one .html file with tables, charts and pictures.

        Raises:
            Error: if the file cannot be written.
        """
        write_text(path, self._core.html(*self._origin))

    def _repr_html_(self) -> str:
        return self.table.to_html()  # type: ignore[no-any-return]

    def __reduce__(self) -> Any:
        return _comparison, (_freepath.comparison_bytes(self._core), *self._origin)

    def __repr__(self) -> str:
        names = ", ".join(entry["name"] for entry in self.data["configurations"])
        return f"<freepath.Comparison of {names}>"


_NUMBERS = ("efficiency", "_low", "_high")


def _comparison(data: bytes, *origin: str) -> Comparison:
    """Comparison of what pickling has made of it."""
    return Comparison(_freepath.comparison_of_bytes(data), *origin)


def compare(
    scene: Scene,
    *,
    trackers: str | Sequence[str] | None = None,
    estimators: str | Sequence[str] = "ratio",
    interpolations: str | Sequence[str] | None = None,
    time: float | None = None,
    spp: int | None = None,
    repeats: int = 5,
    reference: str | os.PathLike[str] | None = None,
    reference_time: float | None = None,
    reference_spp: int | None = None,
    cache: str | os.PathLike[str] | None = None,
    seed: int = 0,
    color: str = "rgb",
    crop: tuple[int, int, int, int] | None = None,
    absorption: str = "weighted",
    emission: str = "collision",
    max_scatterings: int | None = None,
    wavelengths: int = 4,
    shadow_roulette: bool = True,
    near_light_lines: bool = True,
    lobe_splitting: bool = True,
    light_through_glass: bool = True,
    progress: Progress | None = None,
    threads: int = 0,
    simd: str = "best",
) -> Comparison:
    """Measure methods against each other on a picture of a scene (docs/compare.md).

    All combinations of trackers, estimators and interpolations are run, in rounds, and their errors
    against a reference, their efficiency and their bias are told. What is measured is what
    `freepath compare` measures with the same options; but for times it depends on the scene, the
    options and the seed alone, if samples are given and not times.

    Args:
        scene: what to render; others who render it wait meanwhile.
        trackers: methods with their options, "weighted-decomposition:control=0.5" [delta,
            weighted-delta, decomposition, weighted-decomposition, spectral-decomposition].
        estimators: of the transmittance of shadow rays, likewise.
        interpolations: of "nearest", "trilinear" and "stochastic" [stochastic; and trilinear for
            trackers that refuse it].
        time: seconds of each method, shared evenly by its repeats [10, where spp is not given].
        spp: samples of each pixel of each method, shared evenly by its repeats; with time,
            whichever ends first.
        repeats: independent runs of each method; of one there are no intervals.
        reference: picture to measure against, best an .exr with variances. None: one is made.
        reference_time: seconds for one that is made [15, where reference_spp is not given].
        reference_spp: its samples of each pixel.
        cache: folder where references that are made are kept, and found again. None: they are not.
        seed: of the random numbers, 0 to 2^64 - 1.
        color, crop, absorption, emission, max_scatterings, wavelengths, shadow_roulette,
            near_light_lines, lobe_splitting, light_through_glass: as `render` has them.
        progress: called some times a second with the name of a step and the fraction of all work
            that is done; False ends the comparison with an Error.
        threads: to work on; 0: as many as the machine has.
        simd: "best", or one of `freepath.simd()`; all give the same bits.

    Returns:
        The comparison: data frames, a figure, a report.

    Raises:
        Error: for methods that do not exist, are given twice or refuse the medium, before anything
            long is run; for times and samples out of range, and a reference of another size.
        KeyboardInterrupt: at Ctrl-C; nothing is returned then.
    """
    render, options = compare_options(
        scene, trackers=trackers, estimators=estimators, interpolations=interpolations, time=time,
        spp=spp, repeats=repeats, reference=reference, reference_time=reference_time,
        reference_spp=reference_spp, cache=cache, seed=seed, color=color, crop=crop,
        absorption=absorption, emission=emission, max_scatterings=max_scatterings,
        wavelengths=wavelengths, shadow_roulette=shadow_roulette,
        near_light_lines=near_light_lines, lobe_splitting=lobe_splitting,
        light_through_glass=light_through_glass, threads=threads, simd=simd,
    )  # fmt: skip
    return named(_freepath.compare(scene._core, render, options, progress), scene, render)


def named(
    core: _freepath.Comparison, scene: Scene, render: _freepath.RenderOptions
) -> Comparison:
    """Return a comparison that says where and when it was made."""
    date = datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC")
    return Comparison(core, repr(scene)[1:-1], _freepath.machine_text(render), date)


def compare_options(
    scene: Scene,
    *,
    trackers: Any = None,
    estimators: Any = "ratio",
    interpolations: Any = None,
    time: float | None = None,
    spp: int | None = None,
    repeats: int = 5,
    reference: Any = None,
    reference_time: float | None = None,
    reference_spp: int | None = None,
    cache: Any = None,
    seed: int = 0,
    color: str = "rgb",
    **how: Any,
) -> tuple[_freepath.RenderOptions, _freepath.CompareOptions]:
    """Return what `compare` takes for the extension: of all pictures, and of the comparison.

    Raises:
        Error: for what is out of range, and what can't be said together.
    """
    render = picture_options(scene, seed=seed, color=color, adaptive=False, **how)
    options = _freepath.CompareOptions()
    options.trackers = (
        _freepath.compared_trackers.split(",") if trackers is None else listed(trackers)
    )
    options.estimators = listed(estimators)
    options.interpolations = None if interpolations is None else listed(interpolations)
    options.time = _seconds(time, "time", 0.0 if spp is not None else 10.0)
    options.samples = 0 if spp is None else as_count(spp, "spp", 1, 2**30)
    options.repeats = as_count(repeats, "repeats", 1, 1000)
    for name, value in {
        "reference_time": reference_time, "reference_spp": reference_spp, "cache": cache
    }.items():  # fmt: skip
        if reference is not None and value is not None:
            raise Error(f"{name} is for references that are made, not for one given")
    options.reference = "" if reference is None else os.fspath(reference)
    options.cache = "" if cache is None else os.fspath(cache)
    options.reference_time = _seconds(
        reference_time, "reference_time", 0.0 if reference_spp is not None else 15.0
    )
    options.reference_samples = (
        0 if reference_spp is None else as_count(reference_spp, "reference_spp", 2, 2**30)
    )
    if options.cache:
        shown = how.get("crop"), how.get("max_scatterings")
        facts = repr([*facts_of(scene, render), color, *shown])
        options.digest = hashlib.sha1(facts.encode()).hexdigest()
    return render, options


def _seconds(value: Any, what: str, default: float) -> float:
    if value is None:
        return default
    if not (np.isfinite(value) and value > 0):
        raise Error(f"{what}: {value!r} is no positive number of seconds")
    return float(value)


def _numbers_of(run: dict[str, Any]) -> dict[str, Any]:
    """Numbers of a run, those of the channels by their names."""
    numbers = {key: value for key, value in run.items() if not isinstance(value, list)}
    return {**numbers, **{f"mse_{c}": v for c, v in zip("rgb", run["channel_mse"])}}
