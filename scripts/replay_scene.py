#!/usr/bin/python3
"""replay_scene.py DATA.csv COMMAND...: the prefix with which replay.launch starts the node.

Writes the cable of a recording to the private parameters of the node that COMMAND starts, then becomes COMMAND. So the
parameter is there before the node asks for it.
"""
import os
import sys

import rosgraph

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import Recording, RecordingError  # noqa: E402

SEGMENT_LENGTH = 0.02  # [m], about
PARAMETER = '/cable/cables'
ORANGE = [1.0, 0.55, 0.1, 1.0]


def cables_of(recording):
    """A cable of the material in config/replay.yaml, clamped where the recorded one was held, in its first shape and motion."""
    length = recording.length()
    return [{
        'name': 'cable',
        'length': length,
        'segments': max(1, round(length / SEGMENT_LENGTH)),
        'material': 'generic',
        'color': ORANGE,
        'initial': {
            'type': 'points',
            'points': recording.markers[0].tolist(),
            'velocities': recording.initial_velocities().tolist(),
        },
        'attachments': [
            {'name': 'start', 'at': 'start', 'frame': 'start_gripper', 'type': 'clamp'},
            {'name': 'end', 'at': 'end', 'frame': 'end_gripper', 'type': 'clamp'},
        ],
    }]


def main():
    if len(sys.argv) < 3:
        sys.exit('usage: replay_scene.py DATA.csv COMMAND...')
    try:
        cables = cables_of(Recording(sys.argv[1]))
    except RecordingError as error:
        sys.exit(f'replay_scene.py: {error}')
    rosgraph.Master('/replay_scene').setParam(PARAMETER, cables)
    os.execvp(sys.argv[2], sys.argv[2:])


if __name__ == '__main__':
    main()
