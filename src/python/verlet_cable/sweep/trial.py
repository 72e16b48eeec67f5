"""What the simulation says of a description before anything is simulated: motions, values that are drawn, fields, frames, guides."""
import copy
import csv

import numpy as np

from verlet_cable.sim import Batch, Scene, SceneError, World

from .errors import rejected
from .paths import holder_of, parse_path
from .text_yaml import shown

_MOST_LISTED = 5
_NODE_FIELDS = ('positions', 'velocities', 'tension', 'curvature', 'twist', 'plastic_curvature', 'orientations')
_ANY_SCENE = {'particles': [{'name': 'particle', 'mass': '1', 'position': ['0', '0', '0']}]}


def motion_errors(path):
    """What is wrong with a motion file, whatever the scene; without its path, which the sweep names in its own way."""
    return _errors_of('motion', Scene.from_dict(_ANY_SCENE), path)


def loads_errors(path, scene):
    """What is wrong with a file of loads on a scene, likewise."""
    return _errors_of('loads', scene, path)


def _errors_of(argument, scene, path):
    try:
        World(scene, **{argument: path})
        return []
    except (ValueError, KeyError) as error:
        lines = getattr(error, 'errors', None) or [str(error)]
        named = f'{argument}: "{path}": '
        return [line[len(named):] if line.startswith(named) else line for line in lines]


def value_errors(sweep, variations):
    """Which of the variations {path in the scene: Variation} the scene refuses, whatever is drawn: one with a wrong type, say."""
    errors = []
    for text, variation in variations.items():
        parts = parse_path(text)
        tree = copy.deepcopy(sweep.tree)
        reasons = []
        for value in variation.examples():
            holder_of(tree, parts)[parts[-1]] = value
            try:
                Scene.from_dict(tree, directory=sweep.scene_folder)
                break
            except SceneError as error:
                reasons.append('; '.join(error.errors))
        else:
            errors.append(f'vary.{text}.{variation.kind}: {shown(variation.parameters)}: the scene refuses what is drawn: {reasons[0]}')
    return errors


def field_errors(sweep, scene, fields):
    """Which of the fields {index in the list: name} nothing in the scene has."""
    batch = Batch([scene], threads=1)
    return [rejected(f'record.fields[{index}]', field, f'fields of what {sweep.scene_name} has')
            for index, field in fields.items() if not list(rows_of(batch, scene, field))]


def rows_of(batch, scene, field):
    """(name, shape) of everything in the scene that has the field."""
    if field == 'wrench':
        names = scene.attachment_names
    elif field in ('body_pose', 'body_twist'):
        names = scene.body_names
    else:
        names = [*scene.cable_names, *scene.net_names, *scene.particle_names]
    for name in names:
        try:
            yield name, tuple(np.shape(getattr(batch, field)(name))[1:])
        except (KeyError, ValueError):
            continue


def holder_errors(sweep, scene):
    """Which frames hold something and have no pose, in the scene or in a motion."""
    held = set(_holding_frames(sweep.tree))
    errors = []
    for frame, motions in _unplaced_frames(sweep, scene).items():
        if frame in held:
            where = f' in {_listed(motions)}' if motions[0] else ''
            errors.append(rejected('scene', f'{sweep.scene_name}: frame {frame}: it has no pose{where}',
                                   f'initial_pose: [x, y, z, roll, pitch, yaw] (m, rad) beside frame: {frame}, or rows of it in each motion'))
    return errors


def notes(sweep, scene):
    """What a user may not have meant: frames of one name here and of another there, fields that guides make impossible."""
    return _notes_of_frames(sweep, scene) + _notes_of_guides(sweep, scene)


def _notes_of_frames(sweep, scene):
    if 'robot' in sweep.tree:  # whose links are frames, too, which Scene does not tell
        return []
    files = {}
    for motion in sweep.motions:
        unused = sorted(_frames_of(sweep.motion_path(motion)) - set(scene.frame_names) - {scene.frame_id})
        if unused:
            files.setdefault(f'the scene does not use frames {_listed(unused)}', []).append(motion)
    for frame, motions in _unplaced_frames(sweep, scene).items():
        files.setdefault(f'nothing places frame {frame}, and the obstacles in it: at the origin', []).extend(motions)
    return [(f'{_listed(motions)}: ' if motions[0] else '') + text for text, motions in files.items()]


def _unplaced_frames(sweep, scene):
    """{frame: [motion]} of frames that neither the scene nor that motion (None: there is none) gives a pose."""
    if 'robot' in sweep.tree:  # whose links are placed, and not told by Scene
        return {}
    placed = set(_placed_frames(sweep.tree))
    unplaced = {}
    for motion in sweep.motions or [None]:
        moved = _frames_of(sweep.motion_path(motion)) if motion else set()
        for frame in sorted(set(scene.frame_names) - moved - placed):
            unplaced.setdefault(frame, []).append(motion)
    return unplaced


def _holding_frames(tree):
    """Names of the frames that attachments and guides are in."""
    for owner in [owner for key in ('cables', 'nets', 'bodies') for owner in tree.get(key) or []]:
        yield from (holder['frame'] for holder in owner.get('attachments') or [] if 'frame' in holder)
    yield from (guide['frame'] for guide in tree.get('guides') or [] if 'frame' in guide)


def _placed_frames(tree):
    """Names of the frames that have an initial_pose."""
    if isinstance(tree, dict):
        if tree.get('initial_pose') is not None and isinstance(tree.get('frame'), str):
            yield tree['frame']
        for value in tree.values():
            yield from _placed_frames(value)
    elif isinstance(tree, list):
        for value in tree:
            yield from _placed_frames(value)


def _frames_of(path):
    with open(path, encoding='utf-8', newline='') as file:
        rows = csv.reader(file)
        next(rows)
        return {row[1].strip() for row in rows if len(row) > 1}


def _listed(names):
    text = ', '.join(names[:_MOST_LISTED])
    return text if len(names) <= _MOST_LISTED else f'{text} and {len(names) - _MOST_LISTED} more'


def _notes_of_guides(sweep, scene):
    fields = [field for field in sweep.fields if field in _NODE_FIELDS]
    if not scene.guide_names or not fields:
        return []
    return [f'guides ({_listed(scene.guide_names)}) change the number of nodes of a cable that slides through them; '
            f'samples in which they do fail, since they have no {_listed(fields)} of one shape']
