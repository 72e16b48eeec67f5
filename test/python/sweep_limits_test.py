"""Descriptions of sweeps that ask for more than anybody has: refused by name, before anything is simulated."""
import os

import pytest

pytest.importorskip('distributed')
from verlet_cable.sweep import command, text_yaml  # noqa: E402
from verlet_cable.sweep.description import read_sweep  # noqa: E402
from verlet_cable.sweep.errors import SweepError  # noqa: E402
from verlet_cable.sweep.layout import plan_layout  # noqa: E402

SCENE = 'time_step: 0.001\nparticles: [{name: ball, mass: 1, position: [0, 0, 0]}]\n'
SWEEP = """
scene: scene.yaml
duration: 1.0
record: {rate: 50, fields: [positions]}
samples: 2
vary:
  particles[0].mass: {uniform: [1, 2]}
"""


def read(folder, text=SWEEP, scene=SCENE):
    (folder / 'scene.yaml').write_text(scene)
    (folder / 'sweep.yaml').write_text(text)
    return read_sweep(str(folder / 'sweep.yaml'))


def refusal(folder, *texts):
    with pytest.raises(SweepError) as refused:
        read(folder, *texts)
    assert all(len(error) < 1000 for error in refused.value.errors)
    return '\n'.join(refused.value.errors)


def laughs(item):
    return f'a0: &a0 [{item}]\n' + ''.join(f'a{i}: &a{i} [{", ".join([f"*a{i - 1}"] * 10)}]\n' for i in range(1, 13))


def test_a_sound_sweep_is_read(tmp_path):
    assert read(tmp_path)[0].samples == 2


def test_aliases_that_multiply_are_refused(tmp_path):
    assert 'sweep.yaml: more than 1000000 values; allowed: less' in refusal(tmp_path, laughs('x') + SWEEP)
    assert 'scene.yaml: line 7, column 25: more than 1000000 values' in refusal(tmp_path, SWEEP, laughs('x') + SCENE)


def test_what_contains_itself_or_is_nested_deeply_is_refused(tmp_path):
    assert 'sweep.yaml: nested deeper than 32 levels; allowed: less' in refusal(tmp_path, SWEEP + 'a: &a [*a]\n')
    assert 'nested deeper than 32 levels' in refusal(tmp_path, SWEEP + f'a: {"[" * 100}{"]" * 100}\n')
    assert 'not YAML' in refusal(tmp_path, SWEEP + 'a: ' + '[' * 100_000)


def test_pyyaml_is_given_no_large_scene_that_was_refused(tmp_path, monkeypatch):
    parsed = []
    parse = text_yaml.parse
    monkeypatch.setattr(text_yaml, 'parse', lambda text, name, errors: parsed.append(name) or parse(text, name, errors))
    assert 'nested deeper than 32 levels' in refusal(tmp_path, SWEEP, SCENE + 'a: ' + '[' * 2000 + '\n' + '# large\n' * 200_000)
    assert len(parsed) == 1 and 'sweep.yaml' in parsed[0]


def test_what_is_no_file_is_not_read(tmp_path):
    os.mkfifo(tmp_path / 'pipe')
    for no_file in (str(tmp_path / 'pipe'), '/dev/zero'):
        with pytest.raises(SweepError, match='it is not a file; allowed: a file that can be read'):
            read_sweep(no_file)
        assert f'scene: {no_file}: it is not a file' in refusal(tmp_path, SWEEP.replace('scene.yaml', no_file))
        assert f'motion: {no_file}: it is not a file' in refusal(tmp_path, SWEEP + f'motion: {no_file}\n')


def test_large_files_are_not_read_to_their_end(tmp_path):
    assert 'sweep.yaml: more than 1048576 bytes; allowed: less' in refusal(tmp_path, SWEEP + '#' * (1 << 20))
    assert 'scene: scene.yaml: more than 16777216 bytes; allowed: less' in refusal(tmp_path, SWEEP, SCENE + '#' * (16 << 20))


def test_long_numbers_and_keys_are_named_briefly(tmp_path):
    assert 'seed: 9' in refusal(tmp_path, SWEEP + f'seed: {"9" * 5000}\n')
    assert 'k...: unknown key, its value is 1; allowed: scene, ' in refusal(tmp_path, SWEEP + f'? {"k" * 100_000}\n: 1\n')


def test_what_varies_is_bounded(tmp_path):
    many = ''.join(f'  particles[{i}].mass: {{uniform: [1, 2]}}\n' for i in range(1, 1001))
    assert 'vary: 1001 keys; allowed: at most 1000' in refusal(tmp_path, SWEEP + many)
    options = SWEEP.replace('uniform: [1, 2]', f'choice: [{"1," * 10_001}]')
    assert 'vary.particles[0].mass.choice: 10001 values; allowed: at most 10000' in refusal(tmp_path, options)


def test_rows_of_a_sample_are_bounded(tmp_path):
    sweep, scene = read(tmp_path, SWEEP.replace('duration: 1.0', 'duration: 20000').replace('rate: 50', 'rate: 1000'))
    with pytest.raises(SweepError, match='record.rate: 20000001 rows a sample; allowed: at most 10000000'):
        plan_layout(sweep, scene)


def test_many_errors_are_counted(tmp_path, capsys):
    motions = ', '.join(f'{i}.csv' for i in range(1000))
    (tmp_path / 'scene.yaml').write_text(SCENE)
    (tmp_path / 'sweep.yaml').write_text(SWEEP + f'motions: [{motions}]\n')
    assert command.main([str(tmp_path / 'sweep.yaml'), '--output', str(tmp_path / 'store')]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 101 and lines[-1] == 'cable_sweep: and 900 more errors'
