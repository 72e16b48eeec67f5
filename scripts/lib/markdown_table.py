"""Tables of Markdown."""


def table(header, rows):
    """Lines."""
    return ['| ' + ' | '.join(cells) + ' |' for cells in (header, ['---'] * len(header), *rows)]
