#!/usr/bin/python3
"""run_page.py PAGE.md [--rewrite]: runs the blocks of Python of a page, in order, as a reader does who pastes them into python3.

What a block prints is what the ```text block after it shows, exactly, or, where that is marked ```text tolerance=0.01, with numbers
that differ by so much of themselves and by one of the last digit. Figures that a block draws are the pictures after it, in the same
section, that lie in the folder named like the page. Exits with 1 and says what differs; with --rewrite it makes printed text and
pictures anew instead.

python3 also echoes the value of a statement that is an expression, and pages do not show that: it may only be what Matplotlib
returns, and no more of that than ECHOED_LINES and ECHOED_LENGTH for each statement.

The page runs in an empty folder that has the package's config. Needs the workspace's setup sourced.
"""
import argparse
import ast
import codeop
import contextlib
import dataclasses
import io
import os
import pathlib
import re
import reprlib
import sys
import tempfile

CONFIG = pathlib.Path(__file__).resolve().parents[2] / 'config'
DPI = 80
ECHOED_LINES, ECHOED_LENGTH = 20, 1000
TOLERANCE = re.compile(r'text tolerance=([\d.e-]+)$')
NUMBER = re.compile(r'([-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?)')
PICTURE = re.compile(r'!\[[^\]]*\]\(([^)]+)\)')


class PageError(Exception):
    """What of a page is not so."""


@dataclasses.dataclass
class Text:
    """A block of printed text: its lines are [begin, end) of the page."""
    begin: int
    end: int
    tolerance: float


@dataclasses.dataclass
class Block:
    """A block of Python, and what the page shows of it before the next one."""
    line: int  # of the page, from 1, where the code begins
    code: str
    texts: list = dataclasses.field(default_factory=list)
    pictures: list = dataclasses.field(default_factory=list)


def read_blocks(lines, folder):
    """The blocks of Python among the lines of a page whose pictures lie in a folder."""
    blocks, begin, kind, drawn = [], None, None, []
    for k, line in enumerate(lines):
        if begin is None:
            if line.startswith('```'):
                begin, kind = k + 1, line[3:].strip()
            elif line.startswith('#'):
                drawn = []  # a section may show what nothing on the page draws
            else:
                drawn += [path for path in PICTURE.findall(line) if path.startswith(folder + '/')]
        elif line.rstrip() == '```':
            tolerance = TOLERANCE.match(kind)
            if kind == 'python':
                blocks.append(Block(begin + 1, ''.join(lines[begin:k])))
                drawn = blocks[-1].pictures
            elif blocks and (kind == 'text' or tolerance):
                blocks[-1].texts.append(Text(begin, k, float(tolerance[1]) if tolerance else 0.0))
            begin = None
    if begin is not None:
        raise PageError(f'line {begin}: the block does not end')
    if not blocks:
        raise PageError('has no block of Python')
    return blocks


def check_pasting(block):
    """An interpreter that reads line by line ends a compound statement at an empty line, and only there."""
    compile_lines = codeop.CommandCompiler()
    pending = []
    for k, line in enumerate([*block.code.splitlines(), '']):
        pending.append(line)
        try:
            if compile_lines('\n'.join(pending)) is not None:
                pending = []
        except SyntaxError as error:
            raise PageError(f'line {block.line + k}: {error.msg}, when it is pasted into python3') from error
    if pending:
        raise PageError(f'line {block.line}: is not a whole statement, when it is pasted into python3')


def same_text(shown, printed, tolerance):
    """Whether two texts agree, in their numbers within a part of each and one of the last digit shown."""
    if not tolerance:
        return shown == printed
    shown, printed = (NUMBER.split(text) for text in (shown, printed))
    if [''.join(text.split()) for text in shown[::2]] != [''.join(text.split()) for text in printed[::2]]:
        return False
    return all(abs(float(b) - float(a)) <= tolerance * abs(float(a)) + 1.001 * last_digit(a) for a, b in zip(shown[1::2], printed[1::2]))


def last_digit(number):
    """What one of the last digit of a number's text is worth."""
    mantissa, _, exponent = number.partition('e')
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition('.')[2]))


def run_block(block, page, namespace):
    """Runs a block as an interpreter does; returns what it printed, without what it echoed."""
    # Tracebacks name the page and its lines.
    tree = ast.parse('\n' * (block.line - 1) + block.code, str(page))
    output = io.StringIO()
    with contextlib.redirect_stdout(output):
        for statement in tree.body:
            echoed = []
            sys.displayhook = echoed.append
            try:
                exec(compile(ast.Interactive([statement]), str(page), 'single'), namespace)
            finally:
                sys.displayhook = sys.__displayhook__
            check_echo(statement.lineno, [value for value in echoed if value is not None])
    return output.getvalue()


def check_echo(line, values):
    """Refuses values that a statement echoes, unless they are a few of Matplotlib's."""
    for value in values:
        # Methods that make or set several things at once return a list.
        if not (isinstance(value, list) or type(value).__module__.startswith('matplotlib.')):
            raise PageError(f'line {line}: echoes {reprlib.repr(value)}, when it is pasted into python3: give it a name')
    length = sum(len(repr(value)) for value in values)
    if len(values) > ECHOED_LINES or length > ECHOED_LENGTH:
        raise PageError(f'line {line}: echoes {len(values)} lines with {length} characters, when it is pasted into python3')


def take_figures(block, keep):
    """Closes the figures that a block drew; keep(path, figure) is called with each."""
    plt = sys.modules.get('matplotlib.pyplot')  # what draws nothing need not have it
    numbers = plt.get_fignums() if plt else []
    if len(numbers) != len(block.pictures):
        raise PageError(f'line {block.line}: the block draws {len(numbers)} figures; the page shows {len(block.pictures)}')
    for path, number in zip(block.pictures, numbers):
        keep(path, plt.figure(number))
        plt.close(number)


def run_page(page, rewrite):
    """Runs a page. Raises PageError, and what the page's code raises."""
    lines = page.read_text().splitlines(keepends=True)
    blocks = read_blocks(lines, page.stem)

    def keep(path, figure):
        if rewrite:
            (page.parent / path).parent.mkdir(exist_ok=True)
            # No date and no version inside: the same data make the same bytes.
            figure.savefig(page.parent / path, dpi=DPI, metadata={'Software': None})
        elif not (page.parent / path).is_file():
            raise PageError(f'{path} is not there')

    printed_texts, errors = [], []
    namespace = {'__name__': '__main__'}
    for block in blocks:
        check_pasting(block)
        printed = run_block(block, page, namespace)
        take_figures(block, keep)
        if len(block.texts) != bool(printed):
            raise PageError(f'line {block.line}: the block has {len(block.texts)} blocks of text after it, and prints:\n{printed}')
        if not printed.endswith('\n') and printed:
            raise PageError(f'line {block.line}: the last line that the block prints does not end:\n{printed}')
        for text in block.texts:
            printed_texts.append((text, printed))
            shown = ''.join(lines[text.begin:text.end])
            if not same_text(shown, printed, text.tolerance):
                errors.append(f'line {text.begin + 1}: shown is\n{shown}printed is\n{printed}')
    if rewrite:
        for text, printed in reversed(printed_texts):
            lines[text.begin:text.end] = [printed]
        page.write_text(''.join(lines))
    elif errors:
        raise PageError('\n'.join(errors))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('page', metavar='PAGE.md', type=pathlib.Path)
    parser.add_argument('--rewrite', action='store_true', help='make printed text and pictures of the page anew')
    options = parser.parse_args()
    page = options.page.resolve()
    os.environ['MPLBACKEND'] = 'Agg'
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(CONFIG, f'{folder}/config')
        os.chdir(folder)
        try:
            run_page(page, options.rewrite)
        except PageError as error:
            sys.exit(f'{options.page}: {error}')
        finally:
            os.chdir('/')


if __name__ == '__main__':
    main()
