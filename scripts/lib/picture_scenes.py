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
# scene: launch file and arguments, [s] until the picture, distance [m], focal point [m], pitch and yaw [rad] of the view
SCENES = {
    'pole': (['scene.launch', 'scene:=pole'], 2, 1.8, (0, 0, 0.75), 0.2, -1.1),
    'pile': (['scene.launch', 'scene:=pile'], 3, 0.5, (0, 0, 0.02), 0.6, -1.2),
    'table': (['scene.launch', 'scene:=table'], 4, 2.2, (-0.1, 0, 0.6), 0.3, -1.0),
    'knot': (['scene.launch', 'scene:=knot'], 5, 0.45, (0, 0, 0.96), 0.3, -1.3),
    'crossed': (['scene.launch', 'scene:=crossed'], 4, 0.9, (0.1, 0, 0.87), 0.3, -1.2),
    'dress_pack': (['dress_pack.launch'], 8, 2.0, (0.15, 0, 0.55), 0.2, -1.2),
}
LECTURE = {
    'box': (['lecture.launch', 'scene:=box'], 2, 4.5, (0, 0, 0), 0.3, -1.2),
    'planet': (['lecture.launch', 'scene:=planet'], 3, 4.0, (-0.2, 0, 0), 1.2, -1.57),
    'oscillator': (['lecture.launch', 'scene:=oscillator'], 2, 2.0, (0.5, 0.25, 0), 0.9, -1.57),
    'ropes': (['lecture.launch', 'scene:=ropes'], 2, 2.8, (0.1, 0.25, 1.4), 0.15, -1.2),
    'elastic_flag': (['lecture.launch', 'scene:=elastic_flag'], 2, 3.5, (0.6, 0.3, 1.5), 0.2, -1.0),
    'semi_rigid_flag': (['lecture.launch', 'scene:=semi_rigid_flag'], 2, 3.5, (0.6, 0.3, 1.5), 0.2, -1.0),
    'figure_on_stairs': (['lecture.launch', 'scene:=figure_on_stairs'], 0.5, 6, (1.0, 0, 1.2), 0.25, -1.2),
    'dragged_figure': (['lecture.launch', 'scene:=dragged_figure'], 4, 4.5, (1.2, 0.4, 0.6), 0.3, -1.2),
}
SETS = {'scenes': SCENES, 'lecture': LECTURE}


def view_of(distance, focus, pitch, yaw):
    """The text of an rviz configuration."""
    config = yaml.safe_load((PACKAGE / 'rviz/cable.rviz').read_text())
    manager = config['Visualization Manager']
    for display in manager['Displays']:
        if display['Class'] == 'rviz/TF':
            display['Enabled'] = False
    view = manager['Views']['Current']
    view.update({'Distance': distance, 'Pitch': pitch, 'Yaw': yaw, 'Focal Point': dict(zip('XYZ', focus))})
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


def picture(launch, seconds, view, file):
    with tempfile.NamedTemporaryFile('w', suffix='.rviz') as config:
        config.write(view_of(*view))
        config.flush()
        port = urlsplit(os.environ['ROS_MASTER_URI']).port
        with running('roscore', '-p', str(port)), running('rviz', '-d', config.name, DISPLAY=DISPLAY):
            time.sleep(STARTING)
            with running('roslaunch', 'verlet_cable', *launch, 'rviz:=false'):
                time.sleep(STARTING + seconds)
                subprocess.run(['import', '-display', DISPLAY, '-window', 'root', '-crop', VIEW, '+repage', file],
                               check=True)


def main():
    output, scenes = pathlib.Path(sys.argv[1]), SETS[sys.argv[2]]
    output.mkdir(parents=True, exist_ok=True)
    with running('Xvfb', DISPLAY, '-screen', '0', f'{SIZE[0]}x{SIZE[1]}x24', '-nolisten', 'tcp'):
        for name in sys.argv[3:] or scenes:
            launch, seconds, *view = scenes[name]
            picture(launch, seconds, view, output / f'{name}.png')


if __name__ == '__main__':
    main()
