#!/usr/bin/python3
"""real_cables.py PROGRAMS DATA WORK PICTURES [SEGMENTS]: fits the cables of DATA (dloK_R.csv) with the programs in PROGRAMS, keeps
scenes and reports in WORK (those that are there already are taken), prints the tables of doc/real_cables.md, and draws its
pictures."""
import glob
import json
import os
import resource
import subprocess
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
import yaml  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..'))
from recording import Recording  # noqa: E402

# Mean absolute errors [cm] over 5 s of the learned model that was published with the recordings (arXiv 2406.05931).
PUBLISHED = {1: 1.03, 2: 1.02, 3: 0.99, 4: 1.15}
SHOWN_TIMES = (0.0, 1.0, 2.5, 4.9)  # [s]


def processor_time():
    """[s] of the programs that have ended."""
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def fit(programs, cable, recordings, segments, work):
    """Runs cable_fit, unless its report is there; the report, and the processor time that it took [s], cross-validation and all."""
    report, seconds = (os.path.join(work, f'dlo{cable}.{kind}') for kind in ('json', 'seconds'))
    if not os.path.exists(seconds):
        began = processor_time()
        subprocess.run([os.path.join(programs, 'cable_fit'), *recordings, '--name', f'dlo{cable}', '--segments', str(segments),
                        '--output', os.path.join(work, f'dlo{cable}.yaml'), '--report', report],
                       check=True, stdout=subprocess.DEVNULL)
        with open(seconds, 'w', encoding='utf-8') as file:
            file.write(str(processor_time() - began))
    with open(report, encoding='utf-8') as file, open(seconds, encoding='utf-8') as taken:
        found = json.load(file)
        if found['segments'] != segments:
            sys.exit(f'{report}: of {found["segments"]} segments, asked for are {segments}; allowed: another WORK, or the same number')
        return found, float(taken.read())


def simulate(programs, cable, recording, places, segments, work):
    """Predicts a recording with cable_sim, as the contract says a fitted cable is used: positions of the markers [m] (rows,
    markers, 3), which sit at `places` (fractions of the length), and how many times faster than real time."""
    with open(os.path.join(work, f'dlo{cable}.yaml'), encoding='utf-8') as file:
        scene = yaml.safe_load(file)
    desc = scene['cables'][0]
    desc['segments'] = segments
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
    nodes = np.genfromtxt(names['nodes.csv'], delimiter=',', skip_header=1, usecols=(0, 3, 4, 5))
    times = nodes[::segments + 1, 0]
    positions = nodes[:, 1:].reshape(-1, segments + 1, 3)
    places = np.array(places) * segments
    before = np.minimum(places.astype(int), segments - 1)
    fraction = (places - before)[None, :, None]
    markers = (1 - fraction) * positions[:, before] + fraction * positions[:, before + 1]
    rows = np.searchsorted(times, recording.times - 1e-9)
    with open(names['summary.json'], encoding='utf-8') as file:
        return markers[np.minimum(rows, len(markers) - 1)], json.load(file)['real_time_factor']


def errors_over_time(predicted, recording):
    """Mean |predicted - measured| over markers and coordinates [m], a row after the two that are given."""
    return np.abs(predicted - recording.markers)[2:].mean(axis=(1, 2))


def left_out_errors(report, in_order):
    """Errors [cm] of the recordings that the fit did not know: mean, largest, at the end. `in_order`: where markers are swapped,
    with them in their order."""
    errors = [recording.get('left_out_in_order' if in_order else 'left_out', recording['left_out'])
              for recording in report['recordings']]
    return (100 * np.mean([error['mean'] for error in errors]), 100 * max(error['largest'] for error in errors),
            100 * np.mean([error['last'] for error in errors]))


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
    mean, largest, last = left_out_errors(report, in_order)
    fitted = [recording.get('fitted_in_order' if in_order else 'fitted', recording['fitted'])['mean']
              for recording in report['recordings']]
    print(f"| {name} | {mean:.2f} | {PUBLISHED.get(cable, '')} | {largest:.1f} | {last:.2f} | {100 * np.mean(fitted):.2f} |")


def main():
    if len(sys.argv) not in (5, 6):
        sys.exit('usage: real_cables.py PROGRAMS DATA WORK PICTURES [SEGMENTS]')
    programs, data, work, pictures = sys.argv[1:5]
    segments = int(sys.argv[5]) if len(sys.argv) == 6 else 40
    os.makedirs(work, exist_ok=True)
    os.makedirs(pictures, exist_ok=True)
    figure, axis = plt.subplots(figsize=(8, 4.5), constrained_layout=True)
    other_numbers = []
    print('| cable | left out [cm] | published [cm] | largest [cm] | at 5 s [cm] | fitted [cm] |\n|---|---|---|---|---|---|')
    for cable in range(1, 6):
        paths = sorted(glob.glob(os.path.join(data, f'dlo{cable}_*.csv')))
        report, seconds = fit(programs, cable, paths, segments, work)
        table_row(cable, cable, report, in_order=False)
        if 'cross_validated_error_in_order' in report:
            table_row(cable, f'{cable}, markers in order', report, in_order=True)
        recordings = [Recording(path) for path in paths]
        means = {}
        for count in (segments // 2, segments, 2 * segments):
            runs = [simulate(programs, cable, recording, report['marker_places'], count, work) for recording in recordings]
            over_time = [errors_over_time(predicted, recording) for (predicted, _), recording in zip(runs, recordings)]
            means[count] = 100 * np.mean([errors.mean() for errors in over_time])
            if count == segments:
                rows = min(len(errors) for errors in over_time)
                axis.plot(recordings[0].times[2:rows + 2], 100 * np.mean([errors[:rows] for errors in over_time], axis=0),
                          label=f'cable {cable}')
                draw_shapes(cable, recordings[0], runs[0][0], pictures)
                factor = min(factor for _, factor in runs)
        other_numbers.append(f'| {cable} | ' + ' | '.join(f'{mean:.3f}' for mean in means.values()) +
                             f' | {seconds:.0f} | {factor:.0f} |')
        sys.stdout.flush()
    print(f'\n| cable | fitted, {segments // 2} segments [cm] | {segments} | {2 * segments} | fit and cross-validation, processor time [s] '
          '| times real time |\n|---|---|---|---|---|---|', *other_numbers, sep='\n')
    axis.set(xlabel='t [s]', ylabel='mean absolute error [cm]', ylim=(0, None), title='Fitted cables, mean over 8 recordings')
    axis.legend()
    figure.savefig(os.path.join(pictures, 'errors.png'), dpi=90)


if __name__ == '__main__':
    main()
