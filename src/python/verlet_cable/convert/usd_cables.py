"""The BasisCurves of a text file of USD, as cables."""
import numpy as np

from .cables import RADIUS, Cable, Found, axis_matrix, quaternion_matrix
from .errors import ConvertError
from .usda import read_usda

_UNITS = 0.01  # [m] of a unit where metersPerUnit is not given, as USD has it
_Y_UP = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])
_ARCS = ('references', 'payload', 'inherits', 'specializes', 'variants')
_LEFT_OUT = ': left out'
_STEPS = 8  # straight segments of a cubic part
# Rows: of t^3, t^2, t, 1; columns: of its four points.
_CUBICS = {'bezier': np.array([[-1, 3, -3, 1], [3, -6, 3, 0], [-3, 3, 0, 0], [1, 0, 0, 0.0]]),
           'bspline': np.array([[-1, 3, -3, 1], [3, -6, 3, 0], [-3, 0, 3, 0], [1, 4, 1, 0]]) / 6,
           'catmullRom': np.array([[-1, 3, -3, 1], [2, -5, 4, -1], [-1, 0, 1, 0], [0, 2, 0, 0]]) / 2}
_SOLIDS = ('Cube', 'Sphere', 'Capsule', 'Cylinder', 'Cone', 'Mesh', 'Plane', 'NurbsCurves', 'HermiteCurves', 'NurbsPatch', 'Points',
           'PointInstancer')


def usd_cables(text):
    metadata, prims = read_usda(text)
    found = Found([])
    units = metadata.get('metersPerUnit')
    if units is None:
        units = _UNITS
        found.notes.append('the file has no metersPerUnit: its units are taken as centimetres, as USD has it')
    if not isinstance(units, float) or not 0 < units < np.inf:
        raise ConvertError(f'metersPerUnit: {units!r}; allowed: a number above 0 [m]')
    up = metadata.get('upAxis', 'Y')
    if up not in ('Y', 'Z'):
        raise ConvertError(f'upAxis: {up!r}; allowed: "Y", "Z"')
    if metadata.get('subLayers'):
        found.notes.append('sublayers are not followed')
    root = np.diag([units, units, units, 1.0])
    if up == 'Y':
        root = _Y_UP @ root
        found.notes.append('y is up in the file: turned about x, so that z is')
    for prim in prims:
        _visit(prim, root, found)
    if not found.cables:
        left_out = [note for note in found.notes if note.endswith(_LEFT_OUT)]
        raise ConvertError('no BasisCurves; allowed: a file with at least one', *left_out)
    found.notes.append('USD has no weight and no stiffness of curves: they weigh as much as water, do not stretch, and bend freely; nothing '
                       'holds them')
    return found


def _why_left_out(prim):
    """Why there is nothing of a prim and of what is in it; None if there is."""
    visibility = prim.attributes.get('visibility')
    if prim.metadata.get('active') is False:
        return 'it is not active'
    if prim.specifier == 'over':
        return 'it only changes a prim of another file (over)'
    if visibility and visibility.first() == 'invisible':
        return 'it is invisible at the start'
    return None


def _visit(prim, transform, found):
    if prim.specifier == 'class':
        return
    reason = _why_left_out(prim)
    if reason:
        found.notes.append(f'{prim.path}: {reason}{_LEFT_OUT}')
        return
    for arc in _ARCS:
        if arc in prim.metadata:
            found.notes.append(f'{prim.path}: its {arc} are not followed')
    transform = transform @ _transform(prim, found)
    if prim.type == 'BasisCurves':
        _add_curves(prim, transform, found)
    elif prim.type in _SOLIDS:
        found.notes.append(f'{prim.path}: a {prim.type} is not converted')
    for child in prim.children:
        _visit(child, transform, found)


def _array(prim, name, width, default=None):
    """An attribute as an array (n,) or (n, width), the first of its values over time."""
    attribute = prim.attributes.get(name)
    value = attribute.first() if attribute else None
    if value is None:
        return default
    try:
        array = np.array(value, float).reshape((-1, width) if width > 1 else -1)
        if width > 1 and array.size and np.shape(value)[-1] != width:
            raise ValueError
    except (TypeError, ValueError):
        what = f'a list of {width} numbers each' if width > 1 else 'a list of numbers'
        raise ConvertError(f'{prim.path}.{name}: {str(value)[:60]}; allowed: {what}') from None
    return array


def _add_curves(prim, transform, found):
    points = _array(prim, 'points', 3)
    counts = _array(prim, 'curveVertexCounts', 1)
    if points is None or counts is None:
        missing = 'points' if points is None else 'curveVertexCounts'
        raise ConvertError(f'{prim.path}.{missing}: missing; allowed: one of each')
    if not np.isfinite(counts).all() or (counts != counts.round()).any() or (counts < 2).any() or counts.sum() != len(points):
        raise ConvertError(f'{prim.path}.curveVertexCounts: {[f"{count:g}" for count in counts]}; allowed: integers from 2 whose sum is '
                           f'{len(points)}, which is how many points there are')
    counts = counts.astype(int)
    if any(attribute.samples for attribute in prim.attributes.values()):
        found.notes.append(f'{prim.path}: it moves over time: its first shape is taken')
    basis, is_closed = _kind(prim, found)
    if basis:
        found.notes.append(f'{prim.path}: a cubic curve: {_STEPS} straight segments are in each of its parts')
    scale = abs(np.linalg.det(transform[:3, :3])) ** (1 / 3)
    widths = _widths(prim, counts, [len(_parts(count, basis, is_closed, prim)) + (not is_closed) for count in counts], scale, found)
    colors = _array(prim, 'primvars:displayColor', 3)
    opacity = _array(prim, 'primvars:displayOpacity', 1, np.ones(1))
    placed = points @ transform[:3, :3].T + transform[:3, 3]
    ends = np.cumsum(counts)
    for index, (first, last) in enumerate(zip(ends - counts, ends)):
        element = prim.path + (f', curve {index}' if len(counts) > 1 else '')
        color = None if colors is None or not len(colors) else (*colors[min(index, len(colors) - 1)], *opacity[:1])
        label = prim.name + (f'_{index + 1}' if len(counts) > 1 else '')
        line = placed[first:last]
        found.cables.append(Cable(element, label, _evaluated(line, _parts(len(line), basis, is_closed, prim), basis, is_closed),
                                  widths[index] / 2, color=color))


def _token(prim, name, default, allowed):
    attribute = prim.attributes.get(name)
    value = attribute.first() if attribute and attribute.first() else default
    if value not in allowed:
        quoted = ', '.join(f'"{one}"' for one in allowed)
        raise ConvertError(f'{prim.path}.{name}: {value!r}; allowed: {quoted}')
    return value


def _kind(prim, found):
    """(what its points are, whether it is closed): straight, or what makes a cubic curve of them."""
    kind = _token(prim, 'type', 'cubic', ('linear', 'cubic'))
    basis = _token(prim, 'basis', 'bezier', tuple(_CUBICS)) if kind == 'cubic' else None
    wrap = _token(prim, 'wrap', 'nonperiodic', ('nonperiodic', 'periodic', 'pinned'))
    if wrap == 'periodic':
        found.notes.append(f'{prim.path}: a closed curve: it is left open')
    if wrap == 'pinned' and basis in ('bspline', 'catmullRom'):
        return f'pinned {basis}', False
    return basis, wrap == 'periodic'


def _parts(count, basis, is_closed, prim):
    """Indices of the points of each part of a curve of so many points: two of a straight part, four of a cubic one."""
    count = int(count)
    if basis is None:
        return [(k, k + 1) for k in range(count - 1)]
    is_pinned = basis.startswith('pinned')
    step = 3 if basis == 'bezier' else 1
    least = 2 if is_pinned else 4 - is_closed
    if count < least or (basis == 'bezier' and (count - (not is_closed)) % 3):
        of_bezier = ', 3 more for each further part' if basis == 'bezier' else ''
        raise ConvertError(f'{prim.path}.curveVertexCounts: {count}; allowed: at least {least} for a curve of basis "{basis.split()[-1]}"'
                           f'{of_bezier}')
    if is_pinned:  # -1 and count: as far beyond the end as the next is before it
        return [(k - 1, k, k + 1, k + 2) for k in range(count - 1)]
    if is_closed:
        return [tuple((k + j) % count for j in range(4)) for k in range(0, count, step)]
    return [(k, k + 1, k + 2, k + 3) for k in range(0, count - 3, step)]


def _evaluated(points, parts, basis, is_closed):
    """(n + 1, 3)"""
    if basis is None:
        return points
    ends = np.vstack([points, 2 * points[-1] - points[-2], 2 * points[0] - points[1]])  # the last has the index -1
    at = np.arange(_STEPS) / _STEPS
    powers = np.column_stack([at ** 3, at ** 2, at, at ** 0])
    matrix = _CUBICS[basis.split()[-1]]
    line = [powers @ matrix @ ends[list(part)] for part in parts]
    if not is_closed:  # else it would end where it begins
        line.append(np.ones((1, 4)) @ matrix @ ends[list(parts[-1])])
    return np.vstack(line)


def _widths(prim, counts, joints, scale, found):
    """[m] of each curve. `joints`: how many places each has between and at the ends of its parts."""
    widths = _array(prim, 'widths', 1)
    if widths is None or not len(widths):
        found.notes.append(f'{prim.path}: it has no widths: its radius is {RADIUS:g} m')
        return np.full(len(counts), 2 * RADIUS)
    if (~(widths > 0)).any():
        raise ConvertError(f'{prim.path}.widths: {widths.min():g}; allowed: above 0')
    widths = widths * scale
    if len(widths) == 1:
        return np.full(len(counts), widths[0])
    if len(widths) == len(counts):
        return widths
    if len(widths) != counts.sum() and len(widths) == sum(joints):
        counts = np.array(joints)
    if len(widths) != counts.sum():
        raise ConvertError(f'{prim.path}.widths: {len(widths)} of them; allowed: 1, {len(counts)} (one a curve) or {counts.sum()} (one a '
                           'point)')
    if np.ptp(widths) > 0:
        found.notes.append(f'{prim.path}: its widths vary: each curve has their mean')
    ends = np.cumsum(counts)
    return np.array([widths[first:last].mean() for first, last in zip(ends - counts, ends)])


def _transform(prim, found):
    """Of its points into those of its parent."""
    attribute = prim.attributes.get('xformOpOrder')
    total = np.eye(4)
    for name in (attribute.first() or [] if attribute else []):
        if name == '!resetXformStack!':
            found.notes.append(f'{prim.path}: !resetXformStack! is not followed')
            continue
        is_inverse = name.startswith('!invert!')
        name = name[len('!invert!'):] if is_inverse else name
        one = _operation(prim, name)
        total = total @ (np.linalg.inv(one) if is_inverse else one)
    return total


def _operation(prim, name):
    attribute = prim.attributes.get(name)
    kind = name.split(':')[1] if name.startswith('xformOp:') else ''
    value = attribute.first() if attribute else None
    result = np.eye(4)
    try:
        numbers = np.array(value, float)
        if kind == 'translate':
            result[:3, 3] = numbers
        elif kind == 'scale':
            result[:3, :3] = np.diag(numbers)
        elif kind == 'transform':
            result = numbers.reshape(4, 4).T  # USD has points as rows
        elif kind == 'orient':
            result[:3, :3] = quaternion_matrix(numbers)
        elif kind.startswith('rotate') and sorted(kind[6:]) in (['X'], ['Y'], ['Z'], ['X', 'Y', 'Z']):
            # rotateXYZ turns about x first; its numbers are those about x, y and z.
            angles = dict(zip('XYZ', numbers)) if len(kind) == 9 else {kind[6]: float(numbers)}
            for axis in kind[6:]:
                result[:3, :3] = axis_matrix('XYZ'.index(axis), np.radians(angles[axis])) @ result[:3, :3]
        else:
            raise ConvertError(f'{prim.path}.{name}; allowed: translate, scale, rotateX, rotateXYZ and the like, orient, transform')
    except (TypeError, ValueError, KeyError):
        raise ConvertError(f'{prim.path}.{name}: {value!r}; allowed: its numbers') from None
    return result
