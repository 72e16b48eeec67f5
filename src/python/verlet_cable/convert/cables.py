"""What a conversion finds, and how it becomes a scene."""
import dataclasses
import json
import math
import re
from typing import List, Optional, Tuple

import numpy as np

from .errors import ConvertError

DENSITY = 1000.0       # [kg/m^3] where the source has none: water's, which MuJoCo's geoms have, too
RADIUS = 0.005         # [m] likewise
LEAST_LENGTH = 1e-9    # [m] of a segment
MOST_NAME = 200        # letters
MOST_POINTS = 100001   # of a cable: scenes have up to 100000 segments
MOST_DEPTH = 100       # of elements in elements


@dataclasses.dataclass
class Cable:
    """A cable in metres, in a frame with z up."""
    element: str                                 # in the source, for messages
    name: str
    points: np.ndarray                           # (n + 1, 3)
    radius: float
    linear_density: Optional[float] = None
    bending_stiffness: Optional[List[float]] = None  # [EI] or [EI about y, EI about z]
    torsional_stiffness: float = 0.0
    color: Optional[Tuple[float, ...]] = None    # red, green, blue, alpha
    rest_curvature: str = 'straight'
    start: Optional[str] = None                  # hinge or clamp in the fixed frame
    y_axis: Optional[np.ndarray] = None          # of the material at the start; None: any


@dataclasses.dataclass
class Found:
    """All cables of a file; `notes`: what does not carry over, and what was assumed."""
    cables: List[Cable]
    notes: List[str] = dataclasses.field(default_factory=list)
    gravity: Optional[List[float]] = None
    time_step: Optional[float] = None


def scene_text(found, source):
    """The scene as YAML. Raises ConvertError for cables that it cannot have."""
    errors = [error for cable in found.cables for error in _errors(cable)]
    if errors:
        raise ConvertError(*errors)
    lines = [f'# Made by cable_convert from {json.dumps(source)}.']
    lines += [f'# {note}' for note in found.notes]
    if found.time_step is not None:
        lines.append(f'time_step: {_number(found.time_step)}')
    if found.gravity is not None:
        lines.append(f'gravity: {_numbers(found.gravity)}')
    used = set()
    names = [_unique_name(cable.name, used) for cable in found.cables]
    materials = {}
    for cable, name in zip(found.cables, names):
        materials.setdefault(_material(cable), f'{name}_material')
    lines.append('materials:')
    lines += [f'  {name}: {text}' for text, name in materials.items()]
    lines.append('cables:')
    for cable, name in zip(found.cables, names):
        lines += _cable_lines(cable, name, materials[_material(cable)])
    return '\n'.join(lines) + '\n'


def _errors(cable):
    if len(cable.points) < 2:
        yield f'{cable.element}: {len(cable.points)} points; allowed: at least 2'
        return
    if len(cable.points) > MOST_POINTS:
        yield f'{cable.element}: {len(cable.points)} points; allowed: at most {MOST_POINTS}'
        return
    if not np.isfinite(cable.points).all():
        yield f'{cable.element}: points that are not finite; allowed: finite numbers'
        return
    lengths = np.linalg.norm(np.diff(cable.points, axis=0), axis=1)
    if not lengths.min() > LEAST_LENGTH:
        yield f'{cable.element}: points {lengths.argmin()} and {lengths.argmin() + 1} are at one place; allowed: different ones'
    if not (math.isfinite(cable.radius) and cable.radius > 0):
        yield f'{cable.element}: a radius of {cable.radius:g} m; allowed: above 0'


def _material(cable):
    density = cable.linear_density
    keys = {'linear_density': _number(density if density is not None else DENSITY * math.pi * cable.radius ** 2),
            'radius': _number(cable.radius)}
    stiffness = cable.bending_stiffness
    if stiffness:
        keys['bending_stiffness'] = _number(stiffness[0]) if len(set(stiffness)) == 1 else _numbers(stiffness)
    if cable.torsional_stiffness:
        keys['torsional_stiffness'] = _number(cable.torsional_stiffness)
    return '{' + ', '.join(f'{key}: {value}' for key, value in keys.items()) + '}'


def _cable_lines(cable, name, material):
    steps = np.diff(cable.points, axis=0)
    length = np.linalg.norm(steps, axis=1).sum()
    yield f'  - name: {name}'
    yield f'    length: {_number(length)}'
    yield f'    segments: {len(steps)}'
    yield f'    material: {material}'
    if cable.color is not None:
        yield f'    color: {_numbers(np.clip(cable.color, 0, 1))}'
    if cable.rest_curvature != 'straight':
        yield f'    rest_curvature: {cable.rest_curvature}'
    if cable.start:
        rotation = _rotation(steps[0], cable.y_axis) if cable.start == 'clamp' else [0, 0, 0]
        yield (f'    attachments: [{{name: {name}_start, at: start, type: {cable.start}, offset: {_numbers(cable.points[0])}, '
               f'rotation: {_numbers(rotation)}}}]')
    yield '    initial:'
    yield '      type: points'
    yield '      points:'
    for point in cable.points:
        yield f'        - {_numbers(point)}'


def _rotation(along, y_axis):
    """Roll, pitch, yaw of x along a vector; y is as near to the axis as it can be, None: level."""
    x, y, z = along
    pitch, yaw = math.atan2(-z, math.hypot(x, y)), math.atan2(y, x)
    if y_axis is None:
        return [0, pitch, yaw]
    level = axis_matrix(2, yaw) @ axis_matrix(1, pitch)
    return [math.atan2(y_axis @ level[:, 2], y_axis @ level[:, 1]), pitch, yaw]


def axis_matrix(axis, angle):
    """The rotation by an angle [rad] about x, y or z."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[[i, j], [i, j]] = np.cos(angle)
    matrix[i, j], matrix[j, i] = -np.sin(angle), np.sin(angle)
    return matrix


def quaternion_matrix(quaternion):
    """Of w, x, y, z, normalized."""
    norm = np.linalg.norm(quaternion)
    if len(quaternion) != 4 or not norm > 0:
        raise ValueError
    w, x, y, z = quaternion / norm
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def smallest_turn(direction):
    """The matrix of the smallest rotation that takes x to a unit vector."""
    x, y, z = direction
    if x < -1 + 1e-12:
        return np.diag([-1.0, -1.0, 1.0])
    return quaternion_matrix(np.array([1 + x, 0, -z, y]))


def _number(value):
    return repr(float(value))


def _numbers(values):
    return '[' + ', '.join(map(_number, values)) + ']'


def _unique_name(name, used):
    """As scenes allow it: letters, digits and _, a letter first."""
    start = re.sub(r'[^A-Za-z0-9_]', '_', name)[:MOST_NAME]
    if not re.match('[A-Za-z]', start):
        start = 'cable' + ('_' + start.lstrip('_') if start.lstrip('_') else '')
    name, number = start, 1
    while name in used:
        number += 1
        name = f'{start}_{number}'
    used.add(name)
    return name
