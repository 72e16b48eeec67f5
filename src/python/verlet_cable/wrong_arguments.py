"""What a call says that does not fit: which argument, what was given, and what is allowed. The compiled classes would list signatures."""
import difflib
import functools
import inspect
import operator
import re

import numpy as np

_MOST_SHOWN = 80
_MOST_COMPARED = 300  # letters of a name: longer ones take long
_MISMATCH = ('incompatible function arguments', 'incompatible constructor arguments')
_NO_DEFAULT = object()

_MISNAMED = re.compile(r'[^\n]*?"((?:[^"\\\n]|\\.)*)"[^"\n]*; allowed: ([^\n]*)')  # name: "ropes"; allowed: rope, wire

_WORDS = {'Any': 'a value', 'str': 'text', 'bytes': 'bytes, as save() returns them', 'buffer': 'bytes, as save() returns them',
          'Dict[str, Dict[str, numpy.ndarray[numpy.float64]]]': "a dict of dicts of numbers, such as {'my_hose': {'drag': 0.1}}",
          'int': 'an integer', 'bool': 'True or False', 'float': 'a number', 'dict': 'a dict',
          'numpy.ndarray[numpy.float64]': 'numbers that are real, as an array or nested sequences'}

# By the type that is asked for and the one that was given: what makes the one of the other.
_WAYS = {('Scene', str): '; Scene.load(path) reads a file, Scene.from_yaml(text) text',
         ('Scene', dict): '; Scene.from_dict(keys) makes one of a dict',
         ('dict', str): '; Scene.load(path) reads a file, Scene.from_yaml(text) text'}


def meant(name, names):
    """Which of the names was meant, in brackets, or nothing."""
    close = difflib.get_close_matches(name[:_MOST_COMPARED], names, 1)
    return f' (did you mean {close[0]}?)' if close else ''


class _Parameter:
    def __init__(self, text):
        declared, _, default = text.partition(' = ')
        self.name, _, self.type = declared.partition(': ')
        self.has_default = bool(default)


def _split(text):
    """At the commas that are in no brackets."""
    parts, depth = [''], 0
    for character in text:
        depth += (character in '([{') - (character in ')]}')
        if character == ',' and depth == 0:
            parts.append('')
        else:
            parts[-1] += character
    return [part.strip() for part in parts if part.strip()]


class _Signature:
    """positional, keyword_only: _Parameters, but for self; others: whether it takes any other keyword."""

    def __init__(self, text):
        self.positional, self.keyword_only, self.others = [], [], False
        kind = self.positional
        for part in _split(text):
            if part == '*' or part == '*args':
                kind = self.keyword_only
            elif part == '**kwargs':
                self.others = True
            elif not part.startswith('self:'):
                kind.append(_Parameter(part))

    def problem(self, args, kwargs):
        """(how many arguments fit before it, what is wrong)"""
        parameters = self.positional + self.keyword_only
        names = [parameter.name for parameter in parameters]
        if len(args) > len(self.positional):
            allowed = f'at most {len(self.positional)}: ' + ', '.join(p.name for p in self.positional) if self.positional else 'none'
            return len(args), f'{len(args)} argument{"s" if len(args) > 1 else ""} without a name; allowed: {allowed}'
        given = dict(zip(names, args))
        for name, value in kwargs.items():
            if name in given:
                return len(given), f'{name}: given twice; allowed: once'
            if name not in names and not self.others:
                return len(given), f'{name}: no such argument{meant(name, names)}; allowed: {", ".join(names) or "none"}'
            given[name] = value
        for index, parameter in enumerate(parameters):
            if parameter.name not in given:
                if not parameter.has_default:
                    return index, f'{parameter.name}: missing; allowed: {_words(parameter.type)}'
            elif not _fits(parameter.type, given[parameter.name]):
                value = given[parameter.name]
                return index, f'{parameter.name}: {_shown(value)}; allowed: {_words(parameter.type)}{_way(parameter.type, value)}'
        return len(given), None


def _class(name):
    from verlet_cable import _simulation
    return getattr(_simulation, name, None)


def _inner(kind, outer):
    match = re.fullmatch(outer + r'\[(.*)\]', kind)
    return match and match.group(1)


def _fits(kind, value):
    optional, several = _inner(kind, 'Optional'), _inner(kind, '(?:List|Sequence)')
    if optional:
        return value is None or _fits(optional, value)
    if several:
        if isinstance(value, (str, bytes)) or not hasattr(value, '__len__') or not hasattr(value, '__getitem__'):
            return False
        return isinstance(value, dict) is False and all(_fits(several, item) for item in value)
    union, items = _inner(kind, 'Union'), _inner(kind, 'Tuple')
    if union:
        return any(_fits(one, value) for one in _split(union))
    if items:
        kinds = _split(items)
        return isinstance(value, (tuple, list)) and len(value) == len(kinds) and all(map(_fits, kinds, value))
    if kind.startswith('Dict[') or kind == 'dict':
        if not isinstance(value, dict):
            return False
        parts = _split(_inner(kind, 'Dict') or '')
        return not parts or all(_fits(parts[0], key) and _fits(parts[1], item) for key, item in value.items())
    if kind == 'str':
        return isinstance(value, str)
    if kind == 'bytes':
        return isinstance(value, bytes)
    if kind == 'bool':
        return isinstance(value, (bool, np.bool_))
    if kind == 'int':
        return _succeeds(operator.index, value) and not _is_too_large(value)
    if kind == 'float':
        return not isinstance(value, str) and _succeeds(float, value)
    if kind == 'buffer':
        return _succeeds(memoryview, value)
    if kind.startswith('numpy.ndarray'):
        return _are_numbers(value)
    known = _class(kind.rpartition('.')[2])
    return known is None or isinstance(value, known)


def _is_too_large(integer):
    return operator.index(integer).bit_length() > 63


def _succeeds(function, value):
    try:
        function(value)
        return True
    except (TypeError, ValueError, OverflowError):
        return False


def _are_numbers(value):
    try:
        array = np.asarray(value)
    except ValueError:
        return False
    if array.dtype.kind != 'O':
        return array.dtype.kind in 'biuf'
    return all(hasattr(item, '__float__') and not isinstance(item, complex) for item in array.flat)


def _words(kind):
    optional, several = _inner(kind, 'Optional'), _inner(kind, '(?:List|Sequence)')
    if optional:
        return 'None, or ' + _words(optional)
    if several:
        return 'a list, of each ' + _words(several)
    union, items = _inner(kind, 'Union'), _inner(kind, 'Tuple')
    if union:
        return ' or '.join(map(_words, _split(union)))
    if items:
        return '(' + ', '.join(map(_words, _split(items))) + ')'
    name = kind.rpartition('.')[2]
    return _WORDS.get(kind) or ('a ' + name if _class(name) else kind)


def _way(kind, value):
    if kind == 'int' and _succeeds(operator.index, value):
        return '; this one is too large'
    for (asked, given), way in _WAYS.items():
        if kind.rpartition('.')[2] == asked and isinstance(value, given):
            return way
    return ''


def _shown(value):
    text = ascii(value)
    return text if len(text) <= _MOST_SHOWN else text[:_MOST_SHOWN] + '...'


def _signatures(function):
    lines = (function.__doc__ or '').split('\n')
    pattern = re.compile(r'(?:\d+\. )?' + re.escape(function.__name__) + r'\((.*)\)(?: -> .*)?')
    if 'Overloaded function.' not in lines:
        lines = lines[:1]
    found = [match.group(1) for match in map(pattern.fullmatch, lines) if match]
    return [_Signature(text) for text in found if text != '*args, **kwargs']


def _message(function, args, kwargs):
    problems = [signature.problem(args, kwargs) for signature in _signatures(function)]
    problems = [(fitting, text) for fitting, text in problems if text]
    if not problems:
        return f'{function.__name__}: arguments that it does not take'
    most = max(fitting for fitting, text in problems)
    return '; or '.join(dict.fromkeys(text for fitting, text in problems if fitting == most))


def _with_meant(text):
    misnamed = isinstance(text, str) and _MISNAMED.fullmatch(text)
    names = misnamed[2].split(', ') if misnamed else []
    return text + meant(misnamed[1], names) if len(names) > 1 else text


def _explaining(function, has_self):
    @functools.wraps(function)
    def call(*args, **kwargs):
        try:
            return function(*args, **kwargs)
        except TypeError as error:
            if not any(text in str(error) for text in _MISMATCH):
                raise
            message = _message(function, args[1:] if has_self else args, kwargs)
        except (KeyError, ValueError) as error:
            if type(error) in (KeyError, ValueError):  # a SceneError has named its keys
                error.args = tuple(map(_with_meant, error.args))
            raise
        raise TypeError(message)
    return call


def _checking(function):
    parts = []
    for parameter in list(inspect.signature(function).parameters.values())[1:]:
        if parameter.kind is parameter.KEYWORD_ONLY and '*' not in parts:
            parts.append('*')
        parts.append(f'{parameter.name}: Any' + ('' if parameter.default is parameter.empty else ' = ...'))
    signature = _Signature(', '.join(parts))

    @functools.wraps(function)
    def call(self, *args, **kwargs):
        _, problem = signature.problem(args, kwargs)
        if problem:
            raise TypeError(problem)
        return function(self, *args, **kwargs)
    return call


def explain_names(cls):
    """Has all public methods of a class that is written in Python say which arguments they take, as `explain` those of compiled ones.
    What values these may have they say themselves."""
    for name, attribute in list(vars(cls).items()):
        if inspect.isfunction(attribute) and (name == '__init__' or not name.startswith('_')):
            setattr(cls, name, _checking(attribute))
    return cls


def explain(*classes):
    """Has all methods of compiled classes say what was wrong with a call."""
    for cls in classes:
        for name, attribute in list(vars(cls).items()):
            if isinstance(attribute, staticmethod):
                setattr(cls, name, staticmethod(_explaining(attribute.__func__, False)))
            elif type(attribute).__name__ == 'instancemethod' and (name in ('__init__', '__getitem__') or not name.startswith('__')):
                setattr(cls, name, _explaining(attribute, True))
