"""Says how many lines the inputs of each fuzz target reach, of the sources that the target is for, as a table in Markdown."""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import run_fuzz

# What each target is for, in src/.
SUBJECTS = {
    'mesh': ['mesh_reader'],
    'motion': ['scene/motion.cpp', 'scene/motion_reader.cpp', 'scene/csv_lines.cpp'],
    'recording': ['tools/cable_fit/recording.cpp', 'tools/cable_fit/recording_reader.cpp'],
    'robot': ['scene/robot_model.cpp', 'scene/xml_outline.cpp'],
    'scene': ['scene', 'core'],
    'world': ['core'],
    'world_file': ['scene/world_file.cpp', 'core/world/state_bytes.cpp', 'python/simulation/driven_world.cpp'],
}


def tool(name):
    """An LLVM tool of the compiler's version: others do not read what it writes."""
    return subprocess.run(['clang', f'--print-prog-name={name}'], stdout=subprocess.PIPE, text=True, check=True).stdout.strip()


def run_inputs(program, corpus, most_bytes, directory):
    """Leaves a profile in `directory`; each of the program's libraries has a file of its own."""
    environment = dict(os.environ, LLVM_PROFILE_FILE=f'{directory}/%m.profraw')
    log = directory / 'log'
    command = [str(program), '-runs=0', f'-max_len={most_bytes}', f'-artifact_prefix={directory}/', str(corpus)]
    with open(log, 'wb') as output:
        status = subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
                                check=False).returncode
    if status != 0:
        sys.exit(f'{program.name} ended with {status}:\n{log.read_text(errors="replace")[-2000:]}')


def covered_files(target, arguments):
    """llvm-cov's summaries of files, after all inputs of a target. Also writes a report that shows the lines."""
    programs = arguments.workspace / 'devel' / 'lib'
    program, corpus = programs / 'verlet_cable' / f'fuzz_{target}', arguments.runs / 'corpus' / target
    run_fuzz.fill_corpus(target, arguments.checkout, corpus)
    profile = arguments.workspace / f'{target}.profdata'
    with tempfile.TemporaryDirectory(dir=arguments.workspace) as directory:
        run_inputs(program, corpus, run_fuzz.most_bytes(target), pathlib.Path(directory))
        profiles = map(str, pathlib.Path(directory).glob('*.profraw'))
        subprocess.run([tool('llvm-profdata'), 'merge', '-o', str(profile), *profiles], check=True)
    libraries = [f'-object={library}' for library in sorted(programs.glob('libverlet_cable_*.so'))]
    covered = [f'-instr-profile={profile}', str(program), *libraries]
    report = arguments.workspace / 'report' / target
    only_sources = '-ignore-filename-regex=/fuzz/|^/usr/'
    subprocess.run([tool('llvm-cov'), 'show', '-format=html', f'-output-dir={report}', only_sources, *covered], check=True)
    exported = subprocess.run([tool('llvm-cov'), 'export', '-summary-only', *covered], stdout=subprocess.PIPE, check=True)
    return json.loads(exported.stdout)['data'][0]['files']


def lines(files, subject):
    """(reached, all) of the sources at or below a path in src/."""
    inside = [file['summary']['lines'] for file in files if f'/src/{subject}{"" if "." in subject else "/"}' in file['filename']]
    return sum(summary['covered'] for summary in inside), sum(summary['count'] for summary in inside)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--workspace', type=pathlib.Path, required=True, help='of the programs that count lines')
    parser.add_argument('--checkout', type=pathlib.Path, required=True)
    parser.add_argument('--runs', type=pathlib.Path, required=True, help='workspace of the runs whose inputs these are')
    parser.add_argument('targets', nargs='+')
    arguments = parser.parse_args()
    print('| target | executions | of the sources in `src/` | lines reached | % |\n|---|---:|---|---:|---:|')
    for target in arguments.targets:
        files = covered_files(target, arguments)
        executions, _ = run_fuzz.totals(arguments.runs / 'executions.csv', target)
        for subject in SUBJECTS[target]:
            reached, count = lines(files, subject)
            percent = 100 * reached / max(count, 1)
            print(f'| `{target}` | {executions:,} | `{subject}` | {reached:,} of {count:,} | {percent:.0f} |', flush=True)


if __name__ == '__main__':
    main()
