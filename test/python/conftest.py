import os
import subprocess
import sys
from pathlib import Path

import pytest

DEVEL = Path(os.environ['VERLET_CABLE_DEVEL'])
sys.path.insert(0, str(DEVEL / 'lib/python3/dist-packages'))

HANG = {
    'frame_id': 'world',
    'time_step': 0.005,
    'materials': {'wire': {'linear_density': 0.1, 'radius': 0.005, 'bending_stiffness': 0.002}},
    'cables': [{
        'name': 'hose', 'length': 1.0, 'segments': 20, 'material': 'wire',
        'attachments': [{'name': 'left', 'at': 'start', 'frame': 'hand', 'initial_pose': [0.6, 0, 0, 0, 0, 0], 'type': 'clamp'},
                        {'name': 'right', 'at': 'end', 'offset': [0, 0, 0]}],
    }],
}


@pytest.fixture
def hang():
    """A cable from the frame `hand` to the fixed frame, as a dict of its own."""
    import copy
    return copy.deepcopy(HANG)


@pytest.fixture
def ropes(hang):
    """Two straight ropes along x, `first` held at its start and `second` behind its end, and a plug in the air."""
    hang['materials']['wire']['bending_stiffness'] = 0
    hang['cables'] = [
        {'name': 'first', 'length': 1.0, 'segments': 10, 'material': 'wire',
         'initial': {'type': 'straight', 'from': [0, 0, 0], 'to': [1, 0, 0]}, 'attachments': [{'name': 'left', 'at': 'start'}]},
        {'name': 'second', 'length': 1.0, 'segments': 10, 'material': 'wire',
         'initial': {'type': 'straight', 'from': [1.01, 0, 0], 'to': [2, 0, 0]}}]
    hang['bodies'] = [{'name': 'plug', 'mass': 0.1, 'inertia': [1e-4, 1e-4, 1e-4], 'pose': [0, 0, 1, 0, 0, 0]}]
    hang['obstacles'] = [{'name': 'floor', 'type': 'plane', 'pose': [0, 0, -3, 0, 0, 0]}]
    return hang


@pytest.fixture
def cable_sim(tmp_path):
    """Runs cable_sim on a scene; returns its summary and its rows as an array (t, node, x, y, z, vx, vy, vz, tension)."""
    import json

    import numpy

    def run(scene, *options):
        (tmp_path / 'scene.yaml').write_text(json.dumps(scene))
        subprocess.run([str(DEVEL / 'lib/verlet_cable/cable_sim'), 'scene.yaml', '--output', 'rows.csv', '--summary', 'summary.json',
                        *options], cwd=tmp_path, check=True, stdout=subprocess.DEVNULL)
        rows = [line.split(',') for line in (tmp_path / 'rows.csv').read_text().splitlines()[1:]]
        return json.loads((tmp_path / 'summary.json').read_text()), numpy.array([[float(x) for x in row[:1] + row[2:]] for row in rows])

    return run
