"""Scenes in which cables hold bodies, branch, and run over winches and through guides."""
import math

import numpy as np

from audit.cables import Together, cable_of, end, floor
from audit.hands import Hand, wander
from audit.scenes import SHIPPED, LengthCommand, begin, end_type, radius_of, rope, rounded, segments_of, wire

PLASTIC = 1000.0  # [kg/m^3] of loads


def box(random, name, mass, **keys):
    """A box as large as its mass calls for."""
    side = (mass / PLASTIC) ** (1 / 3)
    return dict(name=name, mass=rounded(mass), shapes=[dict(type='box', size=rounded(side * random.uniform(0.8, 1.25, 3)))], **keys)


def half_height(body):
    return 0.5 * body['shapes'][0]['size'][2]


def mass_of(keys, names, cable):
    material = keys['materials'].get(names[cable['name']]) or SHIPPED[names[cable['name']]]
    return material['linear_density'] * cable['length']


def load_for(random, name, mass, **keys):
    """A load of 1 to 100 times what its ropes weigh, but not so large that it is none."""
    return box(random, name, min(mass * 10 ** random.uniform(0, 2), 30), angular_damping=float(random.choice([0, 1e-4])), **keys)


def start_quietly(random, cable):
    """Half of what can stretch starts where it hangs, the other half as long as it is at rest."""
    if random.random() < 0.5:
        cable['initial'] = dict(type='settled')


def swinging_load(random, until):
    """A load on a rope from a hand."""
    keys, names = begin(cable=rope(random) if random.random() < 0.7 else wire(random))
    cable = cable_of(random, keys, names)
    load = load_for(random, 'load', mass_of(keys, names, cable))
    cable['attachments'] = [end('grip', 'start', 'hand', 'hinge'), dict(name='hook', at='end', body='load', offset=[0, 0, half_height(load)])]
    start_quietly(random, cable)
    keys['cables'].append(cable)
    keys['bodies'] = [load]
    hand = Hand([0, 0, 3])
    wander(random, hand, until, 0.3 * cable['length'])
    return keys, dict(hand=hand), []


def carried(random, until):
    """A plate on two to four ropes, each from a hand; these move together, and a little apart."""
    keys, names = begin(rope=rope(random))
    count = int(random.integers(2, 5))
    first = cable_of(random, keys, dict(rope=names['rope']), 'rope')
    length, half = first['length'], random.uniform(0.15, 0.4)
    mass = min(count * mass_of(keys, names, first) * 10 ** random.uniform(0, 2), 30)
    keys['bodies'] = [dict(name='plate', mass=rounded(mass), shapes=[dict(type='box', size=rounded([2 * half, half, 0.04]))],
                           angular_damping=float(random.choice([0, 1e-3])), pose=rounded([0, 0, 2 - length - 0.02, 0, 0, 0]))]
    corners = {2: [(-1, 0), (1, 0)], 3: [(-1, 0.4), (1, 0), (-1, -0.4)], 4: [(-1, 0.4), (1, 0.4), (1, -0.4), (-1, -0.4)]}[count]
    way, hands = Hand([0, 0, 0]), {}
    wander(random, way, until, 0.3 * length)
    for i, (x, y) in enumerate(corners):
        place = np.array([x * half, y * half, 0.02])
        cable = dict(first, name=f'rope_{i}', attachments=[
            end(f'grip_{i}', 'start', f'hand_{i}', 'hinge'), dict(name=f'corner_{i}', at='end', body='plate', offset=rounded(place))])
        keys['cables'].append(cable)
        hand = Hand(rounded([place[0], place[1], 2 - 1e-4 * length]))
        wander(random, hand, until, 0.05 * length)
        hands[f'hand_{i}'] = Together(hand, way)
    return keys, hands, []


def chain_of_bodies(random, until):
    """Bodies on ropes below each other, from a hand."""
    keys, names = begin(rope=rope(random) if random.random() < 0.6 else wire(random))
    keys['bodies'] = []
    height, above = 3.0, None
    for i in range(int(random.integers(2, 5))):
        length = rounded(random.uniform(0.15, 0.4))
        body = box(random, f'body_{i}', 10 ** random.uniform(-1.5, 0.3), angular_damping=1e-4)
        top = dict(frame='hand') if above is None else dict(body=above['name'], offset=[0, 0, -half_height(above)])
        keys['cables'].append(dict(name=f'rope_{i}', length=length, segments=segments_of(random, length, radius_of(keys, names['rope'])),
                                   material=names['rope'], attachments=[
                                       dict(name=f'top_{i}', at='start', **top),
                                       dict(name=f'bottom_{i}', at='end', body=body['name'], offset=[0, 0, half_height(body)])]))
        height -= 0.999 * length + 2 * half_height(body)
        body['pose'] = rounded([0, 0, height + half_height(body), 0, 0, 0])
        keys['bodies'].append(body)
        above = body
    hand = Hand([0, 0, 3])
    wander(random, hand, until, 0.15)
    return keys, dict(hand=hand), []


def plug(random, until):
    """A hand holds a plug, whose cable is clamped to it and held at its other end."""
    keys, names = begin(cable=wire(random))
    cable = cable_of(random, keys, names)
    length = cable['length']
    far = end_type(random)
    cable['attachments'] = [dict(name='wall', at='start', type=far), dict(name='back', at='end', body='plug', offset=[-0.02, 0, 0], type='clamp')]
    keys['cables'].append(cable)
    keys['bodies'] = [dict(name='plug', mass=rounded(10 ** random.uniform(-2, -1)), shapes=[dict(type='box', size=[0.04, 0.016, 0.01])],
                           attachments=[dict(name='grip', frame='hand', type='clamp')])]
    hand = Hand(rounded([random.uniform(0.5, 0.8) * length + 0.02, 0, 0]))
    wander(random, hand, until, 0.5 * length, lambda place: 0.25 * length < np.linalg.norm(place - [0.02, 0, 0]) < 0.85 * length - 0.04,
           turns=1.0)
    return keys, dict(hand=hand), []


def bar_on_a_joint(random, until):
    """A bar on a hinge or an axle, with a rope at its end; a hand draws it, or it swings with the frame that holds it."""
    keys, names = begin(cable=rope(random) if random.random() < 0.6 else wire(random))
    cable = cable_of(random, keys, names)
    length, mass, size = cable['length'], random.uniform(0.2, 3), rounded(random.uniform(0.2, 0.5))
    joint = dict(name='pivot', frame='frame', type=str(random.choice(['hinge', 'axle'])), at=rounded([0, 0, 0.5 * size, -math.pi / 2, 0, 0]),
                 rotation=rounded([-math.pi / 2, 0, 0]))
    keys['bodies'] = [dict(name='bar', mass=rounded(mass), shapes=[dict(type='capsule', radius=0.015, length=size)], pose=rounded([0, 0, 2 - 0.5 * size, 0, 0, 0]),
                           angular_damping=float(random.choice([0, 1e-3])), attachments=[joint])]
    frame, hands = Hand([0, 0, 2]), {}
    if random.random() < 0.5:
        cable['attachments'] = [dict(name='tail', at='start', body='bar', offset=rounded([0, 0, -0.5 * size]))]
        wander(random, frame, until, 0.2)
    else:
        hand = Hand(rounded([0.8 * length, 0, 2 - size]))
        cable['attachments'] = [dict(name='tail', at='start', body='bar', offset=rounded([0, 0, -0.5 * size])), end('grip', 'end', 'hand', 'hinge')]
        wander(random, hand, until, 0.3 * length, lambda place: 0.2 * length < np.linalg.norm(place - [0, 0, 2 - size]) < 0.85 * length)
        hands['hand'] = hand
    keys['cables'].append(cable)
    return keys, dict(hands, frame=frame), []


def dragged(random, until):
    """A crate on a floor, drawn by a rope."""
    keys, names = begin(cable=rope(random) if random.random() < 0.6 else wire(random))
    cable = cable_of(random, keys, names)
    crate = load_for(random, 'crate', 3 * mass_of(keys, names, cable))
    size = crate['shapes'][0]['size']
    crate['pose'] = rounded([0, 0, half_height(crate), 0, 0, 0])
    start = np.array([0.5 * size[0] + 0.95 * cable['length'], 0, half_height(crate) + 0.2 * cable['length']])
    cable['attachments'] = [end('grip', 'start', 'hand', 'hinge'), dict(name='hitch', at='end', body='crate', offset=rounded([0.5 * size[0], 0, 0]))]
    keys.update(bodies=[crate], obstacles=[floor(random)])
    keys['cables'].append(cable)
    hand = Hand(rounded(start))
    hand.go(0.05 * until, 0.9 * until, start + [random.uniform(0.05, 0.3) * min(until, 1), random.uniform(-0.1, 0.1), 0])
    return keys, dict(hand=hand), []


def harness(random, until):
    """A trunk between two hands, with branches, most of which have a plug at their end."""
    keys, names = begin(trunk=wire(random), branch=wire(random))
    trunk = cable_of(random, keys, names, 'trunk')
    length, count = trunk['length'], int(random.integers(1, 5))
    trunk['attachments'] = [end('left_grip', 'start', 'left', end_type(random)), end('right_grip', 'end', 'right', end_type(random))]
    keys['cables'].append(trunk)
    keys.update(bodies=[], junctions=[])
    for i in range(count):
        size = rounded(random.uniform(0.1, 0.3))
        branch = dict(name=f'branch_{i}', length=size, segments=segments_of(random, size, radius_of(keys, names['branch'])), material=names['branch'])
        if random.random() < 0.7:
            branch['attachments'] = [dict(name=f'branch_end_{i}', at='end', body=f'plug_{i}', offset=[-0.015, 0, 0], type='clamp')]
            keys['bodies'].append(dict(name=f'plug_{i}', mass=rounded(10 ** random.uniform(-2.3, -1.3)), shapes=[dict(type='box', size=[0.03, 0.016, 0.01])]))
        keys['cables'].append(branch)
        keys['junctions'].append(dict(name=f'fork_{i}', cable='trunk', at=rounded(length * (i + 1) / (count + 1)), type='rigid' if random.random() < 0.7 else 'hinge',
                                      branches=[dict(cable=branch['name'], end='start', rotation=rounded([0, 0, random.choice([-1, 1]) * random.uniform(0.4, 1.4)]))]))
    span, way = random.uniform(0.5, 0.85) * length, Hand([0, 0, 0])
    wander(random, way, until, 0.3 * length)
    return keys, dict(left=Together(Hand([0, 0, 1]), way), right=Together(Hand(rounded([span, 0, 1])), way)), []


def eyelets(random, until):
    """A cable through eyelets in a row, a load at its end; a hand draws it."""
    keys, names = begin(cable=rope(random) if random.random() < 0.5 else wire(random))
    count, gap, tail = int(random.integers(1, 4)), random.uniform(0.1, 0.2), 0.3
    length = rounded((count + 1) * gap + tail)
    ways = [[i * gap, 0, 1] for i in range(count + 1)] + [[count * gap, 0, 1 - gap - tail]]
    load = box(random, 'load', 10 ** random.uniform(-1.3, 0), angular_damping=1e-4)
    load['pose'] = rounded([count * gap, 0, 1 - gap - tail - half_height(load), 0, 0, 0])
    keys['cables'].append(dict(name='cable', length=length, segments=segments_of(random, length, radius_of(keys, names['cable']), 0.03), material=names['cable'],
                               initial=dict(type='points', points=rounded(ways)),
                               attachments=[end('grip', 'start', 'hand', 'hinge'), dict(name='hook', at='end', body='load', offset=[0, 0, half_height(load)])]))
    keys['bodies'] = [load]
    friction = float(random.choice([0, 0.1, 0.3]))
    keys['guides'] = [dict(name=f'eye_{i}', cable='cable', at=rounded((i + 1) * gap), offset=rounded([(i + 1) * gap, 0, 1]), type='eyelet', friction=friction)
                      for i in range(count)]
    hand = Hand([0, 0, 1])
    wander(random, hand, until, 0.15, lambda place: -0.2 < place[0] < 0.3 * gap and abs(place[1]) < 0.05 and abs(place[2] - 1) < 0.05)
    return keys, dict(hand=hand), []


def sheave(random, until):
    """A rope over a wheel, a load at one end, another load or a hand at the other one."""
    keys, names = begin(rope=rope(random))
    radius, hang = rounded(random.uniform(0.03, 0.08)), random.uniform(0.3, 0.8)
    length = rounded(math.pi * radius + 2 * hang)
    arc = [[-radius * math.cos(a), 0, 2 + radius * math.sin(a)] for a in np.linspace(0, math.pi, 24)]
    cable = dict(name='rope', length=length, segments=segments_of(random, length, radius_of(keys, names['rope']), 0.03), material=names['rope'],
                 initial=dict(type='points', points=rounded([[-radius, 0, 2 - hang], *arc, [radius, 0, 2 - hang]])), attachments=[])
    mass = 10 ** random.uniform(-0.7, 0.5)
    right = box(random, 'right', mass, angular_damping=1e-4)
    right['pose'] = rounded([radius, 0, 2 - hang - half_height(right), 0, 0, 0])
    right_end = dict(name='right_hook', at='end', body='right', offset=[0, 0, half_height(right)])
    keys['bodies'], hands = [right], {}
    if random.random() < 0.5:
        left = box(random, 'left', mass * random.uniform(0.8, 1.25), angular_damping=1e-4)
        left['pose'] = rounded([-radius, 0, 2 - hang - half_height(left), 0, 0, 0])
        keys['bodies'].append(left)
        cable['attachments'] = [dict(name='left_hook', at='start', body='left', offset=[0, 0, half_height(left)]), right_end]
    else:
        hand = Hand(rounded([-radius, 0, 2 - hang]))
        wander(random, hand, until, 0.3 * hang, lambda place: place[2] < 2 - 0.6 * hang and np.hypot(place[0] + radius, place[1]) < 0.15)
        cable['attachments'], hands = [end('grip', 'start', 'hand', 'hinge'), right_end], dict(hand=hand)
    keys['cables'].append(cable)
    wheel = dict(name='wheel', cable='rope', at=rounded(0.5 * length), offset=[0, 0, 2], rotation=rounded([math.pi / 2, 0, 0]), type='sheave', radius=radius)
    if random.random() < 0.4:
        wheel['inertia'] = rounded(10 ** random.uniform(-5, -3.5))
    keys['guides'] = [wheel]
    return keys, hands, []


def winch(random, until):
    """A load that is hoisted and let down."""
    keys, hands, _ = swinging_load(random, until)
    cable, time, commands = keys['cables'][0], 0.05 * until, []
    length = cable['length']
    while time < 0.7 * until:
        target, speed = length * random.uniform(0.75, 1.25), 10 ** random.uniform(-1.3, -0.3)
        target = length + np.clip(target - length, -speed * (until - time) * 0.7, speed * (until - time) * 0.7)
        commands.append(LengthCommand(rounded(time), cable['name'], rounded(target), rounded(speed)))
        time += random.uniform(0.3, 0.8) * until
    return keys, hands, commands


FAMILIES = dict(swinging_load=swinging_load, carried=carried, chain_of_bodies=chain_of_bodies, plug=plug, bar_on_a_joint=bar_on_a_joint, dragged=dragged,
                harness=harness, eyelets=eyelets, sheave=sheave, winch=winch)
