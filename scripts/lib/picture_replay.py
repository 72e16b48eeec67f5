#!/usr/bin/python3
"""picture_replay.py DATA.csv SCENE.yaml PICTURE.png: replays a recording beside its fitted cable in rviz, on a display of its own,
and keeps a picture. The view is that of rviz/replay.rviz, aimed at the recording.

Needs the workspace's setup sourced, Xvfb and ImageMagick.
"""
import os
import subprocess
import sys
import tempfile
import time
from urllib.parse import urlsplit

import yaml

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from picture_scenes import PACKAGE, STARTING, running  # noqa: E402
sys.path.insert(0, str(PACKAGE / 'scripts'))
from recording import Recording  # noqa: E402

DISPLAY = ':78'
SIZE = (1280, 800)       # [pixels] of rviz/replay.rviz
VIEW = '900x706+364+63'  # of it, without rviz's panels
PLAYED = 2.5             # [s] of the recording, until the picture
LABEL_HEIGHT = 0.25      # [m] of scripts/replay.py, above the cable's ends


def view_of(data):
    """The text of rviz/replay.rviz, aimed at the middle of a recording and its label."""
    config = yaml.safe_load((PACKAGE / 'rviz/replay.rviz').read_text())
    markers = Recording(data).markers
    middle = (markers.min(axis=(0, 1)) + markers.max(axis=(0, 1))) / 2 + [0, 0, LABEL_HEIGHT / 2]
    config['Visualization Manager']['Views']['Current']['Focal Point'] = dict(zip('XYZ', middle.tolist()))
    return yaml.safe_dump(config)


def main():
    if len(sys.argv) != 4:
        sys.exit('usage: picture_replay.py DATA.csv SCENE.yaml PICTURE.png')
    data, scene, picture = (os.path.abspath(argument) for argument in sys.argv[1:])
    port = urlsplit(os.environ['ROS_MASTER_URI']).port
    with tempfile.NamedTemporaryFile('w', suffix='.rviz') as config, \
            running('Xvfb', DISPLAY, '-screen', '0', f'{SIZE[0]}x{SIZE[1]}x24', '-nolisten', 'tcp'), \
            running('roscore', '-p', str(port)):
        config.write(view_of(data))
        config.flush()
        with running('rviz', '-d', config.name, DISPLAY=DISPLAY):
            time.sleep(STARTING)
            with running('roslaunch', 'verlet_cable', 'replay.launch', f'data:={data}', f'scene:={scene}', 'rviz:=false'):
                subprocess.run(['rostopic', 'echo', '-n', '1', '/replay/error'], check=True, stdout=subprocess.DEVNULL)
                time.sleep(PLAYED)
                subprocess.run(['import', '-display', DISPLAY, '-window', 'root', '-crop', VIEW, '+repage', picture], check=True)


if __name__ == '__main__':
    main()
