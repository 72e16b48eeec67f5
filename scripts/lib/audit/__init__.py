"""Random ordinary scenes, and whether energy and forces are right in them: scripts/audit."""
import numpy as np

from audit import bodies, cables
from audit.scenes import AuditScene

KINDS = dict(cables=cables.FAMILIES, bodies=bodies.FAMILIES)
MOVING = 0.7  # of a scene's time; then hands stand


def make_scene(kind, index, seed=1, seconds=3.0):
    """The same scene for the same arguments; families take turns."""
    families = list(KINDS[kind])
    family = families[index % len(families)]
    random = np.random.default_rng([seed, list(KINDS).index(kind), index])
    keys, hands, *winches = KINDS[kind][family](random, MOVING * seconds)
    return AuditScene(kind, family, index, seconds, keys, hands, winches[0] if winches else [])
