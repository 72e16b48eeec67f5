#!/usr/bin/env python3
"""A package that depends on this one and sets nothing compiles, links and runs, with a compiler that defaults to C++14 as ROS
Noetic's does: against the devel space, and against an install space.

Usage: dependent_test.py BUILD DEVEL    (the package's build directory, its devel space)
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import rosunit

PACKAGE = Path(__file__).resolve().parent / 'package'
BUILD, DEVEL = (Path(argument) for argument in sys.argv[1:3])


def without_devel(variable):
    return [path for path in os.environ.get(variable, '').split(os.pathsep) if path and DEVEL not in [Path(path), *Path(path).parents]]


class DependentTest(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix='dependent_test_')
        self.addCleanup(directory.cleanup)
        self.directory = Path(directory.name)

    def run_checked(self, *command, **options):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
        self.assertEqual(done.returncode, 0, f'{command}:\n{done.stdout[-4000:]}')
        return done.stdout

    def use(self, prefix):
        """Builds and runs the dependent package with the libraries in `prefix`."""
        environment = dict(os.environ, CXXFLAGS='-std=gnu++14', LD_LIBRARY_PATH=os.pathsep.join(without_devel('LD_LIBRARY_PATH')),
                           CMAKE_PREFIX_PATH=os.pathsep.join([str(prefix), *without_devel('CMAKE_PREFIX_PATH')]))
        build = self.directory / 'build'
        self.run_checked('cmake', '-S', str(PACKAGE), '-B', str(build), f'-DPYTHON_EXECUTABLE={sys.executable}', env=environment)
        self.run_checked('cmake', '--build', str(build), '--target', 'cable_user', env=environment)
        program, = build.rglob('lib/cable_user/cable_user')
        for library in ('core', 'scene'):
            self.assertIn(f'{prefix}/lib/libverlet_cable_{library}.so', self.run_checked('ldd', str(program), env=environment))
        self.assertRegex(self.run_checked(str(program), env=environment), r'^rope at 0\.100000 s: -0\.0[0-9]+ m\n$')

    def test_devel_space(self):
        self.use(DEVEL)

    def test_install_space(self):
        prefix = self.directory / 'install'
        self.run_checked('cmake', f'-DCMAKE_INSTALL_PREFIX={prefix}', '-P', str(BUILD / 'cmake_install.cmake'))
        self.use(prefix)
        headers = prefix / 'include'
        for header in headers.rglob('*.h'):
            for included in re.findall(r'#include "(.*)"', header.read_text()):
                self.assertTrue((headers / included).is_file(), f'{header} includes {included}, which is not installed')


if __name__ == '__main__':
    rosunit.unitrun('verlet_cable', 'dependent', DependentTest)
