#!/usr/bin/python3
"""picture_examples.py OUTPUT_DIRECTORY [NAME...]: pictures of launch/examples, and of the panel, the tools and a menu in use.

Needs the workspace's setup sourced, Xvfb, xdotool and ImageMagick.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import time
from urllib.parse import urlsplit

import yaml

from picture_scenes import DISPLAY, PACKAGE, STARTING, running

SIZE = (800, 600)            # [pixels] of the window
WIDE = (1100, 700)           # with panels
EXAMPLES = {  # [s] until the picture
    'arm_dress_pack': 8,
    'crane': 4,
    'drones_with_bar': 5,
    'finger': 3,
    'gripper_load': 5,
    'harness': 14,
    'hose_between_arms': 7,
    'plug': 10,
    'rov_tether': 8,
    'tethered_drone': 5,
    'tracker': 4,
}
SCENE = 'config/hanging_cable.yaml'  # of the tools and the menu: it hangs still
VIEW = {'Distance': 2.0, 'Pitch': 0.1, 'Yaw': -1.5708, 'Focal Point': {'X': 0.5, 'Y': 0, 'Z': 0.75}}
ON_CABLE = (735, 458)  # [pixels] the middle of the cable in that view


def configuration(file, size, panels, **view):
    """The text of an rviz configuration for a window of a size, with or without its panels, and what it shows."""
    config = yaml.safe_load((PACKAGE / file).read_text())
    config['Visualization Manager']['Views']['Current'].update(view)
    config['Window Geometry'].update({'Width': size[0], 'Height': size[1], 'X': 0, 'Y': 0})
    config['Panels'] = [panel for panel in config['Panels'] if panels and panel['Class'] != 'rviz/Displays']
    return yaml.safe_dump(config)


def xdotool(*command):
    subprocess.run(['xdotool', *map(str, command)], check=True, env={**os.environ, 'DISPLAY': DISPLAY})


def press(key):
    """In rviz: it chooses the tool of that key."""
    xdotool('mousemove', *ON_CABLE, 'key', key)
    time.sleep(1)


def click(button):
    xdotool('mousemove', *ON_CABLE, 'sleep', 0.5, 'click', button)
    time.sleep(1.5)


def keep(file, geometry=None):
    crop = ['-crop', geometry, '+repage'] if geometry else []
    subprocess.run(['import', '-display', DISPLAY, '-window', 'root', *crop, '-colors', '128', f'PNG8:{file}'], check=True)


class Stage:
    """rviz on the display, and a launch file."""

    def __init__(self, config, launch):
        self._file = tempfile.NamedTemporaryFile('w', suffix='.rviz')
        self._file.write(config)
        self._file.flush()
        port = str(urlsplit(os.environ['ROS_MASTER_URI']).port)
        self._parts = [running('roscore', '-p', port), running('rviz', '-d', self._file.name, DISPLAY=DISPLAY),
                       running('roslaunch', 'verlet_cable', *launch, 'rviz:=false')]

    def __enter__(self):
        for part in self._parts:
            part.__enter__()
            time.sleep(STARTING / 2)
        time.sleep(STARTING / 2)

    def __exit__(self, *exception):
        for part in reversed(self._parts):
            part.__exit__(*exception)
        self._file.close()


def picture_example(name, file):
    with Stage(configuration(f'rviz/examples/{name}.rviz', SIZE, panels=False), [f'{name}.launch']):
        time.sleep(EXAMPLES[name])
        keep(file, f'{SIZE[0] - 34}x{SIZE[1] - 105}+17+65')  # without rviz's menus and edges


def picture_panel(file):
    with Stage(configuration('rviz/panel.rviz', WIDE, panels=True), ['demo.launch']):
        keep(file)


def on_the_still_cable():
    return Stage(configuration('rviz/panel.rviz', WIDE, panels=True, **VIEW), ['cable.launch', f'scene:={PACKAGE / SCENE}'])


def picture_tool(file):
    with on_the_still_cable():
        press('x')
        click(1)
        keep(file)


def picture_menu(file):
    with on_the_still_cable():
        press('i')
        click(3)
        keep(file)


def main():
    output = pathlib.Path(sys.argv[1])
    output.mkdir(parents=True, exist_ok=True)
    others = {'panel': picture_panel, 'tool': picture_tool, 'menu': picture_menu}
    with running('Xvfb', DISPLAY, '-screen', '0', f'{WIDE[0]}x{WIDE[1]}x24', '-nolisten', 'tcp'):
        for name in sys.argv[2:] or [*EXAMPLES, *others]:
            file = output / f'{name}.png'
            if name in others:
                others[name](file)
            else:
                picture_example(name, file)


if __name__ == '__main__':
    main()
