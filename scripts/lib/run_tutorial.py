#!/usr/bin/python3
"""run_tutorial.py PAGE.md [--rewrite]: does what a tutorial tells its reader to do, block by block, in an empty folder.

What a block is for follows its language:
  yaml file=NAME, text file=NAME, ...  is written to that file; append=NAME adds to it. Files of YAML that are scenes are simulated for
                                       0.1 s, unless marked as `wrong`
  cpp template=PATH                    is part of that file of doc/template
  bash                                 is typed, and ends by itself, with status 0 or status=N
  bash terminal=N                      is typed into a terminal of its own, whose program runs on until the terminal's next block
  bash not-run                         is for the reader only
  text, text tolerance=0.01            after bash: what is printed, see run_page.py; `...` stands for anything. After a terminal's: what
                                       is printed there some time
What fails while terminals are open is typed again for a while: readers type more slowly than programs start. `rviz:=true` is typed as
`rviz:=false`. The folder has the package's config. Exits with 1 and says what is not so; with --rewrite it makes printed text without
`...` anew. Needs the workspace's setup sourced.
"""
import argparse
import dataclasses
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

import yaml
from run_page import CONFIG, NUMBER, PageError, same_text

PATIENCE = 60.0  # [s]
TEMPLATE = CONFIG.parent / 'doc/template'
NOT_RUN, WRONG = ['not-run'], ['wrong']
SCENE_KEYS = {'cables', 'nets', 'bodies', 'particles'}


@dataclasses.dataclass
class Block:
    """A block of a page, its content the lines [begin, end)."""
    begin: int
    end: int
    language: str
    flags: list
    options: dict
    content: str


def read_blocks(lines):
    """The blocks of a page that have a language."""
    blocks, begin, info = [], None, ''
    for k, line in enumerate(lines):
        if begin is None and line.startswith('```'):
            begin, info = k + 1, line[3:].split()
        elif begin is not None and line.rstrip() == '```':
            if info:
                options = dict(word.split('=', 1) for word in info[1:] if '=' in word)
                flags = [word for word in info[1:] if '=' not in word]
                blocks.append(Block(begin, k, info[0], flags, options, ''.join(lines[begin:k])))
            begin = None
    if begin is not None:
        raise PageError(f'line {begin}: the block does not end')
    if not blocks:
        raise PageError('has no block')
    return blocks


def is_output(block):
    return block.language == 'text' and not block.flags and 'file' not in block.options


def shows(shown, printed, tolerance, anywhere=False):
    """Whether printed text is what is shown, where `...` stands for anything; or, anywhere, whether it is in it."""
    if '...' not in shown and not anywhere:
        return same_text(shown, printed, tolerance)
    # A number before a gap is the beginning of one.
    pieces = re.split(rf'((?:{NUMBER.pattern[1:-1]})?\.\.\.)|{NUMBER.pattern}', ' '.join(shown.split()))
    pattern, numbers = '', []
    for literal, gap, number in zip(pieces[::3], pieces[1::3] + [None], pieces[2::3] + [None]):
        pattern += re.escape(literal) + (re.escape(gap[:-3]) + '.*?' if gap else NUMBER.pattern if number else '')
        numbers += [number] if number else []
    found = (re.search if anywhere else re.fullmatch)(pattern, ' '.join(printed.split()))
    return bool(found) and all(same_text(number, other, tolerance) for number, other in zip(numbers, found.groups()))


def is_scene(path):
    return path.suffix == '.yaml' and bool(SCENE_KEYS & set(yaml.safe_load(path.read_text(encoding='utf-8')) or ()))


class Terminal:
    """What runs on while the reader types elsewhere."""

    def __init__(self, script, folder):
        self._log = tempfile.TemporaryFile()
        self._process = subprocess.Popen(['bash', '-c', script], cwd=folder, stdin=subprocess.DEVNULL, stdout=self._log,
                                         stderr=subprocess.STDOUT, start_new_session=True)

    def text(self):
        return os.pread(self._log.fileno(), 1 << 22, 0).decode()

    def wait_for(self, shown, tolerance):
        deadline = time.monotonic() + PATIENCE
        while not shows(shown, self.text(), tolerance, anywhere=True):
            if time.monotonic() > deadline:
                return False
            time.sleep(0.1)
        return True

    def close(self):
        """As Ctrl-C does."""
        if self._process.poll() is None:
            os.killpg(self._process.pid, signal.SIGINT)
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()
        self._log.close()


class Reader:
    """Who does what a page says."""

    def __init__(self, folder, rewrite):
        self._folder = folder
        self._rewrite = rewrite
        self._terminals = {}
        self.new_texts = []  # blocks of text, and what was printed

    def close(self):
        for terminal in reversed(list(self._terminals.values())):
            terminal.close()

    def do(self, block, text):
        """A block and the block of text after it, or None."""
        where = f'line {block.begin + 1}'
        if 'file' in block.options or 'append' in block.options:
            self._save(where, block)
        elif 'template' in block.options:
            if block.content not in (TEMPLATE / block.options['template']).read_text():
                raise PageError(f'{where}: is not in doc/template/{block.options["template"]}')
        elif block.language == 'bash' and block.flags != NOT_RUN:
            script = block.content.replace('rviz:=true', 'rviz:=false')
            tolerance = float(text.options.get('tolerance', 0)) if text else 0.0
            if 'terminal' in block.options:
                self._open(where, block.options['terminal'], script, text, tolerance)
            else:
                self._type(where, script, int(block.options.get('status', 0)), text, tolerance)
        elif block.language in ('bash', 'text') and block.flags == NOT_RUN:
            pass
        else:
            raise PageError(f'{where}: what is this block for? See run_tutorial.py')

    def _save(self, where, block):
        name = block.options.get('file') or block.options['append']
        path = self._folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if 'append' in block.options and not path.is_file():
            raise PageError(f'{where}: there is no {name} to add to')
        with open(path, 'a' if 'append' in block.options else 'w', encoding='utf-8') as file:
            file.write(block.content)
        if block.flags != WRONG and is_scene(path):
            done = self._run(f'rosrun verlet_cable cable_sim {name} --duration 0.1')
            if done.returncode != 0:
                raise PageError(f'{where}: {done.stdout}')

    def _run(self, script):
        return subprocess.run(['bash', '-c', script], cwd=self._folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)

    def _type(self, where, script, status, text, tolerance):
        deadline = time.monotonic() + PATIENCE
        fixed = text and (not self._rewrite or '...' in text.content)
        while True:
            done = self._run('set -e\n' + script)
            wrong = done.returncode != status or fixed and not shows(text.content, done.stdout, tolerance)
            if not wrong or not self._terminals or time.monotonic() > deadline:
                break
            time.sleep(0.5)
        if wrong:
            opened = ''.join(f'terminal {name}:\n{terminal.text()}' for name, terminal in self._terminals.items())
            raise PageError(f'{where}: ends with status {done.returncode}; shown is\n{text.content if text else ""}'
                            f'printed is\n{done.stdout}{opened}')
        if text and not fixed:
            self.new_texts.append((text, done.stdout))

    def _open(self, where, name, script, text, tolerance):
        if name in self._terminals:
            self._terminals.pop(name).close()
        terminal = self._terminals[name] = Terminal(script, self._folder)
        if text and not terminal.wait_for(text.content, tolerance):
            raise PageError(f'{where}: shown is\n{text.content}printed is\n{terminal.text()}')


def run_tutorial(page, folder, rewrite):
    lines = page.read_text(encoding='utf-8').splitlines(keepends=True)
    blocks = read_blocks(lines)
    reader = Reader(folder, rewrite)
    try:
        for block, following in zip(blocks, blocks[1:] + [None]):
            if not is_output(block):
                reader.do(block, following if following and is_output(following) else None)
    finally:
        reader.close()
    for text, printed in reversed(reader.new_texts):
        lines[text.begin:text.end] = [printed]
    if reader.new_texts:
        page.write_text(''.join(lines), encoding='utf-8')


def free_port():
    with socket.socket() as probe:
        probe.bind(('localhost', 0))
        return probe.getsockname()[1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('page', metavar='PAGE.md', type=pathlib.Path)
    parser.add_argument('--rewrite', action='store_true', help='make printed text of the page anew')
    options = parser.parse_args()
    folder = pathlib.Path(tempfile.mkdtemp(prefix='tutorial_'))
    os.environ.update(ROS_MASTER_URI=f'http://localhost:{free_port()}', ROS_HOSTNAME='localhost', ROS_HOME=str(folder / '.ros'),
                      ROSCONSOLE_STDOUT_LINE_BUFFERED='1', PYTHONUNBUFFERED='1', PWD=str(folder))
    for variable in ('ROS_LOG_DIR', 'ROS_IP', 'ROS_NAMESPACE'):
        os.environ.pop(variable, None)
    os.symlink(CONFIG, folder / 'config')
    try:
        run_tutorial(options.page.resolve(), folder, options.rewrite)
    except PageError as error:
        sys.exit(f'{options.page}: {error}')
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == '__main__':
    main()
