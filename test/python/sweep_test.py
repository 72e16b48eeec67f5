#!/usr/bin/python3
"""cable_sweep: the store's bytes whatever happens to workers and program, wrong samples, wrong descriptions, rows."""
import contextlib
import filecmp
import json
import os
import pathlib
import re
import resource
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import time
import warnings

import numpy as np
import pytest

zarr = pytest.importorskip('zarr')
pytest.importorskip('distributed')

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / 'scripts' / 'cable_sweep'
ENVIRONMENT = dict(os.environ)
if 'VERLET_CABLE_DEVEL' in os.environ:
    ENVIRONMENT['PYTHONPATH'] = os.pathsep.join(
        [os.environ['VERLET_CABLE_DEVEL'] + '/lib/python3/dist-packages', *filter(None, [os.environ.get('PYTHONPATH')])])
TIMEOUT = 300  # [s] for what takes a few on an idle machine

SCENE = """
time_step: 0.005
materials: {m: {linear_density: 0.1, radius: 0.005, drag: 0.1}}
cables:
  - {name: hose, length: 1.0, segments: 20, material: m, attachments: [
      {name: left, at: start}, {name: right, at: end, frame: hand, initial_pose: [0.7, 0, 0, 0, 0, 0]}]}
"""
SWEEP = """
scene: scene.yaml
duration: 1.0
record: {rate: 50, fields: [positions, tension, wrench]}
samples: 40
seed: 1
vary:
  materials.m.linear_density: {log_uniform: [0.05, 0.2]}
  cables[0].length: {uniform: [0.95, 1.1]}
  materials.m.radius: {choice: [0.004, 5e-3]}
"""
# Some seconds of work, in 64 chunks and more: there is time to kill somebody.
LONG = SWEEP.replace('samples: 40', 'samples: 2000').replace('duration: 1.0', 'duration: 5.0').replace('rate: 50', 'rate: 10')


def write(folder, sweep=SWEEP, scene=SCENE):
    (folder / 'scene.yaml').write_text(scene)
    (folder / 'sweep.yaml').write_text(sweep)
    return folder


def start(folder, output, *options, sweep='sweep.yaml', largest_file=None):
    def limit():
        if largest_file is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (largest_file, largest_file))

    return subprocess.Popen([sys.executable, str(PROGRAM), str(folder / sweep), '--output', str(output), *options],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT, preexec_fn=limit)


def finish(process):
    """(exit status, all that was printed)"""
    output, errors = process.communicate(timeout=TIMEOUT)
    return process.returncode, output + errors


def run(folder, output, *options, **keywords):
    return finish(start(folder, output, *options, **keywords))


def chunks(output):
    status = output / 'status'
    return sum(entry.name.isdigit() for entry in status.iterdir()) if status.is_dir() else 0


def wait_until(condition, process):
    deadline = time.monotonic() + TIMEOUT
    while not condition():
        assert process.poll() is None, f'came to its end too early: {process.communicate()}'
        assert time.monotonic() < deadline
        time.sleep(0.005)


def workers_of(process):
    children = []
    for task in pathlib.Path(f'/proc/{process.pid}/task').iterdir():
        children += (task / 'children').read_text().split()
    return [int(child) for child in children if b'spawn_main' in pathlib.Path(f'/proc/{child}/cmdline').read_bytes()]


def listening_addresses(pids):
    """The local addresses, as /proc writes them, of all sockets of these processes that listen."""
    sockets, addresses = set(), set()
    for pid in pids:
        for descriptor in pathlib.Path(f'/proc/{pid}/fd').iterdir():
            try:
                sockets.add(os.readlink(descriptor))
            except FileNotFoundError:  # closed in the meantime
                continue
    for table in ('tcp', 'tcp6'):
        for line in pathlib.Path(f'/proc/net/{table}').read_text().splitlines()[1:]:
            _, local, _, state, *rest = line.split()
            if state == '0A' and f'socket:[{rest[5]}]' in sockets:
                addresses.add(local.partition(':')[0])
    return addresses


def has_ended(pid):
    try:
        return pathlib.Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()[0] == 'Z'
    except (FileNotFoundError, ProcessLookupError):
        return True


def files_of(store):
    return sorted(str(path.relative_to(store)) for path in store.rglob('*'))


def assert_same_bytes(one, other):
    assert files_of(one) == files_of(other)
    files = [name for name in files_of(one) if (one / name).is_file()]
    _, differing, unreadable = filecmp.cmpfiles(one, other, files, shallow=False)
    assert not differing and not unreadable


@pytest.fixture(scope='module')
def undisturbed(tmp_path_factory):
    """A long sweep and its store, of one worker that nothing happened to."""
    folder = write(tmp_path_factory.mktemp('long'), LONG)
    status, text = run(folder, folder / 'undisturbed', '--workers', '1')
    assert status == 0, text
    return folder, folder / 'undisturbed'


def test_same_bytes_on_one_and_four_workers(undisturbed, tmp_path):
    folder, reference = undisturbed
    status, text = run(folder, tmp_path / 'store', '--workers', '4')
    assert status == 0, text
    assert_same_bytes(reference, tmp_path / 'store')


def test_killed_worker(undisturbed, tmp_path):
    folder, reference = undisturbed
    store = tmp_path / 'store'
    process = start(folder, store, '--workers', '2')
    wait_until(lambda: chunks(store) >= 3, process)
    workers = workers_of(process)
    assert listening_addresses([process.pid, *workers]) <= {'0100007F', f'{1 << 24:032X}'}, 'others than this machine can connect'
    os.kill(workers[0], signal.SIGKILL)
    assert chunks(store) < chunks(reference)
    status, text = finish(process)
    assert status == 0, text
    assert_same_bytes(reference, store)


def test_killed_program_and_resume(undisturbed, tmp_path):
    folder, reference = undisturbed
    store = tmp_path / 'store'
    process = start(folder, store, '--workers', '2', '--resume')
    wait_until(lambda: chunks(store) >= 3, process)
    workers = workers_of(process)
    process.kill()
    process.communicate()
    deadline = time.monotonic() + TIMEOUT
    while not all(has_ended(worker) for worker in workers):
        assert time.monotonic() < deadline, 'workers outlive the program'
        time.sleep(0.01)
    assert chunks(store) < chunks(reference)
    (store / 'message' / '0.0123.partial').write_bytes(b'half')
    status, text = run(folder, store, '--workers', '2')
    assert status == 2 and '--resume' in text
    status, text = run(folder, store, '--workers', '2', '--resume')
    assert status == 0, text
    assert_same_bytes(reference, store)


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_interrupt_keeps_what_is_done(undisturbed, tmp_path, number):
    folder, reference = undisturbed
    store = tmp_path / 'store'
    process = start(folder, store, '--workers', '1')
    wait_until(lambda: chunks(store) >= 2, process)
    process.send_signal(number)
    status, text = finish(process)
    assert status == 3 and '--resume' in text, text
    assert 2 <= chunks(store) < chunks(reference)
    assert not list(store.rglob('*.partial'))
    status, text = run(folder, store, '--workers', '2', '--resume')
    assert status == 0, text
    assert_same_bytes(reference, store)


def test_what_cannot_be_written_stops_a_sweep(undisturbed, tmp_path):
    """As where a disk is full: a file cannot grow."""
    folder, reference = undisturbed
    store = tmp_path / 'store'
    largest = max(path.stat().st_size for path in (reference / 'hose/positions').iterdir())
    status, text = run(folder, store, '--workers', '1', largest_file=largest // 2)
    assert status == 3 and 'OSError' in text and '0 of 2000 samples' in text and '--resume' in text, text
    assert chunks(store) == 0 and not list(store.rglob('*.partial'))
    (tmp_path / 'file').write_text('')
    status, text = run(folder, tmp_path / 'file' / 'store', '--workers', '1')
    assert status == 2 and '--output' in text and 'Not a directory' in text, text
    status, text = run(folder, store, '--workers', '2', '--resume')
    assert status == 0, text
    assert_same_bytes(reference, store)


def test_one_program_at_a_time(undisturbed, tmp_path):
    folder, reference = undisturbed
    store = tmp_path / 'store'
    process = start(folder, store, '--workers', '1')
    wait_until(lambda: chunks(store) >= 1, process)
    process.send_signal(signal.SIGSTOP)
    status, text = run(folder, store, '--workers', '1', '--resume')
    process.send_signal(signal.SIGCONT)
    assert status == 2 and 'another cable_sweep is at work there' in text, text
    assert finish(process)[0] == 0
    assert_same_bytes(reference, store)
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ['store']


def commands_for_two_machines():
    """As the page has them, by two addresses of this machine, with a worker each; and the scheduler's address."""
    block = re.search(r'## On two machines\n.*?```\n(.*?)```', (PROGRAM.parents[1] / 'doc/sweeps.md').read_text(), re.DOTALL)[1]
    with socket.socket() as free:
        free.bind(('127.0.0.1', 0))
        port = free.getsockname()[1]
    for shown, here in (('192.168.1.10', '127.0.0.1'), ('192.168.1.11', '127.0.0.2'), ('8786', str(port)), ('python3', sys.executable)):
        block = block.replace(shown, here)
    *commands, sweep = [shlex.split(re.sub(r'&?\s*(#.*)?$', '', line)) for line in block.splitlines()]
    assert len(commands) == 3 and sweep[:-1] == ['cable_sweep', '/shared/sweep.yaml', '--output', '/shared/store', '--scheduler']
    for command in commands[1:]:
        command[command.index('--nworkers') + 1] = '1'
    return commands, sweep[-1]


def is_answered(address):
    host, port = address.removeprefix('tcp://').split(':')
    with contextlib.suppress(OSError), socket.create_connection((host, int(port)), 1):
        return True
    return False


def test_external_scheduler(undisturbed, tmp_path):
    folder, reference = undisturbed
    log = open(tmp_path / 'dask.log', 'w')
    commands, address = commands_for_two_machines()
    processes = []
    try:
        for command in commands:
            options = ['--local-directory', str(tmp_path)] if processes else []
            processes.append(subprocess.Popen(command + options, stdout=log, stderr=log, cwd=tmp_path, env=ENVIRONMENT))
            wait_until(lambda: is_answered(address), processes[0])
        status, text = run(folder, tmp_path / 'store', '--scheduler', address)
        assert status == 0, text
        process = start(folder, tmp_path / 'part', '--scheduler', address)
        wait_until(lambda: chunks(tmp_path / 'part') >= 1, process)
        processes[0].kill()
        status, text = finish(process)
        assert status == 3 and f'the scheduler at {address} is gone\n' in text and 'Traceback' not in text, text
    finally:
        for process in reversed(processes):
            process.terminate()
        for process in processes:
            process.wait(timeout=TIMEOUT)
    assert_same_bytes(reference, tmp_path / 'store')


def test_rows_are_those_of_cable_sim(tmp_path):
    """Each sample is the scene with its values, as World simulates it: with rates that divide the steps' and such that do not."""
    from verlet_cable.sim import Scene, World
    for rate in (50, 60):
        folder = write(tmp_path, SWEEP.replace('rate: 50', f'rate: {rate}').replace('samples: 40', 'samples: 3').replace('1.0\n', '0.5\n'))
        store = tmp_path / f'store{rate}'
        status, text = run(folder, store, '--workers', '1')
        assert status == 0, text
        root = zarr.open_group(str(store), mode='r')
        assert root['hose/positions'].shape == (3, 1 + rate // 2, 21, 3)
        assert root['left/wrench'].shape == (3, 1 + rate // 2, 6)
        assert list(root['status'][:]) == [0, 0, 0]
        assert set(root['vary/materials.m.radius'][:]) <= {0.004, 0.005}
        for sample in range(3):
            text = SCENE.replace('length: 1.0', f'length: {float(root["vary/cables[0].length"][sample])!r}')
            text = text.replace('0.1, radius', f'{float(root["vary/materials.m.linear_density"][sample])!r}, radius')
            text = text.replace('radius: 0.005', f'radius: {float(root["vary/materials.m.radius"][sample])!r}')
            world = World(Scene.from_yaml(text))
            done = 0
            for row in range(1 + rate // 2):
                step = int(np.ceil(row / (rate * 0.005) - 1e-6))
                world.step(step - done)
                done = step
                assert np.array_equal(root['hose/positions'][sample, row], world.positions('hose'))
                assert np.array_equal(root['hose/tension'][sample, row], world.tension('hose'))


def test_sample_depends_on_seed_and_number_only(tmp_path):
    folder = write(tmp_path, SWEEP)
    (folder / 'fewer.yaml').write_text(SWEEP.replace('samples: 40', 'samples: 7'))
    (folder / 'other.yaml').write_text(SWEEP.replace('samples: 40', 'samples: 7').replace('seed: 1', 'seed: 2'))
    for name in ('sweep', 'fewer', 'other'):
        status, text = run(folder, tmp_path / name, '--workers', '2', sweep=f'{name}.yaml')
        assert status == 0, text
    sweep, fewer, other = (zarr.open_group(str(tmp_path / name), mode='r') for name in ('sweep', 'fewer', 'other'))
    for key in ('vary/cables[0].length', 'vary/materials.m.linear_density', 'hose/positions'):
        assert np.array_equal(sweep[key][:7], fewer[key][:])
        assert not np.array_equal(other[key][:], fewer[key][:])
    lengths = sweep['vary/cables[0].length'][:]
    assert len(set(lengths)) == 40 and lengths.min() >= 0.95 and lengths.max() <= 1.1
    assert sweep.attrs['seed'] == 1 and sweep.attrs['units']['tension'] == 'N' and sweep.attrs['scene'] == SCENE


def test_wrong_samples_are_recorded(tmp_path):
    scene = SCENE.replace('radius: 0.005', 'axial_stiffness: 100, breaking_tension: 1.0e+9, radius: 0.005')
    sweep = SWEEP.replace('{uniform: [0.95, 1.1]}', '{choice: [1.0, -1.0]}')
    sweep += '  materials.m.breaking_tension: {choice: [1.0e-3, 1.0e+9]}\n'
    folder = write(tmp_path, sweep, scene)
    status, text = run(folder, tmp_path / 'store', '--workers', '2')
    assert status == 0, text
    assert 'cables[0].length' in text and 'failed:' in text
    root = zarr.open_group(str(tmp_path / 'store'), mode='r')
    status = root['status'][:]
    is_wrong = root['vary/cables[0].length'][:] < 0
    is_weak = root['vary/materials.m.breaking_tension'][:] < 1
    assert {0, 1, 2} == set(status)
    assert np.array_equal(status, np.where(is_wrong, 1, np.where(is_weak, 2, 0)))
    assert np.array_equal(root['worst'][:] == -1, is_wrong)
    for sample in range(40):
        message = root['message'][sample].decode()
        assert ('cables[0].length' in message) == (status[sample] == 1)
        assert bool(message) == (status[sample] != 0)
        positions = root['hose/positions'][sample]
        assert np.isfinite(positions).all() if status[sample] == 0 else np.isnan(positions).all()


PULL = 't,frame,x,y,z,qx,qy,qz,qw\n0,hand,0.7,0,0,0,0,0,1\n0.5,hand,1.5,0,0,0,0,0,1\n'


@pytest.mark.parametrize('fields, rate, limits', [('[wrench]', 20, [5.0, 1e9]), ('[positions]', 20, [5.0, 1e9]),
                                                  ('[positions, wrench]', 30, [5.0, 1e9]), ('[wrench]', 30, [5.0, 5.0])])
def test_a_cable_that_breaks_fails_whatever_is_recorded(tmp_path, fields, rate, limits):
    scene = SCENE.replace('radius: 0.005', 'axial_stiffness: 100, breaking_tension: 1.0e+9, radius: 0.005')
    folder = write(tmp_path, f"""
scene: scene.yaml
motion: pull.csv
duration: 0.5
record: {{rate: {rate}, fields: {fields}}}
samples: 8
vary:
  materials.m.breaking_tension: {{choice: {limits}}}
""", scene)
    (tmp_path / 'pull.csv').write_text(PULL)
    status, text = run(folder, tmp_path / 'store', '--workers', '1')
    assert status == 0, text
    root = zarr.open_group(str(tmp_path / 'store'), mode='r')
    is_weak = root['vary/materials.m.breaking_tension'][:] < 6
    assert {limit < 6 for limit in limits} == set(is_weak)
    assert np.array_equal(root['status'][:], np.where(is_weak, 2, 0))
    for sample in range(8):
        assert ('s: cable "hose" broke at segment ' in root['message'][sample].decode()) == is_weak[sample]
        assert np.isnan(root['left/wrench' if 'wrench' in fields else 'hose/positions'][sample]).all() == is_weak[sample]


def test_worst_status_of_the_steps(tmp_path):
    """A cable that is pulled beyond its length within the time, between two rows or at the end."""
    for rate in (2, 60):
        folder = write(tmp_path, SWEEP.replace('samples: 40', 'samples: 3').replace('rate: 50', f'rate: {rate}').replace('1.0\n', '0.75\n')
                       + 'motion: pull.csv\n')
        (tmp_path / 'pull.csv').write_text(PULL)
        status, text = run(folder, tmp_path / f'store{rate}', '--workers', '1')
        assert status == 0, text
        root = zarr.open_group(str(tmp_path / f'store{rate}'), mode='r')
        assert list(root['status'][:]) == [0, 0, 0] and list(root['worst'][:]) == [2, 2, 2]


def test_what_starts_below_a_table_is_the_worst(tmp_path):
    """Every sample that is below the table at the start or the end is named by `worst`."""
    scene = """
time_step: 0.005
materials: {m: {linear_density: 0.05, radius: 0.004, bending_stiffness: 0.002, bending_damping: 0.0001}}
cables: [{name: rope, length: 1.0, segments: 40, material: m, initial: {type: straight, from: [0, 0, 0.6], to: [0, 0, -0.4]}, attachments: [
  {name: hand, at: start, frame: hand, type: clamp, initial_pose: [0, 0, 0.6, 0, 0, 0]}]}]
obstacles: [{name: table, type: plane, friction: 0.2}]
"""
    folder = write(tmp_path, """
scene: scene.yaml
duration: 0.5
record: {rate: 20, fields: [positions]}
samples: 64
vary:
  cables[0].attachments[0].initial_pose[2]: {uniform: [0.3, 1.2]}
  cables[0].length: {uniform: [0.8, 1.2]}
  obstacles[0].friction: {uniform: [0.0, 0.6]}
""", scene)
    status, text = run(folder, tmp_path / 'store', '--workers', '1')
    assert status == 0, text
    root = zarr.open_group(str(tmp_path / 'store'), mode='r')
    heights = root['rope/positions'][..., 2]
    below = np.logical_or(heights[:, 0].min(axis=1) < 0, heights[:, -1].min(axis=1) < 0)
    assert 0 < np.count_nonzero(below) < 64
    assert (root['worst'][:][below] >= 3).all()


def test_a_frame_that_nothing_places_is_an_error(tmp_path):
    folder = write(tmp_path, scene=SCENE.replace(', initial_pose: [0.7, 0, 0, 0, 0, 0]', ''))
    status, text = run(folder, tmp_path / 'store')
    assert status == 2 and 'scene.yaml: frame hand: it has no pose; allowed: initial_pose' in text, text
    assert not (tmp_path / 'store').exists()


def test_a_store_opens_in_xarray(tmp_path):
    xarray = pytest.importorskip('xarray')
    folder = write(tmp_path, SWEEP.replace('{uniform: [0.95, 1.1]}', '{choice: [1.0, -1.0]}') + '  cables[0].material: {choice: [m, m]}\n')
    status, text = run(folder, tmp_path / 'store', '--workers', '1')
    assert status == 0, text
    with warnings.catch_warnings():
        warnings.simplefilter('error', UserWarning)
        warnings.simplefilter('error', RuntimeWarning)
        root = xarray.open_zarr(str(tmp_path / 'store'), consolidated=False)
        hose = xarray.open_zarr(str(tmp_path / 'store'), group='hose', consolidated=False)
        left = xarray.open_zarr(str(tmp_path / 'store'), group='left', consolidated=False)
        vary = xarray.open_zarr(str(tmp_path / 'store'), group='vary', consolidated=False)
    assert dict(root.sizes) == {'samples': 40, 'rows': 51}
    assert hose.positions.dims == ('samples', 'rows', 'nodes', 'axes') and hose.tension.dims == ('samples', 'rows', 'segments')
    assert left.wrench.shape == (40, 51, 6)
    failed = (root.status != 0).values
    assert 0 < np.count_nonzero(failed) < 40 and int(root.worst.max()) == 0
    assert np.array_equal(np.isnan(hose.positions).all(['rows', 'nodes', 'axes']).values, failed)
    assert np.array_equal(np.isnan(hose.positions).any(['rows', 'nodes', 'axes']).values, failed)
    assert float(root.time[0]) == 0 and np.array_equal(np.isnan(root.worst), failed)
    assert not np.isnan(vary['cables[0].length']).any() and not np.isnan(vary['cables[0].material']).any()
    assert np.array_equal([b'length' in message for message in root.message.values], failed)


def test_motions_are_drawn_from(tmp_path):
    header = 't,frame,x,y,z,qx,qy,qz,qw\n'
    (tmp_path / 'up.csv').write_text(header + '0,hand,0.7,0,0,0,0,0,1\n1,hand,0.7,0,0.2,0,0,0,1\n')
    (tmp_path / 'down.csv').write_text(header + '0,hand,0.7,0,0,0,0,0,1\n1,hand,0.7,0,-0.2,0,0,0,1\n')
    folder = write(tmp_path, SWEEP + '\nmotions: [up.csv, down.csv]\n')
    status, text = run(folder, tmp_path / 'store', '--workers', '2')
    assert status == 0, text
    root = zarr.open_group(str(tmp_path / 'store'), mode='r')
    drawn = root['vary/motion'][:]
    assert root['vary/motion'].attrs['choices'] == ['up.csv', 'down.csv'] and set(drawn) == {0, 1}
    assert np.allclose(root['hose/positions'][:, -1, -1, 2], np.where(drawn == 0, 0.2, -0.2), atol=1e-3)


def test_loads_push_every_sample(tmp_path):
    from verlet_cable.sim import Scene, World
    header = 't,name,on,node,fx,fy,fz,tx,ty,tz\n'
    (tmp_path / 'gusts.csv').write_text(header + '0.2,gust,hose,10,0,0.1,0,0,0,0\n0.4,gust,hose,10,0,0,0,0,0,0\n')
    folder = write(tmp_path, 'loads: gusts.csv' + SWEEP.replace('samples: 40', 'samples: 2').partition('vary:')[0])
    status, text = run(folder, tmp_path / 'store', '--workers', '1')
    assert status == 0, text
    root = zarr.open_group(str(tmp_path / 'store'), mode='r')
    world = World(Scene.from_yaml(SCENE), loads=tmp_path / 'gusts.csv')
    world.step(200)
    for sample in range(2):
        assert np.array_equal(root['hose/positions'][sample, -1], world.positions('hose'))
    assert abs(world.positions('hose')[10, 1]) > 1e-3
    assert root.attrs['sweep']['loads'] == 'gusts.csv'
    (tmp_path / 'gusts.csv').write_text(header + '0.2,gust,rope,10,0,0.1,0,0,0,0\n')
    status, text = run(folder, tmp_path / 'other')
    assert status == 2 and 'loads: gusts.csv: line 2: on "rope"; allowed: hose' in text, text
    status, text = run(write(tmp_path, SWEEP + '\nloads: nowhere.csv\n'), tmp_path / 'other')
    assert status == 2 and 'loads: nowhere.csv' in text, text


def test_all_errors_of_a_description_at_once(tmp_path):
    folder = write(tmp_path, """
scene: scene.yaml
motion: nowhere.csv
duration: -1
record: {rate: 1000, fields: [positions, colour, tensoin], feilds: 1}
samples: 0
seed: 1.5
wokers: 3
sample: 3
vary:
  materials.m.linear_density: {log_uniform: [0.0, 0.2]}
  materials.n.radius: {uniform: [0.1, 0.2]}
  cables[1].length: {uniform: [2, 1]}
  cables[0].segments: {choice: [10, 20]}
  cables[0].length: {gaussian: [1, 2]}
  cables[0].lenght: {uniform: [1, 2]}
  materials.m.friction: {unifrom: [1, 2]}
  cables[99].length: {uniform: [1, 2]}
  time_stp: {uniform: [.nan, 2]}
  materials.m.drag: {normal: [0.1, -0.01]}
""")
    (tmp_path / 'store').mkdir()
    status, text = run(folder, tmp_path / 'store')
    assert status == 2
    for word in ('nowhere.csv', 'duration: -1', 'record.rate: 1000', 'at most 1 / time_step = 200', 'record.fields[1]', 'colour',
                 "'tensoin' (did you mean tension?)",
                 'record.feilds: unknown key, its value is 1 (did you mean fields?); allowed: rate, fields', 'samples: 0',
                 'sample: unknown key, its value is 3 (did you mean samples?); allowed: scene, motion, ', '(did you mean uniform?)',
                 'seed: 1.5', 'wokers', 'vary.materials.m.linear_density.log_uniform: [0.0, 0.2]', 'vary.materials.n.radius',
                 'vary.cables[1].length', 'vary.cables[1].length.uniform: [2, 1]', 'vary.cables[0].segments: cannot vary',
                 'vary.cables[0].length', 'gaussian', 'vary.cables[0].lenght: not in scene.yaml', 'did you mean length?',
                 'vary.cables[99].length: not in scene.yaml', 'vary.time_stp.uniform', 'did you mean time_step?', 'normal: [0.1, -0.01]', '--output'):
        assert word in text, f'{word} is not in\n{text}'
    assert not list((tmp_path / 'store').iterdir())


def test_a_scene_is_no_sweep(tmp_path):
    status, text = run(write(tmp_path), tmp_path / 'store', sweep='scene.yaml')
    assert status == 2
    assert text == ('cable_sweep: scene.yaml: this is a scene, not a sweep; allowed: a file that names it, as `scene: scene.yaml`, '
                    'and says what to vary: doc/sweeps.md\n')


def test_errors_of_the_scene_are_named(tmp_path):
    folder = write(tmp_path, SWEEP, SCENE.replace('length: 1.0', 'length: -1').replace('linear_density: 0.1', 'linear_density: none'))
    status, text = run(folder, tmp_path / 'store')
    assert status == 2 and 'scene.yaml: ' in text and 'cables[0].length' in text and 'linear_density' in text
    assert not (tmp_path / 'store').exists()


def test_errors_of_scene_motions_and_values_come_together(tmp_path):
    sweep = SWEEP + '  cables[0].lenght: {uniform: [1, 2]}\n  gravity: {uniform: [1, 2]}\nmotions: [nan.csv, header.csv, empty.csv]\n'
    folder = write(tmp_path, sweep, SCENE.replace('length: 1.0', 'length: -1'))
    (tmp_path / 'nan.csv').write_text('t,frame,x,y,z,qx,qy,qz,qw\n0,hand,nan,0,0,0,0,0,1\n')
    (tmp_path / 'header.csv').write_text('t,frame,x\n')
    (tmp_path / 'empty.csv').write_text('')
    words = ['vary.cables[0].lenght: not in scene.yaml', 'motions[0]: nan.csv: line 2: x', 'motions[1]: header.csv: line 1',
             'motions[2]: empty.csv: empty']
    status, text = run(folder, tmp_path / 'store')
    assert status == 2 and all(word in text for word in [*words, 'scene.yaml: cables[0].length: -1']), text
    write(tmp_path, sweep.replace('wrench', 'body_pose'))
    status, text = run(folder, tmp_path / 'store')
    assert status == 2 and all(word in text for word in [*words, 'vary.gravity.uniform: [1.0, 2.0]: the scene refuses', 'body_pose']), text
    assert not (tmp_path / 'store').exists()


def test_example():
    from verlet_cable.sweep.description import read_sweep
    from verlet_cable.sweep.trial import notes
    sweep, scene = read_sweep(str(PROGRAM.parents[1] / 'config' / 'sweep.yaml'))
    assert sweep.samples == 200 and scene.cable_names == ['hose'] and len(sweep.variations) == 4
    assert notes(sweep, scene) == []


def test_numbers_of_choices_are_numbers(tmp_path):
    folder = write(tmp_path, """
scene: scene.yaml
duration: 0.1
record: {rate: 10, fields: [wrench]}
samples: 16
vary:
  gravity: {choice: [[0, 0, -9.81], [0, 0, 1.62e0]]}
  materials.m.radius: {choice: [4e-3, 5e-3]}
""")
    status, text = run(folder, tmp_path / 'store', '--workers', '1')
    assert status == 0, text
    root = zarr.open_group(str(tmp_path / 'store'), mode='r')
    choices = root['vary/gravity'].attrs['choices']
    assert choices == [[0, 0, -9.81], [0, 0, 1.62]] and isinstance(choices[0][0], int)
    assert root.attrs['sweep']['vary']['materials.m.radius'] == {'choice': [0.004, 0.005]}
    assert set(root['vary/materials.m.radius'][:]) == {0.004, 0.005} and not root['status'][:].any()
    is_up = root['vary/gravity'][:] == 1
    assert {False, True} == set(is_up)
    assert len(set(np.sign(root['left/wrench'][:, -1, 2])[is_up])) == 1
    assert set(np.sign(root['left/wrench'][:, -1, 2])[is_up]) != set(np.sign(root['left/wrench'][:, -1, 2])[~is_up])


def test_notes_of_what_may_not_be_meant(tmp_path):
    from verlet_cable.sweep.description import read_sweep
    from verlet_cable.sweep.trial import notes
    header = 't,frame,x,y,z,qx,qy,qz,qw\n'
    (tmp_path / 'hand.csv').write_text(header + '0,hand,0.7,0,0,0,0,0,1\n')
    (tmp_path / 'hamd.csv').write_text(header + '0,hamd,0.7,0,0,0,0,0,1\n')
    write(tmp_path, SWEEP + 'motions: [hand.csv, hamd.csv]\n')
    assert notes(*read_sweep(str(tmp_path / 'sweep.yaml'))) == ['hamd.csv: the scene does not use frames hamd']
    guide = 'guides:\n  - {name: eye, cable: hose, at: 0.5, offset: [0.35, 0, 0], type: eyelet}\n'
    box = 'obstacles: [{name: box, type: box, frame: mast, pose: [0, 0, 9, 0, 0, 0], size: [1, 1, 1]}]\n'
    write(tmp_path, SWEEP + 'motions: [hand.csv, hamd.csv]\n', SCENE + guide + box)
    assert notes(*read_sweep(str(tmp_path / 'sweep.yaml'))) == [
        'hamd.csv: the scene does not use frames hamd',
        'hand.csv, hamd.csv: nothing places frame mast, and the obstacles in it: at the origin',
        'guides (eye) change the number of nodes of a cable that slides through them; '
        'samples in which they do fail, since they have no positions, tension of one shape']


def test_frames_that_hold_something_need_a_pose(tmp_path):
    from verlet_cable.sweep.description import read_sweep
    from verlet_cable.sweep.errors import SweepError
    header = 't,frame,x,y,z,qx,qy,qz,qw\n'
    (tmp_path / 'hand.csv').write_text(header + '0,hand,0.7,0,0,0,0,0,1\n')
    (tmp_path / 'hamd.csv').write_text(header + '0,hamd,0.7,0,0,0,0,0,1\n')
    guide = 'guides:\n  - {name: eye, cable: hose, at: 0.5, frame: mast, type: eyelet}\n'
    unplaced = SCENE.replace(', initial_pose: [0.7, 0, 0, 0, 0, 0]', '') + guide
    allowed = 'allowed: initial_pose: [x, y, z, roll, pitch, yaw] (m, rad) beside frame: {0}, or rows of it in each motion'

    def errors(sweep):
        write(tmp_path, sweep, unplaced)
        with pytest.raises(SweepError) as refused:
            read_sweep(str(tmp_path / 'sweep.yaml'))
        return refused.value.errors

    assert errors(SWEEP) == [f'scene: scene.yaml: frame {frame}: it has no pose; ' + allowed.format(frame) for frame in ('hand', 'mast')]
    assert errors(SWEEP + 'motions: [hand.csv, hamd.csv]\n') == [
        'scene: scene.yaml: frame mast: it has no pose in hand.csv, hamd.csv; ' + allowed.format('mast'),
        'scene: scene.yaml: frame hand: it has no pose in hamd.csv; ' + allowed.format('hand')]


def test_fields_that_the_scene_does_not_have(tmp_path):
    folder = write(tmp_path, SWEEP.replace('wrench', 'body_pose'))
    status, text = run(folder, tmp_path / 'store')
    assert status == 2 and 'record.fields[2]: body_pose' in text, text


def test_resume_refuses_another_sweep(tmp_path):
    folder = write(tmp_path)
    assert run(folder, tmp_path / 'store', '--workers', '1')[0] == 0
    before = {name: (tmp_path / 'store' / name).stat().st_mtime_ns for name in files_of(tmp_path / 'store')}
    (folder / 'sweep.yaml').write_text(SWEEP.replace('seed: 1', 'seed: 3'))
    status, text = run(folder, tmp_path / 'store', '--resume')
    assert status == 2 and 'sweep.seed was 1, is 3' in text, text
    write(folder, SWEEP, SCENE.replace('drag: 0.1', 'drag: 0.2'))
    status, text = run(folder, tmp_path / 'store', '--resume')
    assert status == 2 and 'scene' in text, text
    (folder / 'other').mkdir()
    status, text = run(folder, folder / 'other', '--resume')
    assert status == 2 and 'no store of cable_sweep' in text, text
    write(folder)
    shutil.copytree(tmp_path / 'store', tmp_path / 'part')
    shutil.rmtree(tmp_path / 'part/hose/tension')
    metadata = tmp_path / 'part/hose/positions/.zarray'
    metadata.write_text(metadata.read_text().replace('"<f8"', '"<f4"'))
    status, text = run(folder, tmp_path / 'part', '--resume')
    assert status == 2 and 'without hose/tension' in text and 'hose/positions/.zarray: not as cable_sweep wrote it' in text, text
    assert before == {name: (tmp_path / 'store' / name).stat().st_mtime_ns for name in files_of(tmp_path / 'store')}


def test_resume_simulates_again_what_was_lost(tmp_path):
    folder = write(tmp_path)
    assert run(folder, tmp_path / 'reference', '--workers', '1')[0] == 0
    shutil.copytree(tmp_path / 'reference', tmp_path / 'store')
    (tmp_path / 'store/hose/positions/0.0.0.0').unlink()
    (tmp_path / 'store/hose/tension/1.0.0').write_bytes(b'')
    os.truncate(tmp_path / 'store/left/wrench/2.0.0', 100)
    os.truncate(tmp_path / 'store/status/3', 17)
    changed = tmp_path / 'store/hose/positions/4.0.0.0'
    data = bytearray(changed.read_bytes())
    data[len(data) // 2] ^= 1
    changed.write_bytes(data)
    with pytest.raises(RuntimeError, match='checksum'):
        zarr.open(str(tmp_path / 'store'), mode='r')['hose/positions'][:]
    status, text = run(folder, tmp_path / 'store', '--workers', '1', '--resume')
    assert status == 0 and 'files of 5 chunks' in text and '40 simulated now' in text, text
    assert_same_bytes(tmp_path / 'reference', tmp_path / 'store')


def test_no_scheduler(tmp_path):
    folder = write(tmp_path)
    status, text = run(folder, tmp_path / 'store', '--scheduler', 'nonsense://here')
    assert status == 2 and '--scheduler: nonsense://here' in text, text
    status, text = run(folder, tmp_path / 'store', '--scheduler', 'tcp://127.0.0.1:1', '--workers', str(len(os.sched_getaffinity(0))))
    assert status == 2 and 'not allowed with argument --scheduler' in text, text
    status, text = run(folder, '')
    assert status == 2 and "--output: ''; allowed: the name of a directory" in text, text
    assert not (tmp_path / 'store').exists()


if __name__ == '__main__':
    sys.exit(pytest.main([__file__, '-v', *sys.argv[1:]]))
