#!/usr/bin/env python3
"""write_reference.py CHECKOUT PROGRAMS [DIRECTORY]: makes the pages of doc/reference, or of DIRECTORY, from the sources. PROGRAMS is the
directory of the built programs."""
import sys
from pathlib import Path

from reference import camera, interfaces, languages, node, programs, scene


def pages(checkout, built):
    """Content by file name."""
    return {
        'scene.md': scene.page((checkout / 'config/scene_template.yaml').read_text(encoding='utf-8')),
        'messages.md': interfaces.messages_page(checkout),
        'services.md': interfaces.services_page(checkout),
        'node.md': node.page(checkout),
        'camera_node.md': camera.page(checkout),
        'command_lines.md': programs.page(checkout, built),
        'cpp.md': languages.cpp_page(checkout),
        'python.md': languages.python_page(),
    }


def main():
    checkout, built = Path(sys.argv[1]), Path(sys.argv[2])
    directory = Path(sys.argv[3]) if len(sys.argv) > 3 else checkout / 'doc/reference'
    directory.mkdir(exist_ok=True)
    for name, content in pages(checkout, built).items():
        (directory / name).write_text(content.rstrip() + '\n', encoding='utf-8')


if __name__ == '__main__':
    main()
