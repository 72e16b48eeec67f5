"""YAML whose scalars stay text, as the package's own reader takes them: `1e-5` is a number for both, `on` is a name."""
import math
import re

import yaml

_NULL = ('', '~', 'null', 'Null', 'NULL')
_NUMBER = re.compile(r'[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?')
_INTEGER = re.compile(r'[-+]?(0|[1-9]\d*)')
# As in scenes.
_MOST_VALUES = 1_000_000
_DEEPEST_LEVEL = 32
_SPECIAL = {'.inf': math.inf, '+.inf': math.inf, '-.inf': -math.inf}


def parse(text, name, errors):
    """`text` as dicts, lists, texts and None; None, with what is wrong in `errors`, if it cannot be read. `name`: the file's. Aliases
    that multiply or nest without end are refused before anything is built of them."""
    try:
        node = yaml.compose(text, Loader=yaml.SafeLoader)
    except (yaml.YAMLError, RecursionError) as error:
        errors.append(f'{name}: not YAML: ' + ' '.join(str(error).split()))
        return None
    if node is None:
        return None
    problem = _why_too_large(node)
    if problem:
        errors.append(f'{name}: {problem}; allowed: less')
        return None
    return _value(node, '', name, errors)


def number(value):
    """The number that a scalar is, or None."""
    if isinstance(value, bool) or value is None:
        return None
    if isinstance(value, (int, float)):
        return float(value)
    if not isinstance(value, str):
        return None
    if value.lower() in _SPECIAL:
        return _SPECIAL[value.lower()]
    return float(value) if _NUMBER.fullmatch(value) else None


def with_numbers(value):
    """A value whose texts that are finite numbers are numbers, as YAML has them: integers where they are written so."""
    if isinstance(value, dict):
        return {key: with_numbers(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [with_numbers(entry) for entry in value]
    found = number(value)
    if found is None or not math.isfinite(found):
        return value
    return int(value) if _INTEGER.fullmatch(value) else found


def shown(value):
    """A value as errors show it: short, on one line."""
    if value is None:
        return 'nothing'
    if isinstance(value, str) and number(value) is None:
        text = repr(value)
    elif isinstance(value, dict):
        text = '{' + ', '.join(f'{key}: {shown(entry)}' for key, entry in value.items()) + '}'
    elif isinstance(value, list):
        text = '[' + ', '.join(shown(entry) for entry in value) + ']'
    else:
        text = str(value)
    return text if len(text) <= 80 else text[:77] + '...'


def _why_too_large(root):
    """Why no tree is built of a node, whose parts may be the same ones many times; None if one is."""
    values = 0
    waiting = [(root, 0)]
    while waiting:
        node, level = waiting.pop()
        values += 1
        if level > _DEEPEST_LEVEL:
            return f'nested deeper than {_DEEPEST_LEVEL} levels'
        if values > _MOST_VALUES:
            return f'more than {_MOST_VALUES} values'
        if isinstance(node, yaml.SequenceNode):
            waiting += [(entry, level + 1) for entry in node.value]
        elif isinstance(node, yaml.MappingNode):
            waiting += [(entry, level + 1) for pair in node.value for entry in pair]
    return None


def _value(node, key, name, errors):
    if isinstance(node, yaml.ScalarNode):
        return None if node.style is None and node.value in _NULL else node.value
    if isinstance(node, yaml.SequenceNode):
        return [_value(entry, f'{key}[{index}]', name, errors) for index, entry in enumerate(node.value)]
    values = {}
    for key_node, value_node in node.value:
        if not isinstance(key_node, yaml.ScalarNode):
            errors.append(f'{name}: a key of {key or "the file"} is no text')
            continue
        child = f'{key}.{key_node.value}' if key else key_node.value
        if key_node.value in values:
            errors.append(f'{name}: {child}: given twice; allowed: each key once')
        values[key_node.value] = _value(value_node, child, name, errors)
    return values
