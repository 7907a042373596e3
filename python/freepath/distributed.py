"""Pictures on a cluster, by Dask.

Every `dask.distributed.Client` will do: of a LocalCluster, of dask-jobqueue on Slurm, of Kubernetes.
It is an optional part, `pip install freepath[distributed]`, which workers need too.
"""

from __future__ import annotations

import inspect
import pickle
import threading
import warnings
from collections import OrderedDict
from collections.abc import Callable, Generator, Iterator
from contextlib import closing
from dataclasses import dataclass
from typing import Any

from . import _freepath
from ._arrays import as_count
from ._film import Film, merge
from ._freepath import Error, version
from ._picture_options import picture_options
from ._render import Picture, checked, film_of_part
from ._sampling import threads_of
from ._scene import Scene

__all__ = ["render"]

_PARTS_OF_A_THREAD = 4
"""Parts for each thread of the cluster: the last ones to end keep others waiting for less."""
_PARTS_OF_NO_WORKERS = 64
"""Parts where there are no workers yet."""
_SCENES_KEPT = 2
"""Scenes that a worker keeps built."""


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
    dask = _dask()
    if not isinstance(client, dask.Client):
        raise TypeError(f"client: {type(client).__name__} is no dask.distributed.Client")
    if client.asynchronous:
        raise Error("client: is an asynchronous one; give one that waits, Client(...)")
    _check_options(how)
    how["threads"] = threads_of(threads)
    retries = as_count(retries, "retries", 0, 1000)
    if parts is not None:
        parts = as_count(parts, "parts", 1, 2**20)
    # Errors of options are told before anything is sent.
    options = picture_options(scene, spp=spp, noise=noise, **how)
    samples = _freepath.settled_samples(scene._core, options)
    crew = _Crew(dask, client, _send(client, scene), dict(scene._facts()), retries)
    parts = parts or _standard_parts(client)
    if noise is not None:
        samples = _planned_samples(crew, scene, options, {**how, "layers": "none"}, parts)
    merged = _Merged()
    with closing(crew.films(_ranges(0, samples, parts), how)) as films:
        for film in films:
            merged.add(film)
            if merged.samples == samples or on_result is None:
                continue
            if on_result(merged.film().picture()) is False:
                break
    return checked(merged.film().picture())


def _dask() -> Any:
    try:
        import distributed
    except ImportError:
        raise Error(
            "freepath.distributed works on Dask, which is not installed: "
            "pip install 'freepath[distributed]'"
        ) from None
    return distributed


def _check_options(how: dict[str, Any]) -> None:
    """Refuse what `render` doesn't know, and what can't be said of parts of a picture."""
    known = inspect.signature(picture_options).parameters
    for name in how:
        if name in ("time", "samples", "tile", "progress"):
            raise TypeError(f"{name}: not on a cluster; give spp or noise, and on_result")
        if name not in known:
            raise TypeError(f"render() has no argument {name!r}")


def _standard_parts(client: Any) -> int:
    threads = sum(client.nthreads().values())
    return _PARTS_OF_A_THREAD * threads if threads else _PARTS_OF_NO_WORKERS


def _ranges(first: int, end: int, parts: int) -> list[tuple[int, int]]:
    """Samples shared out to at most so many parts."""
    parts = min(parts, end - first)
    edges = [first + (end - first) * i // parts for i in range(parts + 1)]
    return list(zip(edges, edges[1:]))


@dataclass(frozen=True)
class _Crew:
    """Workers that have a scene, or will have it.

    Attributes:
        dask: the module `distributed`.
        client: of the cluster.
        scene: future of the scene.
        facts: what pictures of it depend on.
        retries: of a task that fails.
    """

    dask: Any
    client: Any
    scene: Any
    facts: dict[str, str]
    retries: int

    def films(self, ranges: list[tuple[int, int]], how: dict[str, Any]) -> Generator[Film, None, None]:
        """Render ranges of samples, and yield their films in the order in which they come.

        What is not rendered when the iterator is closed is cancelled.
        """
        futures = self.client.map(
            _render_part, ranges, scene=self.scene, how=how, pure=False, retries=self.retries
        )
        try:
            for future, data in self.dask.as_completed(futures, with_results=True):
                future.release()
                yield _same_scene(Film.from_bytes(data), self.facts)
        finally:
            self.client.cancel([future for future in futures if not future.done()])


def _planned_samples(
    crew: _Crew, scene: Scene, options: _freepath.RenderOptions, how: dict[str, Any], parts: int
) -> int:
    """Return the number of samples that a noise takes, as `render` plans it in one process."""
    seed, end, most = _freepath.first_pilot(scene._core, options)
    noise = options.noise
    assert noise is not None
    first = 0
    pilot = _Merged()
    while True:
        for film in crew.films(_ranges(first, end, parts), {**how, "seed": seed}):
            pilot.add(film)
        samples, is_known = _freepath.samples_by_pilot(pilot.film()._core, noise, most)
        if is_known:
            return samples
        first, end = end, 2 * end


def _same_scene(film: Film, facts: dict[str, str]) -> Film:
    """Return a film of a worker whose scene is that of the client.

    Raises:
        Error: where it isn't, naming what differs; where the worker has another freepath.
    """
    if film._core.version != version:
        raise Error(
            f"a worker has freepath {film._core.version} and not {version}; give workers the same"
        )
    theirs = film.facts
    for name, value in facts.items():
        if theirs.get(name) != value:
            raise Error(
                f"a worker has rendered another scene: {name} is {theirs.get(name, 'not there')} "
                f"and not {value}; give workers the same files"
            )
    return film


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


@dataclass(frozen=True)
class _SentScene:
    """A scene on its way: built by those who need it, not by those who pass it on.

    Attributes:
        digest: its name; the same scene, the same name.
        data: the scene, pickled.
    """

    digest: str
    data: bytes


def _send(client: Any, scene: Scene) -> Any:
    """Give the scene to the cluster as the result of a task, which can be repeated if it is lost."""
    data = pickle.dumps(scene, protocol=pickle.HIGHEST_PROTOCOL)
    sent = _SentScene(repr(scene._facts()), data)
    with warnings.catch_warnings():
        # Dask advises to scatter what is large. What is scattered is lost with its workers.
        warnings.filterwarnings("ignore", message="Sending large graph")
        return client.submit(_itself, sent, pure=False)


def _itself(scene: _SentScene) -> _SentScene:
    return scene


_built: OrderedDict[str, Scene] = OrderedDict()
_building = threading.Lock()


def _scene_of(sent: _SentScene) -> Scene:
    """Return the scene, built by this process at most once while it is in use."""
    with _building:
        scene = _built.get(sent.digest)
        if scene is None:
            scene = pickle.loads(sent.data)
            _built[sent.digest] = scene
        _built.move_to_end(sent.digest)
        while len(_built) > _SCENES_KEPT:
            _built.popitem(last=False)
        return scene


def _render_part(samples: tuple[int, int], scene: _SentScene, how: dict[str, Any]) -> bytes:
    """Return the film of some samples; runs on a worker."""
    return film_of_part(_scene_of(scene), samples=samples, **how).to_bytes()
