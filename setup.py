"""pip installs the Python modules and the command lines by it, without ROS; catkin reads which modules there are."""
import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = pathlib.Path(__file__).resolve().parent
PACKAGES = {
    'packages': ['verlet_cable', 'verlet_cable.camera', 'verlet_cable.convert', 'verlet_cable.environments', 'verlet_cable.sim',
                 'verlet_cable.sweep'],
    'package_dir': {'': 'src/python'},
}
# By which the package's CMake files install: all of it goes beside the modules.
DESTINATIONS = ['GLOBAL_BIN', 'PACKAGE_BIN', 'PACKAGE_LIB', 'PACKAGE_PYTHON', 'PACKAGE_SHARE']


class BuildByCMake(build_ext):
    """Builds and installs what CMake has for the package, beside its modules.

    For an editable install, too: that has a directory of its own with links to the modules, see `editable_wheel` below. In the
    checkout, a ROS workspace that has the same checkout would take the compiled parts for its own.
    """

    def run(self):
        self.inplace = False
        super().run()

    def build_extension(self, ext):
        place = self._place(ext)
        build = pathlib.Path(self.build_temp).resolve()
        if getattr(self, 'editable_mode', False):  # whose own directory is temporary: all would be compiled anew each time
            build = HERE / 'build' / 'temp.editable'
        jobs = self.parallel or len(os.sched_getaffinity(0))
        subprocess.run(['cmake', '-S', HERE, '-B', build, f'-DCMAKE_INSTALL_PREFIX={place}',
                        f'-DVERLET_CABLE_INSTEAD={HERE / "cmake/python_package.cmake"}',
                        f'-DPYTHON_EXECUTABLE={sys.executable}', f'-DPython3_EXECUTABLE={sys.executable}',
                        f'-DCATKIN_DEVEL_PREFIX={build}', *(f'-DCATKIN_{name}_DESTINATION=.' for name in DESTINATIONS)], check=True)
        subprocess.run(['cmake', '--build', build, '--parallel', str(jobs)], check=True)
        subprocess.run(['cmake', '--install', build, '--strip', '--component', 'Unspecified'], check=True)

    def get_outputs(self):
        return [str(path) for ext in self.extensions for path in sorted(self._place(ext).rglob('*'))
                if path.is_file() and not path.is_symlink()]

    def get_output_mapping(self):
        return {}

    def _place(self, ext):
        return pathlib.Path(self.build_lib).resolve() / pathlib.Path(*ext.name.split('.')[:-1])


def by_catkin():
    """Whether catkin runs this, which builds and installs the rest by itself."""
    return __name__ != '__main__' or 'CATKIN_BINARY_DIR' in os.environ


if by_catkin():
    from catkin_pkg.python_setup import generate_distutils_setup

    setup(**generate_distutils_setup(**PACKAGES))
else:
    PACKAGE_XML = (HERE / 'package.xml').read_text(encoding='utf-8')
    setup(
        name='verlet_cable',
        version=re.search('<version>(.*)</version>', PACKAGE_XML)[1],
        description=re.search('<description>(.*)</description>', PACKAGE_XML)[1],
        license='BSD-3-Clause',
        python_requires='>=3.8',
        install_requires=['numpy'],
        extras_require={'camera': ['pillow', 'pyyaml'], 'plot': ['matplotlib'], 'sweep': ['dask', 'distributed', 'zarr', 'pyyaml']},
        package_data={'verlet_cable': ['py.typed', '*.pyi'], 'verlet_cable.environments': ['*.pyi'], 'verlet_cable.sim': ['*.pyi']},
        ext_modules=[Extension('verlet_cable._simulation', [])],
        cmdclass={'build_ext': BuildByCMake},
        options={'editable_wheel': {'mode': 'strict'}},
        entry_points={'console_scripts': [
            'cable_sim = verlet_cable.programs:cable_sim',
            'cable_fit = verlet_cable.programs:cable_fit',
            'cable_coco = verlet_cable.coco_command:main',
            'cable_convert = verlet_cable.convert.command:main',
            'cable_sweep = verlet_cable.sweep.command:main',
        ]},
        zip_safe=False,
        **PACKAGES)
