#!/usr/bin/python3
"""picture_examples.py OUTPUT_DIRECTORY [NAME...]: pictures of launch/examples, of the demo, and of the panel, the tools and a
menu in use, NAME.png. What it needs: see rviz_stage.py.
"""
import os
import pathlib
import subprocess
import sys
import time

from rviz_stage import DISPLAY, PACKAGE, configuration, inside, keep, stage

SIZE = (800, 600)            # [pixels] of the window
WIDE = (1100, 700)           # with panels
EXAMPLES = {  # [s] until the picture
    'arm_dress_pack': 9,
    'crane': 5,
    'drones_with_bar': 6,
    'finger': 4,
    'flying_drone': 5,
    'gripper_load': 6,
    'harness': 15,
    'hose_between_arms': 8,
    'plug': 11,
    'rov_tether': 9,
    'table_camera': 8,
    'tethered_drone': 6,
    'tracker': 5,
}
SCENE = 'config/hanging_cable.yaml'  # of the tools and the menu: it hangs still
VIEW = {'Distance': 2.0, 'Pitch': 0.1, 'Yaw': -1.5708, 'Focal Point': {'X': 0.5, 'Y': 0, 'Z': 0.75}}
ON_CABLE = (735, 458)  # [pixels] the middle of the cable in that view
SETTLING = 3  # [s] until the panel shows the speed of after a click, during which the clock stands


def xdotool(*command):
    subprocess.run(['xdotool', *map(str, command)], check=True, env={**os.environ, 'DISPLAY': DISPLAY})


def press(key):
    """In rviz: it chooses the tool of that key."""
    xdotool('mousemove', *ON_CABLE, 'key', key)
    time.sleep(1)


def click(button):
    xdotool('mousemove', *ON_CABLE, 'sleep', 0.5, 'click', button)
    time.sleep(1.5)


def show(file, config, launch, seconds):
    """In a window without panels."""
    with stage(SIZE, configuration(config, SIZE), launch) as clock:
        clock.go_on(seconds)
        keep(file, inside(SIZE))


def on_the_still_cable():
    return stage(WIDE, configuration('rviz/cable.rviz', WIDE, panels=True, **VIEW), ['cable.launch', f'scene:={PACKAGE / SCENE}'], pace=1.0)


def picture_demo(file):
    show(file, 'rviz/demo.rviz', ['demo.launch'], 3)


def picture_panel(file):
    with stage(WIDE, configuration('rviz/demo.rviz', WIDE, panels=True, Distance=4.3), ['demo.launch'], pace=1.0) as clock:
        clock.go_on(8)
        keep(file)


def picture_tool(file):
    with on_the_still_cable() as clock:
        clock.go_on(1)
        press('x')
        click(1)
        clock.go_on(SETTLING)
        keep(file)


def picture_menu(file):
    with on_the_still_cable() as clock:
        clock.go_on(1)
        press('i')
        click(3)
        clock.go_on(SETTLING)
        keep(file)


OTHERS = {'demo': picture_demo, 'panel': picture_panel, 'tool': picture_tool, 'menu': picture_menu}


def main():
    output = pathlib.Path(sys.argv[1])
    output.mkdir(parents=True, exist_ok=True)
    if len(sys.argv) == 3:
        name, file = sys.argv[2], output / f'{sys.argv[2]}.png'
        if name in OTHERS:
            OTHERS[name](file)
        else:
            show(file, f'rviz/examples/{name}.rviz', [f'{name}.launch'], EXAMPLES[name])
        return
    for name in sys.argv[2:] or [*EXAMPLES, *OTHERS]:
        subprocess.run([sys.executable, __file__, str(output), name], check=True)


if __name__ == '__main__':
    main()
