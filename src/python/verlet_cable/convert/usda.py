"""Reads the text format of USD (openusd.org): prims with attributes. References, payloads and sublayers are not followed."""
import contextlib
import dataclasses
import re
from typing import Any, Dict, List

from .cables import MOST_DEPTH
from .errors import ConvertError

_TOKEN = re.compile(r'''
    (?P<space>[\s;]+|\#[^\n]*) |
    (?P<string>"""(?:\\.|[^\\])*?""" | \'\'\'(?:\\.|[^\\])*?\'\'\' | "(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])*') |
    (?P<asset>@@@.*?@@@|@[^@\n]*@) |
    (?P<path><[^>\n]*>) |
    (?P<number>[-+]?(?:inf\b|nan\b|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)) |
    (?P<word>[A-Za-z_][\w:]*(?:\.[A-Za-z_][\w:]*)*) |
    (?P<mark>[()\[\]{}=:,.&])
''', re.VERBOSE | re.DOTALL)
_SPECIFIERS = ('def', 'over', 'class')
_QUALIFIERS = ('custom', 'uniform', 'varying', 'config', 'add', 'prepend', 'append', 'delete', 'reorder')


@dataclasses.dataclass
class Attribute:
    type: str
    value: Any = None
    samples: Dict[float, Any] = dataclasses.field(default_factory=dict)  # by time code
    metadata: Dict[str, Any] = dataclasses.field(default_factory=dict)

    def first(self):
        """The value, or that of the first sample over time."""
        return self.samples[min(self.samples)] if self.value is None and self.samples else self.value


@dataclasses.dataclass
class Prim:
    specifier: str
    type: str
    name: str
    path: str
    metadata: Dict[str, Any] = dataclasses.field(default_factory=dict)
    attributes: Dict[str, Attribute] = dataclasses.field(default_factory=dict)
    children: List['Prim'] = dataclasses.field(default_factory=list)


def read_usda(text):
    """(metadata of the file, its prims)"""
    if not re.match(r'#usda\s+1\.\d+', text):
        start = text.split('\n', 1)[0][:40]
        raise ConvertError(f'line 1: {start!r}; allowed: #usda 1.0, the text format of USD (usdcat makes it of others)')
    return _Reader(text).read()


class _Reader:
    def __init__(self, text):
        self.tokens, self.next, self.depth = [], 0, 0
        place, line = 0, 1
        while place < len(text):
            match = _TOKEN.match(text, place)
            if not match:
                raise ConvertError(f'line {line}: {text[place:place + 20]!r}; allowed: the text format of USD')
            if match.lastgroup != 'space':
                self.tokens.append((match.lastgroup, match.group(), line))
            line += match.group().count('\n')
            place = match.end()
        self.tokens.append(('end', 'the end of the file', line))

    def read(self):
        metadata = self.metadata() if self.sees('(') else {}
        prims = []
        while self.kind() != 'end':
            prims.append(self.prim(''))
        return metadata, prims

    def kind(self):
        return self.tokens[self.next][0]

    def sees(self, text):
        kind, found, _ = self.tokens[self.next]
        return kind in ('mark', 'word') and found == text

    def take(self, allowed, *kinds):
        kind, text, line = self.tokens[self.next]
        if (kinds and kind not in kinds) or (not kinds and not self.sees(allowed)):
            raise ConvertError(f'line {line}: {text[:40]!r}; allowed: {allowed}')
        self.next += 1
        return text

    def takes(self, text):
        found = self.sees(text)
        self.next += found
        return found

    @contextlib.contextmanager
    def deeper(self):
        self.depth += 1
        if self.depth > MOST_DEPTH:
            raise ConvertError(f'line {self.tokens[self.next][2]}: more than {MOST_DEPTH} brackets in each other; allowed: fewer')
        yield
        self.depth -= 1

    def prim(self, parent):
        specifier = self.take('def, over or class', 'word')
        if specifier not in _SPECIFIERS:
            self.next -= 1
            self.take('def, over or class')
        kind = self.take('the type of a prim', 'word') if self.kind() == 'word' else ''
        name = _unquoted(self.take('the name of a prim in quotes', 'string'))
        prim = Prim(specifier, kind, name, f'{parent}/{name}')
        if self.sees('('):
            prim.metadata = self.metadata()
        self.take('{')
        with self.deeper():
            while not self.takes('}'):
                self.statement(prim)
        return prim

    def statement(self, prim):
        word = self.take('a prim or an attribute', 'word')
        if word in _SPECIFIERS and (self.kind() == 'string' or self.tokens[self.next + 1][0] == 'string'):
            self.next -= 1
            prim.children.append(self.prim(prim.path))
            return
        if word == 'variantSet':
            self.variants(prim)
            return
        is_list_edit = False
        while word in _QUALIFIERS:
            is_list_edit |= word in _QUALIFIERS[4:]
            word = self.take('the type of an attribute', 'word')
        kind = word
        if self.takes('['):
            self.take(']')
            kind += '[]'
        if is_list_edit and self.sees('='):  # reorder nameChildren = [...]
            self.take('=')
            self.value()
            return
        name, _, field = self.take('the name of an attribute', 'word').partition('.')
        attribute = prim.attributes.setdefault(name, Attribute(kind))
        if self.takes('='):
            value = self.value()
            if field == 'timeSamples':
                attribute.samples = value
            elif not field:
                attribute.value = value
        if self.sees('('):
            attribute.metadata.update(self.metadata())

    def variants(self, prim):
        """Passed over: which variant is chosen is not followed."""
        self.take('the name of a set of variants', 'string')
        self.take('=')
        self.take('{')
        depth = 1
        while depth:
            self.take('}', *(kind for kind in ('string', 'asset', 'path', 'number', 'word', 'mark')))
            depth += {'{': 1, '}': -1}.get(self.tokens[self.next - 1][1], 0)

    def metadata(self):
        self.take('(')
        found = {}
        while not self.takes(')'):
            if self.kind() == 'string':  # a comment
                self.next += 1
                continue
            name = self.take('a name', 'word')
            if name in _QUALIFIERS:
                name = self.take('a name', 'word')
            self.take('=')
            found[name] = self.value()
            self.takes(',')
        return found

    def value(self):
        if self.takes('('):
            with self.deeper():
                return tuple(self.items(')'))
        if self.takes('['):
            with self.deeper():
                return self.items(']')
        if self.takes('{'):
            with self.deeper():
                return self.entries()
        kind, text, line = self.tokens[self.next]
        self.take('a value', 'string', 'asset', 'path', 'number', 'word')
        if kind == 'string':
            return _unquoted(text)
        if kind == 'number':
            return float(text)
        if kind == 'asset' and self.kind() == 'path':  # @file@</prim>
            self.next += 1
        return {'None': None, 'true': True, 'false': False}.get(text, text)

    def items(self, end):
        found = []
        while not self.takes(end):
            found.append(self.value())
            if not self.takes(','):
                self.take(end)
                break
        return found

    def entries(self):
        """Samples over time, or a dictionary, whose entries have types."""
        found = {}
        while not self.takes('}'):
            if self.kind() == 'number':
                time = float(self.take('a time code', 'number'))
                self.take(':')
                found[time] = self.value()
            else:
                word = self.take('a type', 'word')
                if self.takes('['):
                    self.take(']')
                name = _unquoted(self.take('a name', 'word', 'string')) if not self.sees('=') else word
                self.take('=')
                found[name] = self.value()
            self.takes(',')
        return found


def _unquoted(text):
    for quote in ('"""', "'''", '"', "'"):
        if text.startswith(quote) and text.endswith(quote):
            return re.sub(r'\\(.)', r'\1', text[len(quote):-len(quote)], flags=re.DOTALL)
    return text
