"""`<a id="name"></a>` in a page is what `page.md#name` leads to, as on GitHub. Tables with such anchors are those of the reference, to
which the style sheet gives another form on narrow screens."""
import re

from docutils import nodes

ANCHOR = re.compile(r'<a id="([^"]+)">')


def note_anchors(app, doctree):
    docname = app.env.docname
    labels = app.env.get_domain('std').anonlabels
    for raw in doctree.findall(nodes.raw):
        for name in ANCHOR.findall(raw.astext()):
            labels[f'{app.env.doc2path(docname, base=False)}#{name}'] = docname, name
            if isinstance(raw.parent.parent, nodes.entry):
                table = raw.parent.parent.parent.parent.parent.parent
                table['classes'] = ['reference-table']


def setup(app):
    app.connect('doctree-read', note_anchors)
    return {'version': '1', 'parallel_read_safe': True, 'parallel_write_safe': True}
