"""Worlds for tests."""
import json
import signal
import subprocess
import sys
import time

from verlet_cable.sim import Scene, World

IDENTITY = [0, 0, 0, 1]


def world_of(scene, *options):
    return World(Scene.from_dict(scene), *options)


def quiet(world):
    """At rest: settled, and its forces measured."""
    assert world.settle()
    world.step(5)
    return world


def interrupted(program, scene, *arguments):
    """What a Python program, whose first line is 'begins', prints after it when it is interrupted a little later."""
    process = subprocess.Popen([sys.executable, '-c', program, json.dumps(scene), *arguments], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == 'begins\n'
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        return process.communicate(timeout=60)[0]
    finally:
        process.kill()
