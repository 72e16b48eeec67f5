"""Runs fuzz targets, as many at once as there are cores, and says what each found."""
import argparse
import concurrent.futures
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

# On a machine that does much else, too: an input that takes so long is a finding.
LONGEST_INPUT_SECONDS = 600
MEMORY_MB = 4096
MOST_BYTES = 20000
# Of files whose lines are all alike: some of them are enough, and are read several times as often.
MOST_BYTES_OF_LINES = 4000
# Of worlds and saved worlds, whose inputs have no format: enough for some tens of calls.
WORLD_SEEDS = 20
WORLD_SEED_BYTES = 600
# How often a place is reached says little of a simulation: inputs with more iterations would pile up. To weigh inputs by all that
# they reach takes libFuzzer a third of the time here.
WORLD_OPTIONS = ['-use_counters=0', '-entropic=0']
# What libFuzzer and the sanitizers say of a finding, and the frames of its stack that are in this package.
REASON = re.compile(r'^not so: |ERROR: |runtime error: |^SUMMARY: ')
OWN_FRAME = re.compile(r'^\s*#\d+ .* in (?P<function>.*) \S*/(?P<place>(?:src|fuzz)/\S+)$')
MOST_LINES = 20
FIGURE = re.compile(r'^stat::number_of_executed_units:\s*(\d+)', re.MULTILINE)
COVERAGE = re.compile(r'cov: (\d+)')


def seeds(target, checkout):
    """Files that a target's first inputs are."""
    config = checkout / 'config'
    if target == 'scene':
        return sorted(config.rglob('*.yaml')) + sorted((checkout / 'fuzz' / 'worlds').glob('*.yaml'))
    if target == 'motion':
        return sorted(config.rglob('*.csv'))
    if target == 'recording':
        return sorted((config / 'recordings').glob('*.csv'))
    if target == 'robot':
        return sorted(config.rglob('*.urdf'))
    return []


def most_bytes(target):
    return MOST_BYTES_OF_LINES if target in ('motion', 'recording') else MOST_BYTES


def shorter(content, most):
    """Whole lines of long files: what is large is slow, and no other code."""
    return content if len(content) <= most else content[:content.rfind(b'\n', 0, most) + 1]


def fill_corpus(target, checkout, corpus):
    """With a target's first inputs, and with those of earlier findings."""
    corpus.mkdir(parents=True, exist_ok=True)
    for path in seeds(target, checkout):
        (corpus / ('seed_' + path.name)).write_bytes(shorter(path.read_bytes(), most_bytes(target)))
    if target in ('world', 'world_file'):
        for seed in range(WORLD_SEEDS):
            content = random.Random(seed).getrandbits(8 * WORLD_SEED_BYTES)
            (corpus / f'seed_{seed}').write_bytes(content.to_bytes(WORLD_SEED_BYTES, 'big'))
    kept = checkout / 'fuzz' / 'inputs' / target
    for path in sorted(kept.glob('*')) if kept.is_dir() else []:
        shutil.copy(path, corpus / ('kept_' + path.name))


def run(target, corpus, arguments):
    """(executions, covered edges, paths of what was found)"""
    workspace, checkout = arguments.workspace, arguments.checkout
    findings = workspace / 'findings' / target
    fill_corpus(target, checkout, corpus)
    findings.mkdir(parents=True, exist_ok=True)
    before = set(findings.iterdir())
    program = workspace / 'devel' / 'lib' / 'verlet_cable' / f'fuzz_{target}'
    options = [f'-max_total_time={arguments.seconds}', f'-timeout={LONGEST_INPUT_SECONDS}',
               f'-report_slow_units={LONGEST_INPUT_SECONDS}', f'-rss_limit_mb={MEMORY_MB}', f'-max_len={most_bytes(target)}',
               f'-seed={arguments.seed or 0}', '-print_final_stats=1', f'-artifact_prefix={findings}/']
    if target == 'world':
        options += WORLD_OPTIONS
    dictionary = checkout / 'fuzz' / 'dictionaries' / f'{target}.dict'
    if dictionary.exists():
        options.append(f'-dict={dictionary}')
    environment = dict(os.environ, ASAN_OPTIONS='allocator_may_return_null=1', UBSAN_OPTIONS='print_stacktrace=1',
                       LSAN_OPTIONS=f"suppressions={checkout / 'fuzz' / 'leaks_of_libraries.txt'}:print_suppressions=0")
    log = workspace / f'fuzz_{target}.log'
    with open(log, 'wb') as output:
        status = subprocess.run([str(program), *options, str(corpus)], stdout=output, stderr=subprocess.STDOUT,
                                stdin=subprocess.DEVNULL, env=environment, check=False).returncode
    text = log.read_text(errors='replace')
    found = sorted(set(findings.iterdir()) - before)
    if status != 0 and not found:
        found = [log]
    executed, covered = FIGURE.search(text), COVERAGE.findall(text)
    return int(executed.group(1)) if executed else 0, int(covered[-1]) if covered else 0, found


def reasons(log):
    """What a run's log says of what was found, a line each: the input is seldom at hand where the message is read."""
    lines = []
    for line in log.read_text(errors='replace').splitlines():
        frame = OWN_FRAME.match(line)
        if frame and 'eigen3' not in line:
            lines.append(f'  {frame["function"][:100]} {frame["place"]}')
        elif REASON.search(line):
            lines.append(line)
    return lines[:MOST_LINES]


def count_run(path, target, executions, seconds):
    with open(path, 'a', encoding='utf-8') as file:
        print(target, executions, round(seconds), sep=',', file=file)


def totals(path, target):
    """(executions, hours) of all runs of a target; `path` has a line for each."""
    runs = [line.split(',') for line in path.read_text(encoding='utf-8').split()] if path.exists() else []
    own = [(int(executed), int(duration)) for name, executed, duration in runs if name == target]
    return sum(executed for executed, _ in own), sum(duration for _, duration in own) / 3600


def run_all(corpora, arguments):
    """{target: text of what was wrong}"""
    failures = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = {target: pool.submit(run, target, corpora / target, arguments) for target in arguments.targets}
        for target, result in runs.items():
            executions, edges, found = result.result()
            counts = arguments.workspace / 'executions.csv'
            count_run(counts, target, executions, arguments.seconds)
            total, hours = totals(counts, target)
            text = ', '.join(map(str, found)) if found else 'nothing'
            if found or executions == 0:
                failures[target] = f'{executions} executions, found: {text}'
                print(*reasons(arguments.workspace / f'fuzz_{target}.log'), sep='\n')
            print(f'{target}: {executions} executions, {edges} edges covered, found: {text}; with earlier runs {total} executions '
                  f'in {hours:.2f} h', flush=True)
    return failures


def write_results(path, failures, targets):
    """`failures`: text by target."""
    suite = ElementTree.Element('testsuite', name='fuzz', tests=str(len(targets)), failures=str(len(failures)))
    for target in targets:
        case = ElementTree.SubElement(suite, 'testcase', classname='fuzz', name=target)
        if target in failures:
            ElementTree.SubElement(case, 'failure', message=failures[target])
    path.parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(suite).write(path, encoding='utf-8', xml_declaration=True)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--workspace', type=pathlib.Path, required=True)
    parser.add_argument('--checkout', type=pathlib.Path, required=True)
    parser.add_argument('--seconds', type=int, required=True, help='how long each target runs')
    parser.add_argument('--seed', type=int, help='begin with no inputs of earlier runs, and make up the same ones each time')
    parser.add_argument('--results', type=pathlib.Path, help='JUnit file to write')
    parser.add_argument('targets', nargs='+')
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    if arguments.seed is None:
        failures = run_all(arguments.workspace / 'corpus', arguments)
    else:
        with tempfile.TemporaryDirectory(dir=arguments.workspace) as corpora:
            failures = run_all(pathlib.Path(corpora), arguments)
    if arguments.results:
        write_results(arguments.results, failures, arguments.targets)
    sys.exit(1 if failures else 0)


if __name__ == '__main__':
    main()
