"""Runs a scene of the audit and measures what is right in it."""
from collections import Counter
from dataclasses import dataclass, field
from typing import Optional

import numpy as np
from verlet_cable.sim import Scene, World

TIME_STEP = 1e-3  # [s]
MEDIAN_TIME = 0.05  # [s] over which forces are taken: a shorter blow has a force that depends on the time step
WATCHED_TIME = 0.01  # [s] between two looks at energy and places
CLOSED = 1e-4  # of m g L: what a ledger may leave, and a scene gain, in all

# Refined runs have so much shorter steps and segments.
STEP_PARTS, SEGMENT_PARTS = 4, 2


@dataclass
class Run:
    """What a run of a scene has shown."""
    statuses: Counter = field(default_factory=Counter)
    forces: list = field(default_factory=list)  # [N] the largest at an attachment, by step
    gains: list = field(default_factory=list)  # [J] of energy beyond the work done
    places: list = field(default_factory=list)  # [m] of all nodes, by WATCHED_TIME
    unaccounted: float = 0.0  # [J]
    dissipated: dict = field(default_factory=dict)  # [J]
    speed: float = 0.0  # [m/s] of the fastest node, at the end

    @property
    def is_ok(self):
        return set(self.statuses) == {'ok'}

    def largest_force(self, time_step):
        """[N] of medians over a while."""
        width = round(MEDIAN_TIME / time_step)
        forces = np.asarray(self.forces)
        every = max(1, width // 10)
        return max(np.median(forces[i:i + width]) for i in range(0, max(1, len(forces) - width + 1), every))

    @property
    def gain(self):
        """[J] The greatest rise of energy that no work has brought."""
        gains = np.asarray(self.gains)
        return float(np.max(gains - np.minimum.accumulate(gains)))


def world_of(scene, time_step=TIME_STEP, finer=1):
    return World(Scene.from_dict(scene.refined(time_step, finer)))


def simulate(scene, time_step=TIME_STEP, finer=1):
    world = world_of(scene, time_step, finer)
    names = world.attachment_names
    waiting = sorted(scene.winches, key=lambda command: command.time)
    run, watched = Run(gains=[0.0]), round(WATCHED_TIME / time_step)
    for step in range(1, round(scene.seconds / time_step) + 1):
        while waiting and waiting[0].time < (step - 0.5) * time_step:
            command = waiting.pop(0)
            world.set_length(command.cable, command.at_end, command.length, command.speed)
        for name, hand in scene.hands.items():
            world.set_frame(name, *hand.pose(step * time_step))
        run.statuses[world.step()] += 1
        run.forces.append(max(float(np.linalg.norm(world.wrench(name)[:3])) for name in names))
        if step % watched == 0:
            ledger = world.ledger()
            run.gains.append(ledger['change'] - sum(ledger['work'].values()))
            run.places.append([world.positions(cable)[::finer] for cable in world.cable_names])
    run.unaccounted, run.dissipated = world.ledger()['unaccounted'], world.ledger()['dissipated']
    run.speed = max(float(np.linalg.norm(world.velocities(cable), axis=1).max()) for cable in world.cable_names)
    return run


def difference(one, other):
    """[m] The greatest distance of a node in two runs; None where cables do not have the same nodes."""
    greatest = 0.0
    for places, others in zip(one.places, other.places):
        for a, b in zip(places, others):
            if a.shape != b.shape:
                return None
            greatest = max(greatest, float(np.linalg.norm(a - b, axis=1).max()))
    return greatest


@dataclass
class Finding:
    """What is known of a scene once it has run. Energies are parts of its m g L, lengths of that of its longest cable."""
    name: str
    family: str
    error: str = ''
    statuses: Counter = field(default_factory=Counter)
    unaccounted: float = 0.0
    gain: float = 0.0
    force: float = 0.0  # [N]
    speed: float = 0.0  # [m/s]
    force_ratio: Optional[float] = None  # over that of the refined run
    step_difference: Optional[float] = None  # between 1 ms and half of it

    @property
    def is_ok(self):
        return not self.error and set(self.statuses) == {'ok'}

    @property
    def closes(self):
        return abs(self.unaccounted) <= CLOSED and self.gain <= CLOSED


def audit(scene, refines=True):
    finding = Finding(scene.name, scene.family)
    try:
        run = simulate(scene)
    except ValueError as error:  # of the scene, or of a command to a winch
        finding.error = str(error).splitlines()[0]
        return finding
    finding.statuses = run.statuses
    finding.unaccounted, finding.gain = run.unaccounted / scene.energy, run.gain / scene.energy
    finding.force, finding.speed = run.largest_force(TIME_STEP), run.speed
    if refines:
        half, fine = simulate(scene, 0.5 * TIME_STEP), simulate(scene, TIME_STEP / STEP_PARTS, SEGMENT_PARTS)
        apart = difference(run, half)
        finding.step_difference = None if apart is None else apart / scene.length
        finding.force_ratio = finding.force / fine.largest_force(TIME_STEP / STEP_PARTS)
    return finding
