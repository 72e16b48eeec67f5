#!/usr/bin/python3
"""plot_ledgers.py OUTPUT_DIRECTORY: ledgers of energy over time, NAME.png, and of the shipped scenes, a table in measured.md.

What doc/how_to/ledger.md shows, by the Python module, in half a minute.
"""
import dataclasses
import math
import pathlib
import sys
import typing

import matplotlib
import numpy
import yaml
from markdown_table import table
from verlet_cable.sim import Scene, World

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

CONFIG = pathlib.Path(__file__).resolve().parents[2] / 'config'
# The table
DURATION = 5.0     # [s] of a scene
NOTICED = 1e-4     # of m g L: what is left unaccounted beyond this has a remark
NEGLIGIBLE = 1e-6  # of m g L: 0 in the table

# The pictures
LOOK = 0.01                # [s] between two points of a curve
SEEN = 1e-4                # of the largest entry
SHOWN_RANGE = (5e-13, 50)  # [J] of what is unaccounted

# Why a scene leaves more than NOTICED unaccounted, or is odd otherwise.
REMARKS = {
    'scene_template': 'the net starts a metre from its holder, which draws it there',
    'scenes/knot': 'the rope slides on itself: contacts are solved to a tolerance, with shorter steps, too',
    'scenes/pole': 'its ends strike each other below the pole; with steps of 0.25 ms 6e-6 J are left',
}

INTRODUCTION = """# Ledgers of the shipped scenes

By `scripts/pictures` (`scripts/lib/plot_ledgers.py`): what each scene of `config` that has cables has in its [ledger](../ledger.md) after 5 s,
with the motion that is beside it; without ROS, so that the crane's winch rests. Energies in J; 0 is less than 1e-6 m g L, where m is the mass
of all cables and bodies and L the length of the longest cable. "Of m g L" is the part of it that is unaccounted, "steps" how many left too much
unaccounted. What leaves more than 1e-4 m g L, or dissipates less than nothing, has a remark that says why."""

COLORS = {'axial': 'tab:gray', 'bending': 'tab:orange', 'torsional': 'tab:pink', 'drag': 'tab:cyan', 'contact': 'tab:green', 'guides': 'tab:olive',
          'bodies': 'tab:brown', 'unresolved': 'tab:red', 'edits': 'tab:purple'}
LINES = {'attachments': ':', 'winches': '--', 'obstacles': '-.', 'applied': (0, (1, 3))}

SWINGING_ROPE = {
    'materials': {'rope': {'linear_density': 0.1, 'radius': 0.005, 'drag': 0.04, 'bending_stiffness': 0.001, 'bending_damping': 1e-4}},
    'cables': [{'name': 'rope', 'length': 1.0, 'segments': 40, 'material': 'rope',
                'attachments': [{'name': 'top', 'at': 'start', 'offset': [0, 0, 2]}],
                'initial': {'type': 'straight', 'from': [0, 0, 2], 'to': [0.8, 0, 1.4]}}],
}


@dataclasses.dataclass
class Shown:
    """A picture."""
    title: str
    cable: str
    duration: float            # [s]
    shapes: typing.List[float]  # [s] when the cable is drawn
    scene: typing.Union[dict, str]
    lengths: typing.Dict[float, float] = dataclasses.field(default_factory=dict)  # [s]: [m] to which a winch at the start winds the cable
    speed: float = 0.25        # [m/s] of the winch
    view: typing.Tuple[int, int] = (0, 2)  # axes of the picture


SHOWN = {
    'rope': Shown('A rope that swings', 'rope', 6.0, [0, 0.25, 0.5, 0.75], SWINGING_ROPE),
    'crane': Shown('A crane that lowers its load and hoists it', 'rope', 8.0, [0, 2.5, 7.9], 'examples/crane', {0.5: 1.7, 4.0: 0.8}),
    'knot': Shown('A knot that is pulled tight', 'rope', 5.0, [0, 1.5, 4.9], 'scenes/knot', view=(0, 1)),
}


def motion_beside(path):
    """CSV file that moves the frames of a scene, None where there is none."""
    beside = [path.with_suffix('.csv'), path.with_name(f'{path.stem}_motion.csv')]
    return next((str(motion) for motion in beside if motion.exists()), None)


def world_of(scene):
    """Of keys, or of the name of a shipped scene, with its motion; and its time step [s]."""
    if isinstance(scene, dict):
        loaded, motion = Scene.from_dict(scene), None
    else:
        path = CONFIG / f'{scene}.yaml'
        loaded, motion = Scene.load(str(path)), motion_beside(path)
    return World(loaded, motion), loaded.time_step


def entries_of(ledgers, side):
    """[J] by entry, one a ledger, of those that can be seen beside the others."""
    largest = max(abs(ledger[part][name]) for ledger in ledgers for part in ('work', 'dissipated') for name in ledger[part])
    curves = {name: numpy.array([ledger[side][name] for ledger in ledgers]) for name in ledgers[0][side]}
    return {name: curve for name, curve in curves.items() if abs(curve).max() > SEEN * largest}


def run(shown):
    """Times [s], ledgers, and shapes [m] by time."""
    world, time_step = world_of(shown.scene)
    waiting, shapes = sorted(shown.lengths.items()), {0.0: world.positions(shown.cable)}
    times, ledgers = [0.0], [world.ledger()]
    for look in range(1, round(shown.duration / LOOK) + 1):
        if waiting and waiting[0][0] < (look - 0.5) * LOOK:
            world.set_length(shown.cable, False, waiting.pop(0)[1], shown.speed)
        world.step(round(LOOK / time_step))
        times.append(look * LOOK)
        ledgers.append(world.ledger())
        if any(abs(time - look * LOOK) < 0.5 * LOOK for time in shown.shapes):
            shapes[round(look * LOOK, 3)] = world.positions(shown.cable)
    return numpy.array(times), ledgers, shapes


def draw_shapes(axes, legend, shapes, view):
    for k, (time, nodes) in enumerate(shapes.items()):
        color = plt.cm.viridis(0.85 * k / (len(shapes) - 1))
        axes.plot(*nodes[:, view].T, color=color, label=f'{time:g} s')
        axes.plot(*nodes[-1, view], 'o', color=color, markersize=4)
    axes.set_aspect('equal', anchor='S')
    axes.margins(0.12)
    axes.set_xlabel(f'{"xyz"[view[0]]} [m]')
    axes.set_ylabel(f'{"xyz"[view[1]]} [m]')
    legend.axis('off')
    legend.legend(*axes.get_legend_handles_labels(), loc='center', ncol=2, frameon=False)


def draw_ledger(axes, times, ledgers):
    """Work as a line; below it what is dissipated, a band an entry; what is left is the change. The legend has the sum at the end."""
    upper, change = (numpy.array(curve) for curve in zip(*((sum(ledger['work'].values()), ledger['change']) for ledger in ledgers)))
    works, dissipated = entries_of(ledgers, 'work'), entries_of(ledgers, 'dissipated')
    digits = 3 - math.floor(math.log10(max(abs(curve[-1]) for curve in (change, *works.values(), *dissipated.values()))))

    def told(what, curve):
        return f'{what}: {curve[-1] + 0.0:.{digits}f} J'.replace('-', '\N{MINUS SIGN}')

    axes.plot(times, upper, color='tab:blue', linewidth=5, alpha=0.5, label=told('work', upper))
    for name, curve in works.items():
        axes.plot(times, curve, color='tab:blue', linewidth=1, linestyle=LINES[name], label=told(f'   by {name}', curve))
    for name, curve in dissipated.items():
        axes.fill_between(times, upper, upper - curve, color=COLORS[name], alpha=0.5, linewidth=0, label=told(f'- {name}', curve))
        upper = upper - curve
    axes.plot(times, change, color='black', linewidth=1.5, label=told('= change', change))
    axes.axhline(0, color='black', linewidth=0.5)
    axes.set_ylabel('energy [J]')
    axes.legend(loc='upper left', bbox_to_anchor=(1.0, 1.03), frameon=False, title=f'after {times[-1]:g} s', alignment='left')


def draw_unaccounted(axes, times, ledgers):
    unaccounted = numpy.array([ledger['unaccounted'] for ledger in ledgers])
    axes.semilogy(times[1:], numpy.maximum(abs(unaccounted[1:]), SHOWN_RANGE[0]), color='tab:red')
    axes.set_ylim(SHOWN_RANGE)
    axes.set_yticks([1e-12, 1e-8, 1e-4, 1])
    axes.set_yticks([], minor=True)
    axes.set_ylabel('size [J]')
    axes.set_xlabel('time [s]')
    axes.grid(alpha=0.3)
    told = f'unaccounted: {unaccounted[-1]:.0e} J'.replace('-', '\N{MINUS SIGN}')
    axes.annotate(told, (1.03, 0.5), xycoords='axes fraction', va='center', color='tab:red')


def plot(shown, path):
    times, ledgers, shapes = run(shown)
    figure = plt.figure(figsize=(10, 5))
    grid = figure.add_gridspec(2, 2, width_ratios=(1, 1.7), height_ratios=(3, 1), hspace=0.12, wspace=0.32, left=0.07, right=0.755, top=0.92,
                               bottom=0.11)
    energy = figure.add_subplot(grid[0, 1])
    unaccounted = figure.add_subplot(grid[1, 1], sharex=energy)
    draw_shapes(figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[1, 0]), shapes, shown.view)
    draw_ledger(energy, times, ledgers)
    draw_unaccounted(unaccounted, times, ledgers)
    energy.tick_params(labelbottom=False)
    energy.set_xlim(0, times[-1])
    figure.align_ylabels((energy, unaccounted))
    figure.suptitle(shown.title)
    # No date and no version inside: the same data make the same bytes.
    figure.savefig(path, dpi=80, metadata={'Software': None})
    plt.close(figure)


def energy_scale(keys):
    """m g L [J], of all that cables and bodies are, and of the longest cable."""
    materials = {**yaml.safe_load((CONFIG / 'materials.yaml').read_text()), **keys.get('materials', {})}
    mass = sum(body['mass'] for body in keys.get('bodies', []))
    for cable in keys['cables']:
        mass += materials[cable['material']]['linear_density'] * cable['length'] + sum(load['mass'] for load in cable.get('point_masses', []))
    return mass * numpy.linalg.norm(keys.get('gravity', (0, 0, -9.81))) * max(cable['length'] for cable in keys['cables'])


def shipped_scenes():
    """Names and keys of those with cables."""
    for path in sorted(CONFIG.rglob('*.yaml')):
        keys = yaml.safe_load(path.read_text())
        if keys.get('cables'):
            yield path.relative_to(CONFIG).with_suffix('').as_posix(), keys


def row_of(name, keys):
    world, time_step = world_of(name)
    world.step(round(DURATION / time_step))
    ledger, scale = world.ledger(), energy_scale(keys)
    part = abs(ledger['unaccounted']) / scale
    is_odd = part > NOTICED or min(ledger['dissipated'].values()) < -NOTICED * scale
    if is_odd and name not in REMARKS:
        sys.exit(f'plot_ledgers.py: {name} leaves {part:.1e} m g L unaccounted, or dissipates less than nothing; say why in REMARKS')

    def number(value):
        return f'{value:.2g}' if abs(value) > NEGLIGIBLE * scale else '0'

    dissipated = ', '.join(f'{entry} {number(value)}' for entry, value in ledger['dissipated'].items() if number(value) != '0')
    return (name, number(sum(ledger['work'].values())), dissipated or '0', number(ledger['change']), f'{ledger["unaccounted"]:.1e}', f'{part:.0e}',
            str(ledger['unaccounted_steps']), REMARKS.get(name, ''))


def write_table(path):
    header = ('scene', 'work [J]', 'dissipated [J]', 'change [J]', 'unaccounted [J]', 'of m g L', 'steps', 'remark')
    rows = [row_of(name, keys) for name, keys in shipped_scenes()]
    path.write_text('\n'.join([INTRODUCTION, '', *table(header, rows)]) + '\n')


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    output = pathlib.Path(sys.argv[1])
    output.mkdir(parents=True, exist_ok=True)
    for name, shown in SHOWN.items():
        plot(shown, output / f'{name}.png')
    write_table(output / 'measured.md')


if __name__ == '__main__':
    main()
