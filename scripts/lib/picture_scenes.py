#!/usr/bin/python3
"""picture_scenes.py OUTPUT_DIRECTORY scenes|lecture [NAME...]: shows each of config/scenes, or of config/scenes/lecture, in rviz on a
display of its own, and keeps a picture of each.

Needs the workspace's setup sourced, Xvfb and ImageMagick.
"""
import contextlib
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
from urllib.parse import urlsplit

import yaml

PACKAGE = pathlib.Path(__file__).resolve().parents[2]
DISPLAY = ':79'
SIZE = (960, 640)   # [pixels]
VIEW = '580x546+364+63'  # of it, without rviz's panels
STARTING = 6.0      # [s] until rviz has drawn something
SCENES = {  # [s] until the picture
    'pole': 2,
    'pile': 3,
    'table': 0,
    'knot': 2,
    'crossed': 4,
    'flat_cable': 4,
    'coiled_cable': 1,
    'dress_pack': 8,
}  # their views are rviz/scenes
LECTURE = {  # [s] until the picture, and how many steps after a reset it is of; 0: time just stops for it; None: it goes on, for trails
    'box': (2, None),
    'planet': (6, None),
    'oscillator': (0, 1000),
    'ropes': (0, 350),
    'elastic_flag': (0, 4000),
    'semi_rigid_flag': (0, 4000),
    'figure_on_stairs': (0, 750),
    'dragged_figure': (3, 0),
}  # their views are rviz/lecture


def view_of(name):
    """The text of a view in a window that fills the display."""
    config = yaml.safe_load((PACKAGE / f'rviz/{name}.rviz').read_text())
    config['Window Geometry'].update({'Width': SIZE[0], 'Height': SIZE[1], 'X': 0, 'Y': 0})
    return yaml.safe_dump(config)


@contextlib.contextmanager
def running(*command, **environment):
    process = subprocess.Popen(command, env={**os.environ, **environment}, start_new_session=True, stdout=subprocess.DEVNULL)
    try:
        yield
    finally:
        os.killpg(process.pid, signal.SIGINT)
        try:
            process.wait(15)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def call(service, *arguments):
    subprocess.run(['rosservice', 'call', service, *arguments], check=True, stdout=subprocess.DEVNULL)


def stop(steps):
    """Time stands still, so many steps after a reset, or now."""
    call('/cable/pause', 'true')
    if steps > 0:
        call('/cable/reset')
        call('/cable/step', str(steps))
    time.sleep(1)


def picture(launch, view, seconds, file, steps=None):
    with tempfile.NamedTemporaryFile('w', suffix='.rviz') as config:
        config.write(view)
        config.flush()
        port = urlsplit(os.environ['ROS_MASTER_URI']).port
        with running('roscore', '-p', str(port)), running('rviz', '-d', config.name, DISPLAY=DISPLAY):
            time.sleep(STARTING)
            with running('roslaunch', 'verlet_cable', *launch, 'rviz:=false'):
                time.sleep(STARTING + seconds)
                if steps is not None:
                    stop(steps)
                subprocess.run(['import', '-display', DISPLAY, '-window', 'root', '-crop', VIEW, '+repage', file],
                               check=True)


def picture_scene(name, file):
    launch = ['dress_pack.launch'] if name == 'dress_pack' else ['scene.launch', f'scene:={name}']
    picture(launch, view_of(f'scenes/{name}'), SCENES[name], file)


def picture_lecture(name, file):
    seconds, steps = LECTURE[name]
    picture(['lecture.launch', f'scene:={name}'], view_of(f'lecture/{name}'), seconds, file, steps)


def main():
    output = pathlib.Path(sys.argv[1])
    output.mkdir(parents=True, exist_ok=True)
    names, draw = {'scenes': (SCENES, picture_scene), 'lecture': (LECTURE, picture_lecture)}[sys.argv[2]]
    with running('Xvfb', DISPLAY, '-screen', '0', f'{SIZE[0]}x{SIZE[1]}x24', '-nolisten', 'tcp'):
        for name in sys.argv[3:] or names:
            draw(name, output / f'{name}.png')


if __name__ == '__main__':
    main()
