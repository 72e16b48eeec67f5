"""The page of limits has the numbers of the code."""
import re
from pathlib import Path

import pytest

DOC = Path(__file__).resolve().parents[2] / 'doc'
ROW = re.compile(r'^\|(.*)\|(.*)\|.*\| \[`(\w+)`\]\((.*)\) \|$')
ROWS = [match.groups() for match in map(ROW.match, (DOC / 'limits.md').read_text(encoding='utf-8').splitlines()) if match]


def value_of(name, code):
    """What a constant of C++ or Python is; None where the name is no number."""
    match = re.search(rf"\b{name}\s*=\s*([^;#\n]+)", code)
    text = match and re.sub(r"std::\w+\{(\d+)\}|(?<=\d)[uU]", r'\1', match.group(1).replace("'", '')).strip()
    return float(eval(text, {'__builtins__': {}})) if text and re.fullmatch(r'[\d\s<*+.e_]+', text) else None


@pytest.mark.parametrize('what, limit, name, file', ROWS, ids=[row[0].strip() for row in ROWS])
def test_numbers_are_those_of_the_code(what, limit, name, file):
    code = (DOC / file).read_text(encoding='utf-8')
    assert name in code
    value = value_of(name, code)
    if value is None:
        assert name in ('limits_fields', 'check_memory', 'check_sections', 'room_around', 'segments_range')
    else:
        assert value == float(limit.split()[0]), (what, value)


def test_the_page_has_rows():
    assert len(ROWS) > 20
