"""How setup.py installs: compiled parts come beside the modules, and never into the checkout."""
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip('setuptools', minversion='64')
pytest.importorskip('wheel')

CHECKOUT = Path(__file__).resolve().parents[2]
# Instead of CMake, which would compile for minutes: installs one file where it is told to.
CMAKE = '''#!/bin/sh
case $1 in
  -S) for argument; do case $argument in -DCMAKE_INSTALL_PREFIX=*) echo "${argument#*=}" >prefix ;; esac; done ;;
  --install) mkdir -p "$(cat prefix)" && echo compiled >"$(cat prefix)/_simulation.so" ;;
esac
'''


@pytest.fixture
def copy(tmp_path):
    """Of what setup.py reads, with that CMake; a function that runs setup.py in it."""
    checkout, programs = tmp_path / 'checkout', tmp_path / 'bin'
    checkout.mkdir()
    programs.mkdir()
    for name in ('setup.py', 'pyproject.toml', 'package.xml', 'LICENSE', 'README.md'):
        shutil.copy(CHECKOUT / name, checkout)
    shutil.copytree(CHECKOUT / 'src/python/verlet_cable', checkout / 'src/python/verlet_cable')
    (programs / 'cmake').write_text(CMAKE)
    (programs / 'cmake').chmod(0o755)
    environment = {name: value for name, value in os.environ.items() if not name.startswith('CATKIN')}
    environment['PATH'] = f'{programs}{os.pathsep}{environment["PATH"]}'

    def run(*arguments):
        done = subprocess.run([sys.executable, 'setup.py', *arguments], cwd=checkout, env=environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
        assert done.returncode == 0, done.stdout
        return checkout
    return run


def test_an_editable_install_links_to_modules_and_keeps_compiled_parts_out_of_the_checkout(copy, tmp_path):
    checkout = copy('editable_wheel', '--dist-dir', str(tmp_path))
    package, = checkout.glob('build/__editable__.*/verlet_cable')
    assert (package / '_simulation.so').read_text() == 'compiled\n'
    for module in ('__init__.py', 'programs.py', 'sim/__init__.py', 'environments/lay_cable.py'):
        assert (package / module).resolve() == checkout / 'src/python/verlet_cable' / module
    assert not list((checkout / 'src').rglob('*.so'))


def test_compiled_parts_come_beside_the_modules(copy, tmp_path):
    copy('install', '--single-version-externally-managed', '--record', str(tmp_path / 'record'), '--prefix', str(tmp_path / 'place'))
    module, = (tmp_path / 'place').rglob('_simulation.so')
    assert (module.parent / 'sim/__init__.py').exists() and not (module.parent / 'sim').is_symlink()


def test_programs_are_found_beside_a_module_that_is_a_link(tmp_path):
    for name in ('__init__.py', 'programs.py'):
        (tmp_path / name).symlink_to(CHECKOUT / 'src/python/verlet_cable' / name)
    (tmp_path / 'cable_sim').write_text('#!/bin/sh\necho "this one: $*"\n')
    (tmp_path / 'cable_sim').chmod(0o755)
    done = subprocess.run([sys.executable, '-c', 'import programs; programs.cable_sim()', 'scene.yaml'], cwd=tmp_path,
                          stdout=subprocess.PIPE, text=True, check=True)
    assert done.stdout == 'this one: scene.yaml\n'
