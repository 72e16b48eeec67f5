"""World.draw: a picture of a world, by the camera where that is built, and else by matplotlib alone: there everything is made of flat
faces, which are drawn from far to near."""
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
# By the camera
_FOV = 0.45               # [rad] of the picture's larger side: far away, so that there is little perspective
_FINER = 2                # pixels that are seen for one of the picture, in each direction
_FINEST = 8192            # [pixel] with more, there is one
_BACKGROUND = (1.0, 1.0, 1.0)
_FROM_ABOVE, _FROM_THE_LEFT = (0, 0, 1.5), -0.6  # the light, beside who looks
_SQUARES = 12             # about so many squares of a plane are along what is seen
_BAR = 0.2                # of the width: about how long a scale is


def draw(world, path=None, view=None, size=(800, 600)):
    """See World.draw."""
    path, view, size = _checked(path, view, size)
    try:
        import matplotlib  # noqa: F401
        from mpl_toolkits.mplot3d import Axes3D  # noqa: F401
    except ImportError as error:
        raise ImportError(f'World.draw: {error}; it needs matplotlib (Debian: sudo apt-get install python3-matplotlib; '
                          'pip install matplotlib)') from error
    picture = (_seen if _has_camera() else _png)(world, view, size)
    if path is None:
        return picture
    with open(path, 'wb') as file:
        file.write(picture)
    return None


def _has_camera():
    try:
        import verlet_cable.camera  # noqa: F401
    except ImportError:
        return False
    return True


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
    clouds += [points for (points, _), _ in shapes['solids']]
    for _, position, solids, _ in shapes['bodies']:
        clouds += [position, *(points for points, _ in solids)]
    points = np.concatenate(clouds) if clouds else np.zeros((1, 3))
    low, high = points.min(axis=0), points.max(axis=0)
    for _, (origin, normal), _ in shapes['planes']:
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


def _direction(shapes, low, high, view):
    """(elevation, azimuth) [degree], and the unit vector to who looks."""
    extent = high - low
    is_across_y = extent[1] > extent[0]
    is_flat = extent[2] <= 1.01 * _LEAST_PART * extent.max()
    elevation, azimuth = view or (_FLAT_ELEVATION if is_flat else _ELEVATION, -25.0 if is_across_y else -65.0)
    angles = np.radians([elevation, azimuth])
    towards = np.array([np.cos(angles[0]) * np.cos(angles[1]), np.cos(angles[0]) * np.sin(angles[1]), np.sin(angles[0])])
    return elevation, azimuth, towards


def _png(world, view, size):
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    shapes = world._shapes()
    low, high = _limits(shapes)
    extent = high - low
    elevation, azimuth, towards = _direction(shapes, low, high, view)
    figure = Figure(figsize=(size[0] / _DPI, size[1] / _DPI), dpi=_DPI)
    FigureCanvasAgg(figure)
    side = max(size)  # matplotlib has square ones: it reaches beyond the picture, into which `_fit` puts what it shows
    width, height = side / size[0], side / size[1]
    axes = figure.add_axes([0.5 - width / 2, 0.47 - height / 2, width, height], projection='3d', computed_zorder=False)
    axes.set_proj_type('ortho')
    axes.view_init(elevation, azimuth)
    _label(axes, low, high, extent)
    metres_a_pixel = _fit(axes, low, high, size)
    _draw_planes(axes, shapes, low, high, towards)
    faces = _Faces(towards)
    longest = extent.max() / _SPLIT
    for _, _, solids, color in shapes['bodies']:
        for solid in solids:
            faces.add_solid(solid, color, longest)
    for solid, color in shapes['solids']:
        faces.add_solid(solid, color, longest)
    segments = sum(len(cable[1]) for cable in shapes['cables'])
    sides = int(min(_SIDES, max(3, _FACES // max(segments, 1))))
    thinnest = 0.5 * _LEAST_WIDTH * metres_a_pixel
    for _, points, radii, color in shapes['cables']:
        faces.add_tube(points, np.maximum(radii, thinnest), color, sides)
    for _, points, links, color in shapes['nets']:
        for first, last in links:
            faces.add_tube(points[[first, last]], [max(_NET_RADIUS, 0.5 * thinnest)], color, 3)
    faces.draw(axes, zorder=2)
    _draw_legend(figure, world, shapes)
    if len(shapes['bodies']) <= _LABELLED:
        for name, position, *_ in shapes['bodies']:
            axes.text(*position[0], '  ' + name, fontsize=8, zorder=4)
    return _bytes(figure)


def _bytes(figure):
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
    for _, (origin, normal), color in shapes['planes']:
        corners = _plane_in_box(origin, normal, low, high)
        if corners is not None:
            planes.add(corners, normal, color)
    planes.draw(axes, zorder=1 if towards[2] >= 0 else 3, alpha=0.8)


def _draw_legend(figure, world, shapes):
    from matplotlib.patches import Patch
    lines = shapes['cables'] + shapes['nets']
    handles = [Patch(color=color, label=name) for name, *_, color in lines] if len(lines) <= _LISTED else []
    handles += [Patch(color=color, label='bodies') for *_, solids, color in shapes['bodies'] if solids][:1]
    handles += [Patch(color=color, label='obstacles') for *_, color in shapes['solids'] + shapes['planes']][:1]
    if handles:
        figure.legend(handles=handles, loc='upper right', fontsize=8, frameon=False, ncol=min(len(handles), 5), handlelength=1.2)
    figure.text(0.02, 0.96, f'{world.time:.3f} s', fontsize=10, va='center')


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


def _seen(world, view, size):
    """The picture by the camera."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from verlet_cable.camera import Camera
    shapes = world._shapes()
    low, high = _limits(shapes)
    _, _, towards = _direction(shapes, low, high, view)
    middle, reach = (low + high) / 2, np.linalg.norm(high - low) / 2
    scale = 2 * math.tan(_FOV / 2) / max(size)  # [1] size of a pixel at a distance of 1
    distance = _distance(low, high, middle, towards, size, scale)
    finer = _FINER if _FINER * max(size) <= _FINEST else 1
    camera = Camera(finer * size[0], finer * size[1], 2 * math.atan(scale * size[0] / 2), near=0.01 * distance, far=distance + 40 * reach)
    up = [0, 0, 1] if abs(towards[2]) < 1 - 1e-6 else [0, towards[2], 0]
    camera.look_at(middle + distance * towards, middle, up)
    square = _round_length(2 * reach / _SQUARES)
    sun = np.add(towards, _FROM_ABOVE) + _FROM_THE_LEFT * np.cross(up, towards)
    rgb = camera.render(world, ['rgb'], background=_BACKGROUND, light={'direction': sun, 'ambient': _AMBIENT}, stripes=False,
                        distinct_colors=True, least_radius=0.5 * _LEAST_WIDTH * scale * distance,
                        looks={name: {'check_size': square} for name, *_ in shapes['planes']})['rgb']
    pixels = rgb.reshape(size[1], finer, size[0], finer, 3).mean(axis=(1, 3))
    figure = Figure(figsize=(size[0] / _DPI, size[1] / _DPI), dpi=_DPI)
    FigureCanvasAgg(figure)
    figure.figimage(pixels / 255)
    _draw_legend(figure, world, shapes)
    _draw_scale(figure, scale * distance, size)
    if len(shapes['bodies']) <= _LABELLED:
        for name, position, *_ in shapes['bodies']:
            across, down, depth = camera.matrix @ ((position[0] - camera.pose[:3]) @ _axes(camera.pose))
            figure.text(across / depth / camera.width, 1 - down / depth / camera.height, '   ' + name, fontsize=8, va='center')
    return _bytes(figure)


def _distance(low, high, middle, towards, size, scale):
    """[m] From which all corners are in the picture, below the legend."""
    across = np.cross([0, 0, 1], towards) if abs(towards[2]) < 1 - 1e-6 else np.array([1.0, 0, 0])
    across /= np.linalg.norm(across)
    corners = np.array(list(itertools.product(*zip(low, high)))) - middle
    beside, above = np.abs(corners @ across), np.abs(corners @ np.cross(towards, across))
    room = 0.5 * scale * np.array(size) * (0.9, 0.84)
    return max(np.max(beside / room[0] + corners @ towards), np.max(above / room[1] + corners @ towards))


def _axes(pose):
    """(3, 3) Columns: the axes of the optical frame."""
    x, y, z, w = pose[3:]
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def _round_length(length):
    """1, 2 or 5 times a power of ten, the nearest one below."""
    power = 10 ** math.floor(math.log10(length))
    return max(step * power for step in (1, 2, 5) if step * power <= length * (1 + 1e-9))


def _draw_scale(figure, metres_a_pixel, size):
    """How long what is in the middle of the picture is."""
    from matplotlib.lines import Line2D
    length = _round_length(_BAR * size[0] * metres_a_pixel)
    part = length / metres_a_pixel / size[0]
    figure.add_artist(Line2D([0.02, 0.02 + part], [0.03, 0.03], color='0.2', linewidth=2, solid_capstyle='butt'))
    figure.text(0.02, 0.04, f'{length:g} m', fontsize=8, va='bottom')
