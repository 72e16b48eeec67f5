"""Scenes with one or two cables: held by hands that move, in the air, in water, on floors and over poles."""
import math

import numpy as np

from audit.hands import Hand, wander
from audit.scenes import begin, end_type, radius_of, rope, rounded, segments_of, wire

DOWN = [0, math.pi / 2, 0]  # of a clamp that points down


def cable_of(random, keys, names, name='cable', longest=0.05):
    """A cable of a random length; not in the scene yet."""
    length = rounded(random.uniform(0.3, 1.5))
    radius = radius_of(keys, names[name])
    return dict(name=name, length=length, segments=segments_of(random, length, radius, longest), material=names[name], attachments=[])


def end(name, at, frame, kind, **keys):
    return dict(name=name, at=at, frame=frame, type=kind, **keys)


def hanging(random, until):
    """From one hand."""
    keys, names = begin(cable=wire(random) if random.random() < 0.7 else rope(random))
    cable = cable_of(random, keys, names)
    kind = end_type(random)
    cable['attachments'] = [end('grip', 'start', 'hand', kind, **(dict(rotation=rounded(DOWN)) if kind == 'clamp' else {}))]
    if random.random() < 0.3:
        cable['point_masses'] = [dict(at='end', mass=rounded(10 ** random.uniform(-2, 0)))]
    keys['cables'].append(cable)
    hand = Hand([0, 0, 2])
    wander(random, hand, until, 0.4 * cable['length'], turns=1.5 if kind == 'clamp' else 0, roll=(0, 0, 1))
    return keys, dict(hand=hand)


def spanned(random, until, turns=2.0, clamped=False, material=None):
    """Between two hands, both of which move, or one."""
    keys, names = begin(cable=material or (wire(random) if random.random() < 0.7 else rope(random)))
    cable = cable_of(random, keys, names)
    length = cable['length']
    cable['attachments'] = [end('left_grip', 'start', 'left', 'clamp' if clamped else end_type(random)),
                            end('right_grip', 'end', 'right', 'clamp' if clamped else end_type(random))]
    keys['cables'].append(cable)
    left, right = Hand([0, 0, 1]), Hand([random.uniform(0.4, 0.85) * length, 0, 1])
    if random.random() < 0.6:  # together, so that they stay as far apart
        way = Hand([0, 0, 0])
        wander(random, way, until, 0.3 * length)
        hands = dict(left=Together(left, way), right=Together(right, way))
    else:
        wander(random, right, until, 0.5 * length, lambda place: 0.2 * length < np.linalg.norm(place - left.place) < 0.9 * length,
               turns=turns)
        hands = dict(left=left, right=right)
    return keys, hands


class Together:
    """A hand that is carried along by another one's way."""

    def __init__(self, hand, way):
        self.hand, self.way = hand, way

    def pose(self, time):
        place, orientation = self.hand.pose(time)
        return place + self.way.pose(time)[0], orientation


def twisted(random, until):
    """Between two clamps, one of which turns by up to two turns."""
    material = wire(random)
    if isinstance(material, dict) and 'torsional_stiffness' not in material:
        material['torsional_stiffness'] = rounded(0.72 * material['bending_stiffness'])
    return spanned(random, until, turns=12.0, clamped=True, material=material)


def sections(random, until):
    """Between two hands, of two materials."""
    keys, hands = spanned(random, until)
    cable = keys['cables'][0]
    other = wire(random)
    keys['materials'].update({} if isinstance(other, str) else dict(section=other))
    half = max(2, cable['segments'] // 4) * cable['length'] / cable['segments']
    cable['sections'] = [{'from': rounded(half), 'to': rounded(2 * half), 'material': other if isinstance(other, str) else 'section'}]
    return keys, hands


def in_water(random, until):
    """Between two hands or from one, in water that flows or in wind."""
    keys, hands = hanging(random, until) if random.random() < 0.5 else spanned(random, until)
    is_water = random.random() < 0.6
    speed = random.uniform(-1, 1, 3) * ([0.3, 0.3, 0.05] if is_water else [4, 4, 0.2])
    keys['fluid'] = dict(density=1000 if is_water else 1.2, velocity=rounded(speed))
    return keys, hands


def floor(random):
    if random.random() < 0.7:
        return dict(name='floor', type='plane', friction=rounded(random.uniform(0.1, 0.8)))
    return dict(name='floor', type='box', size=[6, 6, 0.2], pose=[0, 0, -0.1, 0, 0, 0], friction=rounded(random.uniform(0.1, 0.8)))


def lying(random, until):
    """Straight on a floor, one end lifted and drawn."""
    keys, names = begin(cable=wire(random) if random.random() < 0.7 else rope(random))
    cable = cable_of(random, keys, names)
    length, radius = cable['length'], radius_of(keys, names['cable'])
    cable['attachments'] = [end('grip', 'start', 'hand', end_type(random))]
    cable['initial'] = {'type': 'straight', 'from': rounded([0, 0, radius]), 'to': rounded([length, 0, radius])}
    keys['cables'].append(cable)
    keys['obstacles'] = [floor(random)]
    hand = Hand(rounded([0, 0, radius]))
    wander(random, hand, until, 0.5 * length, lambda place: radius * 0.999 < place[2] < 0.6 * length, roll=(0, 0, 1),
           turns=0.5)
    return keys, dict(hand=hand)


def lowered(random, until):
    """Hanging above a floor, and let down on it."""
    keys, names = begin(cable=wire(random) if random.random() < 0.7 else rope(random))
    cable = cable_of(random, keys, names)
    length = cable['length']
    cable['attachments'] = [end('grip', 'start', 'hand', 'hinge')]
    keys['cables'].append(cable)
    keys['obstacles'] = [floor(random)]
    hand = Hand(rounded([0, 0, length + 0.05]))
    down = random.uniform(0.2, 0.6) * length
    hand.go(0.05 * until, 0.9 * until, hand.place + [random.uniform(-0.4, 0.4) * length, random.uniform(-0.2, 0.2) * length, -down - 0.05])
    return keys, dict(hand=hand)


def over_pole(random, until):
    """Between two hands above a pole, and let down on it."""
    keys, names = begin(cable=wire(random) if random.random() < 0.5 else rope(random))
    cable = cable_of(random, keys, names, longest=0.03)
    length, radius = cable['length'], radius_of(keys, names['cable'])
    pole = rounded(max(random.uniform(0.02, 0.06) * length, 2 * radius))
    keys['obstacles'] = [dict(name='pole', type='cylinder', radius=pole, length=2, pose=[0, 0, 0, rounded(math.pi / 2), 0, 0],
                              friction=rounded(random.uniform(0.1, 0.6)))]
    cable['attachments'] = [end('left_grip', 'start', 'left', 'hinge'), end('right_grip', 'end', 'right', 'hinge')]
    keys['cables'].append(cable)
    half = 0.35 * length
    height = math.sqrt(0.25 * length ** 2 - half ** 2) + pole + radius + 0.02
    hands = {}
    for name, side in (('left', -1), ('right', 1)):
        hands[name] = Hand(rounded([side * half, 0, height]))
        hands[name].go(0.05 * until, 0.85 * until, [side * half, random.uniform(-0.05, 0.05) * length, -random.uniform(0, 0.1) * length])
    return keys, hands


def crossed(random, until):
    """One between two hands, let down on another one between two posts."""
    keys, names = begin(cable=wire(random) if random.random() < 0.6 else rope(random))
    cable = cable_of(random, keys, names, longest=0.03)
    length = cable['length']
    other = dict(cable, name='other', attachments=[dict(name=f'{name}_post', at=at, offset=rounded([0, side * 0.45 * length, 0]))
                                                   for name, at, side in (('left', 'start', -1), ('right', 'end', 1))])
    cable['attachments'] = [end('left_grip', 'start', 'left', end_type(random)), end('right_grip', 'end', 'right', end_type(random))]
    keys['cables'] = [cable, other]
    keys['contact'] = dict(self=True, between_cables=True, friction=rounded(random.uniform(0.1, 0.6)))
    hands = {}
    for name, side in (('left', -1), ('right', 1)):
        hands[name] = Hand(rounded([side * 0.35 * length, 0, 0.4 * length]))
        hands[name].go(0.05 * until, 0.85 * until, [side * 0.35 * length, random.uniform(-0.05, 0.05) * length, -0.1 * length])
    return keys, hands


FAMILIES = dict(hanging=hanging, spanned=spanned, twisted=twisted, sections=sections, in_water=in_water, lying=lying, lowered=lowered,
                over_pole=over_pole, crossed=crossed)
