"""What a scene of the audit is, and what its cables are made of."""
import copy
import math
from dataclasses import dataclass, field
from pathlib import Path

import yaml

CHECKOUT = Path(__file__).resolve().parents[3]
SHIPPED = yaml.safe_load((CHECKOUT / 'config/materials.yaml').read_text(encoding='utf-8'))
ROPES = ['nylon_rope_6mm', 'dyneema_rope_4mm', 'steel_wire_rope_4mm']
WIRES = ['usb_cable', 'ethernet_cat6', 'rov_tether', 'rubber_hose_16mm']
GRAVITY = 9.81


def rounded(values):
    """Numbers of a scene file, to six digits; of lists those in them."""
    if isinstance(values, (list, tuple)) or hasattr(values, 'tolist') and getattr(values, 'ndim', 0):
        return [rounded(value) for value in values]
    return float(f'{float(values):.6g}')


@dataclass
class LengthCommand:
    """A winch's."""
    time: float
    cable: str
    length: float
    speed: float
    at_end: bool = False


@dataclass
class AuditScene:
    """A scene, how its frames move, and what winches are told."""
    kind: str
    family: str
    index: int
    seconds: float
    keys: dict
    hands: dict = field(default_factory=dict)
    winches: list = field(default_factory=list)

    @property
    def name(self):
        return f'{self.kind}_{self.index:03d}_{self.family}'

    def refined(self, time_step, finer=1):
        """Its keys at another time step [s] and with `finer` times as many segments, its hands where they start."""
        keys = copy.deepcopy(self.keys)
        keys['time_step'] = time_step
        for cable in keys['cables']:
            cable['segments'] *= finer
        for holder in [*keys['cables'], *keys.get('bodies', [])]:
            for attachment in holder.get('attachments', []):
                if 'frame' in attachment:
                    attachment['initial_pose'] = [*rounded(self.hands[attachment['frame']].pose(0)[0]), 0, 0, 0]
        return keys

    def density(self, material):
        """[kg/m]"""
        return (self.keys['materials'].get(material) or SHIPPED[material])['linear_density']

    @property
    def length(self):
        """[m] of the longest cable."""
        return max(cable['length'] for cable in self.keys['cables'])

    @property
    def energy(self):
        """m g L [J], of all that moves and the longest cable."""
        mass = sum(body['mass'] for body in self.keys.get('bodies', []))
        for cable in self.keys['cables']:
            mass += self.density(cable['material']) * cable['length'] + sum(p['mass'] for p in cable.get('point_masses', []))
        return mass * GRAVITY * self.length


def rope(random):
    """A material without bending stiffness, or the name of a shipped rope."""
    if random.random() < 0.3:
        return str(random.choice(ROPES))
    radius = 10 ** random.uniform(-3, -2)
    keys = dict(linear_density=700 * math.pi * radius ** 2, radius=radius, friction=random.uniform(0.1, 0.8))
    if random.random() < 0.5:
        keys['axial_stiffness'] = 10 ** random.uniform(8, 9.5) * math.pi * radius ** 2
        keys['axial_damping'] = 1e-4 * keys['axial_stiffness']
    if random.random() < 0.5:
        keys['drag'] = 10 ** random.uniform(-3, -1.5)
    return rounded_keys(keys)


def wire(random):
    """A material that bends and twists, or the name of a shipped one."""
    if random.random() < 0.35:
        return str(random.choice(WIRES))
    is_hose = random.random() < 0.35
    radius = 10 ** (random.uniform(-2.3, -1.9) if is_hose else random.uniform(-3, -2.4))
    area = math.pi * radius ** 2 * (0.6 if is_hose else 1)
    modulus = 10 ** (random.uniform(6.5, 7.5) if is_hose else random.uniform(8, 9))
    bending = modulus * math.pi / 4 * radius ** 4 * (0.8 if is_hose else 1)
    keys = dict(linear_density=(1150 if is_hose else 3500) * area, radius=radius, bending_stiffness=bending, friction=random.uniform(0.1, 0.8))
    if random.random() < 0.8:
        keys['bending_damping'] = 10 ** random.uniform(-2.5, -1.5) * bending
    if random.random() < 0.7:
        keys['torsional_stiffness'] = 0.72 * bending
        keys['torsional_damping'] = 0.72 * keys.get('bending_damping', 0)
    if random.random() < 0.4:
        keys['axial_stiffness'] = modulus * area
        keys['axial_damping'] = 1e-4 * keys['axial_stiffness']
    if random.random() < 0.3:
        keys['drag'] = 10 ** random.uniform(-3, -1.5)
    return rounded_keys(keys)


def rounded_keys(keys):
    return {key: rounded(value) for key, value in keys.items()}


def begin(**materials):
    """The keys of a scene with materials by the names that its cables have for them, and those names: of a shipped one its own."""
    own = {name: material for name, material in materials.items() if not isinstance(material, str)}
    names = {name: name if name in own else material for name, material in materials.items()}
    return dict(materials=own, cables=[]), names


def radius_of(keys, material):
    """[m]"""
    return (keys['materials'].get(material) or SHIPPED[material])['radius']


def segments_of(random, length, radius, longest=0.05):
    """A number of segments that are neither thicker than long nor longer [m] than asked for."""
    size = max(10 ** random.uniform(-2, math.log10(longest)), 2.5 * radius)
    return max(8, round(length / size))


def end_type(random):
    return 'clamp' if random.random() < 0.4 else 'hinge'
