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


def read(path):
    with open(path, newline='') as file:
        return list(csv.reader(file))


def legend(axes, size):
    """Beside the data where there is room, below them otherwise."""
    entries = len(axes.get_legend_handles_labels()[1])
    if entries <= 6:
        axes.legend(fontsize=size)
    else:
        columns = len(axes.figure.axes)
        axes.legend(fontsize=6, loc='upper center', bbox_to_anchor=(0.5, -0.26), ncol=columns)
        axes.figure.set_figheight(3.4 + 0.14 * entries / columns)


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


def plot_errors(axes, rows):
    series = defaultdict(list)
    for name, n, error, tolerance in rows:
        series[name].append((float(n), float(error), float(tolerance)))
    for name, samples in series.items():
        n, errors, tolerances = zip(*samples)
        line, = axes.loglog(n, errors, 'o-', label=name)
        axes.loglog(n[-1], tolerances[-1], '_', color=line.get_color(), markersize=16, markeredgewidth=2)
    longest = max(series.values(), key=len)
    if len(longest) > 1:
        n = [sample[0] for sample in longest]
        axes.loglog(n, [longest[0][1] * (n[0] / x) ** 2 for x in n], 'k:', linewidth=1, label='second order')
    axes.set_xlabel('segments or steps; dash: to reach')
    axes.set_ylabel('relative error')
    legend(axes, 7)


def plot_curves(axes, rows, x_label, y_label):
    curves = defaultdict(list)
    for name, label, x, y in rows:
        curves[name + ', ' + label].append((float(x), float(y)))
    if 'stiffness' not in y_label:
        curves = finest(curves)
    references = [label for label in curves if label.endswith(', reference')]
    for label, points in curves.items():
        if 'stiffness' in y_label:
            points.sort()
        if label.endswith(', reference'):
            axes.plot(*zip(*points), 'k--', linewidth=1, zorder=3, label='reference' if label == min(references) else None)
        else:
            axes.plot(*zip(*points), '.-' if len(points) < 10 else '-', label=label)
    if 'stiffness' in y_label:
        axes.axhline(0, color='k', linewidth=0.5)
        axes.axvline(1, color='k', linestyle='--', linewidth=1, label='reference')
    elif x_label.startswith('x'):
        axes.set_aspect('equal', 'datalim')
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    legend(axes, 6)


def main(data, pictures):
    errors, curves = read(data / 'errors.csv'), read(data / 'curves.csv')
    pictures.mkdir(parents=True, exist_ok=True)
    for case, (title, x_label, y_label) in CASES.items():
        of_case = [row for row in errors if row[0].startswith(case)]
        drawn = [row for row in curves if row[0].startswith(case)]
        if not of_case:
            sys.exit(f'plot_validation.py: no errors of "{case}" in {data}')
        figure, axes = plt.subplots(1, 2 if drawn else 1, figsize=(9 if drawn else 4.5, 3.4), squeeze=False)
        plot_errors(axes[0][0], of_case)
        if drawn:
            plot_curves(axes[0][1], drawn, x_label, y_label)
        figure.suptitle(title)
        figure.tight_layout()
        # No date and no version inside: the same data make the same bytes.
        figure.savefig(pictures / (case.lower().replace(',', '').replace(' ', '_') + '.png'), dpi=80, metadata={'Software': None})
        plt.close(figure)


if __name__ == '__main__':
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(Path(sys.argv[1]), Path(sys.argv[2]))
