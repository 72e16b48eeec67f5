"""cable_convert IN OUT.yaml"""
import argparse
import os
import sys
import warnings

from .errors import ConvertError

_BAD_INPUT, _STOPPED = 2, 3
_MOST_BYTES = 100_000_000  # of a file


def main(arguments=None):
    """The exit status."""
    parser = argparse.ArgumentParser(
        prog='cable_convert', description='Makes a scene of the cables in a file of another program: the BasisCurves of a text file of USD '
        '(.usda), or the composite cables of a MuJoCo model (.xml, .mjcf), with the stiffness of its plugin mujoco.elasticity.cable. Prints '
        'what does not carry over.',
        epilog='Exit status: 0 when the scene was written, 2 for a file that cannot be converted, 3 when the scene could not be written.')
    parser.add_argument('input', metavar='IN', help='a file that ends in .usda, .xml or .mjcf')
    parser.add_argument('output', metavar='OUT.yaml', help='the scene; an earlier one is replaced')
    options = parser.parse_args(arguments)
    try:
        text, found = convert(options.input, options.output)
    except ConvertError as error:
        for line in error.errors:
            print(f'cable_convert: {options.input}: {line}', file=sys.stderr)
        return _BAD_INPUT
    try:
        _write(options.output, text)
    except OSError as error:
        print(f'cable_convert: cannot write {options.output!r}: {error.strerror}; allowed: a file in a directory that can be written',
              file=sys.stderr)
        return _STOPPED
    for note in found.notes:
        print(f'cable_convert: note: {note}', file=sys.stderr)
    segments = sum(len(cable.points) - 1 for cable in found.cables)
    count = len(found.cables)
    print(f'{options.output}: {count} {"cable" if count == 1 else "cables"}, {segments} {"segment" if segments == 1 else "segments"}')
    return 0


def convert(source, output):
    """(scene as text, what was found). Raises ConvertError."""
    from .mujoco_cables import mujoco_cables
    from .usd_cables import usd_cables
    ending = os.path.splitext(source)[1].lower()
    readers = {'.usda': usd_cables, '.xml': mujoco_cables, '.mjcf': mujoco_cables}
    if ending not in readers:
        raise ConvertError(f'a name that ends in {ending!r}; allowed: {", ".join(readers)}')
    if os.path.splitext(output)[1] not in ('.yaml', '.yml'):
        raise ConvertError(f'OUT.yaml: {output!r}; allowed: a name that ends in .yaml or .yml')
    try:
        with open(source, 'rb') as file:
            content = file.read(_MOST_BYTES + 1)
        if len(content) > _MOST_BYTES:
            raise ConvertError(f'more than {_MOST_BYTES} bytes; allowed: at most as many')
        content = content.decode('utf-8-sig').replace('\r\n', '\n')
    except OSError as error:
        raise ConvertError(f'cannot read it: {error.strerror}; allowed: a file that can be read') from error
    except UnicodeDecodeError as error:
        raise ConvertError(f'byte {error.start}: no UTF-8; allowed: a text file') from error
    import numpy
    from .cables import scene_text
    try:
        # Numbers that are too large are errors, of which it tells.
        with numpy.errstate(all='ignore'):
            found = readers[ending](content)
            text = scene_text(found, os.path.basename(source))
    except MemoryError as error:
        raise ConvertError(f'{len(content)} letters, for which the memory does not suffice; allowed: a smaller file') from error
    found.notes += _doubts(text)
    return text, found


def _doubts(text):
    """What a scene allows and probably does not mean. What it does not allow is an error, by its own words."""
    from verlet_cable.sim import Scene, SceneError
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore')
            return Scene.from_yaml(text).warnings
    except SceneError as error:
        raise ConvertError(*error.errors) from error


def _write(path, text):
    part = f'{path}.{os.getpid()}.part'
    try:
        with open(part, 'w', encoding='utf-8') as file:
            file.write(text)
        os.replace(part, path)
    except OSError:
        if os.path.exists(part):
            os.remove(part)
        raise
