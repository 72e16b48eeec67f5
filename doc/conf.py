"""The manual: every Markdown file in this directory is a page, which GitHub shows as well. Built by scripts/docs."""
import os
import re
import sys
from pathlib import Path

from pygments.lexers import TextLexer

DOC = Path(__file__).parent
sys.path.insert(0, str(DOC / '_sphinx'))

project = 'verlet_cable'
author = 'verlet_cable maintainers'
release = re.search(r'<version>(.*)</version>', (DOC.parent / 'package.xml').read_text(encoding='utf-8'))[1]
version = release
copyright = f'{author}; BSD-3-Clause'

extensions = [
    'myst_parser', 'sphinx.ext.autodoc', 'sphinx.ext.mathjax', 'sphinx_copybutton', 'breathe', 'repository_files', 'html_anchors',
    'python_docstrings']
exclude_patterns = ['_*']
root_doc = 'index'
nitpicky = True

myst_enable_extensions = ['dollarmath', 'amsmath']
myst_heading_anchors = 6  # GitHub's names of headings
myst_update_mathjax = False  # is for version 3

# MathJax 2 from Debian, beside the pages: scripts/docs copies it, and no page needs the network.
html_static_path = ['_static', os.environ.get('VERLET_CABLE_MATHJAX', '../build/.docs/static')]
mathjax_path = 'mathjax/MathJax.js?config=TeX-AMS_CHTML'
mathjax2_config = {'showMathMenu': False, 'messageStyle': 'none', 'tex2jax': {'ignoreClass': 'body', 'processClass': 'math'}}

highlight_language = 'text'  # where none is named
smartquotes = False  # they make a dash of two hyphens

autodoc_member_order = 'bysource'
autodoc_default_options = {'members': True, 'undoc-members': True}
autoclass_content = 'both'

breathe_projects = {'verlet_cable': os.environ.get('VERLET_CABLE_DOXYGEN', '../build/.docs/doxygen/xml')}
breathe_default_project = 'verlet_cable'
breathe_default_members = ('members', 'undoc-members')

# What libraries declare has no page here.
nitpick_ignore_regex = [('cpp:.*', '.*'), ('py:.*', r'.*')]

html_theme = 'furo'
html_title = f'verlet_cable {release}'
html_css_files = ['manual.css']
html_copy_source = False
pygments_style = 'friendly'


def setup(app):
    app.add_lexer('csv', TextLexer)
