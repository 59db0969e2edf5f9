"""Runs scenarios on Dask: any number of workers, any of which may die."""

from __future__ import annotations

import itertools
import logging
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, TextIO

from .. import load
from .scenario import Scenario, Timed, crashed, execute_batch
from .store import Store

#: Scenarios of a task: so many that sending one costs little beside running it.
BATCH = 64
#: Tasks in the scheduler's hands per worker: one to run, others to have at hand.
AHEAD = 3
#: Workers that a scenario may end before it is given up.
DEATHS = 3
#: s between two looks at what has ended, and looks until the workers are counted.
LOOK_S = 0.05
LOOKS = 200


#: Of Dask's own: what its workers do all the time beside the tasks, and how many deaths of workers a task survives.
QUIET = {
    "distributed.scheduler.allowed-failures": DEATHS,
    "distributed.scheduler.active-memory-manager.start": False,
    "distributed.worker.profile.enabled": False,
    "distributed.admin.tick.interval": "2s",
    "distributed.admin.system-monitor.interval": "5s",
    "distributed.worker.memory.monitor-interval": "1s",
    "distributed.scheduler.work-stealing-interval": "1s",
}


@dataclass
class Costs:
    """Processor time, s."""

    runs_s: float = 0.0
    workers: dict[str, float] = field(default_factory=dict)
    client_s: float = 0.0
    wall_s: float = 0.0

    def add(self, timed: Timed) -> None:
        self.runs_s += timed.runs_s
        self.workers[timed.worker] = max(self.workers.get(timed.worker, 0.0), timed.worker_s)

    @property
    def overhead(self) -> float:
        """What all processes took beside the runs, as a part of the runs."""
        whole = sum(self.workers.values()) + self.client_s
        return whole / self.runs_s - 1 if self.runs_s > 0 else 0.0


class SchedulerLost(OSError):
    """Nobody is there to hand scenarios to."""


class Progress:
    """A bar on a terminal; elsewhere a line for every tenth."""

    def __init__(self, total: int, stream: TextIO | None = None) -> None:
        self.total, self.done, self.begin, self.told = total, 0, time.monotonic(), 0
        self.stream = stream if stream is not None else sys.stderr
        self.workers = 1

    def tell_workers(self, count: int, address: str) -> None:
        if count == 0 < self.workers:
            self.stream.write(f"\nno worker is left at {address}: waiting for one\n")
            self.stream.flush()
        self.workers = count

    def add(self, count: int) -> None:
        self.done += count
        passed = time.monotonic() - self.begin
        left = passed * (self.total - self.done) / self.done
        text = (
            f"{self.done} of {self.total} scenarios, {self.done / max(passed, 1e-9):.0f} a second, "
            f"{int(left) // 3600}:{int(left) // 60 % 60:02d}:{int(left) % 60:02d} left"
        )
        if self.stream.isatty():
            filled = 30 * self.done // self.total
            self.stream.write(f"\r[{'#' * filled}{'.' * (30 - filled)}] {text} ")
        elif self.done * 10 // self.total > self.told:
            self.told = self.done * 10 // self.total
            self.stream.write(text + "\n")
        self.stream.flush()

    def end(self) -> None:
        if self.stream.isatty():
            self.stream.write("\n")


@dataclass
class Batch:
    scenarios: list[Scenario]
    deaths: int = 0


class Engine:
    """Hands batches to a client of Dask, keeps what comes back, gives out again what is lost."""

    def __init__(self, client: Any, store: Store, takt_digest: str, library_path: str | None) -> None:
        self.client, self.store, self.digest, self.library = client, store, takt_digest, library_path
        self.costs = Costs()

    def _submit(self, batch: Batch) -> Any:
        # pure=False: results are kept by the store, not by the scheduler.
        return self.client.submit(execute_batch, batch.scenarios, self.digest, self.library, pure=False)

    def _keep(self, timed: Timed, batch: Batch) -> None:
        self.store.add({s.key(self.digest): timed.rows[s.identity] for s in batch.scenarios})
        self.costs.add(timed)

    def _again(self, batch: Batch, why: str) -> list[Batch]:
        """Halves, down to the scenario that ends its worker; that one is an outcome."""
        deaths = batch.deaths + 1
        if len(batch.scenarios) > 1:
            half = len(batch.scenarios) // 2
            return [Batch(batch.scenarios[:half], deaths), Batch(batch.scenarios[half:], deaths)]
        if batch.deaths < DEATHS:
            return [Batch(batch.scenarios, deaths)]
        self.store.add({batch.scenarios[0].key(self.digest): crashed(why)})
        return []

    def _wait(self, done: Any, progress: Progress) -> None:
        """Until something has ended; tells if nobody is left to work, which a scheduler waits for without a word."""
        for look in itertools.count(1):
            if done.has_ready():
                return
            if look % LOOKS == 0:
                progress.tell_workers(len(self.client.nthreads()), self.client.scheduler.address)
            time.sleep(LOOK_S)

    def run(self, scenarios: list[Scenario], batch_size: int, progress: Progress) -> None:
        """All of them; returns when every row is stored."""
        from dask.distributed import as_completed
        from distributed.scheduler import KilledWorker

        chunks: Iterator[list[Scenario]] = (
            scenarios[i : i + batch_size] for i in range(0, len(scenarios), batch_size)
        )
        waiting: Iterator[Batch] = (Batch(chunk) for chunk in chunks)
        running: dict[Any, Batch] = {}
        done = as_completed()

        def fill() -> None:
            nonlocal waiting
            while len(running) < AHEAD * max(1, len(self.client.nthreads())):
                batch = next(waiting, None)
                if batch is None:
                    return
                future = self._submit(batch)
                running[future] = batch
                done.add(future)

        fill()
        while running:
            self._wait(done, progress)
            future = next(done)
            batch = running.pop(future)
            error = future.exception() if future.status == "error" else None
            if future.status == "finished":
                self._keep(future.result(), batch)
                progress.add(len(batch.scenarios))
            elif error is not None and not isinstance(error, KilledWorker):
                raise error
            else:
                again = self._again(batch, f"the worker dies: {error}")
                if not again:
                    progress.add(1)
                waiting = itertools.chain(again, waiting)
            future.release()
            fill()


def connect(scheduler: str | None, workers: int) -> Any:
    """A client of a running scheduler, or of workers of its own: processes with one thread each."""
    import dask
    from dask.distributed import Client, LocalCluster

    dask.config.set(QUIET)
    for name in ("distributed", "asyncio"):  # what matters of it is told here
        logging.getLogger(name).setLevel(logging.CRITICAL)
    if scheduler is not None:
        return Client(scheduler, timeout="60s")
    cluster = LocalCluster(
        n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=":0", silence_logs=50
    )
    return Client(cluster)


def run_missing(
    store: Store, scenarios: list[Scenario], *, scheduler: str | None, workers: int, batch: int, library: str | None
) -> Costs:
    """Runs what the store does not have yet, each scenario once."""
    from distributed.comm import CommClosedError

    loaded = load(library)
    missing: dict[str, Scenario] = {}
    for s in scenarios:
        key = s.key(loaded.digest)
        if key not in store.rows:
            missing.setdefault(key, s)
    if not missing:
        return Costs()
    begin, begin_cpu = time.monotonic(), time.process_time()
    progress = Progress(len(missing))
    client = connect(scheduler, workers)
    try:
        engine = Engine(client, store, loaded.digest, library)
        engine.run(list(missing.values()), batch, progress)
    except CommClosedError as error:
        raise SchedulerLost(
            f"the scheduler is gone: {error}\n{progress.done} scenarios have been kept; the same command goes on from there"
        ) from error
    finally:
        progress.end()
        cluster = client.cluster
        client.close()
        if cluster is not None and scheduler is None:
            cluster.close()
    engine.costs.wall_s = time.monotonic() - begin
    engine.costs.client_s = time.process_time() - begin_cpu
    return engine.costs
