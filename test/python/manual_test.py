"""The pages of doc, as they are in the repository: links lead somewhere, every page is in the manual, and the reference is up to date.
scripts/docs makes the manual of them, and checks more."""
import os
import re
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote

import pytest
import yaml

PACKAGE = Path(__file__).resolve().parents[2]
DOC = PACKAGE / 'doc'
PAGES = sorted(path for path in DOC.rglob('*.md') if not any(part.startswith('_') for part in path.parts))
OUTSIDE = [path for path in (PACKAGE / 'README.md', PACKAGE / 'CONTRIBUTING.md', *PACKAGE.glob('config/**/*.md')) if path.exists()]
FENCE = re.compile(r'^( *)(`{3,}|~{3,}).*?^\1\2`*$', re.M | re.S)
LINK = re.compile(r'\]\(<?([^)\s>]+)>?(?: "[^"]*")?\)|<img [^>]*src="([^"]+)"')
HEADING = re.compile(r'^#+ +(.*?) *$', re.M)
TOCTREE = re.compile(r'^```\{toctree\}\n(.*?)^```$', re.M | re.S)


def text_of(page):
    """Without what is shown as it is."""
    return FENCE.sub('', page.read_text(encoding='utf-8'))


def anchors_of(page):
    """As GitHub makes them from headings, and those that a page has itself."""
    text = text_of(page)
    anchors = re.findall(r'<a (?:id|name)="([^"]+)"', text)
    for heading in HEADING.findall(text):
        title = re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', heading).lower()
        name = re.sub(r'[^\w\- ]', '', title).replace(' ', '-')
        anchors.append(name if name not in anchors else f'{name}-{sum(anchor == name for anchor in anchors)}')
    return anchors


def error_of(link, page):
    """Why a link of a page is broken, or None."""
    if re.match(r'[a-z]+:', link):
        return None
    file, _, anchor = unquote(link).partition('#')
    target = (page.parent / file).resolve() if file else page
    if not target.exists() or PACKAGE not in target.parents:
        return 'there is no such file in the repository'
    if anchor and target.suffix == '.md' and anchor not in anchors_of(target):
        return 'there is no such heading'
    return None


@pytest.mark.parametrize('page', [*OUTSIDE, *PAGES], ids=lambda path: str(path.relative_to(PACKAGE)))
def test_links_lead_to_files_and_headings(page):
    links = [first or second for first, second in LINK.findall(text_of(page))]
    assert [f'{link}: {error_of(link, page)}' for link in links if error_of(link, page)] == []


def listed_by(page):
    for toctree in TOCTREE.findall(page.read_text(encoding='utf-8')):
        for line in toctree.splitlines():
            if line and not line.startswith(':'):
                yield page.parent / f'{line}.md'


def test_every_page_is_in_the_manual():
    listed = [page for listing in PAGES for page in listed_by(listing)]
    assert sorted(listed) == [page for page in PAGES if page != DOC / 'index.md']


@pytest.fixture(scope='module')
def reference(tmp_path_factory):
    """The pages as they are made now, by their names."""
    directory = tmp_path_factory.mktemp('reference')
    devel = Path(os.environ['VERLET_CABLE_DEVEL'])
    path = os.pathsep.join([str(devel / 'lib/python3/dist-packages'), *filter(None, [os.environ.get('PYTHONPATH')])])
    subprocess.run([sys.executable, str(PACKAGE / 'scripts/lib/write_reference.py'), str(PACKAGE), str(devel / 'lib/verlet_cable'),
                    str(directory)], check=True, env=dict(os.environ, PYTHONPATH=path, PYTHONDONTWRITEBYTECODE='1'))
    return {page.name: page.read_text(encoding='utf-8') for page in directory.iterdir()}


def test_the_reference_is_up_to_date(reference):
    """Else: scripts/docs --reference."""
    assert {page.name for page in (DOC / 'reference').glob('*.md')} == set(reference)
    for name, text in reference.items():
        assert (DOC / 'reference' / name).read_text(encoding='utf-8') == text, name


def key_anchors(keys, path):
    """Of all keys of a scene, items of lists as one."""
    for name, value in keys.items():
        below = f'{path}-{"name" if path == "materials" else name}'.lstrip('-')
        yield below
        for inner in value if isinstance(value, list) else [value]:
            if isinstance(inner, dict) and name not in ('initial', 'shapes'):
                yield from key_anchors(inner, below)


def test_every_key_of_the_template_has_an_anchor(reference):
    template = yaml.safe_load((PACKAGE / 'config/scene_template.yaml').read_text(encoding='utf-8'))
    keys = set(key_anchors(template, ''))
    assert len(keys) > 140
    assert keys - set(re.findall(r'<a id="([^"]+)"', reference['scene.md'])) == set()


def test_every_topic_and_service_of_the_nodes_is_in_the_reference(reference):
    code = '\n'.join(path.read_text(encoding='utf-8') for path in (PACKAGE / 'src/ros').rglob('*.cpp'))
    names = set(re.findall(r'(?:advertise|subscribe|advertiseService|serve|serve_aside)<[^;]*?>\(\s*(?:node, )?"([^"]+)"', code))
    assert {'state', 'events', 'pin', 'reset', '/tf', 'parameter_updates', 'goal'} <= names
    told = set(re.findall(r'`([^`]+)`', reference['node.md'] + reference['camera_node.md']))
    assert {name for name in names if not any(text == name or text.endswith('/' + name) for text in told)} == set()


def test_every_parameter_of_the_camera_is_in_the_reference(reference):
    code = (PACKAGE / 'src/ros/camera/camera_settings.cpp').read_text(encoding='utf-8')
    keys = {name for name in re.findall(r'(?:_key|of_camera|number)(?:<[^>]*>)?\(\s*"(\w+)"', code)}
    assert {'state', 'width', 'axial', 'dropout_angle', 'distortion', 'depth_encoding'} <= keys
    told = {name.rpartition('.')[2] for name in re.findall(r'></a>`([^`]+)`', reference['camera_node.md'])}
    assert keys - told == set()


def test_every_value_of_the_diagnostics_is_explained(reference):
    rows = re.findall(r'^\| <a id="diagnostics-([^"]+)"></a>`.*` \| (.*) \|$', reference['node.md'], re.M)
    assert len(rows) > 20 and [key for key, meaning in rows if not meaning.strip()] == []
