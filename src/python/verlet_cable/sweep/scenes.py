"""The scenes of a sweep's samples."""
import copy

from verlet_cable.sim import Scene

from .description import MOTION
from .paths import holder_of, parse_path


class Scenes:
    """The scenes of draws: one tree, into which their values are put in turn."""

    def __init__(self, sweep):
        self._folder = sweep.scene_folder
        self._tree = copy.deepcopy(sweep.tree)
        self._places = []
        for key, variation in sweep.variations.items():
            if key != MOTION:
                parts = parse_path(key)
                self._places.append((holder_of(self._tree, parts), parts[-1], key, variation))

    def of(self, draw):
        for holder, part, key, variation in self._places:
            holder[part] = variation.scene_value(draw[key])
        return Scene.from_dict(self._tree, directory=self._folder)
