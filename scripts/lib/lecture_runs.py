"""Runs scenes of config/scenes/lecture, changed or as they are, with cable_sim, and reads what it writes."""
import json
import pathlib
import subprocess
import tempfile

import numpy
import yaml

SCENES = pathlib.Path(__file__).resolve().parents[2] / 'config/scenes/lecture'


class Run:
    """Of one net, cable or set of particles: rows of all its nodes."""

    def __init__(self, summary, times, positions, velocities):
        self.summary = summary
        self.times = times            # [s] one a row
        self.positions = positions    # [m] rows x nodes x 3
        self.velocities = velocities  # [m/s] rows x nodes x 3


def scene_of(name, **changes):
    """The scene of that name, with other values for some of its keys."""
    scene = yaml.safe_load((SCENES / f'{name}.yaml').read_text())
    scene.update(changes)
    return scene


def simulate(cable_sim, scene, duration, rate=100):
    """Runs by name of the net, cable or particle. What came to nothing, a scene or the simulation, is an error."""
    with tempfile.TemporaryDirectory() as directory:
        paths = [pathlib.Path(directory, name) for name in ('scene.yaml', 'rows.csv', 'summary.json')]
        paths[0].write_text(yaml.safe_dump(scene))
        subprocess.run([cable_sim, paths[0], '--duration', repr(duration), '--rate', repr(rate), '--output', paths[1],
                        '--summary', paths[2]], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        summary = json.loads(paths[2].read_text())
        names = numpy.loadtxt(paths[1], delimiter=',', skiprows=1, usecols=1, dtype='U32')
        values = numpy.loadtxt(paths[1], delimiter=',', skiprows=1, usecols=(0, 3, 4, 5, 6, 7, 8))
    runs = {}
    for name in dict.fromkeys(names):
        rows = values[names == name]
        times = numpy.unique(rows[:, 0])
        rows = rows.reshape(len(times), -1, 7)
        runs[name] = Run(summary, times, rows[:, :, 1:4], rows[:, :, 4:])
    return runs
