#!/usr/bin/python3
"""replay_scene.py DATA.csv SCENE COMMAND...: the prefix with which replay.launch starts the node.

Writes the cable of a recording to the private parameters of the node that COMMAND starts, then becomes COMMAND. So the
parameter is there before the node asks for it. SCENE: a scene file of cable_fit, whose cable and material are taken; empty: a
cable of the material in config/replay.yaml.
"""
import os
import sys

import rosgraph
import yaml

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from recording import Recording, RecordingError  # noqa: E402

SEGMENT_LENGTH = 0.02  # [m], about
NAMESPACE = '/cable/'
ORANGE = [1.0, 0.55, 0.1, 1.0]


class SceneFileError(Exception):
    """A file that holds no fitted cable; the message names the file, what was found and what is needed."""


def generic_cable(recording):
    """A cable of the material in config/replay.yaml."""
    length = recording.length()
    return {'name': 'cable', 'length': length, 'segments': max(1, round(length / SEGMENT_LENGTH)), 'material': 'generic'}


def read_fitted(path):
    """The scene that cable_fit wrote: a map with its one cable."""
    try:
        with open(path, encoding='utf-8') as file:
            scene = yaml.safe_load(file)
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise SceneFileError(f'{path}: cannot be read: {error}') from error
    cables = scene.get('cables') if isinstance(scene, dict) else None
    if not isinstance(cables, list) or len(cables) != 1 or not isinstance(cables[0], dict):
        raise SceneFileError(f'{path}: holds no list `cables` of one cable; allowed is what cable_fit writes')
    return scene


def replayed(cable, recording):
    """The cable, clamped where the recorded one was held, in its first shape and motion."""
    return {
        **cable,
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
    }


def main():
    if len(sys.argv) < 4:
        sys.exit('usage: replay_scene.py DATA.csv SCENE COMMAND...')
    try:
        recording = Recording(sys.argv[1])
        scene = read_fitted(sys.argv[2]) if sys.argv[2] else {'cables': [generic_cable(recording)]}
    except (RecordingError, SceneFileError) as error:
        sys.exit(f'replay_scene.py: {error}')
    scene['cables'] = [replayed(scene['cables'][0], recording)]
    master = rosgraph.Master('/replay_scene')
    for key, value in scene.items():
        master.setParam(NAMESPACE + key, value)
    os.execvp(sys.argv[3], sys.argv[3:])


if __name__ == '__main__':
    main()
