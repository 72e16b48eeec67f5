#!/usr/bin/python3
"""picture_animations.py OUTPUT_DIRECTORY [NAME...]: animations of examples, NAME.gif. What it needs: see rviz_stage.py."""
import dataclasses
import pathlib
import subprocess
import sys
import tempfile

from rviz_stage import configuration, inside, keep, stage

SIZE = (640, 480)  # [pixels] of the window
FRAME_RATE = 12.5  # [Hz]


@dataclasses.dataclass
class Animation:
    launch: list
    config: str
    view: dict
    begin: float    # [s] after the cables are there
    seconds: float
    speed: float    # times real time


ANIMATIONS = {
    'harness': Animation(['harness.launch'], 'rviz/examples/harness.rviz', {'Distance': 1.4, 'Pitch': 0.75, 'Yaw': -1.3}, 0.5, 16.0, 2.0),
    'knot': Animation(['scene.launch', 'scene:=knot'], 'rviz/scenes/knot.rviz', {'Distance': 0.9}, 0.3, 6.0, 1.0),
}


def animate(animation, file):
    with tempfile.TemporaryDirectory() as directory:
        with stage(SIZE, configuration(animation.config, SIZE, **animation.view), animation.launch) as clock:
            clock.go_on(animation.begin)
            for number in range(round(animation.seconds / animation.speed * FRAME_RATE)):
                keep(f'{directory}/{number:04d}.png', inside(SIZE))
                clock.go_on(animation.speed / FRAME_RATE)
        pictures = sorted(map(str, pathlib.Path(directory).glob('*.png')))
        # The last one stays for two seconds.
        subprocess.run(['convert', '-delay', str(round(100 / FRAME_RATE)), '-loop', '0', *pictures[:-1], '-delay', '200', pictures[-1],
                        '+dither', '-colors', '64', '-fuzz', '1%', '-layers', 'Optimize', file], check=True)


def main():
    output = pathlib.Path(sys.argv[1])
    output.mkdir(parents=True, exist_ok=True)
    if len(sys.argv) == 3:
        animate(ANIMATIONS[sys.argv[2]], output / f'{sys.argv[2]}.gif')
        return
    for name in sys.argv[2:] or ANIMATIONS:
        subprocess.run([sys.executable, __file__, str(output), name], check=True)


if __name__ == '__main__':
    main()
