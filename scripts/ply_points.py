"""The points of PLY files (Turk, The PLY Polygon File Format, 1994): x, y and z of the element vertex. No ROS."""
import itertools
import os

import numpy as np

LARGEST_PLY = 1_000_000_000  # [bytes]
LONGEST_HEADER_LINE = 10_000  # [bytes]
MOST_HEADER_LINES = 1000
MOST_ERRORS = 100  # of a file
FORMATS = {'ascii 1.0': None, 'binary_little_endian 1.0': '<', 'binary_big_endian 1.0': '>'}  # numpy's sign for the order of bytes
TYPES = {'char': 'i1', 'uchar': 'u1', 'short': 'i2', 'ushort': 'u2', 'int': 'i4', 'uint': 'u4', 'float': 'f4', 'double': 'f8',
         'int8': 'i1', 'uint8': 'u1', 'int16': 'i2', 'uint16': 'u2', 'int32': 'i4', 'uint32': 'u4', 'float32': 'f4',
         'float64': 'f8'}
REMARKS = ('comment', 'obj_info')


class PlyError(Exception):
    """Why a file is refused: `errors`, each with what was found and what is allowed."""

    def __init__(self, errors):
        super().__init__('; '.join(errors))
        self.errors = errors


class _Element:
    def __init__(self, name, count):
        self.name, self.count = name, count
        self.scalars, self.lists = [], []  # names and types; names

    def layout(self, order):
        return np.dtype([(name, order + kind) for name, kind in self.scalars])


class _Header:
    """What the lines of a header say, and `errors` of what is wrong with them."""

    def __init__(self, lines):
        self.formats, self.elements, self.errors = [], [], []
        self.size = len(lines) + 2  # with `ply` and `end_header`
        for number, line in enumerate(lines, start=2):
            error = self._take(line.split(), line)
            if error:
                self.errors.append(f'line {number}: {error}')
        if len(self.formats) != 1:
            self.errors.append(f'{len(self.formats)} lines with a format; allowed: 1')
        vertices = [element for element in self.elements if element.name == 'vertex']
        self.order = FORMATS.get(self.formats[0]) if self.formats else None
        if len(vertices) != 1:
            self.errors.append(f'{len(vertices)} elements vertex; allowed: 1')
        else:
            self._check(vertices[0])

    def _take(self, words, line):
        """Takes a line; what is wrong with it."""
        keyword = words[0] if words else ''
        if keyword in REMARKS:
            return None
        if keyword == 'format':
            self.formats.append(' '.join(words[1:]))
            return None if self.formats[-1] in FORMATS else f'format "{self.formats[-1][:80]}"; allowed: {", ".join(FORMATS)}'
        if keyword == 'element' and len(words) == 3:
            if not words[2].isdecimal() or len(words[2]) > 20 or int(words[2]) > LARGEST_PLY:
                return f'{words[2][:80]} elements {words[1][:80]}; allowed: 0 to {LARGEST_PLY}'
            self.elements.append(_Element(words[1], int(words[2])))
            return None
        if keyword == 'property' and self.elements and (len(words) == 3 or len(words) == 5 and words[1] == 'list'):
            return self._take_property(words, self.elements[-1])
        return (f'"{line[:80]}"; allowed: format, element NAME COUNT and below it property TYPE NAME, {", ".join(REMARKS)}, '
                'end_header')

    @staticmethod
    def _take_property(words, element):
        name = words[-1]
        if name in element.lists or name in dict(element.scalars):
            return f'property {name[:80]} once more; allowed: each once'
        for kind in words[1 if len(words) == 3 else 2:-1]:
            if kind not in TYPES:
                return f'type {kind[:80]} of {name[:80]}; allowed: {", ".join(TYPES)}'
        if len(words) == 5:
            element.lists.append(name)
        else:
            element.scalars.append((name, TYPES[words[1]]))
        return None

    def _check(self, vertex):
        self.vertex = vertex
        self.before = list(itertools.takewhile(lambda element: element is not vertex, self.elements))
        self.errors += [f'vertex has the list {name[:80]}; allowed: scalar properties' for name in vertex.lists]
        names = [name for name, _ in vertex.scalars] + vertex.lists
        self.errors += [f'vertex has no {axis}; allowed: x, y and z' for axis in 'xyz' if axis not in names]
        if self.order:
            self.errors += [f'{element.name[:80]} has the list {name[:80]} and comes before vertex; allowed: lists after vertex'
                            for element in self.before for name in element.lists]


def _read_header(file):
    if file.readline(LONGEST_HEADER_LINE).rstrip() != b'ply':
        raise PlyError(['it does not begin with a line "ply"; allowed: PLY files'])
    lines = []
    while len(lines) < MOST_HEADER_LINES:
        line = file.readline(LONGEST_HEADER_LINE)
        if not line.endswith(b'\n'):
            break
        text = line.decode('ascii', 'backslashreplace').strip()
        if text == 'end_header':
            header = _Header(lines)
            if header.errors:
                raise PlyError(header.errors[:MOST_ERRORS])
            return header
        lines.append(text)
    raise PlyError([f'{len(lines) + 1} lines of a header without end_header; allowed: at most {MOST_HEADER_LINES} lines of at most '
                    f'{LONGEST_HEADER_LINE} bytes, the last one end_header'])


def _read_text(file, header):
    """A line an element."""
    skipped = sum(element.count for element in header.before)
    names = [name for name, _ in header.vertex.scalars]
    columns = [names.index(axis) for axis in 'xyz']
    points, errors = [], []
    for number, line in enumerate(itertools.islice(file, skipped, skipped + header.vertex.count), start=header.size + skipped + 1):
        words = line.split()
        try:
            if len(words) != len(names):
                raise ValueError(f'{len(words)} numbers')
            points.append([float(words[column]) for column in columns])
        except ValueError as error:
            errors.append(f'line {number}: {error}; allowed: {len(names)} numbers: {" ".join(names)[:200]}')
            if len(errors) == MOST_ERRORS:
                break
    if errors:
        raise PlyError(errors)
    if len(points) < header.vertex.count:
        raise PlyError([f'{len(points)} lines of vertices; allowed: {header.vertex.count}, as its header says'])
    return np.array(points, float).reshape(-1, 3)


def _read_bytes(file, header, size):
    file.seek(sum(element.count * element.layout(header.order).itemsize for element in header.before), os.SEEK_CUR)
    layout = header.vertex.layout(header.order)
    needed, there = header.vertex.count * layout.itemsize, max(0, size - file.tell())
    if there < needed:
        raise PlyError([f'{there} bytes of vertices; allowed: {needed}, as its header says'])
    records = np.frombuffer(file.read(needed), layout)
    return np.column_stack([records[axis].astype(float) for axis in 'xyz'])


def read_ply(path):
    """(n, 3) The points in their order. Properties may have any types, but no lists. Raises PlyError."""
    if os.path.exists(path) and not os.path.isfile(path):
        raise PlyError(['it is no file; allowed: a PLY file'])
    try:
        with open(path, 'rb') as file:
            size = os.fstat(file.fileno()).st_size
            if size > LARGEST_PLY:
                raise PlyError([f'{size} bytes; allowed: at most {LARGEST_PLY}'])
            header = _read_header(file)
            return _read_bytes(file, header, size) if header.order else _read_text(file, header)
    except OSError as error:
        raise PlyError([f'it cannot be read: {error.strerror}; allowed: a PLY file']) from error
