#!/usr/bin/env python3
"""doc/template, a package that depends on this one and sets nothing, is copied out and compiles, links and runs, with a compiler that
defaults to C++14 as ROS Noetic's does: against the devel space, where its own tests pass, too, and against an install space. Python
finds what it needs in an install space, too.

Usage: dependent_test.py BUILD DEVEL    (the package's build directory, its devel space)
"""
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import rosunit

TEMPLATE = Path(__file__).resolve().parents[2] / 'doc/template'
BUILD, DEVEL = (Path(argument) for argument in sys.argv[1:3])

SCENE = '''
materials: {m: {linear_density: 0.1, radius: 0.005}}
cables: [{name: rope, length: 1.0, segments: 10, material: m, attachments: [{name: held, at: start}]}]
'''
SWEEP = '''
scene: scene.yaml
duration: 0.1
record: {rate: 10, fields: [positions]}
samples: 2
vary:
  cables[0].length: {uniform: [0.9, 1.1]}
'''


def without_devel(variable):
    return [path for path in os.environ.get(variable, '').split(os.pathsep) if path and DEVEL not in [Path(path), *Path(path).parents]]


def install(root):
    """Installs the package below `root`; returns the install space. Not by another prefix: catkin's own script for Python's files knows
    only the one that was configured."""
    configured = re.search(r'set\(CMAKE_INSTALL_PREFIX "(/.*)"\)', (BUILD / 'cmake_install.cmake').read_text()).group(1)
    done = subprocess.run(['cmake', '-P', str(BUILD / 'cmake_install.cmake')], env=dict(os.environ, DESTDIR=str(root)),
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert done.returncode == 0, done.stdout[-4000:]
    return root / configured.lstrip('/')


class DependentTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.root = tempfile.TemporaryDirectory(prefix='dependent_test_root_')
        cls.installed = install(Path(cls.root.name))

    @classmethod
    def tearDownClass(cls):
        cls.root.cleanup()

    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix='dependent_test_')
        self.addCleanup(directory.cleanup)
        self.directory = Path(directory.name)

    def run_checked(self, *command, **options):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
        self.assertEqual(done.returncode, 0, f'{command}:\n{done.stdout[-4000:]}')
        return done.stdout

    def use(self, prefix):
        """Builds and runs a copy of the template with the libraries in `prefix`; returns its build directory."""
        environment = dict(os.environ, CXXFLAGS='-std=gnu++14', LD_LIBRARY_PATH=os.pathsep.join(without_devel('LD_LIBRARY_PATH')),
                           CMAKE_PREFIX_PATH=os.pathsep.join([str(prefix), *without_devel('CMAKE_PREFIX_PATH')]))
        package, build = self.directory / 'my_cables', self.directory / 'build'
        shutil.copytree(TEMPLATE, package)
        self.run_checked('cmake', '-S', str(package), '-B', str(build), f'-DPYTHON_EXECUTABLE={sys.executable}', env=environment)
        self.run_checked('cmake', '--build', str(build), '--target', 'lowest_point', 'simulate', env=environment)
        program = build / 'devel/lib/my_cables/simulate'
        for library in ('core', 'scene'):
            self.assertIn(f'{prefix}/lib/libverlet_cable_{library}.so', self.run_checked('ldd', str(program), env=environment))
        printed = self.run_checked(str(program), str(package / 'config/rope.yaml'), env=environment)
        self.assertEqual(printed, 'hook bears 0.636 N\nhand bears 0.636 N\n')
        return build

    def run_tests(self, build):
        """As a user does, with the workspace sourced; rostest takes a port of its own."""
        results = build / 'test_results'
        place = shlex.quote(str(build))
        self.run_checked('bash', '-c', f'source {place}/devel/setup.bash && cmake --build {place} --target run_tests',
                         env=dict(os.environ, ROS_HOME=str(self.directory / 'ros'), PATH='/usr/sbin:/usr/bin:/sbin:/bin'))
        self.assertTrue(list(results.rglob('rosunit-*.xml')))
        self.assertRegex(self.run_checked('catkin_test_results', str(results)), '[1-9][0-9]* tests, 0 errors, 0 failures')

    def test_devel_space(self):
        self.run_tests(self.use(DEVEL))

    def test_install_space(self):
        self.use(self.installed)
        headers = self.installed / 'include'
        for header in headers.rglob('*.h'):
            for included in re.findall(r'#include "(.*)"', header.read_text()):
                self.assertTrue((headers / included).is_file(), f'{header} includes {included}, which is not installed')

    def test_python_in_install_space(self):
        packages = self.installed / 'lib/python3/dist-packages'
        environment = dict(os.environ, PYTHONPATH=os.pathsep.join([str(packages), *without_devel('PYTHONPATH')]),
                           LD_LIBRARY_PATH=os.pathsep.join(without_devel('LD_LIBRARY_PATH')))
        (self.directory / 'scene.yaml').write_text(SCENE)
        (self.directory / 'sweep.yaml').write_text(SWEEP)
        program = 'from verlet_cable import _simulation, sim, msg\n' \
                  'world = sim.World(sim.Scene.load("scene.yaml"))\n' \
                  'world.step(10)\n' \
                  'print(_simulation.__file__, sim.__file__, msg.__file__, world.state_hash)'
        *files, state = self.run_checked(sys.executable, '-c', program, env=environment, cwd=self.directory).split()
        for file in files:
            self.assertIn(packages, Path(file).parents)
        self.assertRegex(state, '^[0-9a-f]{16}$')
        for name in ('_simulation.pyi', 'py.typed'):
            self.assertTrue((packages / 'verlet_cable' / name).is_file(), name)
        cable_sweep = str(self.installed / 'lib/verlet_cable/cable_sweep')
        self.assertIn('usage: cable_sweep', self.run_checked(cable_sweep, '--help', env=environment))
        self.run_checked(cable_sweep, 'sweep.yaml', '--output', 'store', '--workers', '1', env=environment, cwd=self.directory)
        self.assertTrue((self.directory / 'store/rope/positions/0.0.0.0').is_file())


if __name__ == '__main__':
    rosunit.unitrun('verlet_cable', 'dependent', DependentTest)
