#!/usr/bin/python3
"""picture_replay.py DATA.csv SCENE.yaml PICTURE.png: replays a recording beside its fitted cable in rviz, on a display of its own,
and keeps a picture.

Needs the workspace's setup sourced, Xvfb and ImageMagick.
"""
import os
import pathlib
import subprocess
import sys
import time
from urllib.parse import urlsplit

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from picture_scenes import PACKAGE, STARTING, running  # noqa: E402

DISPLAY = ':78'
SIZE = (1280, 800)       # [pixels] of rviz/replay.rviz
VIEW = '900x706+364+63'  # of it, without rviz's panels
PLAYED = 5.0             # [s] until the replay is in motion


def main():
    if len(sys.argv) != 4:
        sys.exit('usage: picture_replay.py DATA.csv SCENE.yaml PICTURE.png')
    data, scene, picture = (os.path.abspath(argument) for argument in sys.argv[1:])
    port = urlsplit(os.environ['ROS_MASTER_URI']).port
    with running('Xvfb', DISPLAY, '-screen', '0', f'{SIZE[0]}x{SIZE[1]}x24', '-nolisten', 'tcp'), \
            running('roscore', '-p', str(port)), \
            running('rviz', '-d', pathlib.Path(PACKAGE, 'rviz/replay.rviz'), DISPLAY=DISPLAY):
        time.sleep(STARTING)
        with running('roslaunch', 'verlet_cable', 'replay.launch', f'data:={data}', f'scene:={scene}', 'rviz:=false'):
            time.sleep(STARTING + PLAYED)
            subprocess.run(['import', '-display', DISPLAY, '-window', 'root', '-crop', VIEW, '+repage', picture], check=True)


if __name__ == '__main__':
    main()
