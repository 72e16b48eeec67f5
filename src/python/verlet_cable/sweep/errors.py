"""What ends a sweep before or while it runs, in words for the user."""

from ..wrong_arguments import meant

_LONGEST_KEY = 300


class SweepError(Exception):
    """What the user gave cannot be used. `errors`: one text each, all that were found."""

    def __init__(self, errors):
        super().__init__('\n'.join(errors))
        self.errors = list(errors)


class SweepStopped(Exception):
    """The sweep had to stop; what was done until then is in the store."""


def rejected(key, value, allowed):
    """The package's one form of an error: the full key, the value that was given, what is allowed."""
    if len(key) > _LONGEST_KEY:
        key = key[:_LONGEST_KEY - 3] + '...'
    return f'{key}: {value}; allowed: {allowed}'


def unknown_key(key, value, names):
    """An error as scenes have it. `key`: in full; `value`: as it is shown; `names`: those that there are."""
    return rejected(key, f'unknown key, its value is {value}' + meant(key.rpartition('.')[2], names), ', '.join(names))


def missing_package(error):
    """A SweepError for an ImportError of what only sweeps need."""
    return SweepError([f'{error}; needed: Debian\'s packages python3-dask python3-distributed python3-zarr'])
