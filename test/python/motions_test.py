"""The CSV files beside the example scenes are what their launch files do, see scripts/lib/write_motions.py."""
import sys
from pathlib import Path

import numpy as np
import pytest

PACKAGE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PACKAGE / 'scripts/lib'))
import write_motions  # noqa: E402

ROUNDING = 1.1e-6  # [m] the last digit that is written


def rows(text):
    header, *lines = text.splitlines()
    return header, [line.split(',') for line in lines]


@pytest.mark.parametrize('path', write_motions.motion_files())
def test_files_are_as_they_are_written(path):
    header, written = rows(write_motions.motion_files()[path])
    shipped_header, shipped = rows((PACKAGE / path).read_text(encoding='utf-8'))
    assert shipped_header == header
    assert [row[:2] for row in shipped] == [row[:2] for row in written]
    for one, other in zip(shipped, written):
        assert [float(x) for x in one[2:]] == pytest.approx([float(x) for x in other[2:]], abs=ROUNDING)


@pytest.mark.parametrize('robot', write_motions.ARMS)
def test_links_are_where_their_joints_put_them(robot):
    """At zero, and with all joints turned."""
    joints = write_motions.joints_of(PACKAGE / f'{robot}.urdf')
    assert [name for _, _, _, name, _ in joints] == ['mount', 'pan', 'lift', 'elbow', 'roll']
    at_rest = write_motions.arm(0, joints)
    assert list(at_rest) == ['shoulder', 'upper_arm', 'forearm', 'wrist']
    assert at_rest['wrist'] == ((0.42, 0, 0.85), (0, 0, 0, 1))
    t = 3.0
    angles = write_motions.joint_positions(t)
    pan, lift, elbow = (angles[name] for name in ('pan', 'lift', 'elbow'))
    # In the arm's plane: up along the upper arm, then out along the forearm; positive angles about y lead down.
    out = 0.5 * np.sin(lift) + 0.42 * np.cos(lift + elbow)
    up = 0.35 + 0.5 * np.cos(lift) - 0.42 * np.sin(lift + elbow)
    expected = [out * np.cos(pan), out * np.sin(pan), up]
    assert write_motions.arm(t, joints)['wrist'][0] == pytest.approx(expected, abs=1e-12)
