"""Learning tasks with cables, with the interface of Gymnasium: https://gymnasium.farama.org. Gymnasium need not be installed.

    from verlet_cable.environments import ShapeRope

    environment = ShapeRope()
    observation, info = environment.reset(seed=1)
    observation, reward, terminated, truncated, info = environment.step(environment.action_space.sample())

ShapeRope and LayCable have one world; ShapeRopeVector and LayCableVector have many worlds that step together. If Gymnasium 1.1 or
newer is installed, they are a gymnasium.Env and a gymnasium.vector.VectorEnv, their spaces are gymnasium.spaces.Box, and they are
registered with gymnasium.make and make_vec as verlet_cable/ShapeRope-v1 and verlet_cable/LayCable-v1.

The same seed and actions give the same bytes, in a single world or in one of many, with any number of threads.
"""
from verlet_cable.environments.interface import AutoresetMode, Box, gymnasium
from verlet_cable.environments.lay_cable import LayCable, LayCableVector
from verlet_cable.environments.registration import register
from verlet_cable.environments.shape_rope import ShapeRope, ShapeRopeVector

__all__ = ['AutoresetMode', 'Box', 'LayCable', 'LayCableVector', 'ShapeRope', 'ShapeRopeVector']

if gymnasium is not None:
    register(gymnasium)
