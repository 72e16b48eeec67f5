#!/usr/bin/python3
"""environment_speed.py [WORLDS [STEPS]]: how many steps of 0.02 s the environments of verlet_cable.environments do in a second, with
actions drawn at random, in so many worlds (default 1024) on all cores; and in a second of processor time, which does not depend on what
else the machine does.

Needs the workspace's setup sourced.
"""
import sys
import time

from verlet_cable.environments import LayCableVector, ShapeRopeVector


def steps_in_a_second(environments, steps):
    """(of time, of processor time)"""
    environments.reset(seed=0)
    environments.action_space.seed(0)
    actions = [environments.action_space.sample() for _ in range(steps)]
    begin, begin_of_processor = time.perf_counter(), time.process_time()
    for each in actions:
        environments.step(each)
    done = steps * environments.num_envs
    return done / (time.perf_counter() - begin), done / (time.process_time() - begin_of_processor)


def main():
    worlds, steps = [int(argument) for argument in sys.argv[1:]] + [1024, 50][len(sys.argv) - 1:]
    for make in (ShapeRopeVector, LayCableVector):
        environments = make(worlds)
        of_time, of_processor = steps_in_a_second(environments, steps)
        print(f'{make.__name__}: {of_time:.0f} steps a second in {worlds} worlds; {of_processor:.0f} in a second of processor time', flush=True)
        environments.close()


if __name__ == '__main__':
    main()
