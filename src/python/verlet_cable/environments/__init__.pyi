import enum
from collections.abc import Sequence
from types import TracebackType
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

__all__ = ['AutoresetMode', 'Box', 'LayCable', 'LayCableVector', 'ShapeRope', 'ShapeRopeVector']

_Numbers = NDArray[np.float64]
_RenderMode = Literal['rgb_array'] | None
_Reward = Literal['clips', 'dense']

# Gymnasium's own where it is installed.
class AutoresetMode(enum.Enum):
    NEXT_STEP = 'NextStep'
    SAME_STEP = 'SameStep'
    DISABLED = 'Disabled'

class Box:
    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    low: _Numbers
    high: _Numbers
    def __init__(
        self, low: ArrayLike, high: ArrayLike, shape: Sequence[int] | None = None, dtype: DTypeLike = ..., seed: int | None = None,
    ) -> None: ...
    def seed(self, seed: int | None = None) -> Any: ...
    def sample(self) -> _Numbers: ...
    def contains(self, x: object) -> bool: ...
    def __contains__(self, x: object) -> bool: ...
    def __eq__(self, other: object) -> bool: ...

class _Task:
    demonstrations: _Numbers
    @property
    def variants(self) -> int: ...

class _ShapeRopeTask(_Task):
    goals: _Numbers

class _LayCableTask(_Task):
    layouts: _Numbers

class _Environment:
    metadata: dict[str, Any]
    render_mode: str | None
    observation_space: Box
    action_space: Box
    @property
    def np_random(self) -> np.random.Generator: ...
    @np_random.setter
    def np_random(self, generator: np.random.Generator) -> None: ...
    @property
    def np_random_seed(self) -> int: ...
    @property
    def unwrapped(self) -> Any: ...
    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[_Numbers, dict[str, Any]]: ...
    def step(self, action: ArrayLike) -> tuple[_Numbers, float, bool, bool, dict[str, Any]]: ...
    def render(self) -> Any: ...
    def close(self) -> None: ...
    def positions(self) -> _Numbers: ...
    def __enter__(self) -> Any: ...
    def __exit__(self, *error: type[BaseException] | BaseException | TracebackType | None) -> bool: ...

class _VectorEnvironment:
    metadata: dict[str, Any]
    render_mode: str | None
    autoreset_mode: AutoresetMode
    num_envs: int
    closed: bool
    single_observation_space: Box
    single_action_space: Box
    observation_space: Box
    action_space: Box
    @property
    def np_random(self) -> tuple[np.random.Generator, ...]: ...
    @property
    def np_random_seed(self) -> tuple[int, ...]: ...
    @property
    def unwrapped(self) -> Any: ...
    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None,
    ) -> tuple[_Numbers, dict[str, Any]]: ...
    def step(self, actions: ArrayLike) -> tuple[_Numbers, _Numbers, NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]: ...
    def render(self) -> Any: ...
    def close(self, **options: Any) -> None: ...
    def positions(self) -> _Numbers: ...

class ShapeRope(_Environment):
    task: _ShapeRopeTask
    def __init__(self, render_mode: _RenderMode = None, max_episode_steps: int | None = 250, goals: int = 64) -> None: ...

class ShapeRopeVector(_VectorEnvironment):
    task: _ShapeRopeTask
    def __init__(
        self, num_envs: int = 1, render_mode: _RenderMode = None, max_episode_steps: int | None = 250, goals: int = 64, threads: int = 0,
        autoreset_mode: AutoresetMode | str = ...,
    ) -> None: ...

class LayCable(_Environment):
    task: _LayCableTask
    def __init__(
        self, render_mode: _RenderMode = None, max_episode_steps: int | None = 400, reward: _Reward = 'clips',
    ) -> None: ...

class LayCableVector(_VectorEnvironment):
    task: _LayCableTask
    def __init__(
        self, num_envs: int = 1, render_mode: _RenderMode = None, max_episode_steps: int | None = 400, threads: int = 0,
        autoreset_mode: AutoresetMode | str = ..., reward: _Reward = 'clips',
    ) -> None: ...
