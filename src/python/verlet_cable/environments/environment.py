"""One world, or many that step together, with the interface of Gymnasium."""
import numpy

from verlet_cable.environments import arguments
from verlet_cable.environments.episodes import Episodes
from verlet_cable.environments.interface import AutoresetMode, Env, VectorEnv, batch_box

RENDER_MODES = ['rgb_array']
FRAMES_PER_SECOND = 50  # a picture a step


def refuse(call, reason):
    raise RuntimeError(f'{call}: {reason}')


class Environment(Env):
    """A task in one world, with the interface of gymnasium.Env."""

    metadata = {'render_modes': RENDER_MODES, 'render_fps': FRAMES_PER_SECOND}

    def __init__(self, task, max_episode_steps, render_mode):
        self.render_mode = arguments.read_render_mode(render_mode, RENDER_MODES)
        self.task = task
        self.observation_space = task.make_observation_space()
        self.action_space = task.make_action_space()
        self._episodes = Episodes(task, 1, 1, max_episode_steps)

    def reset(self, *, seed=None, options=None):
        """Starts an episode; returns (observation, info)."""
        episodes = self._open('reset')
        options = arguments.read_options(options, [self.task.option])
        chosen = options.get(self.task.option)
        if chosen is not None:
            chosen = numpy.array([arguments.read_index(f'options[{self.task.option!r}]', chosen, self.task.variants)])
        super().reset(seed=arguments.read_seed('seed', seed))
        seen = episodes.begin(numpy.array([True]), [self.np_random], chosen)
        return seen.observation[0], self._info(seen)

    def step(self, action):
        """Performs a step; returns (observation, reward, terminated, truncated, info)."""
        episodes = self._open('step')
        if episodes.over[0]:
            refuse('step', 'the episode is over; call reset()' if episodes.begun else 'no episode has begun; call reset()')
        action = arguments.read_action('action', action, self.action_space)
        seen, reward, terminated, truncated = episodes.step(action[None], [self.np_random])
        return seen.observation[0], float(reward[0]), bool(terminated[0]), bool(truncated[0]), self._info(seen)

    def render(self):
        """A picture (rows, columns, 3) uint8, seen from above; None if render_mode is None."""
        episodes = self._open('render')
        if self.render_mode is None:
            return None
        if not episodes.begun:
            refuse('render', 'no episode has begun; call reset()')
        return episodes.draw(0)

    def close(self):
        """Frees the world. After it only close() may be called."""
        self._episodes = None

    def positions(self):
        """Nodes of the cable, (n + 1, 3) [m]."""
        return self._open('positions').worlds.positions()[0]

    def _open(self, call):
        if self._episodes is None:
            refuse(call, 'the environment is closed')
        return self._episodes

    @staticmethod
    def _info(seen):
        return {key: value[0].copy() if value.ndim > 1 else value[0].item() for key, value in seen.info.items()}


class VectorEnvironment(VectorEnv):
    """A task in many worlds, with the interface of gymnasium.vector.VectorEnv. `autoreset_mode`, an AutoresetMode or its value: when
    a world is reset whose episode has ended.

    NEXT_STEP: in the next step, which ignores its action, and whose reward is 0.
    SAME_STEP: in the step that has ended it. The observation is the first one of the next episode; infos['final_obs'] and
    infos['final_info'] are of the last moment of the one before, where infos['_final_obs'] says so.
    DISABLED: by reset(options={'reset_mask': ...}) alone; before that, step() raises RuntimeError.
    """

    metadata = {'render_modes': RENDER_MODES, 'render_fps': FRAMES_PER_SECOND, 'autoreset_mode': AutoresetMode.NEXT_STEP}

    def __init__(self, task, num_envs, max_episode_steps, render_mode, threads, autoreset_mode):
        self.autoreset_mode = arguments.read_mode('autoreset_mode', autoreset_mode, AutoresetMode)
        self.metadata = {**self.metadata, 'autoreset_mode': self.autoreset_mode}
        self.render_mode = arguments.read_render_mode(render_mode, RENDER_MODES)
        self.task = task
        self.num_envs = arguments.read_count('num_envs', num_envs)
        self._episodes = Episodes(task, self.num_envs, arguments.read_threads(threads), max_episode_steps)
        self._generators = [None] * self.num_envs
        self._seeds = [None] * self.num_envs
        self._begin_generators(self._seeds, numpy.ones(self.num_envs, dtype=bool))
        self.single_observation_space = task.make_observation_space()
        self.single_action_space = task.make_action_space()
        self.observation_space = batch_box(self.single_observation_space, self.num_envs)
        self.action_space = batch_box(self.single_action_space, self.num_envs)

    def reset(self, *, seed=None, options=None):
        """Starts episodes in all worlds, or in those selected by options['reset_mask'], (num_envs,) bool. seed: None; or a number
        for the first world, from which the others count up; or a sequence of numbers or None, one per world."""
        episodes = self._open('reset')
        options = arguments.read_options(options, ['reset_mask', self.task.option])
        mask = numpy.ones(self.num_envs, dtype=bool)
        if options.get('reset_mask') is not None:
            mask = arguments.read_mask("options['reset_mask']", options['reset_mask'], self.num_envs)
        chosen = options.get(self.task.option)
        if chosen is not None:
            chosen = arguments.read_indices(f'options[{self.task.option!r}]', chosen, self.num_envs, self.task.variants)
        self._begin_generators(arguments.read_seeds(seed, self.num_envs), mask)
        seen = episodes.begin(mask, self._generators, chosen)
        return seen.observation, self._infos(seen, mask)

    def step(self, actions):
        """Performs a step in all worlds; returns (observations, rewards, terminations, truncations, infos)."""
        episodes = self._open('step')
        if not episodes.begun.all():
            refuse('step', 'no episode has begun in some worlds; call reset()')
        if self.autoreset_mode is AutoresetMode.DISABLED and episodes.over.any():
            worlds = ', '.join(map(str, numpy.flatnonzero(episodes.over)[:arguments.SHOWN]))
            refuse('step', f"episodes are over, of worlds {worlds}; call reset(options={{'reset_mask': terminations | truncations}})")
        actions = arguments.read_action('actions', actions, self.action_space)
        everywhere = numpy.ones(self.num_envs, dtype=bool)
        if self.autoreset_mode is AutoresetMode.NEXT_STEP:
            seen, rewards, terminated, truncated = episodes.step(actions, self._generators)
            return seen.observation, rewards, terminated, truncated, self._infos(seen, everywhere)
        seen, terminated, truncated = episodes.step_all(actions)
        ended = terminated | truncated
        if self.autoreset_mode is AutoresetMode.DISABLED or not ended.any():
            return seen.observation, seen.reward, terminated, truncated, self._infos(seen, everywhere)
        begun = episodes.begin(ended, self._generators)
        final = {'final_obs': numpy.where(ended[:, None], seen.observation, 0.0), '_final_obs': ended.copy(),
                 'final_info': self._infos(seen, ended), '_final_info': ended.copy()}
        return begun.observation, seen.reward, terminated, truncated, {**self._infos(begun, everywhere), **final}

    def render(self):
        """A picture of each world, see Environment.render; None if render_mode is None."""
        episodes = self._open('render')
        if self.render_mode is None:
            return None
        if not episodes.begun.all():
            refuse('render', 'no episode has begun in some worlds; call reset()')
        return tuple(episodes.draw(world) for world in range(self.num_envs))

    def close_extras(self, **options):
        """Frees the worlds, for close(). After it only close() may be called."""
        self._episodes = None

    def positions(self):
        """Nodes of the cables, (num_envs, n + 1, 3) [m]."""
        return self._open('positions').worlds.positions()

    @property
    def np_random(self):
        """The random number generators of the worlds, a tuple."""
        return tuple(self._generators)

    @property
    def np_random_seed(self):
        """The seeds of the random number generators of the worlds, a tuple; seeds that were not given are random."""
        return tuple(self._seeds)

    def _open(self, call):
        if self._episodes is None:
            refuse(call, 'the environment is closed')
        return self._episodes

    def _begin_generators(self, seeds, mask):
        for world in numpy.flatnonzero(mask):
            if seeds[world] is not None or self._generators[world] is None:
                sequence = numpy.random.SeedSequence(seeds[world])
                self._generators[world], self._seeds[world] = numpy.random.default_rng(sequence), sequence.entropy

    @staticmethod
    def _infos(seen, mask):
        infos = {}
        for key, value in seen.info.items():
            infos[key] = value.copy()
            infos[f'_{key}'] = mask.copy()
        return infos
