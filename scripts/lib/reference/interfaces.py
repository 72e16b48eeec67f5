"""doc/reference/messages.md and services.md from the files of msg, srv and action."""
import re
from dataclasses import dataclass

from reference.markdown import anchor, generated, table, with_code

FIELD = re.compile(r'^(?P<type>[\w/]+(?:\[\d*\])?)\s+(?P<name>\w+)\s*(?:=\s*(?P<value>[^#\s]+))?\s*(?:#\s*(?P<comment>.*))?$')


@dataclass
class Field:
    type: str
    name: str
    value: str
    comment: str


def read_interface(text):
    """What a file says of itself, then the fields of its parts."""
    description, parts = [], [[]]
    for line in text.splitlines():
        if line.startswith('#'):
            description.append(line.lstrip('# '))
        elif line.strip() == '---':
            parts.append([])
        elif line.strip():
            match = FIELD.match(line)
            parts[-1].append(Field(match['type'], match['name'], match['value'] or '', match['comment'] or ''))
    return ' '.join(description), parts


def type_link(name, messages):
    """A type of this package leads to its fields."""
    base = name.partition('[')[0]
    return f'[`{name}`](messages.md#{base.lower()})' if base in messages else f'`{name}`'


def fields_table(fields, messages, owner):
    constants = [[anchor(f'{owner}-{field.name}'.lower()) + f'`{field.name}`', f'`{field.value}`', with_code(field.comment)] for field in fields if field.value]
    rows = [[anchor(f'{owner}-{field.name}'.lower()) + f'`{field.name}`', type_link(field.type, messages), with_code(field.comment)] for field in fields if not field.value]
    if not fields:
        return 'No fields.\n\n'
    text = table(['constant', 'value', 'meaning'], constants) if constants else ''
    return text + (table(['field', 'type', 'unit, meaning'], rows) if rows else '')


def sections(directory, suffix, names, messages):
    text = ''
    for path in sorted(directory.glob(f'*.{suffix}')):
        description, parts = read_interface(path.read_text(encoding='utf-8'))
        text += f'## {path.stem}\n\n' + (with_code(description) + '\n\n' if description else '')
        text += f'[{path.name}](../../{directory.name}/{path.name})\n\n'
        for name, fields in zip(names, parts):
            text += f'{name}:\n\n' * bool(name) + fields_table(fields, messages, f'{path.stem}-{name}'.rstrip('-'))
    return text


def message_names(checkout):
    return {path.stem for path in (checkout / 'msg').glob('*.msg')}


def messages_page(checkout):
    return (generated('Messages', 'msg') + 'SI units; poses and points are in the fixed frame of the message.\n\n'
            + sections(checkout / 'msg', 'msg', [''], message_names(checkout)))


def services_page(checkout):
    messages = message_names(checkout)
    return (generated('Services and actions', 'srv and action')
            + 'A refused call changes nothing, has `success: false`, and says why in `message`.\n\n'
            + sections(checkout / 'srv', 'srv', ['Request', 'Response'], messages)
            + sections(checkout / 'action', 'action', ['Goal', 'Result', 'Feedback'], messages))
