"""Follows a cable by clouds of points: a World is pulled to them. An example of a tracker; no ROS."""
import numpy as np

STIFFNESS = 4000.0    # [1/s^2] of the springs between nodes and cloud, per mass of a node
DAMPING = 40.0        # [1/s] of the motion of nodes relative to the cloud's, per mass of a node
HAND_RATE = 15.0      # [1/s] of the filter that finds where hands are, and how fast
PULL_TIME = 0.005     # [s] between looks at how far the cable is off
HELD_SEGMENTS = 3     # from an end on: so many show where its hand is
END_QUANTILE = 0.97   # of the points along the cable there: where it ends
MOST_POINTS = 600     # of a cloud that are used
GATE = 0.05           # [m] from the cable: what is further away is something else


class CloudTracker:
    """A cable of a world that hands hold at both ends.

    world: as the cable is when it is seen first, within GATE. cable: its name. hands: frames that hold its start and its end, and their
    positions [m]. radius, density: [m], [kg/m] of the cable. step: [s] of the world.
    """

    def __init__(self, world, cable, hands, radius, density, step):
        self._world, self._cable, self._radius, self._step = world, cable, radius, step
        self._hands = [(name, np.array(position, dtype=float), np.zeros(3)) for name, position in hands]
        nodes = world.positions(cable)
        self._mass = density * np.linalg.norm(np.diff(nodes, axis=0), axis=1).mean()
        self._random = np.random.default_rng(0)

    @property
    def nodes(self):
        """(n + 1, 3) [m] in the world's fixed frame."""
        return self._world.positions(self._cable)

    def update(self, cloud, duration):
        """cloud: (k, 3) [m] of points on the cable's surface, in the fixed frame, NaN left out; duration [s] since the last one."""
        if len(cloud) > MOST_POINTS:
            cloud = self._random.choice(cloud, MOST_POINTS, replace=False)
        steps = max(1, round(min(duration, PULL_TIME) / self._step))
        for _ in range(max(1, round(duration / (steps * self._step)))):
            self._pull(cloud, steps * self._step)
            for _ in range(steps):
                self._carry_hands()
                self._world.step(1)

    def _pull(self, cloud, duration):
        nodes, velocities = self.nodes, self._world.velocities(self._cable)
        segment, share, offset, distance = _nearest(cloud, nodes)
        is_near = distance < GATE
        segment, share, offset, distance = (array[is_near] for array in (segment, share, offset, distance))
        # To the surface, not to the centre line: a camera sees one side only.
        residual = offset * (1 - self._radius / np.maximum(distance, 1e-9))[:, None]
        sums, weights = np.zeros_like(nodes), np.zeros(len(nodes))
        for index, weight in ((segment, 1 - share), (segment + 1, share)):
            np.add.at(sums, index, weight[:, None] * residual)
            np.add.at(weights, index, weight)
        is_seen = weights > 0.5
        pulls = np.zeros_like(nodes)
        pulls[is_seen] = sums[is_seen] / weights[is_seen][:, None]
        for node in range(len(nodes)):
            force = self._mass * (STIFFNESS * pulls[node] - (DAMPING * velocities[node] if is_seen[node] else 0))
            self._world.apply_force(self._cable, node, force, duration=duration, name=f'cloud_{node}')
        self._move_hands(cloud[is_near], nodes, segment, residual, duration)

    def _move_hands(self, cloud, nodes, segment, residual, duration):
        """Each by what the cable is off beside it, and along it by how much further the cloud goes on."""
        last = len(nodes) - 2
        for index, (_, position, velocity) in enumerate(self._hands):
            at_end = segment < HELD_SEGMENTS if index == 0 else segment > last - HELD_SEGMENTS
            if np.count_nonzero(at_end) >= 5:
                end, inner = (nodes[0], nodes[HELD_SEGMENTS]) if index == 0 else (nodes[-1], nodes[-1 - HELD_SEGMENTS])
                outwards = (end - inner) / np.linalg.norm(end - inner)
                across = residual[at_end].mean(axis=0)
                across -= across.dot(outwards) * outwards
                beyond = np.quantile((cloud[at_end] - end) @ outwards, END_QUANTILE) - 0.5 * self._radius
                off = across + beyond * outwards
                velocity += HAND_RATE ** 2 * duration * off
                position += 2 * HAND_RATE * duration * off

    def _carry_hands(self):
        """Step by step: a hand that moves at once hits the cable."""
        for name, position, velocity in self._hands:
            position += velocity * self._step
            self._world.set_frame(name, position, [0, 0, 0, 1])


def _nearest(points, nodes):
    """Of each point: the segment that is nearest, where along it (0 to 1), the offset from there, and its length."""
    start, along = nodes[:-1], np.diff(nodes, axis=0)
    share = np.clip(np.einsum('kmi,mi->km', points[:, None] - start, along) / (along ** 2).sum(axis=1), 0, 1)
    offsets = points[:, None] - (start + share[..., None] * along)
    distances = np.linalg.norm(offsets, axis=2)
    segment = distances.argmin(axis=1)
    every = np.arange(len(points))
    return segment, share[every, segment], offsets[every, segment], distances[every, segment]


def distances(points, nodes):
    """(k,) [m] Of points to the line through nodes."""
    return _nearest(points, nodes)[3]
