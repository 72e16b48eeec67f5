"""`<a id="name"></a>` in a page, as in the tables of the reference, is what `page.md#name` leads to, as on GitHub."""
import re

from docutils import nodes

ANCHOR = re.compile(r'<a id="([^"]+)">')


def note_anchors(app, doctree):
    docname = app.env.docname
    labels = app.env.get_domain('std').anonlabels
    for raw in doctree.findall(nodes.raw):
        for name in ANCHOR.findall(raw.astext()):
            labels[f'{app.env.doc2path(docname, base=False)}#{name}'] = docname, name


def setup(app):
    app.connect('doctree-read', note_anchors)
    return {'version': '1', 'parallel_read_safe': True, 'parallel_write_safe': True}
