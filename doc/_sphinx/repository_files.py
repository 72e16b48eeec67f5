"""Links from pages to files of the repository that are no pages lead to pages that show them, or list the directory; those to the README
to the first page, which has its place here.

GitHub shows `[hose.yaml](../config/hose.yaml)` by itself. Files that are no text, and large ones, are downloads."""
import os
from pathlib import Path

from docutils import nodes
from markupsafe import escape
from pygments.lexers import TextLexer, get_lexer_for_filename
from pygments.util import ClassNotFound
from sphinx import addnodes
from sphinx.util.osutil import relative_uri

CHECKOUT = Path(__file__).resolve().parents[2]
README = Path('README.md')
LARGEST = 200_000  # bytes
LANGUAGES = {'.h': 'cpp', '.launch': 'xml', '.test': 'xml', '.msg': 'bash', '.srv': 'bash', '.action': 'bash', '.cfg': 'python'}


def path_of(target, page):
    """What a link leads to, relative to the checkout, or None: not a file of the repository, or a page."""
    if '://' in target or target.startswith(('#', 'mailto:')):
        return None
    path = Path(os.path.normpath(page.parent / target.partition('#')[0]))
    if not path.exists() or CHECKOUT not in path.parents:
        return None
    return path.relative_to(CHECKOUT)


def text_of(path):
    """What a file shows, or None: it is a download."""
    if path.stat().st_size > LARGEST:
        return None
    try:
        return path.read_text(encoding='utf-8')
    except UnicodeDecodeError:
        return None


def is_shown(path):
    return (CHECKOUT / path).is_dir() or text_of(CHECKOUT / path) is not None


def lead_to_files(app, doctree):
    """Links to shown files, before Sphinx makes downloads of them, or finds no page."""
    page = Path(app.env.doc2path(app.env.docname))
    shown = app.env.metadata[app.env.docname].setdefault('repository_files', [])
    for kind in (addnodes.download_reference, addnodes.pending_xref):
        for link in list(doctree.findall(kind)):
            path = link.get('reftype') == 'myst' and path_of(link['reftarget'], page)
            if not path or not is_shown(path) or app.env.path2doc(str(CHECKOUT / path)) in app.env.found_docs:
                continue
            target = f'files/{path}.html'
            if path == README:
                target = app.builder.get_target_uri(app.config.root_doc)
            else:
                shown.append(str(path))
            uri = relative_uri(app.builder.get_target_uri(app.env.docname), target)
            link.replace_self(nodes.reference('', '', *link.children, refuri=uri, internal=True))


def language_of(path, text):
    if path.suffix in LANGUAGES:
        return LANGUAGES[path.suffix]
    if text.startswith('#!'):
        return 'python' if 'python' in text.partition('\n')[0] else 'bash'
    try:
        return get_lexer_for_filename(path.name).aliases[0]
    except ClassNotFound:
        return TextLexer.aliases[0]


def body_of(app, path):
    """The HTML of the page of a file or directory."""
    if (CHECKOUT / path).is_dir():
        entries = (escape(entry.name + '/' * entry.is_dir()) for entry in sorted((CHECKOUT / path).iterdir()))
        return '<ul>' + ''.join(f'<li><code>{entry}</code></li>' for entry in entries) + '</ul>'
    text = text_of(CHECKOUT / path)
    return app.builder.highlighter.highlight_block(text, language_of(path, text), linenos='inline', force=True)


def make_pages(app):
    if app.builder.format != 'html':
        return
    paths = {path for page in app.env.metadata.values() for path in page.get('repository_files', [])}
    for path in sorted(paths):
        body = f'<h1><code class="file-path">{escape(path)}</code></h1>{body_of(app, Path(path))}'
        yield f'files/{path}', {'title': path, 'body': body, 'parents': []}, 'page.html'


def setup(app):
    app.connect('doctree-read', lead_to_files)
    app.connect('html-collect-pages', make_pages)
    return {'version': '1', 'parallel_read_safe': True, 'parallel_write_safe': True}
