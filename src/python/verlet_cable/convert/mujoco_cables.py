"""The composite cables of a MuJoCo model (MJCF), as cables."""
import math
import xml.etree.ElementTree

import numpy as np

from .cables import DENSITY, LEAST_LENGTH, MOST_DEPTH, MOST_POINTS, Cable, Found, axis_matrix, quaternion_matrix, smallest_turn
from .errors import ConvertError

_PLUGIN = 'mujoco.elasticity.cable'
_CURVE = ('s', 'cos(s)', 'sin(s)', '0')
_HOLDS = {'free': None, 'ball': 'hinge', 'none': 'clamp'}
_TIME_STEP = 0.002   # [s] of models that give none
_LARGEST_STEP = 0.1  # [s] of scenes
_LEAST_BEND = 1e-9   # sine of the angle at the second point below which a cable starts straight
_PASSED_OVER = ('compiler', 'option', 'size', 'visual', 'statistic', 'asset', 'extension', 'worldbody', 'keyframe', 'custom')


def mujoco_cables(text):
    try:
        root = xml.etree.ElementTree.fromstring(text)
    except xml.etree.ElementTree.ParseError as error:
        raise ConvertError(f'{error}; allowed: an XML file') from error
    if root.tag != 'mujoco':
        raise ConvertError(f'<{root.tag}>; allowed: <mujoco>')
    found = Found([], gravity=[0, 0, -9.81], time_step=_TIME_STEP)
    for option in root.findall('option'):
        found.gravity = _numbers(option, 'gravity', 3, found.gravity)
        found.time_step = _numbers(option, 'timestep', 1, [found.time_step])[0]
        if not 0 < found.time_step <= _LARGEST_STEP:
            raise ConvertError(f'<option timestep>: {found.time_step:g}; allowed: above 0, at most {_LARGEST_STEP} [s]')
    if any(_text(flag, 'gravity', 'enable', ('enable', 'disable')) == 'disable' for flag in root.findall('option/flag')):
        found.gravity = [0, 0, 0]
    for child in root:
        if child.tag == 'default':
            found.notes.append('<default>: its values are not applied')
        elif child.tag not in _PASSED_OVER:
            found.notes.append(f'<{child.tag}>: it is not converted')
    compiler = root.find('compiler')
    angles = (math.pi / 180 if _text(compiler, 'angle', 'degree', ('degree', 'radian')) == 'degree' else 1,
              _text(compiler, 'eulerseq', 'xyz'))
    for world in root.findall('worldbody'):
        _visit(world, np.eye(4), True, angles, found, 0)
    if not found.cables:
        raise ConvertError('no <composite type="cable">; allowed: a model with at least one')
    found.notes.append('cables do not stretch; damping, friction and armature of joints and geoms are not converted')
    return found


def _visit(body, frame, is_fixed, angles, found, depth):
    if depth > MOST_DEPTH:
        raise ConvertError(f'{_element(body)}: inside of {depth} others; allowed: at most {MOST_DEPTH}')
    for child in body:
        if child.tag in ('body', 'frame'):
            moves = child.tag == 'body' and any(joint.tag in ('joint', 'freejoint') for joint in child)
            _visit(child, frame @ _pose(child, 'pos', angles), is_fixed and not moves, angles, found, depth + 1)
        elif child.tag == 'composite' and child.get('type') in ('cable', 'rope'):
            _add_cable(child, frame, is_fixed, angles, found)
        elif child.tag == 'composite':
            found.notes.append(f'{_element(child)}: a composite of type {child.get("type")!r} is not converted')
        elif child.tag == 'geom':
            found.notes.append(f'{_element(child)}: it is not converted')


def _element(element):
    name = element.get('name') or element.get('prefix')
    return f'<{element.tag}' + (f' {"name" if element.get("name") else "prefix"}="{name}"' if name else '') + '>'


def _text(element, key, default, allowed=None):
    value = default if element is None else element.get(key, default)
    if allowed and value not in allowed:
        raise ConvertError(f'{_element(element)} {key}: {value!r}; allowed: {", ".join(allowed)}')
    return value


def _numbers(element, key, count, default):
    """`count`: how many at least; None: any number."""
    text = element.get(key)
    if text is None:
        return default
    try:
        numbers = [float(part) for part in text.split()]
        if not all(map(math.isfinite, numbers)) or (count and len(numbers) < count):
            raise ValueError
    except ValueError:
        allowed = 'a finite number' if count == 1 else (f'{count} ' if count else '') + 'finite numbers'
        raise ConvertError(f'{_element(element)} {key}: {text[:60]!r}; allowed: {allowed}') from None
    return numbers


def _pose(element, position, angles):
    """Of what is in an element, in its parent."""
    pose = np.eye(4)
    pose[:3, 3] = _numbers(element, position, 3, [0, 0, 0])[:3]
    unit, sequence = angles
    if element.get('quat'):
        quaternion = np.array(_numbers(element, 'quat', 4, None)[:4])
        if not np.linalg.norm(quaternion) > 0:
            raise ConvertError(f'{_element(element)} quat: {element.get("quat")!r}; allowed: w, x, y, z, not all 0')
        pose[:3, :3] = quaternion_matrix(quaternion)
    elif element.get('euler'):
        for axis, angle in zip(sequence, _numbers(element, 'euler', 3, None)):
            turn = axis_matrix('xyz'.index(axis.lower()), unit * angle)
            # Small letters turn about axes that turn along, capital ones about those of the parent.
            pose[:3, :3] = pose[:3, :3] @ turn if axis.islower() else turn @ pose[:3, :3]
    else:
        for key in ('axisangle', 'xyaxes', 'zaxis'):
            if element.get(key):
                raise ConvertError(f'{_element(element)} {key}: {element.get(key)!r}; allowed: quat or euler instead')
    return pose


def _vertices(cable):
    """(n + 1, 3), as MuJoCo's compiler places them."""
    given = _numbers(cable, 'vertex', None, None)
    if given is not None:
        if len(given) % 3 or len(given) < 6:
            raise ConvertError(f'{_element(cable)} vertex: {len(given)} numbers; allowed: 3 for each of 2 or more points')
        return np.array(given).reshape(-1, 3)
    counts = _numbers(cable, 'count', 1, None)
    if counts is None or counts[0] != round(counts[0]) or counts[0] < 2:
        raise ConvertError(f'{_element(cable)} count: {cable.get("count")!r}; allowed: an integer from 2, or vertex instead')
    if counts[0] > MOST_POINTS:
        raise ConvertError(f'{_element(cable)} count: {cable.get("count")!r}; allowed: at most {MOST_POINTS}')
    if cable.get('curve') is None:
        raise ConvertError(f'{_element(cable)} curve: missing; allowed: up to three of {", ".join(_CURVE)}, or vertex instead')
    curve = cable.get('curve').split()
    curve += ['0'] * (3 - len(curve))
    size = (_numbers(cable, 'size', 1, [1, 0, 0]) + [0, 0])[:3]
    part = np.linspace(0, 1, int(counts[0]))
    columns = {'s': size[0] * part, 'cos(s)': size[1] * np.cos(np.pi * size[2] * part), 'sin(s)': size[1] * np.sin(np.pi * size[2] * part),
               '0': 0 * part}
    for letter in curve:
        if letter not in _CURVE or len(curve) > 3:
            raise ConvertError(f'{_element(cable)} curve: {cable.get("curve")!r}; allowed: up to three of {", ".join(_CURVE)}')
    return np.column_stack([columns[letter] for letter in curve])


def _add_cable(element, frame, is_fixed, angles, found):
    pose = _pose(element, 'offset', angles)
    points = _vertices(element) @ pose[:3, :3].T + pose[:3, 3]
    axes = frame[:3, :3] @ _first_axes(points)
    points = points @ frame[:3, :3].T + frame[:3, 3]
    geom = element.find('geom')
    if geom is None:
        raise ConvertError(f'{_element(element)} geom: missing; allowed: a <geom> of type capsule, cylinder or box')
    shape = _text(geom, 'type', 'sphere', ('capsule', 'cylinder', 'box'))
    size = _numbers(geom, 'size', 3 if shape == 'box' else 1, None)
    if size is None or not min(size[:3 if shape == 'box' else 1]) > 0:
        raise ConvertError(f'{_element(element)} geom size: {geom.get("size")!r}; allowed: numbers above 0 [m]')
    area, (about_y, about_z, about_x) = _section(shape, size)
    name = _text(element, 'prefix', 'cable')
    cable = Cable(_element(element), name, points, math.sqrt(area / math.pi))
    if shape == 'box':
        found.notes.append(f'{_element(element)}: for contact its section is round, with the area of the box')
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    cable.linear_density = _numbers(geom, 'density', 1, [DENSITY])[0] * area
    if geom.get('mass'):
        cable.linear_density = _numbers(geom, 'mass', 1, None)[0] * len(lengths) / lengths.sum()
    elif shape == 'capsule':
        more = 100 * 4 / 3 * size[0] * len(lengths) / max(lengths.sum(), LEAST_LENGTH)
        found.notes.append(f'{_element(element)}: its capsules have caps, which are in each other: with them it weighs {more:.3g} % more '
                           'in MuJoCo')
    if not cable.linear_density > 0:
        raise ConvertError(f'{_element(element)} geom: {cable.linear_density:g} kg/m; allowed: a mass or density above 0')
    if geom.get('rgba'):
        cable.color = tuple(_numbers(geom, 'rgba', 4, None)[:4])
    _add_stiffness(element, cable, about_y, about_z, about_x, found)
    cable.start = _HOLDS[_text(element, 'initial', 'ball', tuple(_HOLDS))]
    if cable.start and not is_fixed:
        found.notes.append(f'{_element(element)}: it is in a body that moves, which is not converted: its start is not held')
        cable.start = None
    if len(set(cable.bending_stiffness or [])) > 1:
        _orient(element, cable, axes, found)
    found.cables.append(cable)


def _first_axes(points):
    """Of the first body of a cable, in its parent: x along it, y in the plane of its first bend, as MuJoCo's compiler has it."""
    steps = np.diff(points[:3], axis=0)
    lengths = np.linalg.norm(steps, axis=1, keepdims=True)
    if not lengths.min() > LEAST_LENGTH:  # an error later
        return np.eye(3)
    directions = steps / lengths
    across = np.cross(directions[0], directions[-1])
    if not np.linalg.norm(across) > _LEAST_BEND:
        return smallest_turn(directions[0])
    z_axis = across / np.linalg.norm(across)
    return np.column_stack([directions[0], np.cross(z_axis, directions[0]), z_axis])


def _orient(element, cable, axes, found):
    """Has a cable that is stiffer about one axis bend about the axes of its first body."""
    if cable.start == 'clamp':
        cable.y_axis = axes[:, 1]
        return
    # Nothing says how its material is turned about it: the scene does so by the smallest turn of the fixed frame.
    level = smallest_turn(axes[:, 0])
    angle = math.degrees(math.atan2(axes[:, 1] @ level[:, 2], axes[:, 1] @ level[:, 1]))
    quarters = round(angle / 90)
    if quarters % 2:
        cable.bending_stiffness.reverse()
    if abs(angle - 90 * quarters) > 0.1:
        found.notes.append(f'{_element(element)}: its section is turned by {angle:.3g} degrees about it, which takes a clamp at its start: '
                           f'it is turned by {90 * quarters} degrees')


def _section(shape, size):
    """[m^2], [m^4]: area; second moments about y and z; torsion constant: those of MuJoCo's plugin."""
    if shape != 'box':
        second = math.pi * size[0] ** 4 / 4
        return math.pi * size[0] ** 2, (second, second, 2 * second)
    height, width = size[1:3]
    a, b = max(height, width), min(height, width)
    torsion = a * b ** 3 * (16 / 3 - 3.36 * b / a * (1 - b ** 4 / a ** 4 / 12))
    return 4 * height * width, ((2 * width) ** 3 * 2 * height / 12, (2 * height) ** 3 * 2 * width / 12, torsion)


def _add_stiffness(element, cable, about_y, about_z, about_x, found):
    plugin = element.find('plugin')
    if plugin is None:
        found.notes.append(f'{_element(element)}: it has no plugin {_PLUGIN}: it bends freely')
        return
    if plugin.get('plugin') != _PLUGIN:
        raise ConvertError(f'{_element(element)} plugin: {plugin.get("plugin")!r}; allowed: {_PLUGIN!r}')
    configured = {config.get('key'): config for config in plugin.findall('config')}
    moduli = {}
    for key in ('twist', 'bend'):
        moduli[key] = _numbers(configured[key], 'value', 1, [0])[0] if key in configured else 0
        if moduli[key] < 0:
            raise ConvertError(f'{_element(element)} {key}: {moduli[key]:g}; allowed: 0 or more [Pa]')
    cable.bending_stiffness = [about_y * moduli['bend'], about_z * moduli['bend']]
    cable.torsional_stiffness = about_x * moduli['twist']
    flat = 'flat' in configured and configured['flat'].get('value') == 'true'
    steps = np.diff(cable.points, axis=0)
    # Points at one place are an error later.
    directions = steps / np.maximum(np.linalg.norm(steps, axis=1, keepdims=True), LEAST_LENGTH)
    is_straight = np.ptp(directions, axis=0).max() < 1e-9
    if moduli['bend'] > 0 and not flat and not is_straight:
        cable.rest_curvature = 'initial'
