"""Has Dask do the chunks of a sweep: on a cluster of its own on this machine, or on any whose scheduler is named.

A task is one chunk or, where these take little time, some. Only a few tasks a worker are with the scheduler at a time: its memory does
not grow with the number of samples. Dask gives a task to another worker when one dies; a chunk that was done twice has the same bytes.
"""
import contextlib
import hashlib
import itertools
import logging
import math
import shutil
import tempfile
import time

from .errors import SweepError, SweepStopped, missing_package

try:
    import dask
    import distributed
except ImportError as error:
    raise missing_package(error) from error

_TASKS_A_THREAD = 3    # with the scheduler: one in work, the others so that no worker waits
_FEWEST_TASKS = 8      # where no worker is there yet
_TASK_SECONDS = 1.0    # that a task takes, where chunks take less: Dask spends milliseconds on each
_TASKS_LEFT = 8        # a thread, at least, while there are chunks
_CONNECT = 10          # [s] for a scheduler to answer
_PATIENCE = 5          # [s] without any worker after which the user is told
_RECOUNT = 5           # [s] after which workers are counted again

# Logs of bounded length, so that memory is flat; and nothing that looks at the processes many times a second: on few cores that
# would take what samples need. Dask's HTTP servers cannot be left out: they have no pages, and only this machine reaches them.
_OWN_CLUSTER = {
    'distributed.scheduler.http.routes': [], 'distributed.worker.http.routes': [],
    'distributed.scheduler.transition-log-length': 1000, 'distributed.scheduler.events-log-length': 1000,
    'distributed.scheduler.active-memory-manager.start': False, 'distributed.scheduler.work-stealing-interval': '1s',
    'distributed.worker.use-file-locking': False, 'distributed.worker.profile.enabled': False,
    'distributed.admin.log-length': 100, 'distributed.admin.tick.interval': '1s', 'distributed.admin.tick.limit': '1h',
    'distributed.admin.system-monitor.interval': '10s',
    'distributed.nanny.pre-spawn-environ': {'MALLOC_TRIM_THRESHOLD_': 1 << 28, 'MALLOC_MMAP_THRESHOLD_': 1 << 28, 'OMP_NUM_THREADS': 1},
}

# Dask would look for the source text around every call of submit(), to show it on its dashboard.
_SUBMIT = {'distributed.diagnostics.computations.ignore-modules': ['.*']}


@contextlib.contextmanager
def cluster(workers, scheduler):
    """A Client of the cluster at `scheduler`, or of an own one with so many worker processes."""
    if scheduler is not None:
        try:
            distributed.comm.resolve_address(scheduler)  # Client only gives up on what is no address when its time is up
            client = distributed.Client(scheduler, timeout=_CONNECT, set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            raise SweepError([f'--scheduler: {scheduler}: {error}; allowed: the address of a running dask-scheduler']) from error
        logging.disable(logging.ERROR)  # Dask would tell of a lost connection in tracebacks, by loggers of many names
        with client:
            try:
                yield client
            except Exception as error:
                if client.status == 'running':
                    raise
                raise SweepStopped(f'the scheduler at {scheduler} is gone') from error
        return
    scratch = tempfile.mkdtemp(prefix='cable_sweep-')
    try:
        with dask.config.set(_OWN_CLUSTER), distributed.LocalCluster(
                n_workers=workers, threads_per_worker=1, processes=True, memory_limit=0, local_directory=scratch,
                host='127.0.0.1', dashboard_address='127.0.0.1:0', worker_dashboard_address='127.0.0.1:0',
                scheduler_kwargs={'dashboard': False},
                silence_logs=logging.CRITICAL) as own, distributed.Client(own, set_as_default=False) as client:
            client.register_worker_plugin(_OwnWorker(), name='own')
            yield client
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


class _OwnWorker(distributed.WorkerPlugin):
    """Ctrl-C on a terminal reaches all processes; the workers of the own cluster are ended by the program. What they need is imported
    while the cluster starts."""

    def setup(self, worker):
        import signal
        import threading
        from . import worker as _  # noqa: F401
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGINT, signal.SIG_IGN)


def run_chunks(client, arguments, chunks, count, report):
    """Has worker.run_chunks(*arguments, some of them) done for all `chunks`, of which there are `count`. report.chunk_done(chunk,
    failures) is called for each, report.waiting() while there is no worker. Raises SweepStopped when one cannot be done."""
    from . import worker
    # Two sweeps at one scheduler are told apart by their keys.
    name = 'cable_sweep-' + hashlib.sha256(repr(arguments).encode()).hexdigest()[:16]
    running = {}
    done = distributed.as_completed([], loop=client.loop)
    threads, counted, seconds = 0, 0.0, math.inf
    try:
        while True:
            if time.monotonic() - counted > _RECOUNT or not counted:
                counted = time.monotonic()
                threads = _threads(client, report)
            while len(running) < max(_FEWEST_TASKS, _TASKS_A_THREAD * threads):
                some = list(itertools.islice(chunks, _task_size(seconds, count, threads)))
                if not some:
                    break
                count -= len(some)
                with dask.config.set(_SUBMIT):
                    future = client.submit(worker.run_chunks, *arguments, some, key=f'{name}-{some[0]}-{some[-1]}', pure=False)
                running[future] = some
                done.add(future)
            if not running:
                return
            future = next(done)
            some = running.pop(future)
            taken, failures = _result(future, some)
            seconds = taken / len(some)
            for chunk, failed in zip(some, failures):
                report.chunk_done(chunk, failed)
            future.release()
    finally:
        if running:
            with contextlib.suppress(Exception):
                client.cancel(list(running), force=True)


def _task_size(seconds, left, threads):
    """How many of the chunks that are left, of so many seconds each, are a task: fewer at the end, so that all threads end together."""
    return max(1, min(int(_TASK_SECONDS / max(seconds, 1e-3)), left // (_TASKS_LEFT * threads)))


def _threads(client, report):
    threads = sum(client.nthreads().values())
    if threads:
        return threads
    deadline = time.monotonic() + _PATIENCE
    while not threads:
        if deadline and time.monotonic() > deadline:
            report.waiting()
            deadline = None
        time.sleep(0.1)
        threads = sum(client.nthreads().values())
    return threads


def _result(future, chunks):
    name = f'chunk {chunks[0]}' if len(chunks) == 1 else f'chunks {chunks[0]} to {chunks[-1]}'
    try:
        return future.result()
    except distributed.scheduler.KilledWorker as error:
        raise SweepStopped(f'{name}: every worker that had it died: {error}') from error
    except Exception as error:  # whatever it was in the worker: a full disk, other versions, a scheduler that has gone
        raise SweepStopped(f'{name}: {type(error).__name__}: {error}') from error
