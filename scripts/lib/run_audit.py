"""Runs random ordinary scenes and tells whether energy and forces are right in them: scripts/audit, which builds what this needs."""
import argparse
import json
import os
import sys
import warnings
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import yaml

from audit import KINDS, make_scene
from audit.measure import CLOSED, TIME_STEP, audit

FORCE_LIMIT = 3  # times that of the refined run
REST = 0.05  # [m/s]
HEADING = ('scene', 'unaccounted', 'gain', 'force N', 'of refined', '1 to 0.5 ms', 'end m/s', 'statuses')
ROW = '{:28} {:>11} {:>9} {:>9} {:>10} {:>11} {:>8}  {}'


def row(finding):
    if finding.error:
        return f'{finding.name:28} {finding.error}'
    ratio = '' if finding.force_ratio is None else f'{finding.force_ratio:.2f}'
    apart = '' if finding.step_difference is None else f'{100 * finding.step_difference:.2f} %'
    statuses = ', '.join(f'{status} {count}' for status, count in sorted(finding.statuses.items()))
    note = '  does not close' if finding.is_ok and not finding.closes else ''
    return ROW.format(finding.name, f'{finding.unaccounted:.1e}', f'{finding.gain:.1e}', f'{finding.force:.3g}', ratio, apart, f'{finding.speed:.2g}',
                      statuses + note)


def totals(kind, findings):
    """What came of a kind, a line each."""
    ran = [finding for finding in findings if not finding.error]
    ok = [finding for finding in ran if finding.is_ok]
    yield f'{kind}: {len(findings)} scenes, {len(ok)} with all steps ok, {len(findings) - len(ran)} could not run'
    yield (f'  of those that are ok: {sum(abs(f.unaccounted) > CLOSED for f in ok)} leave more than {CLOSED:g} m g L unaccounted, '
           f'{sum(f.gain > CLOSED for f in ok)} gain more than that')
    yield f'  {sum(f.speed < REST for f in ran)} end with all nodes below {REST:g} m/s'
    refined = [finding for finding in ok if finding.force_ratio is not None]
    if refined:
        yield (f'  {sum(f.force_ratio > FORCE_LIMIT for f in refined)} of {len(refined)} that are ok have more than {FORCE_LIMIT} times the force of the '
               'refined run')
        apart = [f.step_difference for f in ok if f.step_difference is not None]
        yield f'  nodes at 1 ms and at 0.5 ms are {100 * np.median(apart):.2f} % of the length apart in the median, {100 * np.max(apart):.1f} % at most'
    for family in KINDS[kind]:
        of_family = [finding for finding in ok if finding.family == family]
        if of_family:
            worst = max(abs(finding.unaccounted) for finding in of_family)
            open_ones = sum(not finding.closes for finding in of_family)
            yield f'    {family:16} {len(of_family):4} ok, {open_ones:4} of them do not close, the worst leaves {worst:.1e}'


def write(scene, directory):
    """The scene, its motion for cable_sim at each step, and what winches are told."""
    directory.mkdir(parents=True, exist_ok=True)
    (directory / f'{scene.name}.yaml').write_text(yaml.safe_dump(scene.refined(TIME_STEP), sort_keys=False, default_flow_style=None, width=130))
    with open(directory / f'{scene.name}.csv', 'w') as motion:
        motion.write('t,frame,x,y,z,qx,qy,qz,qw\n')
        for step in range(round(scene.seconds / TIME_STEP) + 1):
            for name, hand in scene.hands.items():
                place, orientation = hand.pose(step * TIME_STEP)
                motion.write(f'{step * TIME_STEP:g},{name},' + ','.join(f'{x:.9g}' for x in [*place, *orientation]) + '\n')
    if scene.winches:
        (directory / f'{scene.name}_winches.json').write_text(json.dumps([vars(command) for command in scene.winches], indent=1) + '\n')


def positive(kind):
    def read(text):
        number = kind(text)
        if not number > 0:
            raise ValueError
        return number
    read.__name__ = 'number above 0'
    return read


def arguments():
    """What scripts/audit says of them."""
    parser = argparse.ArgumentParser(prog='scripts/audit', add_help=False)
    parser.add_argument('--scenes', type=positive(int), default=100)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--kind', choices=list(KINDS))
    parser.add_argument('--family', action='append', choices=[family for families in KINDS.values() for family in families])
    parser.add_argument('--seconds', type=positive(float), default=3)
    parser.add_argument('--quick', action='store_true')
    parser.add_argument('--jobs', type=positive(int), default=os.cpu_count())
    parser.add_argument('--write', type=Path)
    return parser.parse_args()


def main():
    args = arguments()
    warnings.simplefilter('ignore')  # refined cables may have segments that are shorter than thick
    all_close = True
    with ProcessPoolExecutor(args.jobs) as pool:
        for kind in [args.kind] if args.kind else KINDS:
            scenes = [make_scene(kind, index, args.seed, args.seconds) for index in range(args.scenes)]
            scenes = [scene for scene in scenes if not args.family or scene.family in args.family]
            if args.write:
                for scene in scenes:
                    write(scene, args.write)
                continue
            print(ROW.format(*HEADING))
            findings = []
            for finding in pool.map(audit, scenes, [not args.quick] * len(scenes)):
                findings.append(finding)
                print(row(finding), flush=True)
            print('\n'.join(totals(kind, findings)) + '\n')
            all_close = all_close and all(not f.error and (not f.is_ok or f.closes) for f in findings)
    return 0 if all_close else 1


if __name__ == '__main__':
    sys.exit(main())
