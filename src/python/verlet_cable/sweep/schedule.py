"""Has Dask do the chunks of a sweep: on a cluster of its own on this machine, or on any whose scheduler is named.

Only a few chunks a worker are with the scheduler at a time: its memory does not grow with the number of samples. Dask gives a chunk
to another worker when one dies; a chunk that was done twice has the same bytes.
"""
import contextlib
import hashlib
import logging
import shutil
import tempfile
import time

from .errors import SweepError, SweepStopped, missing_package

try:
    import dask
    import distributed
except ImportError as error:
    raise missing_package(error) from error

_CHUNKS_A_THREAD = 3   # with the scheduler: one in work, the others so that no worker waits
_FEWEST_CHUNKS = 8     # where no worker is there yet
_CONNECT = 10          # [s] for a scheduler to answer
_PATIENCE = 5          # [s] without any worker after which the user is told
_RECOUNT = 5           # [s] after which workers are counted again

# Logs of bounded length, so that memory is flat; and nothing that looks at the processes many times a second: on few cores that
# would take what samples need.
_OWN_CLUSTER = {
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
        with client:
            yield client
        return
    scratch = tempfile.mkdtemp(prefix='cable_sweep-')
    try:
        with dask.config.set(_OWN_CLUSTER), distributed.LocalCluster(
                n_workers=workers, threads_per_worker=1, processes=True, host='127.0.0.1', dashboard_address=None,
                memory_limit=0, local_directory=scratch, silence_logs=logging.CRITICAL) as own, distributed.Client(
                own, set_as_default=False) as client:
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


def run_chunks(client, arguments, chunks, report):
    """Has worker.run_chunk(*arguments, chunk) done for all `chunks`. report.chunk_done(chunk, failures) is called for each,
    report.waiting() while there is no worker. Raises SweepStopped when a chunk cannot be done."""
    from .worker import run_chunk
    # Two sweeps at one scheduler are told apart by their keys.
    name = 'cable_sweep-' + hashlib.sha256(repr(arguments).encode()).hexdigest()[:16]
    pending = iter(chunks)
    running = {}
    done = distributed.as_completed([], loop=client.loop)
    window, counted = 0, 0.0
    try:
        while True:
            if time.monotonic() - counted > _RECOUNT or not counted:
                counted = time.monotonic()
                window = max(_FEWEST_CHUNKS, _CHUNKS_A_THREAD * _threads(client, report))
            while len(running) < window:
                chunk = next(pending, None)
                if chunk is None:
                    break
                with dask.config.set(_SUBMIT):
                    future = client.submit(run_chunk, *arguments, chunk, key=f'{name}-{chunk}', pure=False)
                running[future] = chunk
                done.add(future)
            if not running:
                return
            future = next(done)
            chunk = running.pop(future)
            report.chunk_done(chunk, _result(future, chunk))
            future.release()
    finally:
        if running:
            with contextlib.suppress(Exception):
                client.cancel(list(running), force=True)


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


def _result(future, chunk):
    try:
        return future.result()
    except distributed.scheduler.KilledWorker as error:
        raise SweepStopped(f'chunk {chunk}: every worker that had it died: {error}') from error
    except Exception as error:  # whatever it was in the worker: a full disk, other versions, a scheduler that has gone
        raise SweepStopped(f'chunk {chunk}: {type(error).__name__}: {error}') from error
