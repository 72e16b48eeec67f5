"""How the frames of launch/examples and launch/demo.launch, and the joints of the arms in launch/dress_pack.launch and
launch/examples/table_camera.launch, move over time. Needs no ROS.

scripts/example_frames.py, scripts/demo_frames.py and scripts/move_joints.py send these motions, scripts/lib/write_motions.py writes them to
the CSV files beside the scenes. Poses are (position [m], quaternion x, y, z, w), in the fixed frame.
"""
import math

# [s] After which an example begins again; when in it its hands let go [s], and of what.
PERIODS = {'harness': 22.0, 'plug': 16.5}
RELEASES = {'harness': (7.5, ['left_hand', 'right_hand']), 'plug': (6.5, ['grip'])}

DEMO_CYCLE = 24.0        # [s] three pulls
DEMO_PULL_PERIOD = 8.0   # [s] the demo's hands pull the rope tight once in each, at its middle

JOINTS_RAMP = 2.0  # [s] in which the motion of the joints grows to its full size
# joint: mean [rad], amplitude [rad], period [s]
JOINTS = {
    'pan': (0.0, 0.9, 7.0),
    'lift': (0.1, 0.4, 5.0),
    'elbow': (0.0, 0.5, 4.0),
    'roll': (0.0, 0.8, 3.0),
}


def swing(t, period, phase=0.0):
    """-1 to 1."""
    return math.sin(2 * math.pi * t / period + phase)


def pose(x, y, z, roll=0.0, pitch=0.0, yaw=0.0):
    """Position [m] and orientation, from fixed-axis roll, pitch and yaw [rad]."""
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(a / 2), math.cos(a / 2)) for a in (roll, pitch, yaw))
    return (x, y, z), (sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
                       cr * cp * cy + sr * sp * sy)


def hose_between_arms(t):
    apart = 0.44 + 0.12 * swing(t, 10)  # [m] half the distance of the grippers
    return {'left_gripper': pose(-apart, 0, 1, roll=2.0 * swing(t, 16), pitch=0.3 * swing(t, 10, 1)),
            'right_gripper': pose(apart, 0.1 * swing(t, 7), 1, pitch=0.3 * swing(t, 10, 2), yaw=math.pi)}


def tethered_drone(t):
    return {'drone': pose(0.2 + 0.8 * swing(t, 12, math.pi / 2), 0.8 * swing(t, 12), 2.0 + 0.3 * swing(t, 8),
                          roll=0.08 * swing(t, 3), pitch=0.15, yaw=0.3 * swing(t, 12))}


def crane(t):
    return {'trolley': pose(0.6 * swing(t, 14), 0, 2.2)}


def rov_tether(t):
    return {'ship': pose(0, 0, 0.08 * swing(t, 5), pitch=0.1 * swing(t, 5, 1)),
            'rov': pose(1.1 + 0.3 * swing(t, 15), 0.3 * swing(t, 20), -1.8 + 0.25 * swing(t, 11), yaw=0.5 * swing(t, 20))}


def tracker(t):
    return {'left_hand': pose(-0.4 - 0.1 * swing(t, 6), 0.1 * swing(t, 8), 1.05),
            'right_hand': pose(0.4 + 0.1 * swing(t, 6), -0.1 * swing(t, 8), 1.05 + 0.1 * swing(t, 5)),
            # z forward, x right, y down
            'camera_optical_frame': pose(0.15 * swing(t, 13), -1.2, 1.0, roll=-math.pi / 2)}


def gripper_load(t):
    return {'gripper': pose(0.55 + 0.15 * swing(t, 7), 0.15 * swing(t, 5), 1.0 + 0.15 * swing(t, 9), roll=0.8 * swing(t, 8),
                            pitch=0.4 * swing(t, 6), yaw=math.pi)}


def drones_with_bar(t):
    x, y, yaw = 0.5 * swing(t, 11), 0.3 * swing(t, 9), 0.5 * swing(t, 17)
    apart = 0.75 + 0.12 * swing(t, 8)  # [m] half the distance of the drones
    rise = 0.2 * swing(t, 7)           # [m] of the left one above the right one, half of it
    along, across = apart * math.cos(yaw), apart * math.sin(yaw)
    roll, pitch = 0.06 * swing(t, 4), 0.08 * swing(t, 5)
    return {'left_drone': pose(x - along, y - across, 1.9 + rise, roll, pitch, yaw),
            'right_drone': pose(x + along, y + across, 1.9 - rise, -roll, pitch, yaw)}


def ramp(t, begin, end):
    """0 before `begin` [s], 1 after `end`, smoothly between."""
    u = min(max((t - begin) / (end - begin), 0.0), 1.0)
    return u * u * (3 - 2 * u)


def harness(t):
    t %= PERIODS['harness']
    z = 0.3 - 0.294 * ramp(t, 1, 6) + 0.294 * ramp(t, 8.5, 10.5)
    x = 0.247 + 0.0028 * (ramp(t, 6, 7) - ramp(t, 11, 12))  # stretched when it lies
    tilt = 1.1 * (ramp(t, 11, 14) - ramp(t, 17, 20))  # [rad]
    return {'left_hand': pose(-x, 0, z), 'right_hand': pose(x, 0, z), 'board': pose(0, 0, 0, roll=tilt)}


def plug(t):
    t %= PERIODS['plug']
    there, pushed, back = ramp(t, 1, 4), ramp(t, 4, 6), ramp(t, 13, 14.5)
    away, pulled = ramp(t, 7, 8.5) - ramp(t, 14.5, 16), ramp(t, 9, 11) - ramp(t, 12, 14)  # back past the cable, then above it
    return {'hand': pose(-0.18 + 0.1 * (there - back) + 0.09 * (pushed - back), 0.12 * away, 0.2 - 0.1 * (there - back)),
            'far_hand': pose(-0.5 - 0.1325 * pulled, 0, 0.2 - 0.1 * pulled)}


def finger(t):
    return {'palm': pose(0, 0, 0.15, pitch=0.3 * swing(t, 9))}


def demo(t):
    apart = 0.7225 - 0.22 * swing(t, DEMO_PULL_PERIOD, math.pi / 2)  # [m] half the distance of the hands
    sway = 0.12 * swing(t, DEMO_PULL_PERIOD / 2)
    tilt = math.radians(60) * (1 + swing(t, DEMO_PULL_PERIOD, math.pi / 2)) / 2  # the hands point along the rope
    return {'left_hand': pose(-apart, sway, 0.95, pitch=tilt), 'right_hand': pose(apart, -sway, 0.95, pitch=-tilt),
            'hook': pose(-1.5 + 0.15 * swing(t, 3.0), 0, 1.1),
            'swivel': pose(1.5 + 0.1 * swing(t, 0.8, math.pi / 2), 0.1 * swing(t, 0.8), 1.1)}


def joint_positions(t):
    """Angles [rad] by joint of config/scenes/dress_pack.urdf and config/examples/table_camera.urdf at a time [s]; all 0 at 0, without a jump of velocity."""
    part = min(t / JOINTS_RAMP, 1.0)
    growth = part * part * (3 - 2 * part)
    return {joint: growth * (mean + amplitude * swing(t, period)) for joint, (mean, amplitude, period) in JOINTS.items()}


# The frames at a time [s], by the names of config/examples.
EXAMPLES = {motion.__name__: motion for motion in (hose_between_arms, tethered_drone, crane, rov_tether, tracker, gripper_load,
                                                   drones_with_bar, harness, plug, finger)}
