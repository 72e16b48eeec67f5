from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(
    packages=['verlet_cable', 'verlet_cable.environments', 'verlet_cable.sim', 'verlet_cable.sweep'],
    package_dir={'': 'src/python'},
))
