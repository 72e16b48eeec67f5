#!/usr/bin/python3
"""environment_speed.py [WORLDS [STEPS]]: how many steps of 0.02 s the environments of verlet_cable.environments do in a minute,
with actions drawn at random, in so many worlds (default 1024) on all cores.

Needs the workspace's setup sourced.
"""
import sys
import time

from verlet_cable.environments import LayCableVector, ShapeRopeVector


def steps_in_a_minute(environments, steps):
    environments.reset(seed=0)
    environments.action_space.seed(0)
    actions = [environments.action_space.sample() for _ in range(steps)]
    begin = time.perf_counter()
    for each in actions:
        environments.step(each)
    return 60 * steps * environments.num_envs / (time.perf_counter() - begin)


def main():
    worlds, steps = [int(argument) for argument in sys.argv[1:]] + [1024, 50][len(sys.argv) - 1:]
    for make in (ShapeRopeVector, LayCableVector):
        environments = make(worlds)
        print(f'{make.__name__}: {steps_in_a_minute(environments, steps):.0f} steps a minute in {worlds} worlds', flush=True)
        environments.close()


if __name__ == '__main__':
    main()
