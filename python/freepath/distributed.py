"""Pictures, comparisons and sweeps on a cluster, by Dask.

Every `dask.distributed.Client` will do: of a LocalCluster, of dask-jobqueue on Slurm, of Kubernetes.
It is an optional part, `pip install freepath[distributed]`, which workers need too.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import closing
from dataclasses import dataclass
from typing import Any

from . import _freepath
from ._arrays import as_count
from ._cluster import Crew, Sent, built, check_facts, check_version
from ._compare import Comparison, compare_options, named
from ._compare import compare as compare_here
from ._field import Field
from ._film import Film, merge
from ._flux import Fluxes, angles, flux
from ._freepath import version
from ._medium import Component, Medium, as_medium
from ._picture_options import picture_options
from ._render import Picture, checked, film_of_part
from ._sampling import threads_of
from ._scene import Scene

__all__ = ["compare", "flux_sweep", "render"]


def render(
    scene: Scene,
    client: Any,
    *,
    spp: int | None = None,
    noise: float | None = None,
    parts: int | None = None,
    on_result: Callable[[Picture], Any] | None = None,
    retries: int = 3,
    threads: int = 1,
    **how: Any,
) -> Picture:
    """Render a scene on a cluster: each task a part of the samples of all pixels.

    The picture has the bits of that of `freepath.render` in one process, whichever workers render
    which parts, are lost, or come later. The scene is sent once to each worker and built there once;
    files that it names are read where the worker is, and refused where their content is another.

    Args:
        scene: what to render.
        client: `dask.distributed.Client` of the cluster.
        spp: samples of each pixel [64, or what the scene's file says].
        noise: the noise to reach, as `freepath.render` has it; pilots are shared out, too.
        parts: tasks that the samples are shared out to [four for each thread of the workers that
            there are]. Some seconds for each keep the overhead low.
        on_result: called with the picture so far whenever a part but the last has come; its pixels
            have the samples of the parts that are there. False ends the rendering, and the picture
            so far is returned.
        retries: how often a task that failed is tried again. A task whose worker is lost is given to
            another one by Dask (`distributed.scheduler.allowed-failures` times).
        threads: of a task. A worker works on as many tasks at a time as it has threads for Dask; on
            one with a single thread and a machine for itself, give 0: as many as the machine has.
        **how: seed, color, layers, crop, tracker and others, as `freepath.render` has them.

    Returns:
        The picture; what makes it less than it should be comes as Python warnings.

    Raises:
        Error: as `freepath.render`; if Dask is not installed; where a worker's files, or its version
            of freepath, are others.
        distributed.KilledWorker: where a task has ended several workers, for want of memory perhaps.
        Exception: whatever `on_result` raises; what is not rendered yet is cancelled then.
    """
    crew = Crew.of(client, retries)
    _check_options(how, picture_options, "render", ("time", "samples", "tile", "progress"))
    how["threads"] = threads_of(threads)
    if parts is not None:
        parts = as_count(parts, "parts", 1, 2**20)
    # Errors of options are told before anything is sent.
    options = picture_options(scene, spp=spp, noise=noise, **how)
    samples = _freepath.settled_samples(scene._core, options)
    films_of = _Filming(crew, _send_scene(crew, scene), dict(scene._facts()))
    parts = parts or crew.standard_parts()
    if noise is not None:
        samples = _planned_samples(films_of, scene, options, {**how, "layers": "none"}, parts)
    merged = _Merged()
    with closing(films_of.ranges(_ranges(0, samples, parts), how)) as films:
        for film in films:
            merged.add(film)
            if merged.samples == samples or on_result is None:
                continue
            if on_result(merged.film().picture()) is False:
                break
    return checked(merged.film().picture())


def compare(
    scene: Scene,
    client: Any,
    *,
    on_result: Callable[[Comparison], Any] | None = None,
    retries: int = 3,
    threads: int = 1,
    **how: Any,
) -> Comparison:
    """Measure methods against each other on a cluster: each task a round of all of them.

    The numbers are those of `freepath.compare` in one process, but for times, if samples are given
    and not times. A round runs all methods on one worker, so that what slows that down meets all
    alike. The reference is made by one task before.

    Args:
        scene: what to render; it is sent as `render` does.
        client: `dask.distributed.Client` of the cluster.
        on_result: called with the comparison so far whenever a round but the last has come. False
            ends it, and the comparison so far is returned.
        retries: how often a task that failed is tried again.
        threads: of a task. CPU times are those of the worker's whole process: where it works on
            several tasks at a time, efficiencies say little.
        **how: trackers, estimators, spp, repeats, reference_spp and others, as `freepath.compare`
            has them, but for cache and progress.

    Returns:
        The comparison.

    Raises:
        Error: as `freepath.compare` and `render`.
        Exception: whatever `on_result` raises; what is not run yet is cancelled then.
    """
    crew = Crew.of(client, retries)
    _check_options(how, compare_here, "compare", ("scene", "cache", "progress"))
    how["threads"] = threads_of(threads)
    render_how, options = compare_options(scene, **how)
    _freepath.check_comparison(scene._core, render_how, options)
    facts = dict(scene._facts())
    sent = _send_scene(crew, scene)
    references: Any
    if options.reference:  # a file that workers need not have
        made = _freepath.references(scene._core, render_how, options, None)
        references = crew.submit(_itself, _freepath.references_bytes(made))
        del how["reference"]
    else:
        references = crew.submit(_references_part, sent, how)
    rounds: dict[int, Any] = {}

    def so_far() -> Comparison:
        ordered = [rounds[number] for number in sorted(rounds)]
        return named(_freepath.merge_rounds(ordered), scene, render_how)

    tasks = crew.results(
        _round_part, range(options.repeats), scene=sent, references=references, how=how
    )
    with closing(tasks) as results:
        for number, (theirs, data) in results:
            check_facts(theirs, facts)
            rounds[number] = _freepath.comparison_of_bytes(data)
            if len(rounds) == options.repeats or on_result is None:
                continue
            if on_result(so_far()) is False:
                break
    return so_far()


def flux_sweep(
    medium: Medium | Component | Field | Iterable[Component],
    client: Any,
    suns: Iterable[tuple[float, float]],
    *,
    on_result: Callable[[int, Fluxes], Any] | None = None,
    retries: int = 3,
    threads: int = 1,
    **how: Any,
) -> list[Fluxes | None]:
    """Trace light from many suns through a medium on a cluster: each task one sun.

    The fluxes have the bits of `freepath.flux(medium, sun=sun, **how)` in one process. The medium
    is sent once to each worker.

    Args:
        medium: what `freepath.flux` takes.
        client: `dask.distributed.Client` of the cluster.
        suns: zenith angle and azimuth of each [degrees].
        on_result: called with the number of a sun and its fluxes whenever they have come. False
            ends the sweep.
        retries: how often a task that failed is tried again.
        threads: of a task.
        **how: columns, ground, views, paths, seed and others, as `freepath.flux` has them.

    Returns:
        The fluxes of each sun, in the order of the suns; None of those that an `on_result` that
        ended the sweep has left out.

    Raises:
        Error: as `freepath.flux`, before anything is sent; as `render`.
        Exception: whatever `on_result` raises; what is not traced yet is cancelled then.
    """
    crew = Crew.of(client, retries)
    _check_options(how, flux, "flux_sweep", ("medium", "sun"))
    how["threads"] = threads_of(threads)
    suns = [angles(sun, "suns", 0, 90) for sun in suns]
    medium = as_medium(medium)
    if not suns:
        return []
    flux(medium, sun=suns[0], **{**how, "paths": 1})  # tells errors before anything is sent
    digest = medium._digest()
    fluxes: list[Fluxes | None] = [None] * len(suns)
    tasks = crew.results(_flux_part, suns, medium=crew.send(medium, digest), how=how)
    with closing(tasks) as results:
        for number, (their_version, their_digest, result) in results:
            check_version(their_version)
            check_facts({"the medium": their_digest}, {"the medium": digest})
            fluxes[number] = result
            if on_result is not None and on_result(number, result) is False:
                break
    return fluxes


def _check_options(
    how: dict[str, Any], function: Callable[..., Any], name: str, not_here: tuple[str, ...]
) -> None:
    """Refuse what a function doesn't know, and what can't be said on a cluster."""
    known = inspect.signature(function).parameters
    for option in how:
        if option in ("time", "samples", "tile", "progress") and option in not_here:
            raise TypeError(f"{option}: not on a cluster; give spp or noise, and on_result")
        if option in not_here:
            raise TypeError(f"{option}: not on a cluster")
        if option not in known:
            raise TypeError(f"{name}() has no argument {option!r}")


def _ranges(first: int, end: int, parts: int) -> list[tuple[int, int]]:
    """Samples shared out to at most so many parts."""
    parts = min(parts, end - first)
    edges = [first + (end - first) * i // parts for i in range(parts + 1)]
    return list(zip(edges, edges[1:]))


@dataclass(frozen=True)
class _Filming:
    """Workers that have a scene, or will have it.

    Attributes:
        crew: the workers.
        scene: future of the scene.
        facts: what pictures of it depend on.
    """

    crew: Crew
    scene: Any
    facts: dict[str, str]

    def ranges(
        self, ranges: list[tuple[int, int]], how: dict[str, Any]
    ) -> Generator[Film, None, None]:
        """Render ranges of samples, and yield their films in the order in which they come."""
        tasks = self.crew.results(_render_part, ranges, scene=self.scene, how=how)
        with closing(tasks) as results:
            for _, data in results:
                film = Film.from_bytes(data)
                check_version(film._core.version)
                check_facts(film.facts, self.facts)
                yield film


def _planned_samples(
    films_of: _Filming,
    scene: Scene,
    options: _freepath.RenderOptions,
    how: dict[str, Any],
    parts: int,
) -> int:
    """Return the number of samples that a noise takes, as `render` plans it in one process."""
    seed, end, most = _freepath.first_pilot(scene._core, options)
    noise = options.noise
    assert noise is not None
    first = 0
    pilot = _Merged()
    while True:
        for film in films_of.ranges(_ranges(first, end, parts), {**how, "seed": seed}):
            pilot.add(film)
        samples, is_known = _freepath.samples_by_pilot(pilot.film()._core, noise, most)
        if is_known:
            return samples
        first, end = end, 2 * end


class _Merged:
    """Films of ranges of samples in any order: one of those without a gap, and the others."""

    def __init__(self) -> None:
        self.samples = 0  # of each pixel
        self._films: dict[int, Film] = {}  # by first sample

    def add(self, film: Film) -> None:
        """Add a film, and merge it with those that it adjoins."""
        self.samples += len(film.samples)
        self._films[film.samples.start] = film
        run: list[Film] = []
        for film in self._in_order():
            if run and film.samples.start != run[-1].samples.stop:
                break
            run.append(film)
        if len(run) > 1 and run[0].samples.start == 0:
            for film in run:
                del self._films[film.samples.start]
            self._films[0] = merge(run)

    def film(self) -> Film:
        """Return the film of all samples that there are."""
        films = list(self._in_order())
        return films[0] if len(films) == 1 else merge(films, partial=True)

    def _in_order(self) -> Iterator[Film]:
        for first in sorted(self._films):
            yield self._films[first]


def _send_scene(crew: Crew, scene: Scene) -> Any:
    return crew.send(scene, repr(scene._facts()))


# What runs on workers.


def _itself(data: bytes) -> bytes:
    return data


def _render_part(samples: tuple[int, int], scene: Sent, how: dict[str, Any]) -> bytes:
    """Return the film of some samples."""
    return film_of_part(built(scene), samples=samples, **how).to_bytes()


def _references_part(scene: Sent, how: dict[str, Any]) -> bytes:
    """Return the references of a comparison."""
    own: Scene = built(scene)
    render_how, options = compare_options(own, **how)
    return _freepath.references_bytes(
        _freepath.references(own._core, render_how, options, None)
    )


def _round_part(
    number: int, scene: Sent, references: bytes, how: dict[str, Any]
) -> tuple[dict[str, str], bytes]:
    """Return what the scene depends on here, and a round of a comparison."""
    own: Scene = built(scene)
    render_how, options = compare_options(own, **how)
    options.references = _freepath.references_of_bytes(references)
    options.first_round, options.end_round = number, number + 1
    core = _freepath.compare(own._core, render_how, options, None)
    return dict(own._facts()), _freepath.comparison_bytes(core)


def _flux_part(
    sun: tuple[float, float], medium: Sent, how: dict[str, Any]
) -> tuple[str, str, Fluxes]:
    """Return version and digest as they are here, and the fluxes of a sun."""
    own: Medium = built(medium)
    return version, own._digest(), flux(own, sun=sun, **how)
