"""Vehicles on cables that push, and winches that feel: each compared with a closed form."""
import numpy
from worlds import world_of

GRAVITY = 9.81
STEP = 0.005  # [s] of the scenes


def total(energy):
    return sum(energy.values())


def is_closed(world, scale):
    """Whether its ledger closes, of a work of `scale` [J]."""
    ledger = world.ledger()
    return ledger['unaccounted_steps'] == 0 and abs(ledger['unaccounted']) < 1e-4 * scale


def pilot(world, body, mass, goal, velocity, feed):
    """A controller of place and speed at 100 Hz: its thrust acts until it says another."""
    pose, twist = world.body_pose(body)[:3], world.body_twist(body)[:3]
    thrust = mass * (9 * (goal - pose) + 6 * (velocity - twist)) + feed
    world.apply_wrench(body, thrust)


def drone(length, segments, stiffness=None):
    tether = {'linear_density': 0.04, 'radius': 0.002, 'drag': 0.05}
    if stiffness:
        tether['axial_stiffness'] = stiffness
    return {
        'time_step': STEP, 'materials': {'tether': tether},
        'bodies': [{'name': 'drone', 'mass': 1.2, 'inertia': [0.01, 0.01, 0.02], 'pose': [0, 0, 1.5, 0, 0, 0]}],
        'cables': [{'name': 'tether', 'length': length, 'segments': segments, 'material': 'tether',
                    'attachments': [{'name': 'ground', 'at': 'start'}, {'name': 'belly', 'at': 'end', 'body': 'drone'}]}],
    }


def test_a_drone_that_hovers_keeps_its_energy():
    for length, segments, goal in ((2.5, 40, (0.6, 0, 1.6)), (1.6, 25, (0.5, 0, 1.62))):
        for stiffness in (None, 1e4):
            world = world_of(drone(length, segments, stiffness))
            energies = []
            for _ in range(6000):
                pilot(world, 'drone', 1.2, goal, (0, 0, 0), [0, 0, 1.26 * GRAVITY])
                assert world.step(2) == 'ok'
                energies.append(total(world.energy()))
            # It has come to rest; its weight times the height is 18 J.
            assert max(energies[3000:]) - min(energies[3000:]) < 1e-7
            assert is_closed(world, 18)


def test_a_drone_draws_its_tether_off_a_winch():
    # Straight up at 0.5 m/s: the winch has its tension, the drone this and the weight of what hangs on it.
    kept, speed = 3.0, 0.5
    world = world_of(drone(1.5, 30))
    world.set_tension('tether', False, kept, max_speed=2.0, min_length=0.5, max_length=20.0)
    heights = []
    for tick in range(800):
        time = 0.01 * tick
        rate = speed * min(1, time)
        goal = 1.5 + (0.5 * speed * time**2 if time < 1 else speed * (time - 0.5))
        weight = GRAVITY * (1.2 + 0.04 * world.body_pose('drone')[2])
        pilot(world, 'drone', 1.2, (0, 0, goal), (0, 0, rate), [0, 0, weight + kept])
        assert world.step(2) == 'ok'
        if time > 2:
            height = world.body_pose('drone')[2]
            heights.append(height)
            tension = world.tension('tether')
            assert abs(tension[0] - kept) < 0.01 * kept
            # Drag of 0.05 kg/(m s) resists the tether on its way.
            assert abs(-world.wrench('belly')[2] - (kept + (GRAVITY * 0.04 + 0.05 * speed) * height)) < 0.01 * kept
    climbed = heights[-1] - heights[0]
    assert abs(climbed - speed * 0.01 * (len(heights) - 1)) < 1e-2
    # As much as the drone has climbed has left the winch.
    rest = numpy.linalg.norm(numpy.diff(world.positions('tether'), axis=0), axis=1).sum()
    assert abs(rest - heights[-1]) < 1e-3
    assert is_closed(world, 1.2 * GRAVITY * climbed)


def kite(wind, segments=40, length=40.0):
    """A parachute on a tether that has only linear drag, downwind of its winch."""
    direction = numpy.asarray(wind) / numpy.linalg.norm(wind)
    return {
        'time_step': STEP, 'gravity': [0, 0, 0], 'winch_acceleration': 5.0, 'fluid': {'velocity': list(wind)},
        'materials': {'tether': {'linear_density': 0.01, 'radius': 0.002, 'drag': 0.02}},
        'bodies': [{'name': 'kite', 'mass': 2.0, 'inertia': [0.1, 0.1, 0.1], 'pose': [*(length * direction), 0, 0, 0]}],
        'cables': [{'name': 'tether', 'length': length, 'segments': segments, 'material': 'tether',
                    'attachments': [{'name': 'winch', 'at': 'start'}, {'name': 'bridle', 'at': 'end', 'body': 'kite'}]}],
    }


def test_a_kite_reels_out_as_wind_and_tension_say():
    # Drag k (W - v) of the kite, and c l (W - v) of its tether, against the tension: v = W - T / (k + c l), along any direction.
    wind, drag, kept = numpy.array([6.0, 3.0, 2.0]), 30.0, 150.0
    world = world_of(kite(wind))
    world.set_tension('tether', False, kept, max_speed=7.0, min_length=1.0, max_length=200.0)
    direction = wind / numpy.linalg.norm(wind)
    work = 0.0
    for tick in range(1600):
        world.apply_wrench('kite', drag * (wind - world.body_twist('kite')[:3]))
        before = numpy.linalg.norm(world.body_pose('kite')[:3])
        assert world.step() == 'ok'
        after = numpy.linalg.norm(world.body_pose('kite')[:3])
        work -= kept * (after - before)
    length = after
    speed = world.body_twist('kite')[:3]
    expected = numpy.linalg.norm(wind) - kept / (drag + 0.02 * length)
    assert numpy.linalg.norm(speed - expected * direction) < 2e-3 * expected, (speed, expected * direction)
    assert length > 55
    # The generator's energy is tension times what has left the winch.
    assert abs(world.ledger()['work']['winches'] - work) < 1e-2 * abs(work), (world.ledger(), work)
    assert is_closed(world, abs(work))


def horizontal_tension(span, depth, length, weight):
    """Of a catenary that hangs between two points: bisection."""
    def arc(tension):
        # length^2 - depth^2 = (2 a sinh(span / (2 a)))^2
        a = tension / weight
        return 2 * a * numpy.sinh(span / (2 * a))
    low, high = 0.02 * weight * span, 1e4 * weight * length
    for _ in range(200):
        middle = numpy.sqrt(low * high)
        low, high = (middle, high) if arc(middle) > numpy.sqrt(length**2 - depth**2) else (low, middle)
    return low


def test_a_mooring_line_holds_a_body_that_another_program_moves():
    # A floating body of that program: 1000 kg, driven by 300 N, damped. It comes to rest where the line pulls with as much.
    length, depth, weight, mass, driven = 60.0, 20.0, 2.0 * GRAVITY, 1000.0, 300.0
    world = world_of({
        'time_step': 0.01, 'materials': {'chain': {'linear_density': 2.0, 'radius': 0.01, 'drag': 2.0}},
        'cables': [{'name': 'line', 'length': length, 'segments': 60, 'material': 'chain',
                    'attachments': [{'name': 'anchor', 'at': 'start', 'offset': [0, 0, 0]},
                                    {'name': 'fairlead', 'at': 'end', 'frame': 'float'}]}],
    })
    world.set_frame('float', [50, 0, 20], [0, 0, 0, 1])
    world.step()
    place, speed = 50.0, 0.0
    for _ in range(20000):
        pull = world.wrench('fairlead')[0]
        speed += 0.01 / mass * (driven + pull - 300 * speed)
        place += 0.01 * speed
        world.set_frame('float', [place, 0, 20], [0, 0, 0, 1])
        assert world.step() in ('ok', 'jumped')
    found = horizontal_tension(place, depth, length, weight)
    assert abs(found - driven) < 1e-2 * driven, (place, pull, found)
    assert abs(world.wrench('fairlead')[0] + driven) < 1e-3 * driven


def test_a_cable_between_two_models_of_another_simulator_stays_calm():
    # Two models of 1 kg turn about each other on a cable of 0.05 kg: it pulls with m r w^2. They move by the pull of the step before,
    # which is half a step behind them, so that they gain pull * w * step / 2 over their speed, and no more.
    mass, spin, step, seconds = 1.0, 2.0, 1e-3, 20
    world = world_of({
        'time_step': step, 'gravity': [0, 0, 0],
        'materials': {'cord': {'linear_density': 0.05, 'radius': 0.002, 'axial_stiffness': 2000.0, 'axial_damping': 5.0}},
        'cables': [{'name': 'cord', 'length': 1.0, 'segments': 20, 'material': 'cord', 'initial': {'type': 'straight', 'to': [0.5, 0, 0]},
                    'attachments': [{'name': 'left', 'at': 'start', 'frame': 'one'}, {'name': 'right', 'at': 'end', 'frame': 'two'}]}],
    })
    places = numpy.array([[-0.5, 0, 0], [0.5, 0, 0]])
    speeds = spin * numpy.array([[0, -0.5, 0], [0, 0.5, 0]])
    pulls = numpy.zeros((2, 3))
    distances, forces = [], []
    for _ in range(round(seconds / step)):
        speeds += step / mass * pulls
        places += step * speeds
        for name, place in zip(('one', 'two'), places):
            world.set_frame(name, place, [0, 0, 0, 1])
        assert world.step() in ('ok', 'jumped')
        pulls = numpy.array([world.wrench('left')[:3], world.wrench('right')[:3]])
        distances.append(numpy.linalg.norm(places[1] - places[0]))
        forces.append(numpy.linalg.norm(pulls[1]))
    distance, force = numpy.mean(distances[-200:]), numpy.mean(forces[-200:])
    turned = numpy.linalg.norm(speeds[1] - speeds[0]) / distance
    assert abs(force - mass * distance / 2 * turned**2) < 2e-3 * force
    assert numpy.ptp(distances[-5000:]) < 1e-4
    assert numpy.abs(speeds.sum(axis=0)).max() < 1e-9
    # The cable takes its share of the angular momentum, m l^2 / 12 w.
    gained = numpy.cross(places, speeds)[:, 2].sum() - 1
    assert abs(gained - (force * turned * step / 2 * distance * seconds - 0.05 / 12 * turned)) < 3e-3, gained


def rov(current):
    return {
        'time_step': STEP, 'fluid': {'density': 1000.0, 'velocity': current, 'normal_drag': 1.2, 'tangential_drag': 0.01},
        'materials': {'tether': {'linear_density': 1000 * numpy.pi * 0.004**2, 'radius': 0.004}},
        'bodies': [{'name': 'rov', 'mass': 12.0, 'inertia': [0.3, 0.3, 0.3], 'pose': [8.4, 0, -5, 0, 0, 0],
                    'fluid': {'volume': 0.012, 'drag_area': [0.05, 0.07, 0.09], 'angular_drag': [2.0, 2.0, 2.0],
                              'added_mass': [6.0, 8.0, 10.0]}}],
        'cables': [{'name': 'tether', 'length': 8.0, 'segments': 40, 'material': 'tether',
                    'attachments': [{'name': 'cage', 'at': 'start', 'offset': [0, 0, -5]},
                                    {'name': 'tail', 'at': 'end', 'body': 'rov', 'offset': [-0.4, 0, 0]}]}],
    }


def test_an_rov_streams_on_its_tether_in_a_current():
    # It and its tether weigh nothing in water: the drag of the body is what the tether holds, and more by that along the tether.
    speed = 0.8
    world = world_of(rov([speed, 0, 0]))
    world.step(6000)
    drag = 0.5 * 1000 * 0.05 * speed**2
    along = 0.5 * 1000 * 0.01 * 8.0 * 0.008 * speed**2
    assert abs(world.wrench('tail') - [-drag, 0, 0, 0, 0, 0]).max() < 1e-6 * drag
    assert abs(world.wrench('cage') - [drag + along, 0, 0, 0, 0, 0]).max() < 1e-6 * drag
    # It swims against the current, and its tether is slack: (m + added) u' = thrust - drag (u / speed)^2 for its speed u through the
    # water, from `speed` at rest. Not for much longer: as added mass is larger across than along, its pitch is unstable (Munk's moment).
    world.apply_wrench('rov', [-4 * drag, 0, 0])
    world.step(200)
    through_water = 2 * speed * numpy.tanh(200 * STEP * 2 * drag / speed / (12 + 6) + numpy.arctanh(0.5))
    assert abs(world.body_twist('rov')[0] - (speed - through_water)) < 0.01 * speed, world.body_twist('rov')
    assert is_closed(world, drag * 10)


def test_an_rov_moves_off_with_the_water_around_it():
    world = world_of(rov([0, 0, 0]))
    world.apply_wrench('rov', [0, 6, 0])
    world.step()
    # But for what its tether weighs, and the drag that it has gathered by the step's end.
    assert abs(world.body_twist('rov')[1] / STEP - 6 / (12 + 8)) < 5e-4 * 0.3
