#!/usr/bin/python3
"""picture_replay.py DATA.csv SCENE.yaml PICTURE.png: replays a recording beside its fitted cable in rviz, and keeps a picture. The view is
that of rviz/replay.rviz, aimed at the recording. What it needs: see rviz_stage.py.
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from rviz_stage import PACKAGE, configuration, inside, keep, stage  # noqa: E402
sys.path.insert(0, str(PACKAGE / 'scripts'))
from recording import Recording  # noqa: E402

SIZE = (934, 810)    # [pixels] of the window
PLAYED = 4.0         # [s] until the picture
LABEL_HEIGHT = 0.25  # [m] of scripts/replay.py, above the cable's ends


def view_of(data):
    """rviz/replay.rviz, aimed at the middle of a recording and its label."""
    markers = Recording(data).markers
    middle = (markers.min(axis=(0, 1)) + markers.max(axis=(0, 1))) / 2 + [0, 0, LABEL_HEIGHT / 2]
    return configuration('rviz/replay.rviz', SIZE, **{'Focal Point': dict(zip('XYZ', middle.tolist()))})


def main():
    if len(sys.argv) != 4:
        sys.exit('usage: picture_replay.py DATA.csv SCENE.yaml PICTURE.png')
    data, scene, picture = (os.path.abspath(argument) for argument in sys.argv[1:])
    with stage(SIZE, view_of(data), ['replay.launch', f'data:={data}', f'scene:={scene}']) as clock:
        clock.go_on(PLAYED)
        keep(picture, inside(SIZE))


if __name__ == '__main__':
    main()
