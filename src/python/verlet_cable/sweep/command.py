"""cable_sweep SWEEP.yaml --output DIR [--workers N | --scheduler tcp://HOST:PORT] [--resume]"""
import argparse
import contextlib
import os
import signal
import sys

from .errors import SweepError, SweepStopped

_BAD_INPUT, _STOPPED = 2, 3
_MOST_ERRORS = 100  # that are printed


def main(arguments=None):
    """The exit status: 0 when every sample is in the store, also those that failed; 2 for bad input; 3 when it had to stop."""
    options = _options(arguments)
    try:
        return _sweep(options)
    except SweepError as error:
        for text in error.errors[:_MOST_ERRORS]:
            print(f'cable_sweep: {text}', file=sys.stderr)
        if len(error.errors) > _MOST_ERRORS:
            print(f'cable_sweep: and {len(error.errors) - _MOST_ERRORS} more errors', file=sys.stderr)
        return _BAD_INPUT


def _options(arguments):
    parser = argparse.ArgumentParser(
        prog='cable_sweep', description='Simulates many variations of a scene with Dask and writes them to one Zarr store.',
        epilog='Exit status: 0 when every sample is in the store, 2 for bad input, 3 when the sweep had to stop: --resume continues.')
    parser.add_argument('sweep', metavar='SWEEP.yaml', help='what to simulate: doc/sweeps.md')
    parser.add_argument('--output', metavar='DIR', required=True, type=_output, help='the store; must not exist, except with --resume')
    where = parser.add_mutually_exclusive_group()
    # No default here: argparse takes a value that is the default for none.
    cores = len(os.sched_getaffinity(0))
    where.add_argument('--workers', metavar='N', type=_workers, help='processes on this machine (default: one per core)')
    where.add_argument('--scheduler', metavar='tcp://HOST:PORT', help='a running dask-scheduler, whose workers are used')
    parser.add_argument('--resume', action='store_true', help='continue with an unfinished store, or create it')
    options = parser.parse_args(arguments)
    options.workers = options.workers or cores
    return options


def _output(text):
    if not text.strip():
        raise argparse.ArgumentTypeError(f'{text!r}; allowed: the name of a directory')
    return text


def _workers(text):
    if not text.isdigit() or not 1 <= int(text) <= 4096:
        raise argparse.ArgumentTypeError(f'{text}; allowed: an integer from 1 to 4096')
    return int(text)


def _sweep(options):
    from . import store, trial
    from .description import read_sweep
    from .layout import plan_layout
    path = os.path.abspath(options.output)
    errors = []
    if os.path.lexists(path) and not options.resume:
        errors.append(f'--output: {options.output}: is there; allowed: a new one, or --resume to go on with it')
    try:
        sweep, scene = read_sweep(options.sweep)
    except SweepError as error:
        raise SweepError(errors + error.errors) from error
    if errors:
        raise SweepError(errors)
    layout = plan_layout(sweep, scene)
    if os.path.lexists(path):
        store.check_same(path, sweep, layout)
    for text in trial.notes(sweep, scene):
        print(f'cable_sweep: note: {text}', file=sys.stderr)
    return _run(options, path, sweep, layout)


def _run(options, path, sweep, layout):
    from . import schedule, store
    from .report import Report
    signal.signal(signal.SIGTERM, _interrupt)
    report = Report(layout)
    reason = None
    try:
        is_begun = os.path.lexists(path)
        damaged = store.damaged_chunks(path) if is_begun else []
        if damaged or store.count_samples(path, layout) < layout.samples:
            with contextlib.ExitStack() as stack:
                if is_begun:
                    stack.enter_context(store.locked(path))
                    if damaged:
                        report.line(f'{options.output}: files of {len(damaged)} chunks are not there or not whole: simulated again')
                    store.forget(path, damaged)
                client = stack.enter_context(schedule.cluster(options.workers, options.scheduler))
                if not is_begun:
                    store.begin(path, sweep, layout)
                    stack.enter_context(store.locked(path))
                _do_the_rest(client, path, sweep, layout, report)
    except SweepStopped as stopped:
        reason = str(stopped)
    except KeyboardInterrupt:
        reason = 'interrupted'
    report.clear()
    if reason is not None:
        print(f'cable_sweep: {reason}\n{store.count_samples(path, layout)} of {layout.samples} samples are in {options.output}; '
              '--resume goes on with the others', file=sys.stderr)
        return _STOPPED
    failures = store.count_failures(path)
    print(f'{layout.samples} samples in {options.output}, {report.new} simulated now in {report.seconds:.1f} s; '
          f'failed: {failures[store.WRONG_SCENE]} scenes, {failures[store.FAULT]} simulations')
    return 0


def _do_the_rest(client, path, sweep, layout, report):
    from . import schedule, store
    complete = store.complete_chunks(path)
    report.begin(store.count_samples(path, layout))
    store.remove_remains(path)
    try:
        schedule.run_chunks(client, (path, sweep.folder, store.identity(path)),
                            (chunk for chunk in range(layout.chunks) if chunk not in complete), layout.chunks - len(complete), report)
    finally:
        store.remove_remains(path)


def _interrupt(number, frame):
    raise KeyboardInterrupt
