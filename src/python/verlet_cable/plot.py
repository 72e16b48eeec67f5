"""Draws the pictures of `cable_sim --plot`, `--gif` and `--movie` with matplotlib.

cable_sim has this file in itself and runs it with python3: `KIND` (png, gif or mp4) as its argument, the record of a run as JSON on standard
input, and the picture on standard output; with `check` or `check_mp4` for KIND it only says whether it could. What is wrong is printed instead of a
picture, with the exit status 1.
"""
import io
import json
import math
import os
import sys
import tempfile

_FRAMES_DRAWN = 12        # in the plot of shapes
_FORCES_DRAWN = 8         # the largest
_LABELLED = 4             # where there are no more cables, their names are beside them
_LISTED = 10              # likewise cables and nets in a legend
_FLAT = 0.05              # what is lower than this part of its width is seen from above
_MARGIN = 0.06            # of the size of what is seen, around it
_LEAST_SIZE = 1e-3        # [m] of a view
_SOLID = {'facecolor': '0.87', 'edgecolor': '0.6', 'linewidth': 0.8}
_BODY = {'facecolor': 'tab:orange', 'edgecolor': '0.25', 'linewidth': 0.8}
_AXES = 'xyz'


def _numpy():
    import numpy
    return numpy


class _View:
    """Which two axes are seen, and how much of them: all that moves."""

    def __init__(self, frames):
        np = _numpy()
        points = np.concatenate([np.asarray(shape, float).reshape(-1, 3) for frame in frames for shape in _moving(frame)])
        points = points[np.isfinite(points).all(axis=1)]
        if len(points) == 0:
            points = np.zeros((1, 3))
        low, high = points.min(axis=0), points.max(axis=0)
        size = high - low
        across = int(size[1] > size[0])
        self.is_from_above = size[2] < _FLAT * min(size[0], size[1])
        self.axes = (0, 1) if self.is_from_above else (across, 2)
        margin = max(_MARGIN * size[list(self.axes)].max(), _LEAST_SIZE)
        self.limits = [(low[axis] - margin, high[axis] + margin) for axis in self.axes]

    def name(self):
        return 'from above' if self.is_from_above else f'from the side, along {_AXES[1 - self.axes[0]]}'

    def of(self, points):
        return _numpy().asarray(points, float).reshape(-1, 3)[:, list(self.axes)]

    def prepare(self, axes):
        axes.set_aspect('equal', adjustable='box')
        axes.set_xlim(self.limits[0])
        axes.set_ylim(self.limits[1])
        axes.set_xlabel(f'{_AXES[self.axes[0]]} [m]')
        axes.set_ylabel(f'{_AXES[self.axes[1]]} [m]')
        axes.grid(color='0.92')
        axes.set_axisbelow(True)


def _moving(frame):
    """The points of all that is simulated."""
    yield from frame['cables'].values()
    yield from frame['nets'].values()
    yield frame['particles']
    yield from frame['bodies']


def _hull(points):
    """The convex hull of points in a plane, in order (Andrew's monotone chain)."""
    points = sorted(set(map(tuple, points)))
    if len(points) < 3:
        return points

    def half(ordered):
        chain = []
        for x, y in ordered:
            while len(chain) > 1 and ((chain[-1][0] - chain[-2][0]) * (y - chain[-2][1])
                                      <= (chain[-1][1] - chain[-2][1]) * (x - chain[-2][0])):
                chain.pop()
            chain.append((x, y))
        return chain[:-1]

    return half(points) + half(reversed(points))


def _draw_solids(axes, view, solids, order, **look):
    from matplotlib.patches import Polygon
    for solid in solids:
        hull = _hull(view.of(solid))
        if len(hull) > 2:
            axes.add_patch(Polygon(hull, closed=True, zorder=order, **look))


def _draw_planes(axes, view, planes):
    """Those that are seen as lines, and their insides."""
    np = _numpy()
    (left, right), (low, high) = view.limits
    middle, reach = np.array([(left + right) / 2, (low + high) / 2]), right - left + high - low
    for point, normal in planes:
        normal = view.of(normal)[0]
        if not np.linalg.norm(normal) > 0.99:
            continue
        along = np.array([-normal[1], normal[0]])
        foot = middle + np.dot(view.of(point)[0] - middle, normal) * normal
        corners = [foot - reach * along, foot + reach * along, foot + reach * (along - normal), foot - reach * (along + normal)]
        axes.fill(*np.transpose(corners), zorder=0.5, **_SOLID)


def _draw_shapes(axes, view, record, frame, color_of, width):
    """Cables, nets and particles of a frame."""
    from matplotlib.collections import LineCollection
    np = _numpy()
    for name, points in frame['cables'].items():
        axes.plot(*view.of(points).T, color=color_of(name), linewidth=width, zorder=3, solid_capstyle='round')
    for name, points in frame['nets'].items():
        nodes = view.of(points)
        axes.add_collection(LineCollection(nodes[np.asarray(record['links'][name], int)], colors=[color_of(name)], linewidths=0.6,
                                           zorder=3))
    if frame['particles']:
        axes.plot(*view.of(frame['particles']).T, 'o', markersize=4, color=color_of(None), zorder=3)


def _names(frames):
    """Of all cables and nets, in the order of the alphabet."""
    return sorted({name for frame in frames for kind in ('cables', 'nets') for name in frame[kind]})


def _draw_names(axes, view, frame):
    """At the middles of cables."""
    for name, points in frame['cables'].items():
        axes.annotate(name, view.of(points)[len(points) // 2], xytext=(3, 3), textcoords='offset points', fontsize=8, zorder=4)


def _draw_forces(axes, record):
    """What the attachments bear."""
    np = _numpy()
    times = record['times']
    forces = {name: np.array([math.nan if force is None else force for force in values], float)
              for name, values in record['forces'].items()}
    largest = sorted(forces, key=lambda name: -np.nan_to_num(forces[name]).max())[:_FORCES_DRAWN]
    for name in forces:
        if name in largest:
            axes.plot(times[:len(forces[name])], forces[name], linewidth=1.2, label=name)
    axes.set_xlabel('time [s]')
    axes.set_ylabel('force [N]')
    what = 'Forces at the attachments'
    if len(forces) > len(largest):
        what += f': the {len(largest)} largest of {len(forces)}'
    axes.set_title(what, fontsize=10, loc='left')
    axes.set_xlim(0, max(times[-1] if times else 0, 1e-9))
    axes.set_ylim(bottom=0)
    axes.grid(color='0.92')
    axes.legend(loc='upper left', bbox_to_anchor=(1.01, 1), borderaxespad=0, fontsize=8, frameon=False)


def _figure_size(view, width, extra):
    """[inch] Of a figure with a view of this width; `extra` is added to its height."""
    (left, right), (low, high) = view.limits
    return width, min(max(width * 0.8 * (high - low) / (right - left), 2.2), 7) + extra


def png(record):
    """Shapes at some times, colored by time, and below them the forces over time, as the bytes of a PNG file."""
    from matplotlib import cm, colors
    from matplotlib.figure import Figure
    np = _numpy()
    frames = record['frames']
    view = _View(frames)
    has_forces = bool(record['forces'])
    width, height = _figure_size(view, 8.0, 0.9)
    figure = Figure(figsize=(width, height + (2.4 if has_forces else 0)), dpi=120, constrained_layout=True)
    if has_forces:
        shapes, forces = figure.subplots(2, 1, gridspec_kw={'height_ratios': [height, 2.4]})
        _draw_forces(forces, record)
    else:
        shapes = figure.subplots()
    figure.suptitle(record['title'])
    view.prepare(shapes)
    shapes.set_title('Shape over time, ' + view.name(), fontsize=10, loc='left')
    last = frames[-1]
    _draw_planes(shapes, view, record['planes'])
    _draw_solids(shapes, view, last['obstacles'], 1, **_SOLID)
    _draw_solids(shapes, view, last['bodies'], 2, **_BODY)
    if 1 < len(_names(frames)) <= _LABELLED:
        _draw_names(shapes, view, last)
    norm = colors.Normalize(0, max(last['time'], 1e-9))
    for index in np.unique(np.linspace(0, len(frames) - 1, _FRAMES_DRAWN).round().astype(int)):
        color = cm.viridis_r(norm(frames[index]['time']))
        _draw_shapes(shapes, view, record, frames[index], lambda name: color, 1.4)
    figure.colorbar(cm.ScalarMappable(norm, 'viridis_r'), ax=shapes, label='time [s]', pad=0.01)
    buffer = io.BytesIO()
    figure.savefig(buffer, format='png')
    return buffer.getvalue()


def gif(record):
    """The motion, as the bytes of a GIF file; in real time, unless the run is longer than its frames can show."""
    from matplotlib.animation import PillowWriter
    return _animation(record, PillowWriter, '.gif')


def mp4(record):
    """The same as the bytes of an MP4 file."""
    from matplotlib.animation import FFMpegWriter

    def writer(fps):
        # Players want colors at half the resolution, and an even number of points.
        return FFMpegWriter(fps=fps, codec='libx264',
                            extra_args=['-pix_fmt', 'yuv420p', '-vf', 'pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white'])

    return _animation(record, writer, '.mp4')


def _animation(record, writer, ending):
    """The bytes of a file that `writer(fps=...)` writes."""
    from matplotlib.animation import FuncAnimation
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    frames = record['frames']
    view = _View(frames)
    figure = Figure(figsize=_figure_size(view, 6.4, 0.9), dpi=80)
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    view.prepare(axes)
    title = axes.set_title(' ', fontsize=10, loc='left')
    _draw_planes(axes, view, record['planes'])
    names = _names(frames)
    color_of = {name: f'C{index % 10}' for index, name in enumerate(names)}
    if 1 < len(names) <= _LISTED:
        axes.legend([Line2D([], [], color=color_of[name]) for name in names], names, loc='upper left', bbox_to_anchor=(1.01, 1),
                    borderaxespad=0, fontsize=8, frameon=False)
    figure.tight_layout()
    standing = set(axes.get_children())

    def draw(frame):
        for artist in set(axes.get_children()) - standing:
            artist.remove()
        title.set_text(f'{record["title"]}, {view.name()}: {frame["time"]:.2f} s')
        _draw_solids(axes, view, frame['obstacles'], 1, **_SOLID)
        _draw_solids(axes, view, frame['bodies'], 2, **_BODY)
        _draw_shapes(axes, view, record, frame, lambda name: color_of.get(name, 'C0'), 2.0)

    rate = (len(frames) - 1) / frames[-1]['time'] if len(frames) > 1 else 1
    animation = FuncAnimation(figure, draw, frames=frames, init_func=lambda: None, cache_frame_data=False)
    with tempfile.TemporaryDirectory() as folder:  # writers write to names only
        path = os.path.join(folder, 'animation' + ending)
        animation.save(path, writer=writer(fps=min(max(rate, 5), 25)))
        with open(path, 'rb') as file:
            return file.read()


def _require_ffmpeg():
    from matplotlib.animation import FFMpegWriter
    if not FFMpegWriter.isAvailable():
        raise OSError('there is no ffmpeg')


def main(kind):
    """Returns the exit status. Everything goes to standard output: a picture, or what is wrong."""
    output = sys.stdout.buffer
    try:
        import matplotlib
        matplotlib.use('Agg')
        import matplotlib.animation  # noqa: F401
        import numpy  # noqa: F401
        import PIL  # noqa: F401
        if kind == 'check_mp4':
            _require_ffmpeg()
        elif kind != 'check':
            output.write({'png': png, 'gif': gif, 'mp4': mp4}[kind](json.load(sys.stdin)))
        return 0
    except Exception as error:  # whatever it is: cable_sim tells the user
        output.write(f'{type(error).__name__}: {error}'.encode())
        return 1


if __name__ == '__main__':
    sys.exit(main(sys.argv[1]))
