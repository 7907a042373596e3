"""Work shared out to the workers of a Dask cluster."""

from __future__ import annotations

import pickle
import threading
import warnings
from collections import OrderedDict
from collections.abc import Callable, Generator, Iterable
from dataclasses import dataclass
from typing import Any

from ._arrays import as_count
from ._freepath import Error, version

_PARTS_OF_A_THREAD = 4
"""Parts for each thread of the cluster: the last ones to end keep others waiting for less."""
_PARTS_OF_NO_WORKERS = 64
"""Parts where there are no workers yet."""
_KEPT = 2
"""Scenes and media that a worker keeps built."""


@dataclass(frozen=True)
class Crew:
    """Workers of a cluster.

    Attributes:
        dask: the module `distributed`.
        client: of the cluster.
        retries: how often a task that fails is tried again.
    """

    dask: Any
    client: Any
    retries: int

    @classmethod
    def of(cls, client: Any, retries: int) -> Crew:
        """Return the crew of a client.

        Raises:
            Error: if Dask is not installed, or the client is an asynchronous one.
        """
        dask = _dask()
        if not isinstance(client, dask.Client):
            raise TypeError(f"client: {type(client).__name__} is no dask.distributed.Client")
        if client.asynchronous:
            raise Error("client: is an asynchronous one; give one that waits, Client(...)")
        return cls(dask, client, as_count(retries, "retries", 0, 1000))

    def standard_parts(self) -> int:
        """Return how many tasks to share work out to, where nobody says."""
        threads = sum(self.client.nthreads().values())
        return _PARTS_OF_A_THREAD * threads if threads else _PARTS_OF_NO_WORKERS

    def send(self, thing: Any, digest: str) -> Any:
        """Give something to the cluster, as the result of a task: it can be repeated if it is lost.

        Args:
            thing: what `built` returns to those who need it.
            digest: its name; the same thing, the same name.

        Returns:
            The future of it.
        """
        sent = Sent(digest, pickle.dumps(thing, protocol=pickle.HIGHEST_PROTOCOL))
        return self.submit(_itself, sent)

    def submit(self, function: Callable[..., Any], *arguments: Any, **named: Any) -> Any:
        """Return the future of a task."""
        with warnings.catch_warnings():
            # Dask advises to scatter what is large. What is scattered is lost with its workers.
            warnings.filterwarnings("ignore", message="Sending large graph")
            return self.client.submit(
                function, *arguments, **named, pure=False, retries=self.retries
            )

    def results(
        self, function: Callable[..., Any], items: Iterable[Any], **shared: Any
    ) -> Generator[tuple[int, Any], None, None]:
        """Yield the number of each item and what a task has made of it, in the order they come in.

        What is not done when the iterator is closed is cancelled.
        """
        futures = self.client.map(
            function, list(items), **shared, pure=False, retries=self.retries
        )
        numbers = {future.key: number for number, future in enumerate(futures)}
        try:
            for future, result in self.dask.as_completed(futures, with_results=True):
                future.release()
                yield numbers[future.key], result
        finally:
            self.client.cancel([future for future in futures if not future.done()])


def _dask() -> Any:
    try:
        import distributed
    except ImportError:
        raise Error(
            "freepath.distributed works on Dask, which is not installed: "
            "pip install 'freepath[distributed]'"
        ) from None
    return distributed


def check_version(theirs: str) -> None:
    """Check that a worker has this version.

    Raises:
        Error: where it has another.
    """
    if theirs != version:
        raise Error(f"a worker has freepath {theirs} and not {version}; give workers the same")


def check_facts(theirs: dict[str, str], facts: dict[str, str]) -> None:
    """Check that what a worker has worked on is what was sent.

    Raises:
        Error: where it isn't, naming what differs.
    """
    for name, value in facts.items():
        if theirs.get(name) != value:
            raise Error(
                f"a worker has rendered another scene: {name} is {theirs.get(name, 'not there')} "
                f"and not {value}; give workers the same files"
            )


@dataclass(frozen=True)
class Sent:
    """Something on its way: built by those who need it, not by those who pass it on.

    Attributes:
        digest: its name; the same thing, the same name.
        data: the thing, pickled.
    """

    digest: str
    data: bytes


def _itself(sent: Sent) -> Sent:
    return sent


_built: OrderedDict[str, Any] = OrderedDict()
_building = threading.Lock()


def built(sent: Sent) -> Any:
    """Return what was sent, built by this process at most once while it is in use."""
    with _building:
        thing = _built.get(sent.digest)
        if thing is None:
            thing = pickle.loads(sent.data)
            _built[sent.digest] = thing
        _built.move_to_end(sent.digest)
        while len(_built) > _KEPT:
            _built.popitem(last=False)
        return thing
