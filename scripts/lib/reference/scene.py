"""doc/reference/scene.md from the comments of config/scene_template.yaml."""
import re
from dataclasses import dataclass, field

import yaml

from reference.markdown import anchor, generated, table, with_code

KEY = re.compile(r'^(?P<indent> *)(?P<item>- )?(?P<key>[a-z_]+):(?: (?P<value>.*))?$')
# A key that is itself a comment, below its own.
HIDDEN_KEY = re.compile(r'^(?P<indent> *)#(?: |   )(?P<key>[a-z_]+): (?P<value>\S.*)$')
COMMENT = re.compile(r'^ *# ?(?P<text>.*)$')
UNIT = re.compile(r'\[([a-zA-Z0-9/^() ]+)\]')
# Whose value in the template is an example.
EXAMPLE = re.compile(r'[Tt]he default is|[Ww]ithout it|required')
REQUIRED = re.compile(r'Required[.,]')
DEFAULT = re.compile(r'The default is ((?:[^.;:]|\.[0-9i])+)[.;:]')
LONGEST_DEFAULT = 40  # letters; where it takes more to tell, the table has an example
NAMES_OF_USERS = {'my_hose': 'NAME'}


@dataclass
class Key:
    name: str
    value: str
    comment: list
    level: int
    is_item: bool = False
    is_example: bool = False
    keys: list = field(default_factory=list)

    def add(self, key):
        """Later items of a list show further keys."""
        if all(key.name != other.name for other in self.keys):
            self.keys.append(key)
            return key
        return next(other for other in self.keys if key.name == other.name)


def read_keys(text):
    """The tree of keys, with the comments above each; a paragraph that stands alone is a key without a name."""
    root = Key('', '', [], -1)
    open_keys, comment = [root], []
    for line in text.splitlines()[1:]:
        hidden, key, remark = HIDDEN_KEY.match(line), KEY.match(line), COMMENT.match(line)
        if not line:
            if comment:
                root.keys.append(Key('', '', comment, 0))
            comment = []
        elif hidden and comment:
            add(open_keys, Key(hidden['key'], hidden['value'], comment, len(hidden['indent']), is_example=True))
            comment = []
        elif hidden and open_keys[-1].value.startswith('{'):  # what the keys of that mapping are
            above = open_keys[-1]
            above.keys.append(Key(hidden['key'], str(yaml.safe_load(above.value)[hidden['key']]), [hidden['value']], 0, is_example=True))
        elif remark:
            comment.append(remark['text'])
        elif key:
            level = len(key['indent']) + 2 * bool(key['item'])
            name = NAMES_OF_USERS.get(key['key'], key['key'])
            add(open_keys, Key(name, key['value'] or '', comment, level, bool(key['item'])))
            comment = []
        else:
            comment = []
    return root


def add(open_keys, key):
    while open_keys[-1].level >= key.level:
        open_keys.pop()
    open_keys.append(open_keys[-1].add(key))


def slug(path):
    return path.replace('[]', '').replace('.', '-').lower()


def is_list(key):
    return bool(key.keys) and key.keys[0].is_item


def unit_of(text):
    """The unit at the beginning, and the text without it; else those that the text names."""
    match = re.match(UNIT.pattern + r' ?', text)
    if match:
        return match[1], text[match.end():match.end() + 1].upper() + text[match.end() + 1:]
    return ', '.join(dict.fromkeys(UNIT.findall(text))), text


def default_of(key, comment):
    value = key.value.split('  #')[0].strip()
    told = DEFAULT.search(comment)
    if REQUIRED.search(comment):
        return f'required, such as `{value}`' if value else 'required'
    if told and len(told[1]) < LONGEST_DEFAULT:
        return with_code(told[1])
    if key.is_example or EXAMPLE.search(comment) or comment.startswith('As for'):
        return f'such as `{value}`' if value else ''
    return f'`{value}`' if value else ''


def meaning(lines):
    """The comment in one cell: indented lines begin anew."""
    text = ''
    for line in lines:
        if line.startswith('  {'):
            text += '<br>• ' + line.strip()
        elif not line.startswith('- {'):
            text += ' ' + line.strip()
    return text.strip()


def row(key, path):
    comment = meaning(key.comment)
    unit, text = unit_of(comment)
    name = f'`{key.name}`' if not key.keys else f'[`{key.name}`](#{heading_anchor(section_path(key, path))})'
    return [anchor(slug(path)) + name, default_of(key, comment), unit, with_code(text.replace('Required.', '').strip())]


def section_path(key, path):
    return path + '[]' * is_list(key)


def heading_anchor(path):
    """GitHub's."""
    return re.sub(r'[^\w-]', '', path.lower())


def section(key, path):
    """A table of the keys, then those of the keys that have some themselves."""
    text, rows = '', []

    def finished():
        return table(['key', 'default', 'unit', 'meaning, range'], rows) if rows else ''

    for inner in key.keys:
        if inner.name:
            rows.append(row(inner, f'{path}.{inner.name}'.lstrip('.')))
        else:
            text, rows = text + finished() + with_code(meaning(inner.comment)) + '\n\n', []
    text += finished()
    for inner in key.keys:
        if inner.keys:
            below = section_path(inner, f'{path}.{inner.name}'.lstrip('.'))
            text += f'## {below}\n\n{with_code(meaning(inner.comment))}\n\n' * bool(inner.name) + section(inner, below)
    return text


def page(template):
    title = generated('Scene', 'config/scene_template.yaml')
    first = template.partition('\n')[0].lstrip('# ')
    return title + f'{first} The same in one file: [scene_template.yaml](../../config/scene_template.yaml).\n\n' + section(read_keys(template), '')
