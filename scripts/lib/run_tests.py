#!/usr/bin/env python3
"""Runs every test program that CMake registered, and the fuzz targets, and counts their test cases.

Usage: run_tests.py WORKSPACE PACKAGE_DIRECTORY yes|no [REPORTS NAME...]    (yes|no: whether everything was built)

With NAMEs, those programs only, as they were compiled with sanitizers, which write to the directory REPORTS: with more time, and
each report is a failure more.

A program that could not be built, crashed, timed out, ended with an error or left no result counts as one failure more.
The last line is "N passed, M failed"; the exit status is 0 only if something passed and nothing failed.
"""
import ctypes
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from xml.etree import ElementTree

TIME_LIMIT = 300.0  # [s] for a program that registers none; rostest has its own, 60 s for each of its tests
FUZZ_SECONDS = 60  # for each target
FUZZ_TIME_LIMIT = 5400.0  # [s] to compile the simulation once more, with clang and its sanitizers, and to run
FUZZ_SEED = 1  # every run makes up the same inputs
SANITIZED = 6.0  # times as long with sanitizers
GRACE = 20.0  # [s] for a program that was interrupted to end its own children
PR_SET_CHILD_SUBREAPER = 36
BUILD_ERROR = re.compile(r'\berror:|CMake Error|No rule to make|undefined reference')


class Background:
    """A command that runs beside the tests, in time that they leave."""

    def __init__(self, command, log):
        with open(log, 'wb') as output:
            self.process = subprocess.Popen(['nice', '-n', '19', *command], stdout=output, stderr=subprocess.STDOUT,
                                            stdin=subprocess.DEVNULL, start_new_session=True)

    def end(self):
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGTERM)
        self.process.wait()


class Program:
    """A test program, as registered with add_test, and what came of it."""

    def __init__(self, name, command, time_limit=TIME_LIMIT):
        self.name = name
        self.command = command
        self.time_limit = time_limit
        self.passed = 0
        self.failures = []


def registered_programs(build):
    """What CMake registered, whether it was built or not."""
    listing = subprocess.run(['ctest', '--show-only=json-v1'], cwd=build, stdout=subprocess.PIPE)
    tests = json.loads(listing.stdout)['tests'] if listing.returncode == 0 else []
    programs = []
    for test in tests:
        properties = {p['name']: p['value'] for p in test.get('properties', [])}
        name = test['name'].replace('_ctest_verlet_cable_', '')
        programs.append(Program(name, test.get('command'), float(properties.get('TIMEOUT', TIME_LIMIT))))
    return programs


def remove_outdated_executables(workspace):
    """After a failed build: a program that no longer builds must not pass in the last version that did."""
    build = workspace / 'build'
    listing = subprocess.run(['make', 'help'], cwd=build, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    targets = {line[4:] for line in listing.stdout.splitlines() if line.startswith('... ')}
    for executable in (workspace / 'devel/lib/verlet_cable').glob('*'):
        if executable.name in targets:
            made = subprocess.run(['make', executable.name], cwd=build, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            if made.returncode != 0:
                executable.unlink()


def children(spared):
    """The process ids of this process's children but for those of `spared` groups."""
    found = []
    for stat in Path('/proc').glob('[0-9]*/stat'):
        try:
            _, parent, group, *_ = stat.read_text().rpartition(')')[2].split()
        except OSError:
            continue  # it ended meanwhile
        if int(parent) == os.getpid() and int(group) not in spared:
            found.append(int(stat.parent.name))
    return found


def end_orphans(spared):
    """Ends what a program that is gone left running: its orphans become children of this process. `spared`: groups of processes that
    run beside it."""
    while children(spared):
        for child in children(spared):
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)


def execute(program, log, spared):
    """Runs a program to its end or its time limit; returns what was wrong with that, or None."""
    process = subprocess.Popen(program.command, stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                               start_new_session=True)
    try:
        status = process.wait(program.time_limit)
        return None if status == 0 else f'ended with exit status {status}'
    except subprocess.TimeoutExpired:
        return f'did not end within {program.time_limit:g} s'
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGINT)
            deadline = time.monotonic() + GRACE
            while time.monotonic() < deadline and group_runs(process):
                time.sleep(0.1)
            if process.poll() is None:
                process.kill()
                process.wait()
        end_orphans(spared)


def group_runs(process):
    process.poll()
    try:
        os.killpg(process.pid, 0)
        return True
    except ProcessLookupError:
        return False


def read_results(program, results):
    """Counts the cases in the result files. rostest's own file repeats, once a test node, only that the node ran."""
    for path in sorted(results.rglob('*.xml')):
        if path.name.startswith('MISSING-'):
            program.failures.append('left no result: it was not built, did not start or crashed')
            continue
        try:
            cases = list(ElementTree.parse(path).iter('testcase'))
        except ElementTree.ParseError as error:
            program.failures.append(f'{path.name} is no result file: {error}')
            continue
        for case in cases:
            problem = next((case.find(tag) for tag in ('failure', 'error') if case.find(tag) is not None), None)
            if problem is not None:
                message = ' '.join((problem.get('message') or '').split())[:200]
                # Of a Python traceback the end says what was wrong.
                message = message or ' '.join((problem.text or '').split())[-300:]
                program.failures.append(f'{case.get("classname")}.{case.get("name")}: {message}')
            elif not (path.name.startswith('rostest-') or case.get('status') == 'notrun' or case.find('skipped') is not None):
                program.passed += 1


def read_reports(program, reports):
    """What sanitizers wrote while the program ran, whichever of its processes; moved to where the next program has no such."""
    for report in sorted(reports.glob('report.*')):
        lines = report.read_text(errors='replace').splitlines()
        what = next((line for line in lines if 'SUMMARY' in line or 'runtime error' in line), 'a report of a sanitizer')
        seen = report.rename(reports / f'{program.name}{report.suffix}')
        program.failures.append(f'{what.strip()[:300]} (see {seen})')


def run(program, results, log_directory, reports=None, spared=()):
    shutil.rmtree(results, ignore_errors=True)
    results.mkdir(parents=True)
    log_path = log_directory / f'{program.name}.log'
    start = time.monotonic()
    print(f'      {program.name} ...', end='\r' if sys.stdout.isatty() else '\n', flush=True)
    if program.command is None:
        problem = 'was not built'
    else:
        with open(log_path, 'wb') as log:
            problem = execute(program, log, spared)
        read_results(program, results)
        if reports:
            read_reports(program, reports)
    if not program.failures:
        if problem:
            program.failures.append(problem)
        elif program.passed == 0:
            program.failures.append('ran no test case')
    verdict = 'FAIL' if program.failures else 'ok  '
    print(f'{verdict}  {program.name}: {program.passed} passed, {len(program.failures)} failed '
          f'({time.monotonic() - start:.1f} s)')
    for failure in program.failures:
        print(f'FAIL  {program.name}: {failure}')
    if program.failures and log_path.exists():
        for line in log_path.read_text(errors='replace').splitlines()[-60:]:
            print('    | ' + line)
    sys.stdout.flush()


def check_package(package):
    """catkin_lint as a test case of its own, where it is installed."""
    lint = Program('catkin_lint', [])
    checked = subprocess.run(['catkin_lint', '--offline', '-q', '--strict', str(package)],
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(checked.stdout, end='')
    if checked.returncode == 0:
        lint.passed = 1
    else:
        lint.failures.append('found errors or warnings')
    print(f'{"ok  " if lint.passed else "FAIL"}  catkin_lint')
    return lint


def build_fuzz_targets(package, log_directory):
    """Most programs use one core, or wait for nodes: the time that they leave is enough to compile the simulation once more."""
    return Background([str(package / 'scripts/fuzz'), '--build'], log_directory / 'fuzz_build.log')


def fuzz_program(package, results):
    """What makes up inputs, see doc/fuzzing.md. What of it is not built yet, it builds."""
    return Program('fuzz', [str(package / 'scripts/fuzz'), '--seconds', str(FUZZ_SECONDS), '--seed', str(FUZZ_SEED),
                            '--results', str(results / 'fuzz.xml')], FUZZ_TIME_LIMIT)


def main():
    workspace, package, built = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3] == 'yes'
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)
    for ending in (signal.SIGINT, signal.SIGTERM):
        signal.signal(ending, signal.default_int_handler)
    log_directory = workspace / 'test_logs'
    shutil.rmtree(log_directory, ignore_errors=True)
    log_directory.mkdir(parents=True)
    os.environ['ROS_HOME'] = str(log_directory / 'ros')
    os.environ.pop('ROS_LOG_DIR', None)

    build = Program('build', [])
    if not built:
        log = (workspace / 'build.log').read_text(errors='replace').splitlines()
        errors = [line for line in dict.fromkeys(log) if BUILD_ERROR.search(line)]
        build.failures.append('\n    | '.join(['see ' + str(workspace / 'build.log')] + errors[:20]))
        remove_outdated_executables(workspace)
    programs = registered_programs(workspace / 'build')
    reports, names = (Path(sys.argv[4]), sys.argv[5:]) if len(sys.argv) > 4 else (None, [])
    if names:
        known = {program.name: program for program in programs}
        programs = [known.get(name, Program(name, None)) for name in names]
        for program in programs:
            program.time_limit *= SANITIZED
    if not programs:
        build.failures.append('no test is registered')
    results = workspace / 'build/test_results'
    if not names:
        programs.append(fuzz_program(package, results))
    print(f'\nRunning {len(programs)} test programs; their output is in {log_directory}')
    finished = [build]
    fuzz_build = None if names else build_fuzz_targets(package, log_directory)
    spared = [fuzz_build.process.pid] if fuzz_build else []
    try:
        if not names and shutil.which('catkin_lint'):
            finished.append(check_package(package))
        for program in programs:
            finished.append(program)
            if program.name == 'fuzz':
                fuzz_build.process.wait()
            run(program, results, log_directory, reports, spared)
    except KeyboardInterrupt:
        finished[-1].failures.append('interrupted')
    finally:
        if fuzz_build:
            fuzz_build.end()
    print()
    for program in finished:
        for failure in program.failures:
            print(f'FAIL  {program.name}: {failure}')
    passed = sum(program.passed for program in finished)
    failed = sum(len(program.failures) for program in finished)
    print(f'{passed} passed, {failed} failed')
    return 0 if passed and not failed else 1


if __name__ == '__main__':
    sys.exit(main())
