"""The Zarr store of a sweep. DIR is the store.

<name>/<field>   (samples, rows, ...) float64; NaN where a sample failed
time             (rows) [s] k / rate; row k is the first step at or after it
vary/<key>       (samples) what was drawn
status           (samples) int8: COMPLETE, WRONG_SCENE, FAULT; MISSING where a sample was not simulated yet
worst            (samples) int8: the worst status that its steps had, an index into STATUSES; MISSING where none was simulated
message          (samples) UTF-8 of fixed length: what failed

All are cut along the samples at the same places. A chunk's piece of `status` is written last, and all files are written aside and renamed:
where it is there, the others are whole. A chunk's bytes are the same whoever writes them, however often.
"""
import contextlib
import errno
import fcntl
import hashlib
import itertools
import math
import os
import pathlib
import shutil
import socket
import struct

import numpy as np

from verlet_cable import _simulation

from .errors import SweepError, missing_package
from .layout import Layout, units_of

try:
    import numcodecs
    import zarr
except ImportError as error:
    raise missing_package(error) from error

COMPLETE, WRONG_SCENE, FAULT, MISSING = 0, 1, 2, -1
# Of a step, as Batch.status numbers them.
STATUSES = ('ok', 'jumped', 'overstretched', 'inside_obstacle', 'not_settled', 'degraded', 'fault')
MESSAGE_LENGTH = 256

# What several threads compress would be in the order in which they came to an end.
numcodecs.blosc.use_threads = False
# What is compressed are bytes: numbers were shuffled before.
_BLOSC = numcodecs.Blosc(cname='lz4', clevel=5, shuffle=numcodecs.Blosc.NOSHUFFLE)
# Blosc does not notice a changed byte. With a checksum in it, whoever reads a chunk is told.
_CHECKSUM = numcodecs.CRC32()
_CHECKSUM_BYTES = 4

# xarray takes what a chunk that is not there holds for what is missing: no number that a sample may have.
_NO_MESSAGE = b'not simulated yet'
_NO_CHOICE = -1
_DIMENSIONS = {'positions': ('nodes', 'axes'), 'velocities': ('nodes', 'axes'), 'tension': ('segments',), 'curvature': ('inner_nodes',),
               'twist': ('inner_nodes',), 'plastic_curvature': ('inner_nodes',), 'orientations': ('segments', 'quaternion'),
               'wrench': ('force_torque',),
               'body_pose': ('position_quaternion',), 'body_twist': ('linear_angular',)}


def versions():
    """What the bytes of a store depend on, besides the description."""
    return {'verlet_cable': _simulation.__version__, 'numpy': np.__version__, 'zarr': zarr.__version__,
            'numcodecs': numcodecs.__version__}


def begin(path, sweep, layout):
    """Makes the store, with nothing in it. It appears at `path` when it is whole."""
    aside = f'{path}.{socket.gethostname()}-{os.getpid()}.partial'  # another cable_sweep may be about to begin the same
    shutil.rmtree(aside, ignore_errors=True)
    try:
        os.makedirs(aside)  # Zarr would not say why it cannot
        _write_arrays(zarr.open_group(zarr.DirectoryStore(aside), mode='w'), sweep, layout)
        os.rename(aside, path)
    except OSError as error:
        shutil.rmtree(aside, ignore_errors=True)
        reason = 'another cable_sweep has begun it' if error.errno in (errno.ENOTEMPTY, errno.EEXIST) else error.strerror
        raise SweepError([f'--output: {path}: {reason}; allowed: a place that can be written to, which nothing else is at']) from error


def _attributes(sweep, layout):
    return {'scene': sweep.scene_text, 'sweep': sweep.to_attributes(), 'seed': sweep.seed, 'units': units_of(layout),
            'versions': versions()}


def _write_arrays(root, sweep, layout):
    root.attrs.put(_attributes(sweep, layout))

    def create(name, dimensions, shape, chunks, dtype, fill, **attributes):
        array = root.create_dataset(name, shape=shape, chunks=chunks, dtype=dtype, fill_value=fill, filters=_filters(np.dtype(dtype)),
                                    compressor=_BLOSC, order='C')
        array.attrs.put({'_ARRAY_DIMENSIONS': list(dimensions), **attributes})
        return array

    samples, chunk, of_samples = (layout.samples,), (layout.chunk,), ('samples',)
    for (name, field), shape in sorted(layout.shapes.items()):
        create(f'{name}/{field}', ('samples', 'rows') + _DIMENSIONS[field][:len(shape)], samples + (layout.rows,) + shape,
               chunk + (layout.row_chunk(shape),) + shape, '<f8', math.nan, unit=units_of(layout)[field])
    time = create('time', ('rows',), (layout.rows,), (layout.rows,), '<f8', math.nan, unit='s')
    time[:] = np.arange(layout.rows) / sweep.rate
    for key, variation in sorted(sweep.variations.items()):
        if variation.is_choice and not variation.is_numeric:
            create(f'vary/{key}', of_samples, samples, chunk, '<i4', _NO_CHOICE, choices=variation.parameters)
        else:
            create(f'vary/{key}', of_samples, samples, chunk, '<f8', math.nan)
    create('message', of_samples, samples, chunk, f'|S{MESSAGE_LENGTH}', _NO_MESSAGE)
    create('worst', of_samples, samples, chunk, '|i1', MISSING, meanings={**{str(index): name for index, name in enumerate(STATUSES)},
                                                               str(MISSING): 'nothing simulated'})
    create('status', of_samples, samples, chunk, '|i1', MISSING,
           meanings={str(COMPLETE): 'complete', str(WRONG_SCENE): 'scene refused', str(FAULT): 'simulation failed',
                     str(MISSING): 'not simulated yet'})


def _filters(dtype):
    numbers = dtype.kind != 'S' and dtype.itemsize > 1
    return [numcodecs.Shuffle(dtype.itemsize), _CHECKSUM] if numbers else [_CHECKSUM]


def check_same(path, sweep, layout):
    """Raises SweepError if the store at `path` is not of this sweep, or of other versions."""
    attributes = _read(path)
    wanted = _attributes(sweep, layout)
    errors = []
    for key in ('scene', 'sweep', 'versions'):
        found = attributes.get(key)
        if found == wanted[key]:
            continue
        if isinstance(found, dict):
            differing = sorted(name for name in {*found, *wanted[key]} if found.get(name) != wanted[key].get(name))
            errors += [f'--resume: {path}: {key}.{name} was {found.get(name)}, is {wanted[key].get(name)}; allowed: the same'
                       for name in differing]
        else:
            errors.append(f'--resume: {path}: not what the store was begun with: {key}; allowed: the same')
    if not errors:
        errors = _foreign_files(path, sweep, layout)
    if errors:
        raise SweepError(errors)


def _foreign_files(path, sweep, layout):
    """What is wrong with the files that were there before any sample: a sweep begins with the same ones every time."""
    files = {}
    _write_arrays(zarr.open_group(files, mode='w'), sweep, layout)
    absent, errors = set(), []
    for name, wanted in sorted(files.items()):
        try:
            if pathlib.Path(path, name).read_bytes() != bytes(wanted) and name != '.zattrs':
                errors.append(f'--resume: {path}: {name}: not as cable_sweep wrote it; allowed: a whole store')
        except FileNotFoundError:
            absent.add(os.path.dirname(name) or name)
        except OSError as error:
            errors.append(f'--resume: {path}: {name}: {error.strerror}; allowed: a store that can be read')
    return errors + ([f'--resume: {path}: without ' + ', '.join(sorted(absent)) + '; allowed: a whole store'] if absent else [])


def _read(path):
    """The attributes of a store. Raises SweepError."""
    try:
        return _open(path).attrs.asdict()
    except OSError as error:
        raise SweepError([f'--resume: {path}: {error.strerror}; allowed: a store that can be read']) from error
    except (KeyError, ValueError, zarr.errors.GroupNotFoundError, zarr.errors.FSPathExistNotDir) as error:
        raise SweepError([f'--resume: {path}: no store of cable_sweep']) from error


def _open(path):
    return zarr.open_group(zarr.DirectoryStore(path), mode='r')


def identity(path):
    """A digest of what the store at `path` is of."""
    with open(os.path.join(path, '.zattrs'), 'rb') as file:
        return hashlib.sha256(file.read()).hexdigest()


def layout_of(root):
    """The Layout of a store that was begun."""
    shapes = {}
    for name, group in root.groups():
        if name != 'vary':
            shapes.update({(name, field): array.shape[2:] for field, array in group.arrays()})
    return Layout(shapes, root['time'].shape[0], root['status'].shape[0], root['status'].chunks[0])


def arrays_of(root):
    """{path in the store: array}, opened once: each opening reads a file."""
    return {array.path: array for _, array in root.arrays(recurse=True)}


def complete_chunks(path):
    """The numbers of the chunks that are there."""
    with os.scandir(os.path.join(path, 'status')) as entries:
        return {int(entry.name) for entry in entries if entry.name.isdigit() and entry.is_file()}


def count_samples(path, layout):
    """How many samples are in a store that may not have been begun."""
    return sum(len(layout.samples_of(chunk)) for chunk in complete_chunks(path)) if os.path.lexists(path) else 0


def damaged_chunks(path):
    """The numbers of the chunks that were there, files of which are no longer there, or not whole."""
    arrays = [array for name, array in arrays_of(_open(path)).items() if name != 'time']
    return [chunk for chunk in sorted(complete_chunks(path)) if not all(_is_whole(path, array, chunk) for array in arrays)]


def _is_whole(path, array, chunk):
    """Whether the files of an array's chunk are as they were written: their checksums, and the lengths in Blosc's headers."""
    for rest in itertools.product(*map(range, array.cdata_shape[1:])):
        name = '.'.join(map(str, (chunk, *rest)))
        try:
            compressed = pathlib.Path(path, array.path, name).read_bytes()
            lengths = struct.unpack_from('<4xI4xI', compressed)
            if lengths != (_CHECKSUM_BYTES + math.prod(array.chunks) * array.dtype.itemsize, len(compressed)):
                return False
            _CHECKSUM.decode(_BLOSC.decode(compressed))
        except (OSError, RuntimeError, struct.error, ValueError, IndexError):
            return False
    return True


def forget(path, chunks):
    """These are to be simulated again."""
    for chunk in chunks:
        with contextlib.suppress(FileNotFoundError):
            os.remove(os.path.join(path, 'status', str(chunk)))


def write_chunk(arrays, layout, chunk, result):
    """Writes a chunk of all arrays; `result`: as simulation.simulate returns it."""
    samples = layout.samples_of(chunk)
    rows = slice(samples.start, samples.stop)
    for (name, field), data in sorted(result.fields.items()):
        arrays[f'{name}/{field}'][rows] = data
    for key, values in sorted(result.drawn.items()):
        arrays[f'vary/{key}'][rows] = values
    arrays['message'][rows] = np.array([_fixed(message) for message in result.messages], dtype=f'S{MESSAGE_LENGTH}')
    arrays['worst'][rows] = np.array(result.worst, dtype=np.int8)
    arrays['status'][rows] = np.array(result.status, dtype=np.int8)


def _fixed(message):
    return message.encode()[:MESSAGE_LENGTH].decode(errors='ignore').encode()


def failures_of(arrays, samples):
    """[(sample, status, message)] of those among `samples` that failed."""
    rows = slice(samples.start, samples.stop)
    status = arrays['status'][rows]
    failed = np.flatnonzero(status > COMPLETE)
    if not len(failed):
        return []
    messages = arrays['message'][rows]
    return [(samples.start + int(index), int(status[index]), messages[index].decode()) for index in failed]


def count_failures(path):
    """{status: how many samples} of those that failed, in the whole store."""
    status = _open(path)['status']
    counts = {WRONG_SCENE: 0, FAULT: 0}
    for chunk in sorted(complete_chunks(path)):
        values = status[chunk * status.chunks[0]:(chunk + 1) * status.chunks[0]]
        for code in counts:
            counts[code] += int(np.count_nonzero(values == code))
    return counts


def remove_remains(path):
    """Removes what killed workers had begun to write aside, as far as it can."""
    for folder, _, files in os.walk(path):
        for file in files:
            if file.endswith('.partial'):
                with contextlib.suppress(OSError):
                    os.remove(os.path.join(folder, file))


@contextlib.contextmanager
def locked(path):
    """Keeps a second cable_sweep out of the store, where the file system can lock a directory; the lock ends with the process."""
    descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno in (errno.EWOULDBLOCK, errno.EAGAIN, errno.EACCES):
            os.close(descriptor)
            raise SweepError([f'--output: {path}: another cable_sweep is at work there']) from error
    try:
        yield
    finally:
        os.close(descriptor)
