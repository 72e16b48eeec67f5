#!/usr/bin/python3
"""learn_to_lay.py OUTPUT_DIRECTORY [ITERATIONS [WORLDS]]: learns to lay a cable into clips by the cross-entropy method, and writes
the curve, lay_cable_learning.csv and .png, and the policy, lay_cable_policy.csv.

Without other numbers it takes some minutes on two cores. The same numbers give the same bytes. Needs the workspace's setup sourced.
"""
import pathlib
import sys
import time

import numpy as np

from verlet_cable.environments import LayCableVector
from verlet_cable.environments.lay_cable import CLIPS, LOW

ITERATIONS, WORLDS = 60, 64
STEPS = 200         # of an episode
ELITES = 10         # policies that the next ones are drawn around
HIDDEN = 8
INPUTS, OUTPUTS = 4, 3
SIZES = [(INPUTS, HIDDEN), (HIDDEN, OUTPUTS)]
WEIGHTS = sum(rows * columns for rows, columns in SIZES)
SPREAD, LEAST_SPREAD = 1.0, 0.05
NEAR = 0.05         # [m] in which inputs are given
HAND, CLIP, HELD = slice(306, 309), slice(312, 324), slice(324, 327)  # of an observation


def act(weights, observations):
    """Actions (count, 3) of policies (count, WEIGHTS) for what they see: where the hand is, as seen from the first clip that does not
    hold the cable, decides how it moves along that clip, across and up."""
    count = len(observations)
    held = observations[:, HELD] > 0
    clip = observations[:, CLIP].reshape(count, CLIPS, 4)[np.arange(count), held.argmin(axis=1)]
    hand, along = observations[:, HAND], clip[:, 2:]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)
    away = hand[:, :2] - clip[:, :2]
    seen = np.stack([(away * along).sum(axis=1) / NEAR, (away * across).sum(axis=1) / NEAR, (hand[:, 2] - LOW[2]) / NEAR,
                     np.ones(count)], axis=1)
    first = weights[:, :INPUTS * HIDDEN].reshape(count, INPUTS, HIDDEN)
    second = weights[:, INPUTS * HIDDEN:].reshape(count, HIDDEN, OUTPUTS)
    moves = np.tanh(np.einsum('wh,who->wo', np.tanh(np.einsum('wi,wih->wh', seen, first)), second))
    plane = moves[:, :1] * along + moves[:, 1:2] * across
    actions = np.clip(np.concatenate([plane, moves[:, 2:]], axis=1), -1, 1)
    return np.where(held.all(axis=1)[:, None], 0.0, actions)


def run(environments, weights, layouts):
    """Mean reward of an episode, (count,), and how many clips hold the cable at its end, (count,)."""
    observations, infos = environments.reset(options={'layout': layouts})
    total = np.zeros(len(weights))
    for _ in range(STEPS):
        observations, rewards, _, _, infos = environments.step(act(weights, observations))
        total += rewards
    return total / STEPS, infos['held'].sum(axis=1)


def learn(iterations, worlds):
    """Yields (mean reward of all, of the elites, mean number of clips at the end of the elites' episodes, the policy)."""
    generator = np.random.default_rng(1)
    environments = LayCableVector(worlds, reward='dense', max_episode_steps=None)
    mean, spread = np.zeros(WEIGHTS), np.full(WEIGHTS, SPREAD)
    for _ in range(iterations):
        policies = mean + spread * generator.standard_normal((worlds, WEIGHTS))
        layout = np.full(worlds, generator.integers(environments.task.variants))  # the same for all: it is policies that compete
        rewards, held = run(environments, policies, layout)
        best = np.argsort(-rewards, kind='stable')[:ELITES]
        mean = policies[best].mean(axis=0)
        spread = np.maximum(policies[best].std(axis=0), LEAST_SPREAD)
        yield rewards.mean(), rewards[best].mean(), held[best].mean(), mean
    environments.close()


def clips_held(policy):
    """In each of all layouts, after an episode of the policy."""
    environments = LayCableVector(LayCableVector().task.variants, max_episode_steps=None)
    layouts = np.arange(environments.num_envs)
    return run(environments, np.tile(policy, (len(layouts), 1)), layouts)[1]


def plot(curve, path):
    import matplotlib
    matplotlib.use('Agg')
    import matplotlib.pyplot as plt
    figure, place = plt.subplots(figsize=(7, 3.2), constrained_layout=True)
    place.plot(curve[:, 1], curve[:, 2], label='reward, mean of all policies')
    place.plot(curve[:, 1], curve[:, 3], label='reward, mean of the elites')
    place.plot(curve[:, 1], curve[:, 4], label='clips that hold the cable at the end, elites')
    place.set(xlabel='steps of the environments', ylabel='reward, clips', ylim=(0, 3.1))
    place.legend()
    place.grid(alpha=0.3)
    figure.savefig(path, dpi=100, metadata={'Software': None})


def main():
    output = pathlib.Path(sys.argv[1])
    iterations, worlds = [int(argument) for argument in sys.argv[2:]] + [ITERATIONS, WORLDS][len(sys.argv) - 2:]
    begin, curve = time.perf_counter(), []
    for k, (everyone, elites, held, policy) in enumerate(learn(iterations, worlds)):
        steps = (k + 1) * STEPS * worlds
        curve.append((k + 1, steps, everyone, elites, held))
        seconds = time.perf_counter() - begin
        print(f'{k + 1}: {seconds:.0f} s, {steps / seconds:.0f} steps/s, reward {everyone:.3f}, elites {elites:.3f} with {held:.2f} clips',
              flush=True)
    output.mkdir(parents=True, exist_ok=True)
    np.savetxt(output / 'lay_cable_learning.csv', curve, fmt=['%d', '%d', '%.6f', '%.6f', '%.6f'], delimiter=',', comments='',
               header='iteration,steps,reward,reward_of_elites,clips_of_elites')
    np.savetxt(output / 'lay_cable_policy.csv', policy, fmt='%.9g')
    plot(np.array(curve), output / 'lay_cable_learning.png')
    held = clips_held(policy)
    print(f'the last policy: {held.mean():.2f} clips on the average of {len(held)} layouts, all of them in {(held == CLIPS).sum()}')


if __name__ == '__main__':
    main()
