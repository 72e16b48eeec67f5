#!/usr/bin/env python3
"""Plots what the validation cases wrote: one picture a case, its errors over the refinement and, where there are, its curves.

Usage: plot_validation.py DATA_DIRECTORY PICTURE_DIRECTORY
"""
import csv
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter  # noqa: E402

COLORS = plt.get_cmap('tab10').colors
MARKERS = 'os^Dvp*X'
LEGEND_WIDTH = 66  # [characters]
DATA_HEIGHT, LEGEND_HEIGHT = 4.0, 0.21  # [inches] of all but the legend, and of a row of it

# Beginning of the names that make a picture: title, labels of the curves' axes.
CASES = {
    'elastic catenary': ('Elastic catenary', 'x [m]', 'z [m]'),
    'stretch': ('Rod stretched between clamps', '', ''),
    'hanging cable': ('Modes of a hanging cable', '', ''),
    'taut string': ('Modes of a taut string', '', ''),
    'cantilever, own weight': ('Cantilever under its own weight', '', ''),
    'elastica': ('Cantilever under a tip load', 'x / L', 'z / L'),
    'cantilever mode': ('Modes of a cantilever', '', ''),
    'flat cantilever': ('Modes of a flat cantilever', '', ''),
    'torsional mode': ('Torsion of a cantilever', '', ''),
    'end moment': ('End moment 2π EI/L', 'x / L', 'z / L'),
    'natural circle': ('Natural curvature 2π / L', '', ''),
    'Euler': ('Euler buckling', 'load / critical load', 'stiffness of the lowest mode'),
    'twisted rod': ('Twisted rod without tension', 'torque / critical torque', 'stiffness of the lowest mode'),
    'long twisted rod': ('Long twisted rod under tension', 'torque / critical torque', 'stiffness of the lowest mode'),
    'Michell ring': ("Michell's ring", 'angle / critical angle', 'stiffness out of the plane'),
    'Zajac ring': ('Rings that are curved at rest', 'rest curvature / critical rest curvature', 'stiffness out of the plane'),
    'ribbon': ('Ribbons', 'load / critical load', 'stiffness out of the plane'),
    'bow beam': ('Bow beam: quarter circle, load across its plane', 'angle from the clamp [rad]', 'deflection / reference at the end'),
    'clamped rod': ('Rods between two clamps, seen from above', 'x / L', 'y / L'),
    'spring': ('Helical springs, drawn out', 'length / at rest', 'force'),
    'close spring': ('Closely wound spring', '', ''),
    'natural helix': ('Rolled up by curvature and twist at rest', 'x / L', 'z / L'),
    'towed cable': ('Cable towed in a stream', '', ''),
    'terminal velocity': ('Terminal velocity', 't [s]', 'speed [m/s]'),
    'free cable': ('Free cable in space, 10 s', '', ''),
    'at rest': ('Free of stress, at rest for 20 s', '', ''),
    'thrown rod': ('Thrown flat rod, curved and twisted at rest, 10 s', '', ''),
    'folded chain': ('Folded chain dropped from one end', 't [s]', 'fallen [m]'),
    'step size': ('Step size halved', '', ''),
    'number of segments': ('Number of segments', '', ''),
}

# What is counted along the axis of a case, and what its errors are, where that is not the number of segments and a relative error.
# The rods of test/validation are 1 m long: distances in m are parts of the length.
REFINEMENTS = {'step size': 'number of steps in 0.64 s'}
ERRORS = {
    'elastic catenary': 'distance / length,\nrelative error of the force',
    'end moment': 'gap / length,\nrelative error of the moment',
    'natural circle': 'gap / length',
    'clamped rod': 'distance / length,\nrelative error of forces and moments',
    'natural helix': 'distance of the end / length',
    'at rest': 'largest distance from the start [m]',
    'folded chain': 'error of the energy / (m g L),\nrelative error of the time',
    'step size': 'largest distance / length',
}


def read(path):
    with open(path, newline='') as file:
        return list(csv.reader(file))


def legend(axes, handles=None):
    """Below the data, a row for two or three entries."""
    handles = axes.get_legend_handles_labels()[0] if handles is None else handles
    longest = max(len(handle.get_label()) for handle in handles)
    columns = max(1, min(len(handles), LEGEND_WIDTH // (longest + 8)))
    axes.legend(handles=handles, loc='upper center', bbox_to_anchor=(0.5, -0.2), ncol=columns, frameon=False)
    return -(-len(handles) // columns)


def without(case, name):
    """What a name tells besides the case, which the title tells."""
    return name[len(case):].lstrip(' ,:') or case


def finest(curves):
    """Of each case with its reference the curve of the most segments, where there are too many to tell apart."""
    if len(curves) <= 9:
        return curves
    most = {}
    for label in curves:
        case, _, segments = label.rpartition(', n = ')
        if case:
            most[case] = max(most.get(case, 0), int(segments))
    kept = [f'{case}, n = {segments}' for case, segments in most.items()]
    return {label: points for label, points in curves.items() if label in kept or ', n = ' not in label}


def plot_errors(axes, case, rows):
    """A color a variant of the case, a marker a quantity. Returns the rows of the legend."""
    series = defaultdict(list)
    for name, n, error, tolerance in rows:
        series[tuple(without(case, name).partition(': ')[::2])].append((float(n), float(error), float(tolerance)))
    variants, quantities = (list(dict.fromkeys(key[part] for key in series)) for part in (0, 1))
    for (variant, quantity), samples in series.items():
        n, errors, tolerances = zip(*samples)
        color, marker = COLORS[variants.index(variant) % len(COLORS)], MARKERS[quantities.index(quantity)]
        axes.loglog(n, errors, marker + '-', color=color, markersize=6)
        axes.loglog(n[-1], tolerances[-1], '_', color=color, markersize=18, markeredgewidth=2)
    longest = max(series.values(), key=len)
    handles = [Line2D([], [], color=COLORS[i % len(COLORS)], marker='o' if quantities == [''] else '', linewidth=2, label=variant)
               for i, variant in enumerate(variants)]
    if quantities != ['']:
        handles += [Line2D([], [], color='0.4', marker=MARKERS[i], linestyle='', label=quantity or 'error') for i, quantity in enumerate(quantities)]
    if len(longest) > 1:
        n = [sample[0] for sample in longest]
        handles += axes.loglog(n, [longest[0][1] * (n[0] / x) ** 2 for x in n], 'k:', linewidth=1.5, label='falls with the square')
    handles.append(Line2D([], [], color='0.4', marker='_', markersize=14, markeredgewidth=2, linestyle='', label='largest error allowed'))
    refinements = sorted({sample[0] for samples in series.values() for sample in samples})
    axes.xaxis.set_major_locator(FixedLocator(refinements))
    axes.xaxis.set_major_formatter(StrMethodFormatter('{x:g}'))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlabel(REFINEMENTS.get(case, 'number of segments'))
    axes.set_ylabel(ERRORS.get(case, 'relative error'))
    axes.grid(color='0.9')
    return legend(axes, handles)


def plot_curves(axes, case, rows, x_label, y_label):
    """The references are wide grey lines below the curves. Returns the rows of the legend."""
    curves = defaultdict(list)
    for name, label, x, y in rows:
        curves[without(case, name + ', ' + label)].append((float(x), float(y)))
    if 'stiffness' not in y_label:
        curves = finest(curves)
    references = [label for label in curves if label.endswith('reference')]
    for label, points in curves.items():
        if 'stiffness' in y_label:
            points.sort()
        if label in references:
            axes.plot(*zip(*points), color='0.75', linewidth=5, zorder=1, label='reference' if label == min(references) else None)
        else:
            axes.plot(*zip(*points), '.-' if len(points) < 10 else '-', linewidth=1.5, label=label)
    if 'stiffness' in y_label:
        axes.axhline(0, color='k', linewidth=0.5)
        axes.axvline(1, color='0.75', linewidth=5, zorder=1, label='reference')
    elif x_label.startswith('x'):
        axes.set_aspect('equal', 'datalim')
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.grid(color='0.9')
    return legend(axes)


def main(data, pictures):
    errors, curves = read(data / 'errors.csv'), read(data / 'curves.csv')
    pictures.mkdir(parents=True, exist_ok=True)
    for case, (title, x_label, y_label) in CASES.items():
        of_case = [row for row in errors if row[0].startswith(case)]
        drawn = [row for row in curves if row[0].startswith(case)]
        if not of_case:
            sys.exit(f'plot_validation.py: no errors of "{case}" in {data}')
        figure, axes = plt.subplots(1, 2 if drawn else 1, figsize=(10 if drawn else 5, 1), squeeze=False)
        rows = plot_errors(axes[0][0], case, of_case)
        if drawn:
            rows = max(rows, plot_curves(axes[0][1], case, drawn, x_label, y_label))
        figure.suptitle(title)
        figure.set_figheight(DATA_HEIGHT + LEGEND_HEIGHT * rows)
        figure.tight_layout()
        # No date and no version inside: the same data make the same bytes.
        figure.savefig(pictures / (case.lower().replace(',', '').replace(' ', '_') + '.png'), dpi=80, metadata={'Software': None})
        plt.close(figure)


if __name__ == '__main__':
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(Path(sys.argv[1]), Path(sys.argv[2]))
