"""The pages of doc/python, doc/how_to and the README: their code does what they show; and run_page.py, which finds out."""
import ast
import os
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

pytest.importorskip('matplotlib')
pytest.importorskip('scipy')
pytest.importorskip('zarr')
pytest.importorskip('distributed')

PACKAGE = Path(__file__).resolve().parents[2]
RUN_PAGE = PACKAGE / 'scripts/lib/run_page.py'
ENVIRONMENT = dict(os.environ, PYTHONPATH=os.pathsep.join(
    [os.environ['VERLET_CABLE_DEVEL'] + '/lib/python3/dist-packages', *filter(None, [os.environ.get('PYTHONPATH')])]))
PYTHON_PAGES, HOW_TO_PAGES = ([path for path in sorted(PACKAGE.glob(f'doc/{folder}/*.md')) if '```python' in path.read_text()]
                              for folder in ('python', 'how_to'))
PAGES = PYTHON_PAGES + HOW_TO_PAGES


def run_page(page, *options):
    return subprocess.run([sys.executable, str(RUN_PAGE), str(page), *options], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, env=ENVIRONMENT)


@pytest.fixture
def write(tmp_path):
    """Writes a page with what is in its blocks; returns its path."""
    def write_page(*parts):
        page = tmp_path / 'page.md'
        page.write_text('# Page\n' + '\n'.join(parts) + '\n')
        return page
    return write_page


def python(code):
    return f'```python\n{code}\n```'


def text(shown, tolerance=''):
    return f'```text{tolerance}\n{shown}\n```'


@pytest.mark.parametrize('page', [PACKAGE / 'README.md', *PAGES], ids=lambda path: path.stem)
def test_a_page_shows_what_its_code_does(page):
    if 'verlet_cable.camera' in page.read_text():
        pytest.importorskip('verlet_cable.camera')
        pytest.importorskip('PIL')
    done = run_page(page)
    assert done.returncode == 0, done.stdout


def test_the_example_in_the_help_runs_well(write):
    module = (PACKAGE / 'src/python/verlet_cable/sim/__init__.py').read_text()
    example = re.search(r'(?:(?:    .*)?\n)+', ast.get_docstring(ast.parse(module)).partition('\n')[2])[0]
    done = run_page(write(python(textwrap.dedent(example) + 'print(status, world.time)'), text('ok 1.1', ' tolerance=1e-9')))
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize('module, shown', [('__init__', "depth.shape, mask.max(), visible.all()"), ('coco', 'len(dataset), world.time')])
def test_the_examples_in_the_help_of_the_camera_run_well(write, module, shown):
    pytest.importorskip('verlet_cable.camera')
    pytest.importorskip('PIL')
    help_text = ast.get_docstring(ast.parse((PACKAGE / f'src/python/verlet_cable/camera/{module}.py').read_text()))
    example = re.search(r'(?:(?:    .*)?\n)+', help_text.partition('\n')[2])[0]
    expected = {'__init__': '(480, 640) 1 True', 'coco': '10 0.1'}[module]
    done = run_page(write(python(textwrap.dedent(example) + f'print({shown})'), text(expected, ' tolerance=1e-9')))
    assert done.returncode == 0, done.stdout


def test_all_pages_are_in_the_index():
    index = (PACKAGE / 'doc/python/README.md').read_text()
    assert len(PYTHON_PAGES) >= 4 and all(f'({page.name})' in index for page in PYTHON_PAGES)


def test_every_picture_is_on_its_page():
    for picture in [*PACKAGE.glob('doc/python/*/*.png'), *PACKAGE.glob('doc/how_to/*/*.png')]:
        page = picture.parent.with_suffix('.md')
        assert f'({picture.relative_to(page.parent)})' in page.read_text(), picture


def test_blocks_go_on_where_the_one_before_ended(write):
    page = write(python('x = 1'), 'Some words.', '```\nthis is not Python\n```', python('print(x + 1)\nprint("two")'), text('2\ntwo'))
    assert run_page(page).returncode == 0


def test_what_is_named_or_within_a_function_is_not_echoed(write):
    page = write(python('def f():\n    "odd"\n    return 1\n\nx = f()\nfor k in range(20):\n    x = f()\n    None\n\nprint(x)'), text('1'))
    done = run_page(page)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize('printed, shown, tolerance, same', [
    ('1.0', '1.0', '', True),
    ('1.0', '1.1', '', False),
    ('about 1.004 m', 'about 1.000 m', ' tolerance=0.01', True),
    ('about 1.02 m', 'about 1.00 m', ' tolerance=0.005', False),
    ('about 1.01 m', 'about 1.00 m', ' tolerance=0.0001', True),
    ('about 1.004 m', 'around 1.000 m', ' tolerance=0.01', False),
    ('-2.0e-05', '-2.1e-05', ' tolerance=0.0001', True),
    ('-2.0e-05', '-2.0e-04', ' tolerance=0.01', False),
    ('-2.0', '2.0', ' tolerance=0.01', False),
    ('1 2', '1 2 3', ' tolerance=0.01', False),
    ('nan', '1', ' tolerance=0.01', False),
])
def test_text_is_compared(write, printed, shown, tolerance, same):
    page = write(python(f'print({printed!r})'), text(shown, tolerance))
    done = run_page(page)
    assert (done.returncode == 0) == same, done.stdout
    assert same or f'printed is\n{printed}' in done.stdout


@pytest.mark.parametrize('parts, message', [
    ([python('print(1)')], 'line 3: the block has 0 blocks of text after it, and prints:\n1'),
    ([python('x = 1'), text('1')], 'line 3: the block has 1 blocks of text after it, and prints:\n'),
    ([python('print(1, end="")'), text('1')], 'line 3: the last line that the block prints does not end:\n1'),
    ([python('for k in range(2):\n    x = k\nx = 3')], 'line 5: invalid syntax, when it is pasted'),
    ([python('def f():\n    x = 1\n\n    return x')], 'line 6: unexpected indent, when it is pasted'),
    ([python('x = (1,')], 'line 3: is not a whole statement'),
    ([python('import matplotlib.pyplot as plt\nplt.figure()')], 'draws 1 figures; the page shows 0'),
    ([python('import matplotlib.pyplot as plt\nplt.figure()'), '![A figure](page/figure.png)'], 'page/figure.png is not there'),
    ([python('x = 1'), '![A figure](page/figure.png)'], 'draws 0 figures; the page shows 1'),
    ([python('x = 1'), '## Section', python('y = 1'), '![A figure](page/figure.png)'], 'line 7: the block draws 0 figures; the page shows 1'),
    ([python('x = 1\nraise ValueError("odd")')], 'line 4'),
    ([python('x = 1\n"odd"')], "line 4: echoes 'odd', when it is pasted"),
    ([python('for k in range(2):\n    k')], 'line 3: echoes 0, when it is pasted'),
    ([python('for k in range(21):\n    [k]')], 'line 3: echoes 21 lines with'),
    ([python('[0.5] * 1000')], 'line 3: echoes 1 lines with 5000 characters'),
    (['```python', 'x = 1'], 'line 2: the block does not end'),
    (['No code.'], 'no block of Python'),
])
def test_what_is_wrong_with_a_page(write, parts, message):
    done = run_page(write(*parts))
    assert done.returncode == 1 and message in done.stdout, done.stdout


def test_a_section_without_blocks_may_show_what_the_page_does_not_draw(write):
    done = run_page(write(python('x = 1'), '## Another program', '![A figure](page/figure.png)'))
    assert done.returncode == 0, done.stdout


def test_rewriting_makes_text_and_pictures_so_that_they_are_right(write):
    page = write(python('print(1)'), text('3\n4'), 'Words.', python('print("a")\nprint("b")'), '```text tolerance=0.1\n```',
                 python('import matplotlib.pyplot as plt\nfigure = plt.figure()\nplt.show()'), '![A figure](page/figure.png)')
    assert run_page(page, '--rewrite').returncode == 0
    assert '```text\n1\n```\nWords.' in page.read_text() and '```text tolerance=0.1\na\nb\n```' in page.read_text()
    picture = page.parent / 'page/figure.png'
    before = picture.read_bytes()
    assert run_page(page).returncode == 0
    assert run_page(page, '--rewrite').returncode == 0
    assert picture.read_bytes() == before
