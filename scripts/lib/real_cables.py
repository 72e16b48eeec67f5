#!/usr/bin/python3
"""real_cables.py PROGRAMS DATA WORK PICTURES [SEGMENTS]: fits the cables of DATA (dloK_R.csv) with the programs in PROGRAMS, keeps
scenes and reports in WORK (those that are there already are taken), prints the tables of
doc/real_cables_measured.md, and draws its pictures."""
import glob
import json
import os
import subprocess
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
import yaml  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..'))
from fitted import fitted  # noqa: E402
from recording import Recording  # noqa: E402

# Mean absolute errors [cm] over 5 s of the learned model that was published with the recordings (arXiv 2406.05931).
PUBLISHED = {1: 1.03, 2: 1.02, 3: 0.99, 4: 1.15}
SHOWN_TIMES = (0.0, 1.0, 2.5, 4.9)  # [s]
# In the order of a report's parameters.
MATERIAL = ('bending stiffness [N m²]', 'bending damping [N m² s]', 'drag [kg/(m s)]', 'torsional stiffness [N m²]')


def fit(programs, cable, recordings, segments, work):
    """The report of both lines and their cross-validation, and how long [s] it took."""
    base = os.path.join(work, f'dlo{cable}')
    arguments = ['--name', f'dlo{cable}', '--output', f'{base}.yaml', '--centre-line', f'{base}_centre_line.yaml',
                 '--predictions', os.path.join(work, f'predicted{cable}')]
    return fitted(programs, recordings, arguments, base, segments)


def real_time_factor(programs, cable, recording, work):
    """How many times faster than real time cable_sim predicts a recording, by the scene of the line through the markers."""
    with open(os.path.join(work, f'dlo{cable}.yaml'), encoding='utf-8') as file:
        scene = yaml.safe_load(file)
    desc = scene['cables'][0]
    desc['initial'] = {'type': 'points', 'points': recording.markers[0].tolist(),
                       'velocities': recording.initial_velocities().tolist()}
    desc['attachments'] = [{'name': at, 'at': at, 'frame': at, 'type': 'clamp'} for at in ('start', 'end')]
    names = {kind: os.path.join(work, kind) for kind in ('scene.yaml', 'motion.csv', 'nodes.csv', 'summary.json')}
    with open(names['scene.yaml'], 'w', encoding='utf-8') as file:
        yaml.safe_dump(scene, file)
    with open(names['motion.csv'], 'w', encoding='utf-8') as file:
        file.write('t,frame,x,y,z,qx,qy,qz,qw\n')
        for name, (positions, quaternions) in zip(('start', 'end'), recording.held_poses()):
            for row, seconds in enumerate(recording.times):
                numbers = ','.join(repr(float(value)) for value in (*positions[row], *quaternions[row]))
                file.write(f'{float(seconds)!r},{name},{numbers}\n')
    subprocess.run([os.path.join(programs, 'cable_sim'), names['scene.yaml'], '--duration', repr(float(recording.duration)),
                    '--motion', names['motion.csv'], '--output', names['nodes.csv'], '--summary', names['summary.json']],
                   check=True, stdout=subprocess.DEVNULL)
    with open(names['summary.json'], encoding='utf-8') as file:
        return json.load(file)['real_time_factor']


def errors_over_time(predicted, recording):
    """Mean |predicted - measured| over markers and coordinates [m], a row after the two that are given."""
    return np.abs(predicted - recording.markers)[2:].mean(axis=(1, 2))


def errors(report, kind, in_order):
    """Errors [cm] of the recordings, `kind` fitted or left_out: mean, largest, at the end. `in_order`: where markers are swapped,
    with them in their order."""
    found = [recording.get(f'{kind}_in_order' if in_order else kind, recording[kind]) for recording in report['recordings']]
    return (100 * np.mean([error['mean'] for error in found]), 100 * max(error['largest'] for error in found),
            100 * np.mean([error['last'] for error in found]))


def draw_shapes(cable, recording, predicted, pictures):
    figure, axes = plt.subplots(1, len(SHOWN_TIMES), figsize=(13, 3.6), sharey=True, constrained_layout=True)
    across = recording.markers[0, -1] - recording.markers[0, 0]
    across = np.array([across[0], across[1], 0]) / np.hypot(across[0], across[1])
    for axis, seconds in zip(axes, SHOWN_TIMES):
        row = int(np.searchsorted(recording.times, seconds - 1e-9))
        for positions, style in ((recording.markers[row], 'o'), (predicted[row], '-')):
            axis.plot(positions @ across, positions[:, 2], style, label='measured' if style == 'o' else 'predicted')
        axis.set(title=f'{seconds} s', xlabel='along the hands [m]', aspect='equal')
    axes[0].set_ylabel('z [m]')
    axes[0].legend()
    figure.suptitle(f'Cable {cable}, {os.path.basename(recording.path)}')
    figure.savefig(os.path.join(pictures, f'dlo{cable}.png'), dpi=90)
    plt.close(figure)


def table_row(cable, name, report, in_order):
    centre_line = report['centre_line']
    mean, largest, last = errors(centre_line, 'left_out', in_order)
    print(f"| {name} | {mean:.2f} | {errors(report, 'left_out', in_order)[0]:.2f} | {PUBLISHED.get(cable, '')} | {largest:.1f} | "
          f"{last:.2f} | {errors(centre_line, 'fitted', in_order)[0]:.2f} |")


def material_row(cable, report):
    """What the fit of the centre line found, for the linear density that cable_fit takes where none is given."""
    cells = [str(cable)]
    for parameter in report['centre_line']['parameters'][:len(MATERIAL)]:
        told = parameter['told_by_the_data'] == 'yes'
        cells.append('{value:.3g} ({low:.2g} to {high:.2g})'.format(**parameter) if told else 'not determined')
    return '| ' + ' | '.join(cells) + ' |'


def other_numbers(cable, report, seconds, factor):
    """Errors [cm] with half, as many and twice the segments; times."""
    cells = [str(cable)]
    for fitted in (report['centre_line'], report):
        half, twice = (100 * other['mean_error'] for other in fitted['resegmented'])
        cells += [f'{error:.3f}' for error in (half, errors(fitted, 'fitted', True)[0], twice)]
    return '| ' + ' | '.join([*cells, f'{seconds:.0f}', f'{factor:.0f}']) + ' |'


def main():
    if len(sys.argv) not in (5, 6):
        sys.exit('usage: real_cables.py PROGRAMS DATA WORK PICTURES [SEGMENTS]')
    programs, data, work, pictures = sys.argv[1:5]
    segments = int(sys.argv[5]) if len(sys.argv) == 6 else 40
    os.makedirs(work, exist_ok=True)
    os.makedirs(pictures, exist_ok=True)
    figure, axis = plt.subplots(figsize=(8, 4.5), constrained_layout=True)
    materials, others = [], []
    print('| cable | left out [cm] | line through the markers [cm] | published [cm] | largest [cm] | at 5 s [cm] | fitted [cm] |\n'
          '|---|---|---|---|---|---|---|')
    for cable in range(1, 6):
        paths = sorted(glob.glob(os.path.join(data, f'dlo{cable}_*.csv')))
        report, seconds = fit(programs, cable, paths, segments, work)
        if 'cross_validated_error_in_order' in report:
            table_row(cable, f'{cable}, as numbered', report, in_order=False)
        table_row(cable, cable, report, in_order=True)
        recordings = [Recording(path) for path in paths]
        factor = min(real_time_factor(programs, cable, recording, work) for recording in recordings)
        materials.append(material_row(cable, report))
        others.append(other_numbers(cable, report, seconds, factor))
        predicted = [Recording(os.path.join(work, f'predicted{cable}', os.path.basename(path))).markers for path in paths]
        in_order = [recording['swapped_markers'] == 'none' for recording in report['recordings']]
        over_time = [errors_over_time(*pair) for pair, sound in zip(zip(predicted, recordings), in_order) if sound]
        rows = min(map(len, over_time))
        axis.plot(recordings[0].times[2:rows + 2], 100 * np.mean([one[:rows] for one in over_time], axis=0),
                  label=f'cable {cable}')
        draw_shapes(cable, recordings[0], predicted[0], pictures)
        sys.stdout.flush()
    print('\n| cable | ' + ' | '.join(MATERIAL) + ' |\n' + (1 + len(MATERIAL)) * '|---' + '|', *materials, sep='\n')
    counts = f'{segments // 2} segments [cm] | {segments} | {2 * segments}'
    print(f'\n| cable | centre line: {counts} | line through the markers: {counts} | all fits [s] | times real time |\n'
          + 9 * '|---' + '|', *others, sep='\n')
    axis.set(xlabel='t [s]', ylabel='mean absolute error [cm]', ylim=(0, None), title='Recordings left out of the fit, mean')
    axis.legend()
    figure.savefig(os.path.join(pictures, 'errors.png'), dpi=90)


if __name__ == '__main__':
    main()
