"""Python's docstrings are plain text: backticks and indented lines are code, `name: text` lines are items, and signatures are those of
the type stubs, where pybind11's would name types of its own."""
import ast
import re
from pathlib import Path

STUBS = Path(__file__).resolve().parents[2] / 'src/python/verlet_cable/_simulation.pyi'
OVERLOAD = re.compile(r'^\d+\. __init__\(')
ALIAS = re.compile(r'\b_(Path|Motion|Status)\b')
ARGUMENT = re.compile(r'^[a-z_]+(?:, [a-z_]+)*(?: \(.*?\)| \[.*?\])?: ')


def signatures():
    """What stands in brackets, by qualified name; of an overloaded function a list of it."""
    found = {}
    for owner in ast.parse(STUBS.read_text(encoding='utf-8')).body:
        for function in getattr(owner, 'body', []):
            if isinstance(function, ast.FunctionDef):
                arguments = function.args
                arguments.args = [argument for argument in arguments.args if argument.arg != 'self']
                parts = f'({ast.unparse(arguments)})', ast.unparse(function.returns)
                found.setdefault(f'{owner.name}.{function.name}', []).append([ALIAS.sub(r'\1', part) for part in parts])
    return found


SIGNATURES = signatures()


def of_stubs(app, what, name, obj, options, signature, returned):
    key = '.'.join(name.split('.')[-2:] if what == 'method' else [name.split('.')[-1], '__init__'])
    if key not in SIGNATURES:
        return None
    if len(SIGNATURES[key]) > 1:
        return '(...)', ''
    arguments, result = SIGNATURES[key][0]
    return arguments, '' if result == 'None' else result


def as_text(app, what, name, obj, options, lines):
    overloads = iter(SIGNATURES.get(f'{name.split(".")[-1]}.__init__', []))
    text = []
    for line in lines:
        if OVERLOAD.match(line):
            line = f'``{name.split(".")[-1]}{next(overloads)[0]}``'
        elif line in ('Overloaded function.', '__init__(*args, **kwargs)') or re.match(r'__\w+__\(self: ', line):
            continue
        elif line.startswith('    '):
            last = next((above for above in reversed(text) if above), '')
            text += ['.. code-block:: python' if ' import ' in line else '::', ''] * (not last.startswith('    '))
        elif ARGUMENT.match(line):
            text += [''] * (not text or not text[-1].startswith('* '))
            line = '* ' + line
        elif text and text[-1].startswith('* ') and line:
            text.append('')
        text.append(line if line.startswith('    ') else re.sub(r'(?<!`)`([^`]+)`(?!`)', r'``\1``', line))
    lines[:] = text


def setup(app):
    app.connect('autodoc-process-signature', of_stubs)
    app.connect('autodoc-process-docstring', as_text)
    return {'version': '1', 'parallel_read_safe': True, 'parallel_write_safe': True}
