#!/usr/bin/python3
"""branched_cables.py PROGRAMS DATA WORK [SEGMENTS]: fits the branched cables of DATA (a directory for each, with meta.json)
with the program cable_fit in PROGRAMS, keeps scenes, reports and predictions in WORK (those that are there already are
taken), and prints the tables of doc/real_cables_measured.md."""
import glob
import json
import os
import sys

import numpy as np
import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..'))
from fitted import fitted  # noqa: E402
from recording import Recording  # noqa: E402

GIVEN_ROWS = 2
# [mm] of the learned model that was published with the recordings (arXiv 2502.15037), by its authors' logs, and of the
# physics in it alone.
LEARNED = {'bdlo1': 14.36, 'bdlo1_mid': 9.22, 'bdlo2': 21.59, 'bdlo3': 12.01, 'bdlo3_mid': 10.42, 'bdlo4': 8.90}
PHYSICS = {'bdlo1': 18.15, 'bdlo1_mid': 15.26, 'bdlo2': 28.62, 'bdlo3': 15.19, 'bdlo3_mid': 20.20, 'bdlo4': 15.80,
           'bdlo5': 13.13, 'bdlo6': 15.16}
# In the order of a cable's parameters.
MATERIAL = {'bending_stiffness': 'bending stiffness [N m²]', 'bending_damping': 'bending damping [N m² s]',
            'drag': 'drag [kg/(m s)]', 'torsional_stiffness': 'torsional stiffness [N m²]', 'linear_density': 'linear density [kg/m]'}


def harness(meta):
    """The description that cable_fit takes."""
    cables = [{'name': 'trunk', 'markers': [meta['parent'][0], meta['parent'][-1]]}]
    for number, child in enumerate(meta['children'], 1):
        cables.append({'name': f'branch_{number}', 'markers': [child['nodes'][0], child['nodes'][-1]],
                       'from': child['attached_to_node']})
    return {'cables': cables, 'held': meta['held']}


def fit(programs, name, meta, recordings, segments, work):
    """The report and its cross-validation, and how long [s] it took."""
    base = os.path.join(work, name)
    with open(f'{base}.harness.yaml', 'w', encoding='utf-8') as file:
        yaml.safe_dump(harness(meta), file)
    arguments = ['--harness', f'{base}.harness.yaml', '--output', f'{base}.yaml',
                 '--predictions', os.path.join(work, f'predicted_{name}')]
    return fitted(programs, recordings, arguments, base, segments)


def shifted(meta, measured):
    """The null hypothesis: markers move with the displacement of what is held, interpolated along the cable."""
    given = measured[GIVEN_ROWS - 1]
    result = np.array(measured)
    moved = measured - given

    def interpolate(markers, held):
        places = np.concatenate([[0], np.linalg.norm(np.diff(given[markers], axis=0), axis=1).cumsum()])
        known = [places[markers.index(marker)] for marker in held]
        for place, marker in zip(places, markers):
            for axis in range(3):
                result[:, marker, axis] = given[marker, axis] + [
                    np.interp(place, known, row) for row in moved[:, held, axis]]

    interpolate(meta['parent'], [marker for marker in meta['held'] if marker in meta['parent']])
    for child in meta['children']:
        moved_attachment = result[:, child['attached_to_node']] - given[child['attached_to_node']]
        for marker in child['nodes']:
            result[:, marker] = given[marker] + moved_attachment
    return result


def errors(meta, predicted, measured):
    """Mean squares of a recording: the authors' number, and of a coordinate of free markers. In theirs, held markers count, which
    are given and have no error, markers at which children begin count once more per child, and zeros fill up children that are
    shorter than the parent."""
    squares = (predicted - measured)[GIVEN_ROWS:] ** 2
    squares[:, meta['held']] = 0
    again = sum(squares[:, child['attached_to_node']].sum() for child in meta['children'])
    slots = (1 + len(meta['children'])) * len(meta['parent'])
    free = [marker for marker in range(meta['nodes']) if marker not in meta['held']]
    return (squares.sum() + again) / (3 * slots * len(measured)), squares[:, free].mean()


def millimetres(mean_squares):
    """Of recordings, each of which counts alike."""
    return 1000 * np.sqrt(np.mean(mean_squares, axis=0))


def material_row(name, cable, report):
    cells = [name, cable]
    found = {parameter['key']: parameter for parameter in report['parameters']}
    for key in MATERIAL:
        parameter = found.get(f'materials.{cable}.{key}')
        told = parameter and parameter['told_by_the_data'] == 'yes'
        cells.append('{value:.2g} ({low:.2g} to {high:.2g})'.format(**parameter) if told else
                     'not determined' if parameter else 'assumed')
    return '| ' + ' | '.join(cells) + ' |'


def main():
    if len(sys.argv) not in (4, 5):
        sys.exit('usage: branched_cables.py PROGRAMS DATA WORK [SEGMENTS]')
    programs, data, work = sys.argv[1:4]
    segments = int(sys.argv[4]) if len(sys.argv) == 5 else 24
    os.makedirs(work, exist_ok=True)
    materials = []
    print('| cable | left out, as published [mm] | learned model [mm] | its physics alone [mm] | no physics [mm] '
          '| left out, free markers [mm] | fitted, free markers [mm] | all fits [s] |\n' + 8 * '|---' + '|')
    for path in sorted(glob.glob(os.path.join(data, '*', 'meta.json'))):
        name = os.path.basename(os.path.dirname(path))
        with open(path, encoding='utf-8') as file:
            meta = json.load(file)
        paths = sorted(set(glob.glob(os.path.join(data, name, '*.csv'))) - {os.path.join(data, name, 'rest.csv')})
        report, seconds = fit(programs, name, meta, paths, segments, work)
        measured = [Recording(path).markers for path in paths]
        predicted = [Recording(os.path.join(work, f'predicted_{name}', os.path.basename(path))).markers for path in paths]
        published, free = millimetres([errors(meta, *pair) for pair in zip(predicted, measured)])
        null = millimetres([errors(meta, shifted(meta, markers), markers) for markers in measured])[0]
        fitted = 1000 * report['root_mean_square_error']
        print(f'| {name} | {published:.1f} | {LEARNED.get(name, "")} | {PHYSICS.get(name, "")} | {null:.1f} '
              f'| {free:.1f} | {fitted:.1f} | {seconds:.0f} |')
        cables = harness(meta)['cables']
        materials += [material_row(name, cable['name'], report) for cable in cables]
        sys.stdout.flush()
    print('\n| cable | part | ' + ' | '.join(MATERIAL.values()) + ' |\n' + (2 + len(MATERIAL)) * '|---' + '|', *materials, sep='\n')


if __name__ == '__main__':
    main()
