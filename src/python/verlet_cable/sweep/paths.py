"""Keys of a scene by their path, as errors name them: `materials.my_hose.bending_stiffness`, `cables[0].length`."""
import functools
import re

_PART = re.compile(r'([A-Za-z_][A-Za-z0-9_]*)((?:\[\d+\])*)')


@functools.lru_cache(maxsize=1024)
def parse_path(text):
    """The keys (str) and indices (int) of a path, from the scene down; None if it is no path."""
    parts = []
    for piece in text.split('.'):
        match = _PART.fullmatch(piece)
        if not match:
            return None
        parts.append(match.group(1))
        parts += [int(index) for index in re.findall(r'\d+', match.group(2))]
    return tuple(parts)


def path_text(parts):
    text = ''
    for part in parts:
        text += f'[{part}]' if isinstance(part, int) else ('.' if text else '') + part
    return text


def why_absent(tree, parts):
    """None if there is something at this path of the scene, or a dict that its last key can be put into; else what is not there."""
    for depth, part in enumerate(parts):
        here = path_text(parts[:depth]) or 'the scene'
        if isinstance(part, int):
            if not isinstance(tree, list):
                return f'{here} is no list'
            if part >= len(tree):
                return f'{here} has {len(tree)} entries, counted from 0'
        elif not isinstance(tree, dict):
            return f'{here} has no keys'
        elif part not in tree:
            return None if depth + 1 == len(parts) else f'{here} has {", ".join(tree) or "no keys"}'
        tree = tree[part]
    return None


def holder_of(tree, parts):
    """The dict or list that the last key of a path is in, or is to be put into."""
    for part in parts[:-1]:
        tree = tree[part]
    return tree
