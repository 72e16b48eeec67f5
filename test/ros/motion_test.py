#!/usr/bin/python3
"""play_motion.py sends what cable_sim simulates: the same poses between the rows of a motion, to rounding."""
import csv
import os
import random
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import rospkg
import rostest

sys.path.insert(0, os.path.join(rospkg.RosPack().get_path('verlet_cable'), 'scripts'))
from play_motion import read_motion  # noqa: E402

# Two cables that show where three points of the frame are.
SCENE = """
materials: {rope: {linear_density: 0.1, radius: 0.005}}
cables:
  - name: along_x
    length: 1.0
    segments: 4
    material: rope
    attachments: [{name: a, at: start, frame: hand}, {name: b, at: end, frame: hand, offset: [0.5, 0, 0]}]
  - name: along_y
    length: 1.0
    segments: 4
    material: rope
    attachments: [{name: c, at: start, frame: hand}, {name: d, at: end, frame: hand, offset: [0, 0.5, 0]}]
"""


def rotated(quaternion, vector):
    axis, w = quaternion[:3], quaternion[3]
    return vector + 2 * np.cross(axis, np.cross(axis, vector) + w * vector)


class MotionTest(unittest.TestCase):
    def test_play_motion_and_cable_sim_agree(self):
        generator = random.Random(1)
        for trial in range(5):
            rows, time, position = [], generator.uniform(-0.3, 0.3), [0, 0, 0]
            for _ in range(generator.randint(1, 12)):
                if generator.random() < 0.7:
                    position = [generator.uniform(-0.2, 0.2) for _ in range(3)]
                orientation = [generator.gauss(0, 1) for _ in range(4)]
                rows.append([time, 'hand'] + position + orientation)
                time += generator.choice((0.003, 0.1, 0.4))
            with tempfile.TemporaryDirectory() as folder:
                scene, motion, output = (os.path.join(folder, name) for name in ('scene.yaml', 'motion.csv', 'output.csv'))
                with open(scene, 'w') as file:
                    file.write(SCENE)
                with open(motion, 'w', newline='') as file:
                    csv.writer(file).writerows([['t', 'frame', 'x', 'y', 'z', 'qx', 'qy', 'qz', 'qw']] + rows)
                subprocess.run(['rosrun', 'verlet_cable', 'cable_sim', scene, '--motion', motion, '--output', output, '--duration', '2',
                                '--rate', '500'], check=True, stderr=subprocess.DEVNULL)
                track = read_motion(motion)['hand']
                with open(output, newline='') as file:
                    nodes = [row for row in csv.DictReader(file) if row['node'] in ('0', '4')]
            self.assertEqual(len(nodes), 4 * 1001)
            for row in nodes:
                offset = np.zeros(3) if row['node'] == '0' else np.array([0.5, 0, 0] if row['cable'] == 'along_x' else [0, 0.5, 0])
                origin, orientation = track.at(float(row['t']))
                place = [float(row[axis]) for axis in 'xyz']
                np.testing.assert_allclose(place, origin + rotated(orientation, offset), atol=1e-12, err_msg=f'{trial} {row["t"]}')


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'motion', MotionTest, sys.argv)
