"""The command lines that pip installs: programs beside this file."""
import os
import pathlib
import sys


def cable_sim() -> None:
    """Runs the program cable_sim in place of this one, with its arguments."""
    _become('cable_sim')


def cable_fit() -> None:
    """Runs the program cable_fit in place of this one, with its arguments."""
    _become('cable_fit')


def _become(name: str) -> None:
    program = pathlib.Path(__file__).absolute().parent / name  # of an editable install this file is a link
    os.execv(program, [name, *sys.argv[1:]])
