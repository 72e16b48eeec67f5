from verlet_cable._simulation import Batch as Batch
from verlet_cable._simulation import Event as Event
from verlet_cable._simulation import Load as Load
from verlet_cable._simulation import Pieces as Pieces
from verlet_cable._simulation import Pinned as Pinned
from verlet_cable._simulation import Scene as Scene
from verlet_cable._simulation import SceneError as SceneError
from verlet_cable._simulation import World as World
from verlet_cable._simulation import Worlds as Worlds

__all__ = ['Batch', 'Event', 'Load', 'Pieces', 'Pinned', 'Scene', 'SceneError', 'World', 'Worlds']
