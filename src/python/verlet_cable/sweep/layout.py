"""The arrays of a store: what the scene has of each field, and how many samples a chunk holds.

The chunk along the samples is the unit of work, and the same for all arrays. It depends on the description alone: not on the workers.
"""
import math

import numpy as np

from verlet_cable.sim import Batch, World

from .description import FIELDS
from .errors import SweepError, rejected
from .trial import rows_of

CHUNK_BYTES = 8 << 20       # of one file, before compression: large for a file system, small for memory
SAMPLE_BYTES = 4 << 30      # of all fields of one sample, which a worker holds
MOST_ROWS = 10_000_000      # of a sample
_CHUNK_NODE_STEPS = 2e9     # about a minute of one core: what a worker's death may cost
_LANES = 8                  # samples that are stepped at once
_FEWEST_CHUNKS = 64         # of a sweep that has samples enough, for the workers to share evenly
_RESERVED = ('status', 'worst', 'message', 'time', 'vary')


class Layout:
    """shapes: {(name, field): shape of one row}; rows; samples; chunk: samples in one."""

    def __init__(self, shapes, rows, samples, chunk):
        self.shapes = shapes
        self.rows = rows
        self.samples = samples
        self.chunk = chunk

    @property
    def chunks(self):
        return -(-self.samples // self.chunk)

    def samples_of(self, chunk):
        return range(chunk * self.chunk, min((chunk + 1) * self.chunk, self.samples))

    def row_chunk(self, shape):
        """Rows in a file of an array: all of them, unless one sample's are too many."""
        return min(self.rows, max(1, CHUNK_BYTES // (8 * _size(shape))))


def plan_layout(sweep, scene):
    """The Layout for a sweep of `scene`. Raises SweepError for motions that do not fit it, and samples that are too large."""
    errors = []
    shapes = {}
    for motion in sweep.motions or [None]:
        try:
            batch = Batch([scene], motion=motion and sweep.motion_path(motion), threads=1, loads=sweep.loads_path)
            World(scene, motion and sweep.motion_path(motion), sweep.loads_path).step()  # says whether all its frames are placed
        except (ValueError, KeyError) as error:  # SceneError is a ValueError
            errors += [f'{motion or sweep.scene_name}: {text}' for text in getattr(error, 'errors', None) or [str(error)]]
    if errors:
        raise SweepError(errors)
    for field in sweep.fields:
        shapes.update({(name, field): shape for name, shape in rows_of(batch, scene, field)})
    for name in sorted({name for name, field in shapes} & set(_RESERVED)):
        errors.append(f'{sweep.scene_name}: {name}: a name that the store uses itself; allowed: any but ' + ', '.join(_RESERVED))
    sample_bytes = sum(8 * _size(shape) for shape in shapes.values()) * sweep.rows
    if sample_bytes > SAMPLE_BYTES:
        errors.append(rejected('record', f'{sample_bytes / 2**30:.3g} GiB a sample ({sweep.rows} rows)',
                               f'at most {SAMPLE_BYTES >> 30} GiB'))
    if sweep.rows > MOST_ROWS:
        errors.append(rejected('record.rate', f'{sweep.rows} rows a sample', f'at most {MOST_ROWS}'))
    if errors:
        raise SweepError(errors)
    largest = max(8 * _size(shape) for shape in shapes.values()) * sweep.rows
    return Layout(shapes, sweep.rows, sweep.samples, _chunk(sweep, scene, batch, largest))


def _chunk(sweep, scene, batch, largest):
    nodes = sum(np.shape(batch.positions(name))[1] for name in [*scene.cable_names, *scene.net_names])
    node_steps = max(1, nodes) * sweep.duration / scene.time_step
    most = max(1, min(CHUNK_BYTES // largest, int(_CHUNK_NODE_STEPS // node_steps)))
    shared = math.ceil(sweep.samples / _FEWEST_CHUNKS / _LANES) * _LANES
    chunk = min(most, shared)
    return chunk - chunk % _LANES if chunk > _LANES else chunk


def _size(shape):
    return max(1, int(np.prod(shape)))


def units_of(layout):
    return {field: FIELDS[field] for name, field in layout.shapes}
