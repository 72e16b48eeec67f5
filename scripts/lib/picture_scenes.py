#!/usr/bin/python3
"""picture_scenes.py OUTPUT_DIRECTORY scenes|lecture [NAME...]: shows each of config/scenes, or of config/scenes/lecture, in rviz, and
keeps a picture of each, NAME.png. What it needs: see rviz_stage.py.
"""
import pathlib
import subprocess
import sys
import time

from rviz_stage import configuration, inside, keep, stage

SIZE = (640, 600)  # [pixels] of the window
SHOWING = 2.0      # [s] until what stands still is published and drawn
SCENES = {  # [s] until the picture
    'pole': 6,
    'pile': 6,
    'table': 4,
    'knot': 2.2,
    'crossed': 4,
    'flat_cable': 5,
    'coiled_cable': 2,
    'dress_pack': 8,
    'moored_buoy': 6,
}  # their views are rviz/scenes
LECTURE = {  # [s] until the picture, and how many steps after a reset it is of; 0: time just stops for it; None: it goes on, for trails
    'box': (4, None),
    'planet': (12, None),
    'oscillator': (1, 1000),
    'ropes': (1, 350),
    'elastic_flag': (1, 4000),
    'semi_rigid_flag': (1, 4000),
    'figure_on_stairs': (1, 750),
    'dragged_figure': (6, 0),
}  # their views are rviz/lecture


def call(service, *arguments):
    subprocess.run(['rosservice', 'call', service, *arguments], check=True, stdout=subprocess.DEVNULL)


def stop(steps):
    """Time stands still, so many steps after a reset, or now."""
    call('/cable/pause', 'true')
    if steps > 0:
        call('/cable/reset')
        call('/cable/step', str(steps))


def picture_scene(name, file):
    launch = ['dress_pack.launch'] if name == 'dress_pack' else ['scene.launch', f'scene:={name}']
    with stage(SIZE, configuration(f'rviz/scenes/{name}.rviz', SIZE), launch) as clock:
        clock.go_on(SCENES[name])
        keep(file, inside(SIZE))


def picture_lecture(name, file):
    seconds, steps = LECTURE[name]
    with stage(SIZE, configuration(f'rviz/lecture/{name}.rviz', SIZE), ['lecture.launch', f'scene:={name}']) as clock:
        clock.go_on(seconds)
        if steps is not None:
            stop(steps)
            time.sleep(SHOWING)
        keep(file, inside(SIZE))


def main():
    output = pathlib.Path(sys.argv[1])
    output.mkdir(parents=True, exist_ok=True)
    names, draw = {'scenes': (SCENES, picture_scene), 'lecture': (LECTURE, picture_lecture)}[sys.argv[2]]
    if len(sys.argv) == 4:
        draw(sys.argv[3], output / f'{sys.argv[3]}.png')
        return
    for name in sys.argv[3:] or names:
        subprocess.run([sys.executable, __file__, *sys.argv[1:3], name], check=True)


if __name__ == '__main__':
    main()
