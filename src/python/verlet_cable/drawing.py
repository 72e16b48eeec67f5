"""World.draw: a picture of a world by matplotlib. Everything is made of flat faces, which are drawn from far to near."""
import io
import itertools
import math
import numbers
import os

import numpy as np

_DPI = 100
_SIZES = (50, 10000)      # [pixel] allowed
_LISTED = 10              # where there are no more cables and nets, a legend has their names
_LABELLED = 6             # likewise bodies, whose names are beside them
_SIDES = 8                # of what is drawn of a cable's section
_FACES = 40000            # of cables: with more segments, sections have fewer sides
_LEAST_WIDTH = 2          # [pixel] of cables
_LEAST_PART = 0.25        # of the largest side of the view, of each of its sides
_SPLIT = 24               # a side of the view is so many faces long: they are drawn in the order of their middles
_FAR_WEIGHT = 8           # of a face's farthest corner where faces are ordered
_ROOM = (0.74, 0.74)      # of the picture's width and height, for the box of the axes
_ELEVATION, _FLAT_ELEVATION = 20.0, 45.0
_LIGHT = np.array([-0.35, -0.55, 0.76])
_AMBIENT = 0.55
_NET_RADIUS = 1e-3        # [m]
_OBSTACLE, _BODY = (0.8, 0.8, 0.8), (1.0, 0.6, 0.25)
_PLANE = (0.93, 0.93, 0.9)


def draw(world, path=None, view=None, size=(800, 600)):
    """See World.draw."""
    path, view, size = _checked(path, view, size)
    try:
        import matplotlib  # noqa: F401
        from mpl_toolkits.mplot3d import Axes3D  # noqa: F401
    except ImportError as error:
        raise ImportError(f'World.draw: {error}; it needs matplotlib (Debian: sudo apt-get install python3-matplotlib; '
                          'pip install matplotlib)') from error
    picture = _png(world, view, size)
    if path is None:
        return picture
    with open(path, 'wb') as file:
        file.write(picture)
    return None


def _checked(path, view, size):
    if path is not None:
        if not isinstance(path, (str, bytes, os.PathLike)):
            raise TypeError(f'path: {path!r}; allowed: None, or the name of a file that ends in .png')
        path = os.fsdecode(path)
        if not path.endswith('.png'):
            raise ValueError(f'path: {path!r}; allowed: a name that ends in .png')
    if view is not None:
        view = _pair('view', view, numbers.Real, 'None, or (elevation, azimuth): two finite numbers [degree]', math.isfinite)
    allowed = f'(width, height): two integers from {_SIZES[0]} to {_SIZES[1]} [pixel]'
    return path, view, _pair('size', size, numbers.Integral, allowed, lambda number: _SIZES[0] <= number <= _SIZES[1])


def _pair(name, value, kind, allowed, is_good):
    if isinstance(value, (str, bytes, dict)) or not hasattr(value, '__len__') or not hasattr(value, '__getitem__'):
        raise TypeError(f'{name}: {value!r}; allowed: {allowed}')
    values = list(value)
    if len(values) != 2 or not all(isinstance(number, kind) and is_good(number) for number in values):
        raise ValueError(f'{name}: {value!r}; allowed: {allowed}')
    return tuple(values)


class _Faces:
    """Polygons and their colors, lit from above. `towards`: the direction to who looks."""

    def __init__(self, towards):
        self.towards, self.polygons, self.colors = towards, [], []

    def add(self, polygon, normal, color):
        length = np.linalg.norm(normal)
        # Sheets are seen from both sides.
        light = abs(np.dot(normal, _LIGHT)) / length if length > 0 else 1
        self.polygons.append(polygon)
        self.colors.append((*np.asarray(color[:3]) * (_AMBIENT + (1 - _AMBIENT) * light), *color[3:]))

    def add_solid(self, solid, color, longest):
        """`longest` [m]: quadrilaterals that are longer are split."""
        points, faces = solid
        for face in faces:
            corners = points[face]
            normal = np.cross(corners[1] - corners[0], corners[-1] - corners[0])
            for part in _split(corners, longest):
                # Faces are drawn in the order of their corners' mean. Of a solid the farthest corner counts most, so that what lies on
                # it is drawn later.
                far = int(np.argmin(part @ self.towards))
                self.add(np.insert(part, far, [part[far]] * _FAR_WEIGHT, axis=0), normal, color)

    def add_tube(self, points, radii, color, sides):
        """`radii` [m]: of each segment."""
        for start, end, radius in zip(points[:-1], points[1:], radii):
            along = end - start
            length = np.linalg.norm(along)
            if not length > 0:
                continue
            first = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
            first /= np.linalg.norm(first)
            second = np.cross(along / length, first)
            angles = 2 * np.pi * np.arange(sides + 1) / sides
            ring = np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second)
            for here, there in zip(ring[:-1], ring[1:]):
                self.add(np.array([start + radius * here, start + radius * there, end + radius * there, end + radius * here]), here + there,
                         color)

    def draw(self, axes, **look):
        from mpl_toolkits.mplot3d.art3d import Poly3DCollection
        if self.polygons:
            axes.add_collection3d(Poly3DCollection(self.polygons, facecolors=self.colors, edgecolors=self.colors, linewidths=0.3, **look))


def _split(corners, longest):
    if len(corners) != 4:
        return [corners]
    a, b, c, d = corners
    across, along = (max(1, min(_SPLIT, math.ceil(np.linalg.norm(side) / longest))) for side in (b - a, d - a))
    u, v = np.linspace(0, 1, across + 1), np.linspace(0, 1, along + 1)

    def at(x, y):
        return (1 - y) * ((1 - x) * a + x * b) + y * ((1 - x) * d + x * c)

    return [np.array([at(x0, y0), at(x1, y0), at(x1, y1), at(x0, y1)])
            for x0, x1 in zip(u[:-1], u[1:]) for y0, y1 in zip(v[:-1], v[1:])]


def _limits(shapes):
    """(lowest, highest) corner of what is seen: everything but planes, of which there is what is near."""
    clouds = [points for _, points, *_ in shapes['cables'] + shapes['nets']]
    clouds += [points for _, (points, _), _ in shapes['particles']]
    clouds += [points for points, _ in shapes['obstacles']]
    for _, position, solids in shapes['bodies']:
        clouds += [position, *(points for points, _ in solids)]
    points = np.concatenate(clouds) if clouds else np.zeros((1, 3))
    low, high = points.min(axis=0), points.max(axis=0)
    for origin, normal in shapes['planes']:
        middle, reach = (low + high) / 2, max((high - low).max(), 1e-3)
        foot = middle - np.dot(middle - origin, normal) * normal
        if np.dot(middle - origin, normal) < reach + np.linalg.norm(high - low) / 2:
            low, high = np.minimum(low, foot), np.maximum(high, foot)
    size = high - low
    margin = np.maximum(0.03 * size.max(), 0.5 * (_LEAST_PART * size.max() - size))
    margin = np.maximum(margin, 1e-3)
    return low - margin, high + margin


def _plane_in_box(origin, normal, low, high):
    """The corners of the part of a plane that is in a box, in order."""
    corners = np.array(list(itertools.product(*zip(low, high))))
    found = []
    for first, last in itertools.combinations(corners, 2):
        if np.count_nonzero(first != last) != 1:
            continue
        height, rise = np.dot(first - origin, normal), np.dot(last - first, normal)
        if rise != 0 and 0 <= -height / rise <= 1:
            found.append(first - height / rise * (last - first))
    if len(found) < 3:
        return None
    found = np.array(found)
    middle = found.mean(axis=0)
    first = found[np.argmax(np.linalg.norm(found - middle, axis=1))] - middle
    second = np.cross(normal, first)
    return found[np.argsort(np.arctan2((found - middle) @ second, (found - middle) @ first))]


def _colors(shapes):
    """Those of the scene where they tell cables and nets apart, else matplotlib's."""
    from matplotlib.colors import to_rgb
    given = [tuple(thing[3]) for thing in shapes['cables'] + shapes['nets']]
    if len(set(given)) == len(given):
        return given
    return [to_rgb(f'C{index % 10}') for index in range(len(given))]


def _png(world, view, size):
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    shapes = world._shapes()
    low, high = _limits(shapes)
    extent = high - low
    figure = Figure(figsize=(size[0] / _DPI, size[1] / _DPI), dpi=_DPI)
    FigureCanvasAgg(figure)
    side = max(size)  # matplotlib has square ones: it reaches beyond the picture, into which `_fit` puts what it shows
    width, height = side / size[0], side / size[1]
    axes = figure.add_axes([0.5 - width / 2, 0.47 - height / 2, width, height], projection='3d', computed_zorder=False)
    axes.set_proj_type('ortho')
    is_across_y = extent[1] > extent[0]
    is_flat = extent[2] <= 1.01 * _LEAST_PART * extent.max()
    elevation, azimuth = view or (_FLAT_ELEVATION if is_flat else _ELEVATION, -25.0 if is_across_y else -65.0)
    axes.view_init(elevation, azimuth)
    _label(axes, low, high, extent)
    metres_a_pixel = _fit(axes, low, high, size)
    angles = np.radians([elevation, azimuth])
    towards = np.array([np.cos(angles[0]) * np.cos(angles[1]), np.cos(angles[0]) * np.sin(angles[1]), np.sin(angles[0])])
    _draw_planes(axes, shapes, low, high, towards)
    colors = _colors(shapes)
    faces = _Faces(towards)
    longest = extent.max() / _SPLIT
    for solid in shapes['obstacles']:
        faces.add_solid(solid, _OBSTACLE, longest)
    for _, _, solids in shapes['bodies']:
        for solid in solids:
            faces.add_solid(solid, _BODY, longest)
    for _, solid, color in shapes['particles']:
        faces.add_solid(solid, color, longest)
    segments = sum(len(cable[1]) for cable in shapes['cables'])
    sides = int(min(_SIDES, max(3, _FACES // max(segments, 1))))
    thinnest = 0.5 * _LEAST_WIDTH * metres_a_pixel
    for (_, points, radii, _), color in zip(shapes['cables'], colors):
        faces.add_tube(points, np.maximum(radii, thinnest), color, sides)
    for (_, points, links, _), color in zip(shapes['nets'], colors[len(shapes['cables']):]):
        for first, last in links:
            faces.add_tube(points[[first, last]], [max(_NET_RADIUS, 0.5 * thinnest)], color, 3)
    faces.draw(axes, zorder=2)
    _draw_names(figure, axes, shapes, colors)
    figure.text(0.02, 0.96, f'{world.time:.3f} s', fontsize=10, va='center')
    buffer = io.BytesIO()
    figure.savefig(buffer, format='png', dpi=_DPI)
    return buffer.getvalue()


def _label(axes, low, high, extent):
    from matplotlib.ticker import MaxNLocator
    for name, first, last, length in zip('xyz', low, high, extent):
        getattr(axes, f'set_{name}lim')(first, last)
        getattr(axes, f'set_{name}label')(f'{name} [m]', fontsize=9)
        axis = getattr(axes, f'{name}axis')
        axis.set_major_locator(MaxNLocator(max(2, round(6 * length / extent.max()))))
        axis.set_tick_params(labelsize=8)
        axis.set_pane_color((1, 1, 1, 0))
        axis._axinfo['grid']['color'] = '0.9'


def _draw_planes(axes, shapes, low, high, towards):
    """Before all that is above them, as far as one looks down on them."""
    planes = _Faces(towards)
    for origin, normal in shapes['planes']:
        corners = _plane_in_box(origin, normal, low, high)
        if corners is not None:
            planes.add(corners, normal, _PLANE)
    planes.draw(axes, zorder=1 if towards[2] >= 0 else 3, alpha=0.8)


def _draw_names(figure, axes, shapes, colors):
    from matplotlib.patches import Patch
    names = [thing[0] for thing in shapes['cables'] + shapes['nets']]
    handles = [Patch(color=color[:3], label=name) for name, color in zip(names, colors)] if len(names) <= _LISTED else []
    handles += [Patch(color=_BODY, label='bodies')] if any(solids for _, _, solids in shapes['bodies']) else []
    handles += [Patch(color=_OBSTACLE, label='obstacles')] if shapes['obstacles'] or shapes['planes'] else []
    if handles:
        figure.legend(handles=handles, loc='upper right', fontsize=8, frameon=False, ncol=min(len(handles), 5), handlelength=1.2)
    if len(shapes['bodies']) <= _LABELLED:
        for name, position, _ in shapes['bodies']:
            axes.text(*position[0], '  ' + name, fontsize=8, zorder=4)


def _fit(axes, low, high, size):
    """Makes the box of the axes as large as the picture has room for; returns [m] of a pixel."""
    from mpl_toolkits.mplot3d import proj3d

    def pixels(points):
        x, y, _ = proj3d.proj_transform(*np.transpose(points), axes.get_proj())
        return axes.transData.transform(np.column_stack([x, y]))

    axes.set_box_aspect(high - low)
    axes.apply_aspect()
    across, up = np.ptp(pixels(list(itertools.product(*zip(low, high)))), axis=0)
    axes.set_box_aspect(high - low, zoom=min(_ROOM[0] * size[0] / across, _ROOM[1] * size[1] / up))
    steps = pixels(low + np.vstack([np.zeros(3), np.eye(3)]))
    return 1 / np.linalg.norm(steps[1:] - steps[0], ord=2)
