#!/usr/bin/python3
"""Writes the motions of the launch files as CSV files beside their scenes, for cable_sim --motion.

Usage: write_motions.py [--check]    (--check: says what differs from the files that are there, and writes nothing)

The motions are those of scripts/example_motions.py, where hands let go of something until then: cable_sim lets nothing go.
"""
import math
import sys
from pathlib import Path
from xml.etree import ElementTree

PACKAGE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PACKAGE / 'scripts'))
from example_motions import EXAMPLES, RELEASES, demo, joint_positions  # noqa: E402

DURATION = 20.0          # [s]
RATE = 20                # [Hz] of rows: between them cable_sim follows a spline
RATES = {'swivel': 50}   # [Hz] of frames that need more: it turns once in 0.8 s
NOT_IN_SCENES = {'camera_optical_frame'}  # frames that launch files need for something else
# By their scenes: what of them their cables meet.
ARMS = {'config/scenes/dress_pack': ('shoulder', 'upper_arm', 'forearm', 'wrist'), 'config/examples/table_camera': ('forearm', 'wrist')}
HEADER = 't,frame,x,y,z,qx,qy,qz,qw'


def multiplied(p, q):
    """The product of quaternions x, y, z, w."""
    (a, b, c, d), (e, f, g, h) = p, q
    return (d * e + a * h + b * g - c * f, d * f - a * g + b * h + c * e, d * g + a * f - b * e + c * h, d * h - a * e - b * f - c * g)


def turned(quaternion, vector):
    x, y, z, w = quaternion
    return multiplied(multiplied(quaternion, (*vector, 0.0)), (-x, -y, -z, w))[:3]


def joints_of(urdf):
    """Parent, child, origin [m], name and axis of the joints of a URDF whose origins are not turned; parents first."""
    joints = []
    for joint in ElementTree.parse(urdf).findall('joint'):
        origin, axis = joint.find('origin'), joint.find('axis')
        xyz = '0 0 0' if origin is None else origin.get('xyz')
        joints.append((joint.find('parent').get('link'), joint.find('child').get('link'), [float(x) for x in xyz.split()],
                       joint.get('name'), None if axis is None else [float(x) for x in axis.get('xyz').split()]))
    return joints


def arm(t, joints):
    """The links that joints move."""
    angles, links = joint_positions(t), {'world': ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))}
    for parent, child, origin, name, axis in joints:
        position, orientation = links[parent]
        half = angles.get(name, 0.0) / 2
        turn = (0.0, 0.0, 0.0, 1.0) if axis is None else (*(math.sin(half) * x for x in axis), math.cos(half))
        at = tuple(p + q for p, q in zip(position, turned(orientation, origin)))
        links[child] = at, multiplied(orientation, turn)
    return {child: links[child] for _, child, _, name, _ in joints if name in angles}


def rows_of(motion, duration):
    """The rows of a CSV file; one only of a frame that stands still."""
    for frame in motion(0).keys() - NOT_IN_SCENES:
        rate = RATES.get(frame, RATE)
        times = [number / rate for number in range(round(duration * rate) + 1)]
        poses = [motion(t)[frame] for t in times]
        stands = all(at == poses[0] for at in poses)
        for t, (position, orientation) in zip(times[:1] if stands else times, poses):
            yield t, frame, [*position, *orientation]


def number_text(number):
    """Rounded to a micrometre, without zeros behind it, and never -0."""
    return f'{round(number, 6) + 0.0:.6f}'.rstrip('0').rstrip('.')


def csv_text(motion, duration=DURATION):
    rows = sorted(rows_of(motion, duration), key=lambda row: row[:2])
    return '\n'.join([HEADER, *(','.join([f'{t:g}', frame, *map(number_text, numbers)]) for t, frame, numbers in rows)]) + '\n'


def motion_files():
    """The text of each file by its path in the package."""
    files = {f'config/examples/{name}.csv': csv_text(motion, RELEASES[name][0] if name in RELEASES else DURATION)
             for name, motion in EXAMPLES.items()}
    files['config/demo.csv'] = csv_text(demo)
    for robot, links in ARMS.items():
        joints = joints_of(PACKAGE / f'{robot}.urdf')
        files[f'{robot}.csv'] = csv_text(lambda t, joints=joints, links=links: {link: arm(t, joints)[link] for link in links})
    return files


def main():
    differing = []
    for path, text in motion_files().items():
        file = PACKAGE / path
        if '--check' not in sys.argv[1:]:
            file.write_text(text, encoding='utf-8')
        elif not file.exists() or file.read_text(encoding='utf-8') != text:
            differing.append(path)
    if differing:
        sys.exit('not as scripts/lib/write_motions.py writes them: ' + ', '.join(differing))


if __name__ == '__main__':
    main()
