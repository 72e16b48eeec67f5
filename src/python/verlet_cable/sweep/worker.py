"""What a Dask worker does: chunks of the samples, from the drawing to the files."""
import functools
import time

import zarr

from . import store
from .description import Sweep, digest_of
from .simulation import simulate


class WrongWorker(RuntimeError):
    """A worker that cannot do what the sweep was begun with."""


def run_chunks(path, folder, identity, chunks):
    """Simulates and writes chunks of the store at `path`, but those that are there. folder: of SWEEP.yaml. identity: store.identity(path).

    Returns the seconds that it took, and for each chunk [(sample, status, message)] of the samples that failed.
    """
    start = time.monotonic()
    arrays, sweep, layout = _plan(path, folder, identity)
    for chunk in chunks:
        if f'status/{chunk}' not in arrays['status'].store:
            store.write_chunk(arrays, layout, chunk, simulate(sweep, layout, layout.samples_of(chunk)))
    failures = [store.failures_of(arrays, layout.samples_of(chunk)) for chunk in chunks]
    return time.monotonic() - start, failures


@functools.lru_cache(maxsize=4)
def _plan(path, folder, identity):
    root = zarr.open_group(zarr.DirectoryStore(path), mode='r+')
    if store.identity(path) != identity:
        raise WrongWorker(f'{path}: not the store of this sweep')
    attributes = root.attrs.asdict()
    if store.versions() != attributes['versions']:
        raise WrongWorker(f'this worker has {store.versions()}, the store was begun with {attributes["versions"]}')
    sweep = Sweep.from_attributes(attributes['sweep'], attributes['scene'], folder)
    for motion, digest in sweep.motion_digests.items():
        if digest_of(sweep.motion_path(motion)) != digest:
            raise WrongWorker(f'{sweep.motion_path(motion)}: changed since the sweep was begun')
    if sweep.loads and digest_of(sweep.loads_path) != sweep.loads_digest:
        raise WrongWorker(f'{sweep.loads_path}: changed since the sweep was begun')
    return store.arrays_of(root), sweep, store.layout_of(root)
