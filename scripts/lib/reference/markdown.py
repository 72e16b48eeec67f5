"""Pieces of Markdown that GitHub and MyST read alike."""
import re

CODE = re.compile(r'(`[^`]*`)')
WORDS = re.compile(r'\{[^{}]*\}|\b[a-z0-9]+(?:_[a-z0-9]+)+(?:\.\w+)*\b')


def generated(title, source):
    return f'<!-- Made by scripts/docs --reference from {source}: change it there. -->\n\n# {title}\n\n'


def with_code(text):
    """Keys and values in a plain comment, as code."""
    parts = CODE.split(text)
    return ''.join(part if part.startswith('`') else WORDS.sub(lambda match: f'`{match[0]}`', part) for part in parts)


def table(header, rows):
    """Cells are Markdown, of one line each; bars in them are escaped."""
    lines = [header, ['---'] * len(header), *rows]
    return ''.join('| ' + ' | '.join(cell.replace('|', r'\|') for cell in line) + ' |\n' for line in lines) + '\n'


def anchor(name):
    return f'<a id="{name}"></a>'


def fence(text, language):
    return f'```{language}\n{text.rstrip()}\n```\n\n'
