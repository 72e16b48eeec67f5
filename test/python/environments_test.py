"""The environments: Gymnasium's interface, the same bytes whatever steps beside, and what is rewarded."""
import copy
import inspect
import os
import pickle
import subprocess
import sys
import textwrap
import threading
from pathlib import Path

import numpy
import pytest
from conftest import DEVEL

from verlet_cable.environments import AutoresetMode, LayCable, LayCableVector, ShapeRope, ShapeRopeVector, lay_cable
from verlet_cable.environments.task import YIELDING, give_way

CHECKOUT = Path(__file__).resolve().parents[2]
PAIRS = [(ShapeRope, ShapeRopeVector), (LayCable, LayCableVector)]


@pytest.fixture(params=[ShapeRope, LayCable])
def environment(request):
    with request.param(max_episode_steps=50) as made:
        yield made


def actions_of(space, seed, steps):
    space.seed(seed)
    return [space.sample() for _ in range(steps)]


def same(first, second):
    """Whether two results of step or reset are the same, to the last bit."""
    if isinstance(first, (tuple, list)):
        return len(first) == len(second) and all(map(same, first, second))
    if isinstance(first, dict):
        return first.keys() == second.keys() and all(same(first[key], second[key]) for key in first)
    return type(first) is type(second) and numpy.array_equal(first, second)


# What gymnasium.utils.env_checker.check_env asks of an environment

def test_reset_and_step_return_what_gymnasium_asks_for(environment):
    signature = inspect.signature(environment.reset).parameters
    assert signature['seed'].default is None and signature['options'].default is None
    assert environment.unwrapped is environment and not hasattr(environment, 'seed')
    observation, info = environment.reset()
    assert observation in environment.observation_space and isinstance(info, dict)
    observation, info = environment.reset(options={})
    for _ in range(50):
        observation, reward, terminated, truncated, info = environment.step(environment.action_space.sample())
        assert observation in environment.observation_space and observation.dtype == environment.observation_space.dtype
        assert type(reward) is float and numpy.isfinite(reward)
        assert type(terminated) is bool and type(truncated) is bool and isinstance(info, dict)
    assert truncated and not terminated


def test_a_seed_decides_what_is_drawn(environment):
    first, info = environment.reset(seed=123)
    generator = environment.np_random.bit_generator.state
    second = environment.reset()
    again, _ = environment.reset(seed=123)
    assert environment.np_random.bit_generator.state == generator
    assert same(first, again) and same(second, environment.reset())
    environment.reset(seed=456)
    assert environment.np_random.bit_generator.state != generator
    starts = [environment.reset(seed=seed)[0] for seed in range(8)]
    assert any(not same(starts[0], start) for start in starts)


@pytest.mark.parametrize('single, vector', PAIRS)
def test_episodes_last_as_long_as_is_asked_for(single, vector):
    for limit in (1, 3, None):
        one, many = single(max_episode_steps=limit), vector(2, max_episode_steps=limit)
        one.reset()
        many.reset()
        for step in range(1, 4 if limit is None else limit + 1):
            truncated = one.step(numpy.zeros(3))[3]
            assert truncated == (step == limit) and (many.step(numpy.zeros((2, 3)))[3] == truncated).all()


def test_a_step_draws_nothing(environment):
    environment.reset(seed=1)
    generator = environment.np_random.bit_generator.state
    environment.step(environment.action_space.sample())
    assert environment.np_random.bit_generator.state == generator


def test_spaces_are_plain_and_bounded(environment):
    box = environment.action_space
    assert box.shape == box.low.shape == box.high.shape and (box.low == -1).all() and (box.high == 1).all()
    samples = numpy.array(actions_of(box, 1, 200))
    assert all(sample in box for sample in samples) and samples.min() < -0.9 and samples.max() > 0.9
    assert same(actions_of(box, 3, 5), actions_of(box, 3, 5))
    assert numpy.full(box.shape, numpy.nan) not in box and numpy.full(box.shape, 1.1) not in box and numpy.zeros(2) not in box
    assert environment.observation_space.sample() in environment.observation_space


def test_render(environment):
    environment.reset()
    assert environment.render() is None
    made = type(environment)(render_mode='rgb_array')
    assert made.metadata['render_modes'] == ['rgb_array'] and made.metadata['render_fps'] == 50
    made.reset(seed=1)
    picture = made.render()
    assert picture.dtype == numpy.uint8 and picture.ndim == 3 and picture.shape[2] == 3
    for _ in range(10):
        made.step(numpy.ones(3))
    assert (made.render() != picture).any()


def test_what_is_closed_or_has_not_begun_does_not_step(environment):
    action = numpy.zeros(3)
    with pytest.raises(RuntimeError, match=r'reset\(\)'):
        environment.step(action)
    environment.reset()
    for _ in range(50):
        environment.step(action)
    with pytest.raises(RuntimeError, match='over'):
        environment.step(action)
    environment.close()
    environment.close()
    for call in (environment.reset, environment.render, lambda: environment.step(action)):
        with pytest.raises(RuntimeError, match='closed'):
            call()


@pytest.mark.parametrize('action, text', [
    (numpy.zeros(2), r'action: shape \(2,\); allowed: \(3,\)'),
    (numpy.zeros((1, 3)), r'action: shape \(1, 3\); allowed: \(3,\)'),
    ([0, numpy.nan, 0], r'action\[1\]: nan; allowed: -1.0 to 1.0'),
    ([0, 2, -numpy.inf], r'action\[1\]: 2.0, action\[2\]: -inf; allowed: -1.0 to 1.0'),
    ('left', r"action: 'left'; allowed: real numbers, of shape \(3,\)"),
    (['0', '0', '0'], 'action: '),
    (None, 'action: '),
    (numpy.zeros(3, dtype=complex), r'action: array\(.*\); allowed: real numbers, of shape \(3,\)'),
    ([0, 1j, 0], r'action: \[0, 1j, 0\]; allowed: real numbers'),
    ([0, [1, 2], 0], r'action: \[0, \[1, 2\], 0\]; allowed: real numbers'),
])
def test_a_wrong_action_changes_nothing(environment, action, text):
    environment.reset(seed=5)
    with pytest.raises(ValueError, match=text):
        environment.step(action)
    after = environment.step(numpy.full(3, 0.5))
    environment.reset(seed=5)
    assert same(after, environment.step(numpy.full(3, 0.5)))


def test_wrong_arguments():
    for wrong, text in (({'max_episode_steps': 0}, 'max_episode_steps: 0; allowed: whole numbers from 1 to 1000000, or None'),
                        ({'goals': 1.5}, 'goals: 1.5'),
                        ({'render_mode': 'human'}, "render_mode: 'human'; allowed: None, 'rgb_array'")):
        with pytest.raises(ValueError, match=text):
            ShapeRope(**wrong)
    for count in (-1, 0, True, 2.0, 10**9, 10**30, None):
        with pytest.raises(ValueError, match=f'num_envs: {count}; allowed: whole numbers from 1 to 1000000'):
            LayCableVector(count)
    for threads in (-1, 1025, 1.5, True, None, 10**30, 'all'):
        with pytest.raises(ValueError, match=f'threads: {threads!r}; allowed: 0, as many as there are cores, to 1024'):
            LayCableVector(2, threads=threads)
    environment = ShapeRope(goals=4)
    for wrong, text in (({'seed': -1}, 'seed: -1'), ({'seed': 1.5}, 'seed: 1.5'),
                        ({'options': {'gaol': 1}}, "'gaol'; allowed: 'goal'"),
                        ({'options': {'goal': 4}}, r"options\['goal'\]: 4; allowed: whole numbers from 0 to 3"),
                        ({'options': 3}, 'options: 3')):
        with pytest.raises(ValueError, match=text):
            environment.reset(**wrong)
    vector = ShapeRopeVector(3, goals=4)
    for seed in (1.5, 'one', float('nan'), b'123', numpy.array(1.5)):
        with pytest.raises(ValueError, match=r'seed: .*; allowed: None, a whole number from 0, or 3 of them, one a world'):
            vector.reset(seed=seed)
    for wrong, text in (({'seed': [1, 2]}, 'seed: 2 numbers'), ({'seed': True}, 'seed: True'), ({'seed': [1, 2, -3]}, r'seed\[2\]: -3'),
                        ({'options': {'reset_mask': [True]}}, r"options\['reset_mask'\]: \[True\]"),
                        ({'options': {'reset_mask': numpy.zeros(3, bool)}}, 'at least one'),
                        ({'options': {'goal': [0, 1, 9]}}, r"options\['goal'\]\[2\]: 9")):
        with pytest.raises(ValueError, match=text):
            vector.reset(**wrong)
    with pytest.raises(RuntimeError, match=r'reset\(\)'):
        vector.step(numpy.zeros((3, 3)))


# Many worlds

@pytest.mark.parametrize('single, vector', PAIRS)
@pytest.mark.parametrize('threads', [1, 2])
def test_each_of_many_worlds_is_the_one_with_its_seed(single, vector, threads):
    count, steps, limit = 19, 40, 15
    many = vector(count, threads=threads, max_episode_steps=limit)
    assert many.metadata['autoreset_mode'] is AutoresetMode.NEXT_STEP
    results = [many.reset(seed=7)]
    actions = actions_of(many.action_space, 2, steps)
    for each in actions:
        results.append(many.step(each))
        assert results[-1][0] in many.observation_space
    for world in (0, 5, count - 1):
        one = single(max_episode_steps=limit)
        observation, info = one.reset(seed=7 + world)
        assert same(results[0][0][world], observation)
        ended = False
        for result, each in zip(results[1:], actions):
            if ended:
                expected = (*one.reset()[:1], 0.0, False, False)
            else:
                *expected, info = one.step(each[world])
                for key, value in info.items():
                    assert numpy.array_equal(result[4][key][world], value) and result[4]['_' + key][world]
            ended = expected[3]
            assert all(numpy.array_equal(given[world], value) for given, value in zip(result, expected))


@pytest.mark.parametrize('vector', [ShapeRopeVector, LayCableVector])
def test_reset_of_some_worlds_leaves_the_others_as_they_are(vector):
    count = 6
    kept, disturbed = vector(count), vector(count)
    kept.reset(seed=3)
    disturbed.reset(seed=3)
    mask = numpy.array([False, True, False, False, True, False])
    for k, actions in enumerate(actions_of(kept.action_space, 4, 30)):
        if k == 10:
            observation, infos = disturbed.reset(seed=11, options={'reset_mask': mask})
            assert all((infos[key] == mask).all() for key in infos if key.startswith('_'))
        expected, given = kept.step(actions), disturbed.step(actions)
        assert all(same(a[~mask], b[~mask]) for a, b in zip(expected[:4], given[:4]))
        assert k < 10 or not same(expected[0][mask], given[0][mask])


@pytest.mark.parametrize('single, vector', PAIRS)
def test_worlds_that_are_reset_in_the_same_step_tell_how_their_episodes_ended(single, vector):
    count, limit = 5, 4
    same_step = vector(count, max_episode_steps=limit, autoreset_mode='SameStep')
    assert same_step.metadata['autoreset_mode'] is AutoresetMode.SAME_STEP and vector.metadata['autoreset_mode'] is AutoresetMode.NEXT_STEP
    ones = [single(max_episode_steps=limit) for _ in range(count)]
    first, _ = same_step.reset(seed=5)
    assert same(first, numpy.stack([one.reset(seed=5 + i)[0] for i, one in enumerate(ones)]))
    same_step.reset(options={'reset_mask': numpy.arange(count) == 3})  # it ends its episodes later than the others
    ones[3].reset()
    for k, actions in enumerate(actions_of(same_step.action_space, 3, 10)):
        if k == 2:
            same_step.reset(options={'reset_mask': numpy.arange(count) == 3})
            ones[3].reset()
        observation, reward, terminated, truncated, infos = same_step.step(actions)
        for i, one in enumerate(ones):
            *expected, info = one.step(actions[i])
            assert same([reward[i].item(), bool(terminated[i]), bool(truncated[i])], expected[1:])
            if not truncated[i]:
                assert same(observation[i], expected[0]) and not infos.get('_final_obs', numpy.zeros(count, bool))[i]
                continue
            assert infos['_final_obs'][i] and infos['_final_info'][i] and same(infos['final_obs'][i], expected[0])
            assert all(numpy.array_equal(infos['final_info'][key][i], value) and infos['final_info']['_' + key][i]
                       for key, value in info.items())
            assert same(observation[i], one.reset()[0])


def test_worlds_that_are_not_reset_by_themselves_wait_for_it():
    many = ShapeRopeVector(3, max_episode_steps=2, goals=4, autoreset_mode=AutoresetMode.DISABLED)
    many.reset(seed=1)
    many.step(numpy.zeros((3, 3)))
    many.reset(options={'reset_mask': numpy.array([True, False, False])})
    _, reward, _, truncated, _ = many.step(numpy.zeros((3, 3)))
    assert truncated.tolist() == [False, True, True] and (reward < 0).all()
    with pytest.raises(RuntimeError, match=r"step: episodes are over, of worlds 1, 2; call reset\(options="):
        many.step(numpy.zeros((3, 3)))
    many.reset(options={'reset_mask': truncated})
    assert many.step(numpy.zeros((3, 3)))[3].tolist() == [True, False, False]
    with pytest.raises(ValueError, match='autoreset_mode: 3; allowed: AutoresetMode.NEXT_STEP'):
        ShapeRopeVector(2, autoreset_mode=3)


def test_worlds_tell_their_seeds():
    many, one = ShapeRopeVector(2, goals=4), ShapeRope(goals=4)
    drawn = many.np_random_seed
    assert len(set(drawn)) == 2 and all(type(seed) is int for seed in drawn) and len(many.np_random) == 2
    many.reset()
    assert many.np_random_seed == drawn
    again = ShapeRopeVector(2, goals=4)
    assert same(many.reset()[0], (again.reset(seed=drawn), again.reset())[1][0])
    many.reset(seed=3)
    one.reset(seed=3)
    assert many.np_random_seed == (3, 4) and one.np_random_seed == 3
    many.reset(seed=[8, numpy.int64(9)], options={'reset_mask': numpy.array([False, True])})
    assert many.np_random_seed == (3, 9)
    many.reset(seed=[None, 7])
    assert many.np_random_seed == (3, 7)


def test_worlds_ask_for_what_is_to_be_done():
    vector = ShapeRopeVector(3, goals=5)
    assert vector.reset(options={'goal': [4, 0, 2]})[1]['goal'].tolist() == [4, 0, 2]
    assert vector.reset(options={'goal': 3})[1]['goal'].tolist() == [3, 3, 3]
    mask = numpy.array([False, True, False])
    assert vector.reset(options={'goal': 1, 'reset_mask': mask})[1]['goal'].tolist() == [3, 1, 3]
    vector.close()
    vector.close()
    assert vector.closed
    with pytest.raises(RuntimeError, match='closed'):
        vector.step(numpy.zeros((3, 3)))


# What is rewarded

def test_a_goal_is_reached_by_the_motion_it_was_made_by():
    environment = ShapeRope()
    for goal in (0, 17, 63):
        observation, info = environment.reset(options={'goal': goal})
        assert info['distance'] > 0.02
        for action in environment.task.demonstrations[goal]:
            observation, reward, terminated, truncated, info = environment.step(action)
        assert reward == -info['distance'] == 0


def test_goals_do_not_depend_on_how_many_there_are():
    assert same(ShapeRope(goals=3).task.goals, ShapeRope(goals=9).task.goals[:3])


def test_shape_reward_is_minus_the_mean_distance():
    environment = ShapeRope()
    environment.reset(seed=2)
    observation, reward, *_ = environment.step(numpy.array([0.3, -0.8, 0.5]))
    nodes, goal = observation[:153].reshape(51, 3), observation[312:465].reshape(51, 3)
    assert (nodes == environment.positions()).all()
    assert abs(reward + numpy.sqrt(((nodes - goal) ** 2).sum(axis=1)).mean()) < 1e-12


def test_leading_the_end_through_the_clips_lays_the_cable():
    task = LayCable().task
    vector = LayCableVector(task.variants, max_episode_steps=1000)
    assert (vector.reset(options={'layout': numpy.arange(task.variants)})[1]['held'].sum(axis=1) == 0).all()
    rewards = []
    for actions in task.demonstrations.swapaxes(0, 1):
        rewards.append(vector.step(actions)[1])
    assert (rewards[-1] == 3).all()
    assert set(numpy.unique(rewards)) == {0, 1, 2, 3}


def test_a_dense_reward_grows_on_the_way_and_is_no_less_than_the_clips():
    task = LayCable(reward='dense').task
    layouts = numpy.arange(task.variants)
    dense, clips = LayCableVector(task.variants, reward='dense', max_episode_steps=1000), LayCableVector(task.variants, max_episode_steps=1000)
    for each in (dense, clips):
        each.reset(options={'layout': layouts})
    rewards, counts = [], []
    for actions in task.demonstrations.swapaxes(0, 1):
        rewards.append(dense.step(actions)[1])
        counts.append(clips.step(actions)[1])
    rewards, counts = numpy.array(rewards), numpy.array(counts)
    assert (rewards >= counts).all() and (rewards - counts < 0.9 + 1e-12).all() and (rewards[-1] == 3).all()
    # Up to the first clip: from where the hand begins there are few steps back.
    for world in range(task.variants):
        way = rewards[:numpy.argmax(counts[:, world] > 0), world]
        assert way[-1] > 0.6 and (numpy.diff(way) > -1e-12).mean() > 0.8
    with pytest.raises(ValueError, match="reward: 'sparse'; allowed: 'clips', 'dense'"):
        LayCable(reward='sparse')


def test_the_way_through_a_clip_is_through_its_middle():
    clip = numpy.array([[0.2, 0.01, 0.8, 0.6]])
    along, across = numpy.array([0.8, 0.6]), numpy.array([-0.6, 0.8])

    def way(forward, aside, up):
        place = numpy.array([[*(clip[0, :2] + forward * along + aside * across), lay_cable.LOW[2] + up]])
        return lay_cable.way_through(place, clip)[0]

    lead = lay_cable.LEAD
    assert way(-lead, 0, 0) == pytest.approx(2 * lead) and way(0, 0, 0) == pytest.approx(lead) and way(lead, 0, 0) == pytest.approx(0, abs=1e-12)
    assert way(0, 0.006, 0) == pytest.approx(numpy.hypot(lead, 0.006) + 2 * lead)  # beside the clip: it has to go back
    assert way(0, 0, 0.02) > way(0, 0, 0.005) > way(0, 0, 0)
    assert way(lead + 0.01, 0.01, 0) > way(-lead, 0.01, 0) > way(-lead, 0, 0)


@pytest.mark.parametrize('vector, first, count', [(ShapeRopeVector, 465, 1), (LayCableVector, 327, 3)])
def test_contacts_are_seen(vector, first, count):
    many = vector(2)
    observation, _ = many.reset(seed=1)
    if vector is ShapeRopeVector:
        # The table bears the rope, but for what the hand and the pin do.
        assert observation[0, -1] == pytest.approx(-0.020 * 9.81, rel=0.3)
    else:
        assert observation.shape[1] == first + 3 * count and (observation[:, first:] == 0).all()
        many.reset(options={'layout': numpy.array([3, 3])})
        seen = []
        for action in many.task.demonstrations[3]:
            seen.append(many.step(numpy.stack([action, action]))[0][0, first:].reshape(count, 3))
        strongest = abs(numpy.array(seen)).max(axis=(0, 2))
        assert (strongest > 1e-3).all() and (strongest < 20).all()


def test_a_cable_that_is_not_led_through_clips_earns_nothing():
    environment = LayCable()
    environment.reset(seed=1)
    for _ in range(100):
        _, reward, *_ = environment.step(numpy.array([0.0, 0.0, 0.2]))
    assert reward == 0


def test_a_clip_holds_what_passes_between_its_posts():
    clips = numpy.array([[[0.5, 0.1, 0.6, 0.8]]])  # x, y, and the direction
    straight = numpy.outer(numpy.linspace(-0.105, 0.1, 21), [0.6, 0.8, 0]) + [0.5, 0.1, 0.002]
    across = numpy.array([-0.8, 0.6, 0])
    for nodes, held in ((straight, True), (straight[::-1], True), (straight + 0.0039 * across, True), (straight + [0, 0, 0.017], True),
                        (straight + 0.0041 * across, False), (straight - 0.0041 * across, False), (straight + [0, 0, 0.019], False),
                        (straight[:10], False), (straight[12:], False), (straight - 0.1 * straight[0], False)):
        assert lay_cable.held_by_clips(nodes[None], clips).tolist() == [[held]]


def nothing_held(layout):
    return lay_cable.Seen(None, numpy.zeros((1, 3)), None, {'held': numpy.zeros((1, 3), dtype=bool), 'layout': numpy.array([layout])})


def test_hands_stay_where_they_can_be():
    task = LayCable().task
    generator = numpy.random.default_rng(1)
    hand = task.hand_of[:1]
    for step in range(1000):
        if step % 40 == 0:
            action = generator.choice([-1.0, 1.0], size=(1, 3))
        hand = task.move(hand, action, nothing_held(0))
        assert (hand >= lay_cable.LOW - 1e-12).all() and (hand <= lay_cable.HIGH + 1e-12).all()
        assert ((hand - [0, 0, lay_cable.LOW[2]]) ** 2).sum() <= lay_cable.REACH ** 2 + 1e-12


def test_hands_do_not_sink_where_the_cable_reaches_no_further():
    task = LayCable().task
    for action in ([1.0, 1, 0], [1.0, 0.4, -1]):
        hand = numpy.array([[0.4, 0.2, lay_cable.LOW[2]]])
        for _ in range(60):
            hand = task.move(hand, numpy.array([action]), nothing_held(0))
            assert hand[0, 2] >= lay_cable.LOW[2] - 1e-15


def test_hands_do_not_go_further_than_the_cable_that_clips_leave_them():
    task = LayCable().task
    seen = lay_cable.Seen(None, numpy.zeros((1, 3)), None, {'held': numpy.array([[True, True, True]]), 'layout': numpy.array([0])})
    hand = numpy.array([[0.4, 0.0, 0.012]])
    for _ in range(200):
        hand = task.move(hand, numpy.array([[1.0, 0.3, 0.1]]), seen)
    places = numpy.zeros((5, 3)) + [0, 0, lay_cable.LOW[2]]
    places[1:4, :2] = task.layouts[0, :, :2]
    places[4] = hand[0]
    length = numpy.sqrt((numpy.diff(places, axis=0) ** 2).sum(axis=1)).sum()
    assert length == pytest.approx(lay_cable.REACH) or (hand[0] == lay_cable.HIGH).any()


def test_hands_do_not_enter_posts():
    task = LayCable().task
    post = task.posts[3, 2]
    seen = nothing_held(3)
    low, high = numpy.array([[*post - [0.02, 0.001], 0.012]]), numpy.array([[*post - [0.02, 0.001], 0.05]])
    for step in range(8):
        low, high = task.move(low, numpy.array([[1.0, 0, 0]]), seen), task.move(high, numpy.array([[1.0, 0, 0]]), seen)
        assert ((low[0, :2] - task.posts[3]) ** 2).sum(axis=1).min() >= 0.999 * lay_cable.CLEARANCE ** 2
    assert abs(high[0] - [*post + [0.02, -0.001], 0.05]).max() < 1e-12


def test_hands_stop_at_posts_they_are_aimed_at():
    task = LayCable().task
    layouts, aim = numpy.arange(task.variants), numpy.array([1.0, -1.0, 0]) / numpy.sqrt(2)
    seen = lay_cable.Seen(None, numpy.zeros((task.variants, 3)), None,
                          {'held': numpy.zeros((task.variants, 3), dtype=bool), 'layout': layouts})
    for post in (0, 1):
        for away in (0.0071, 0.0098, 0.012):  # [m] from the middle, and a step is 0.0071 m long
            hand = numpy.full((task.variants, 3), 0.012)
            hand[:, :2] = task.posts[:, post] - away * aim[:2]
            for _ in range(5):
                hand = task.move(hand, numpy.tile([1.0, -1.0, 0], (task.variants, 1)), seen)
            middle = numpy.append(task.posts[:, post], numpy.full((task.variants, 1), 0.012), axis=1)
            assert hand == pytest.approx(middle - lay_cable.CLEARANCE * aim, abs=1e-6)


@pytest.mark.parametrize('held', [False, True])
def test_hands_go_beside_and_over_posts_no_faster_than_they_can(held):
    task, count = LayCable().task, 2000
    generator = numpy.random.default_rng(6)
    layouts = generator.integers(task.variants, size=count)
    posts = task.posts[layouts]
    seen = lay_cable.Seen(None, numpy.zeros((count, 3)), None, {'held': numpy.full((count, 3), held), 'layout': layouts})
    hand = numpy.zeros((count, 3))
    hand[:, :2] = posts.mean(axis=1) + generator.choice([-0.09, -0.01, 0.05], size=(count, 1))
    hand[:, 2] = generator.uniform(lay_cable.LOW[2], 0.04, count)
    hand[:, 2] = numpy.where(in_posts(hand, posts), 0.04, hand[:, 2])
    for step in range(60):
        if step % 5 == 0:  # to or past some post, up or down
            actions = generator.uniform(-1, 1, (count, 3))
            aim = posts[numpy.arange(count), generator.integers(6, size=count)] - hand[:, :2]
            aim += generator.normal(0, 0.004, (count, 2))
            actions[:, :2] = aim / abs(aim).max(axis=1)[:, None]
        moved = task.move(hand, actions, seen)
        way = lay_cable.SPEED * lay_cable.STEP_TIME * numpy.sqrt((actions ** 2).sum(axis=1))
        assert (numpy.sqrt(((moved - hand) ** 2).sum(axis=1)) <= way + 1e-8).all()
        for part in numpy.linspace(0, 1, 9):
            assert not in_posts(hand + part * (moved - hand), posts).any()
        hand = moved


def in_posts(hand, posts):
    """Whether hands (count, 3) are in posts (count, k, 2), (count,)."""
    distance = numpy.sqrt(((hand[:, None, :2] - posts) ** 2).sum(axis=2)).min(axis=1)
    return (distance < lay_cable.CLEARANCE - 1e-12) & (hand[:, 2] < lay_cable.TOP - 1e-12)


def test_a_hand_that_slides_around_a_post_is_not_torn():
    environment = LayCable()
    observation, _ = environment.reset(options={'layout': 13})
    for _ in range(80):
        hand = observation[306:309]
        observation, *_ = environment.step(numpy.array([1.0, -1.0, 0]))
        assert numpy.linalg.norm(observation[306:309] - hand) <= 0.0071
        assert numpy.linalg.norm(observation[309:312]) < 10


def test_a_hand_goes_over_the_cable_where_it_lies():
    environment = LayCable()
    observation, _ = environment.reset(options={'layout': 0})
    for _ in range(40):
        observation, *_ = environment.step(numpy.array([-1.0, -1.0, -1.0]))
        assert numpy.linalg.norm(observation[309:312]) < 6


def test_hands_give_way_to_what_is_stronger():
    velocity = numpy.array([[0.2, 0.1, 0.0], [0.2, 0.1, 0.0], [-0.2, 0.1, 0.0]])
    force = numpy.array([[-4.9, 0, 0], [-5.1, 0, 0], [-5.1, 0, 0]])  # [N]
    expected = numpy.array([[0.2, 0.1, 0], [-YIELDING, 0.1, 0], [-0.2 - YIELDING, 0.1, 0]])
    assert give_way(velocity, force, 5.0) == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize('vector', [ShapeRopeVector, LayCableVector])
def test_violent_actions_leave_numbers_finite(vector):
    many = vector(16, max_episode_steps=1000)
    many.reset(seed=1)
    generator = numpy.random.default_rng(3)
    for step in range(300):
        if step % 5 == 0:
            actions = generator.choice([-1.0, 1.0], size=(16, 3))
        observation, reward, terminated, truncated, _ = many.step(actions)
        assert numpy.isfinite(observation).all() and numpy.isfinite(reward).all()
        assert abs(observation[:, :153]).max() < 1.2  # [m] no part flies away
        assert abs(observation[:, 309:312]).max() < 300  # [N] nor is torn
    assert not terminated.any()


def test_a_world_that_had_to_stop_is_terminated_and_begins_anew(monkeypatch):
    monkeypatch.setattr('verlet_cable.environments.worlds.FAULT', 0)  # every world's, which are all well
    many = ShapeRopeVector(2, goals=2)
    first, _ = many.reset(options={'goal': 1})
    _, _, terminated, truncated, _ = many.step(numpy.ones((2, 3)))
    assert terminated.all() and not truncated.any()
    observation, reward, terminated, truncated, _ = many.step(numpy.ones((2, 3)))
    assert not terminated.any() and not truncated.any() and (reward == 0).all()
    assert same(observation[:, :312], first[:, :312])


def test_what_is_returned_is_the_callers_to_change():
    kept, changed = LayCableVector(2), LayCableVector(2)
    kept.reset(seed=1)
    observation, infos = changed.reset(seed=1)
    for actions in actions_of(kept.action_space, 1, 5):
        observation[:] = 7
        for value in infos.values():
            value[:] = 1
        expected = kept.step(actions)
        observation, _, _, _, infos = given = changed.step(actions)
        assert same(expected, given)


def test_a_copy_goes_on_by_itself(environment):
    environment.reset(seed=1)
    environment.step(numpy.ones(3))
    others = [copy.deepcopy(environment), pickle.loads(pickle.dumps(environment))]
    for _ in range(10):
        expected = environment.step(numpy.full(3, -0.5))
        for other in others:
            assert same(expected, other.step(numpy.full(3, -0.5)))
    for other in others:
        other.close()
    assert same(environment.reset()[0].shape, environment.observation_space.shape)


def test_environments_have_nothing_in_common(environment):
    other = type(environment)()
    assert other.action_space is not environment.action_space
    for array in (other.task.demonstrations, other.task.hand_of, other.task.start_of):
        with pytest.raises(ValueError, match='read-only'):
            array[:] = 0
    errors = []

    def use():
        try:
            each = type(environment)(max_episode_steps=1)
            for _ in range(20):
                each.reset()
                each.step(numpy.zeros(3))
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=use) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert errors == []


# With Gymnasium. It is no Debian package: what of it these environments use is written here, in a few lines.

GYMNASIUM = {
    '__init__.py': '''
        import numpy
        known = {}
        def register(id, **spec):
            known[id] = spec
        class Env:
            spec = None
            def reset(self, *, seed=None, options=None):
                if seed is not None:
                    self.np_random = numpy.random.default_rng(seed)
            @property
            def unwrapped(self):
                return self
        ''',
    'spaces.py': '''
        import numpy
        class Box:
            def __init__(self, low, high, shape=None, dtype=numpy.float32):
                self.shape = numpy.shape(low) if shape is None else shape
                self.low, self.high = numpy.full(self.shape, low, dtype), numpy.full(self.shape, high, dtype)
                self.dtype = numpy.dtype(dtype)
        ''',
    'vector.py': '''
        import enum
        class AutoresetMode(enum.Enum):
            NEXT_STEP = 'NextStep'
            SAME_STEP = 'SameStep'
            DISABLED = 'Disabled'
        class VectorEnv:
            closed = False
            def close(self):
                self.close_extras()
                self.closed = True
        ''',
}
USE = '''
import hashlib, importlib, sys
import numpy
from verlet_cable.environments import LayCable, LayCableVector
results = []
for environment, shape in ((LayCable(), (3,)), (LayCableVector(2, threads=1), (2, 3))):
    results.append(environment.reset(seed=3)[0])
    results += [environment.step(numpy.full(shape, 0.5))[0] for _ in range(5)]
print(hashlib.sha256(b''.join(result.tobytes() for result in results)).hexdigest())
if 'gymnasium' in sys.modules:
    import gymnasium, gymnasium.spaces, gymnasium.vector
    one, many = LayCable(), LayCableVector(2)
    assert isinstance(one, gymnasium.Env) and isinstance(many, gymnasium.vector.VectorEnv)
    for box, shape in ((one.observation_space, (336,)), (one.action_space, (3,)), (many.observation_space, (2, 336)),
                       (many.action_space, (2, 3)), (many.single_action_space, (3,))):
        assert type(box) is gymnasium.spaces.Box and box.shape == shape and box.dtype == numpy.float64
    assert many.metadata['autoreset_mode'] is gymnasium.vector.AutoresetMode.NEXT_STEP
    many.close()
    assert many.closed
    for name, limit in (('ShapeRope', 250), ('LayCable', 400)):
        spec = gymnasium.known[f'verlet_cable/{name}-v1']
        assert spec['max_episode_steps'] == limit and spec['vector_entry_point'] == f'verlet_cable.environments:{name}Vector'
        module, function = spec['entry_point'].split(':')
        make = getattr(importlib.import_module(module), function)
        assert make.metadata['render_modes'] == ['rgb_array']
        environment = make(render_mode='rgb_array')
        assert type(environment).__name__ == name and environment.render_mode == 'rgb_array'
        environment.reset(seed=1)
        assert not any(environment.step(numpy.zeros(3))[3] for _ in range(limit + 2))  # that is for gymnasium.make to say
    print('with Gymnasium')
'''


def run_beside(path):
    script = f'import sys; sys.path[:0] = {[str(path), str(DEVEL / "lib/python3/dist-packages")]}\n{USE}'
    return subprocess.run([sys.executable, '-c', script], check=True, stdout=subprocess.PIPE, text=True).stdout.split('\n')


def test_gymnasium_is_used_where_it_is_installed(tmp_path):
    without = run_beside(tmp_path / 'nothing')
    (tmp_path / 'gymnasium').mkdir()
    for name, text in GYMNASIUM.items():
        (tmp_path / 'gymnasium' / name).write_text(textwrap.dedent(text))
    with_it = run_beside(tmp_path)
    assert with_it[1] == 'with Gymnasium' and without[1] == ''
    assert with_it[0] == without[0]


# The worked example of the manual

def learning():
    sys.path.insert(0, str(CHECKOUT / 'scripts/lib'))
    import learn_to_lay
    return learn_to_lay


def test_the_policy_of_the_manual_lays_the_cable():
    policy = numpy.loadtxt(CHECKOUT / 'doc/python/environments/lay_cable_policy.csv')
    held = learning().clips_held(policy)
    assert len(held) == 32 and held.mean() > 2.5


def test_the_example_learns(tmp_path):
    """Two of its iterations, with as few worlds as it has elites and some: what it writes, and that it is the same again."""
    for name in ('first', 'second'):
        subprocess.run([sys.executable, str(CHECKOUT / 'scripts/lib/learn_to_lay.py'), str(tmp_path / name), '2', '16'], check=True,
                       stdout=subprocess.DEVNULL, env=dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path)))
    curve = numpy.loadtxt(tmp_path / 'first/lay_cable_learning.csv', delimiter=',', skiprows=1)
    assert curve[:, 1].tolist() == [3200, 6400] and (curve[:, 3] >= curve[:, 2]).all() and (curve[:, 2:] >= 0).all()
    for file in ('lay_cable_learning.csv', 'lay_cable_policy.csv'):
        assert (tmp_path / 'first' / file).read_bytes() == (tmp_path / 'second' / file).read_bytes()
    shown = CHECKOUT / 'doc/python/environments/lay_cable_learning.csv'
    assert shown.read_text().splitlines()[0] == (tmp_path / 'first/lay_cable_learning.csv').read_text().splitlines()[0]
