#!/usr/bin/python3
"""picture_tutorials.py OUTPUT_DIRECTORY [NAME...]: pictures of what readers of doc/tutorials build, NAME.png, in the view that they get.
What it needs: see rviz_stage.py.
"""
import contextlib
import dataclasses
import pathlib
import subprocess
import sys
import tempfile

import yaml
from rviz_stage import PACKAGE, inside, keep, running, stage
from run_tutorial import read_blocks

sys.path.insert(0, str(PACKAGE / 'scripts'))
import rviz_view  # noqa: E402

SIZE = (800, 600)  # [pixels] of the window


@dataclasses.dataclass
class Tutorial:
    """Which of the files of a page are used."""
    launch: str
    scene: str
    program: str    # that moves the frames
    seconds: float  # until the picture


TUTORIALS = {'robot_hose': Tutorial('my_hose.launch', 'my_hose.yaml', 'my_joints.py', 5)}


def write_files(page, folder):
    for block in read_blocks(page.read_text(encoding='utf-8').splitlines(keepends=True)):
        if 'file' in block.options:
            (folder / block.options['file']).write_text(block.content, encoding='utf-8')


def view_of(scene):
    """rviz/cable.rviz as launch/cable.launch has it for a scene, without panels."""
    view = yaml.safe_load((PACKAGE / 'rviz/cable.rviz').read_text(encoding='utf-8'))
    rviz_view.aim(view, scene)
    view['Visualization Manager']['Global Options']['Fixed Frame'] = scene['frame_id']
    view['Window Geometry'].update({'Width': SIZE[0], 'Height': SIZE[1], 'X': 0, 'Y': 0})
    view['Panels'] = []
    return yaml.safe_dump(view)


def picture(name, file):
    tutorial = TUTORIALS[name]
    with contextlib.ExitStack() as stack:
        folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        write_files(PACKAGE / f'doc/tutorials/{name}.md', folder)
        scene = yaml.safe_load((folder / tutorial.scene).read_text(encoding='utf-8'))
        stack.enter_context(running('python3', str(folder / tutorial.program)))
        clock = stack.enter_context(stage(SIZE, view_of(scene), [str(folder / tutorial.launch)]))
        clock.go_on(tutorial.seconds)
        keep(file, inside(SIZE))


def main():
    output = pathlib.Path(sys.argv[1])
    output.mkdir(parents=True, exist_ok=True)
    if len(sys.argv) == 3:
        picture(sys.argv[2], output / f'{sys.argv[2]}.png')
        return
    for name in sys.argv[2:] or TUTORIALS:
        subprocess.run([sys.executable, __file__, str(output), name], check=True)


if __name__ == '__main__':
    main()
