#!/usr/bin/env python3
"""check_manual.py PAGES LIST: whether every link and anchor of the manual leads somewhere, and no page loads anything from the network.
Prints what is wrong; lists the links to other places in LIST, without following them."""
import os
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# Attributes by which a page loads something, by element; other elements' are links.
LOADED = {'img': 'src', 'script': 'src', 'link': 'href', 'source': 'src', 'video': 'src', 'iframe': 'src', 'object': 'data'}


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.loaded = set(), [], []
        self.feed(path.read_text(encoding='utf-8'))

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.anchors.update(attributes[key] for key in ('id', 'name') if attributes.get(key))
        if tag == 'a' and attributes.get('href'):
            self.links.append(attributes['href'])
        if attributes.get(LOADED.get(tag)):
            self.loaded.append(attributes[LOADED[tag]])


def is_elsewhere(link):
    parts = urlsplit(link)
    return bool(parts.scheme or parts.netloc) and parts.scheme != 'data'


def error_of(link, path, pages):
    """Why a link within the manual is broken, or None."""
    parts = urlsplit(link)
    if parts.scheme == 'data':
        return None
    target = Path(os.path.normpath(path.parent / unquote(parts.path))) if parts.path else path
    if not target.is_file():
        return 'no such file'
    if parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].anchors:
        return 'no such anchor'
    return None


def main():
    directory, listed = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    pages = {path: Page(path) for path in sorted(directory.rglob('*.html'))}
    errors, elsewhere = [], {}
    for path, page in pages.items():
        name = path.relative_to(directory)
        errors += [f'{name}: {link}: loaded from the network' for link in page.loaded if is_elsewhere(link)]
        for link in page.links + page.loaded:
            if is_elsewhere(link):
                elsewhere.setdefault(link, str(name))
            elif error_of(link, path, pages):
                errors.append(f'{name}: {link}: {error_of(link, path, pages)}')
    listed.write_text(''.join(f'{link}  {page}\n' for link, page in sorted(elsewhere.items())), encoding='utf-8')
    for error in sorted(set(errors)):
        print(error, file=sys.stderr)
    links = sum(len(page.links) + len(page.loaded) for page in pages.values())
    print(f'{len(pages)} pages, {links} links, {len(set(errors))} broken; {len(elsewhere)} to other places are listed in {listed}')
    return 1 if errors else 0


if __name__ == '__main__':
    sys.exit(main())
