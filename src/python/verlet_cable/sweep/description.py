"""SWEEP.yaml: what is to be simulated, how often, and what is kept of it. Every error is found before anything is simulated."""
import copy
import errno
import hashlib
import math
import os
import stat

from verlet_cable.sim import Scene, SceneError
from verlet_cable.wrong_arguments import meant

from . import text_yaml, trial
from .errors import SweepError, rejected, unknown_key
from .paths import holder_of, parse_path, path_text, why_absent
from .text_yaml import number, shown
from .variations import Variation, read_variation

# Fields of World and Batch, and their units.
FIELDS = {
    'positions': 'm', 'velocities': 'm/s', 'tension': 'N', 'curvature': '1/m', 'twist': 'rad/m', 'plastic_curvature': '1/m',
    'orientations': 'quaternion x, y, z, w', 'wrench': 'N, N m', 'body_pose': 'm, quaternion x, y, z, w', 'body_twist': 'm/s, rad/s',
}
MOTION = 'motion'  # the key of the varied values under which the motion is that was drawn
_KEYS = ('scene', 'motion', 'motions', 'loads', 'duration', 'record', 'samples', 'seed', 'vary')
_RECORD_KEYS = ('rate', 'fields')
_SCENE_KEYS = ('materials', 'cables', 'nets', 'particles', 'bodies')  # of which every scene has one
_NOT_VARIED = {
    'segments': 'all samples have as many nodes', 'rows': 'all samples have as many nodes', 'columns': 'all samples have as many nodes',
    'name': 'the arrays of the store have the names of the scene',
}
_MOST_SAMPLES = 10**9
_MOST_STEPS = 2**53
_LARGEST_SEED = 2**63 - 1
_LARGEST_DESCRIPTION = 1 << 20  # [byte]
_LARGEST_SCENE = 16 << 20       # [byte] as Scene reads
_MOST_VARIED = 1000             # keys: a scene is read for each
_DEFAULT_RATE = 100.0
_TOLERANCE = 1e-6  # of a step, of a row: as cable_sim's


class Sweep:
    """A checked description.

    scene_text, scene_name, tree: the scene's file, and what is in it (scalars are texts); folder: where paths start, absolute.
    motions: files as they were given, none or one or more; motion_digests: {file: SHA-256}. loads: None, or a file
    likewise; loads_digest. duration [s], rate [Hz], fields, samples, seed.
    variations: {path: Variation}, with one of MOTION where there are several.
    """

    def to_attributes(self):
        """The description as the store keeps it; from_attributes reads it again."""
        loads = {'loads': self.loads, 'loads_digest': self.loads_digest} if self.loads else {}
        return {
            'scene': self.scene_name, 'motions': self.motions, 'motion_digests': self.motion_digests, **loads,
            'duration': self.duration, 'record': {'rate': self.rate, 'fields': self.fields}, 'samples': self.samples, 'seed': self.seed,
            'vary': {key: {variation.kind: variation.parameters} for key, variation in self.variations.items()},
        }

    @staticmethod
    def from_attributes(attributes, scene_text, folder):
        sweep = Sweep()
        sweep.scene_name, sweep.motions, sweep.motion_digests = attributes['scene'], attributes['motions'], attributes['motion_digests']
        sweep.loads, sweep.loads_digest = attributes.get('loads'), attributes.get('loads_digest')
        sweep.duration, sweep.samples, sweep.seed = attributes['duration'], attributes['samples'], attributes['seed']
        sweep.rate, sweep.fields = attributes['record']['rate'], attributes['record']['fields']
        sweep.variations = {key: Variation(*next(iter(value.items()))) for key, value in attributes['vary'].items()}
        sweep.scene_text, sweep.folder = scene_text, folder
        sweep.tree = text_yaml.parse(scene_text, sweep.scene_name, [])
        return sweep

    @property
    def scene_folder(self):
        return os.path.dirname(os.path.join(self.folder, self.scene_name))

    def motion_path(self, file):
        return os.path.join(self.folder, file)

    @property
    def loads_path(self):
        return self.loads and os.path.join(self.folder, self.loads)

    @property
    def rows(self):
        return 1 + math.floor(self.duration * self.rate + _TOLERANCE)

    def steps(self, time_step):
        """How many steps a sample takes, and the step that each row belongs to."""
        steps_a_row = 1 / (self.rate * time_step)
        of_rows = [math.ceil(row * steps_a_row - _TOLERANCE) for row in range(self.rows)]
        return max(math.ceil(self.duration / time_step - _TOLERANCE), of_rows[-1]), of_rows

    def rate_error(self, time_step):
        """None, or that rows are closer than this step."""
        if self.rate * time_step <= 1 + _TOLERANCE:
            return None
        return rejected('record.rate', f'{self.rate:g}', f'at most 1 / time_step = {1 / time_step:g} Hz')


def read_sweep(path):
    """The Sweep that a file describes, and its Scene as it stands, without variations. Raises SweepError with all that is wrong."""
    errors = []
    name = os.path.basename(path)
    values = text_yaml.parse(_text_of(path, path, _LARGEST_DESCRIPTION, errors), name, errors)
    if errors:
        raise SweepError(errors)
    if not isinstance(values, dict):
        raise SweepError([rejected(name, shown(values), 'keys ' + ', '.join(_KEYS))])
    if 'scene' not in values and any(key in values for key in _SCENE_KEYS):
        raise SweepError([f'{name}: this is a scene, not a sweep; allowed: a file that names it, as `scene: {name}`, and says what to '
                          'vary: doc/sweeps.md'])
    sweep = Sweep()
    sweep.folder = os.path.dirname(os.path.abspath(path))
    for key in values:
        if key not in _KEYS:
            errors.append(unknown_key(key, shown(values[key]), _KEYS))
    scene = _read_scene(sweep, values, errors)
    _read_numbers(sweep, values, errors)
    _read_record(sweep, values.get('record'), errors)
    if scene is not None and sweep.rate is not None:
        rate_error = sweep.rate_error(scene.time_step)
        errors += [] if rate_error is None else [rate_error]
        if sweep.duration is not None and sweep.duration / scene.time_step > _MOST_STEPS:
            errors.append(rejected('duration', f'{sweep.duration:g}', f'at most {_MOST_STEPS} steps of {scene.time_step:g} s'))
    sweep.variations = {}
    _read_variations(sweep, values, errors)
    if scene is not None:
        errors += trial.value_errors(sweep, sweep.variations)
        errors += trial.field_errors(sweep, scene, {index: field for index, field in enumerate(sweep.fields or []) if field in FIELDS})
    _read_motions(sweep, values, errors)
    _read_loads(sweep, values, scene, errors)
    if not errors:
        errors += trial.holder_errors(sweep, scene)
    if errors:
        raise SweepError(errors)
    return sweep, scene


def _open(path):
    """A file's bytes to be read. What is no file may have no end, or nobody who writes it: OSError."""
    file = open(path, 'rb', opener=lambda name, flags: os.open(name, flags | os.O_NONBLOCK))
    if stat.S_ISREG(os.fstat(file.fileno()).st_mode):
        return file
    file.close()
    raise OSError(errno.EINVAL, 'it is not a file')


def _text_of(path, key, largest, errors):
    try:
        with _open(path) as file:
            content = file.read(largest + 1)
        if len(content) <= largest:
            return content.decode('utf-8')
        errors.append(rejected(key, f'more than {largest} bytes', 'less'))
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else 'not UTF-8'
        errors.append(rejected(key, reason, 'a file that can be read'))
    return ''


def _read_scene(sweep, values, errors):
    sweep.scene_name = values.get('scene')
    sweep.tree = None
    if not isinstance(sweep.scene_name, str) or not sweep.scene_name:
        errors.append(rejected('scene', shown(sweep.scene_name), 'the name of a scene file; required'))
        return None
    path = os.path.join(sweep.folder, sweep.scene_name)
    before = len(errors)
    sweep.scene_text = _text_of(path, f'scene: {sweep.scene_name}', _LARGEST_SCENE, errors)
    if len(errors) > before:
        return None
    try:
        scene = Scene.load(path)
    except SceneError as error:
        errors += [f'{sweep.scene_name}: {text}' for text in error.errors]
        # The tree of it is for errors of the values varied. PyYAML has no limits: what was refused is no larger than a description.
        if len(sweep.scene_text) <= _LARGEST_DESCRIPTION:
            sweep.tree = text_yaml.parse(sweep.scene_text, sweep.scene_name, [])
        return None
    sweep.tree = text_yaml.parse(sweep.scene_text, sweep.scene_name, errors)
    return scene


def _read_number(key, values, default, is_allowed, allowed, errors):
    name = key.rpartition('.')[2]
    if name not in values and default is not None:
        return default
    value = number(values.get(name))
    if value is None or not is_allowed(value):
        errors.append(rejected(key, shown(values.get(name)), allowed + ('' if default is not None else '; required')))
        return None
    return value


def _read_integer(key, values, default, smallest, largest, errors):
    text = values.get(key)
    if key not in values and default is not None:
        return default
    # Not by way of a double, which has no room for every seed.
    is_digits = isinstance(text, str) and text.isascii() and text.isdigit() and len(text) <= len(str(largest))
    if is_digits and smallest <= int(text) <= largest:
        return int(text)
    value = number(text)
    if value is not None and value.is_integer() and smallest <= value <= min(largest, 2**53):
        return int(value)
    errors.append(rejected(key, shown(text), f'an integer from {smallest} to {largest}' + ('' if default is not None else '; required')))
    return None


def _is_positive(value):
    return 0 < value < math.inf


def _read_numbers(sweep, values, errors):
    sweep.duration = _read_number('duration', values, None, _is_positive, 'a finite number of seconds, more than 0', errors)
    sweep.samples = _read_integer('samples', values, None, 1, _MOST_SAMPLES, errors)
    sweep.seed = _read_integer('seed', values, 0, 0, _LARGEST_SEED, errors)


def _read_record(sweep, record, errors):
    sweep.rate = sweep.fields = None
    if not isinstance(record, dict):
        errors.append(rejected('record', shown(record), '{rate: HZ, fields: [...]}; required'))
        return
    for key in record:
        if key not in _RECORD_KEYS:
            errors.append(unknown_key(f'record.{key}', shown(record[key]), _RECORD_KEYS))
    sweep.rate = _read_number('record.rate', record, _DEFAULT_RATE, _is_positive, 'a finite number of Hz, more than 0', errors)
    sweep.fields = record.get('fields')
    if not isinstance(sweep.fields, list) or not sweep.fields:
        errors.append(rejected('record.fields', shown(sweep.fields), 'a list of ' + ', '.join(FIELDS) + '; required'))
        return
    for index, field in enumerate(sweep.fields):
        if not isinstance(field, str) or field not in FIELDS:
            near = meant(field, FIELDS) if isinstance(field, str) else ''
            errors.append(rejected(f'record.fields[{index}]', shown(field) + near, 'one of ' + ', '.join(FIELDS)))
        elif field in sweep.fields[:index]:
            errors.append(rejected(f'record.fields[{index}]', field, 'each field once'))


def _read_variations(sweep, values, errors):
    vary = values.get('vary')
    if vary is None:
        return
    if not isinstance(vary, dict):
        errors.append(rejected('vary', shown(vary), 'keys of the scene, and how each varies'))
        return
    if len(vary) > _MOST_VARIED:
        errors.append(rejected('vary', f'{len(vary)} keys', f'at most {_MOST_VARIED}'))
        return
    paths = {}
    for text, value in vary.items():
        key = f'vary.{text}'
        variation = read_variation(key, value, errors)
        parts = parse_path(text)
        if parts is None:
            errors.append(f'{key}: no key of a scene; allowed: names and indices such as materials.my_hose.radius, cables[0].length')
            continue
        before = len(errors)
        if parts[-1] in _NOT_VARIED:
            errors.append(f'{key}: cannot vary; {_NOT_VARIED[parts[-1]]}')
        if sweep.tree is not None:
            reason = why_absent(sweep.tree, parts) or _why_unknown(sweep, parts, value)
            if reason:
                errors.append(f'{key}: not in {sweep.scene_name}; {reason}')
        for other in paths:
            if parts[:len(other)] == other or other[:len(parts)] == parts:
                errors.append(f'{key}: varies with {paths[other]}, too; allowed: each value of the scene once')
        paths[parts] = key
        if variation is not None and len(errors) == before:
            sweep.variations[text] = variation


def _why_unknown(sweep, parts, value):
    """None if a scene can have this key, else what the scene's reader says of it."""
    if isinstance(parts[-1], int) or parts[-1] in holder_of(sweep.tree, parts):
        return None
    tree = copy.deepcopy(sweep.tree)
    holder_of(tree, parts)[parts[-1]] = value
    try:
        Scene.from_dict(tree, directory=sweep.scene_folder)
    except SceneError as error:
        unknown = f'{path_text(parts)}: unknown key'
        return next((text for text in error.errors if text.startswith(unknown)), None)
    return None


def _read_motions(sweep, values, errors):
    sweep.motions = []
    sweep.motion_digests = {}
    if 'motion' in values and 'motions' in values:
        errors.append(rejected('motions', shown(values['motions']), 'motion or motions, not both'))
        return
    if 'motion' in values:
        files = {'motion': values['motion']}
    elif 'motions' in values:
        if not isinstance(values['motions'], list) or not values['motions']:
            errors.append(rejected('motions', shown(values['motions']), 'a list of names of files'))
            return
        files = {f'motions[{index}]': file for index, file in enumerate(values['motions'])}
    else:
        return
    for key, file in files.items():
        if not isinstance(file, str) or not file:
            errors.append(rejected(key, shown(file), 'the name of a motion file'))
            continue
        try:
            sweep.motion_digests[file] = digest_of(sweep.motion_path(file))
            sweep.motions.append(file)
            errors += [f'{key}: {file}: {text}' for text in trial.motion_errors(sweep.motion_path(file))]
        except OSError as error:
            errors.append(rejected(f'{key}: {file}', error.strerror, 'a file that can be read'))
    if 'motions' in values:
        sweep.variations[MOTION] = Variation('choice', sweep.motions)


def _read_loads(sweep, values, scene, errors):
    sweep.loads = sweep.loads_digest = None
    if 'loads' not in values:
        return
    file = values['loads']
    if not isinstance(file, str) or not file:
        errors.append(rejected('loads', shown(file), 'the name of a file of loads'))
        return
    sweep.loads = file
    try:
        sweep.loads_digest = digest_of(sweep.loads_path)
    except OSError as error:
        errors.append(rejected(f'loads: {file}', error.strerror, 'a file that can be read'))
        return
    if scene is not None:
        errors += [f'loads: {file}: {text}' for text in trial.loads_errors(sweep.loads_path, scene)]


def digest_of(path):
    """SHA-256 of a file."""
    digest = hashlib.sha256()
    with _open(path) as file:
        for block in iter(lambda: file.read(1 << 20), b''):
            digest.update(block)
    return digest.hexdigest()
