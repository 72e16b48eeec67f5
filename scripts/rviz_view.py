#!/usr/bin/python3
"""rviz_view.py VIEW NODE SCENE FIT [RVIZ ARGUMENTS...]: starts rviz with a view of a cable node. Launch files start it as a node.

VIEW is a configuration of rviz. What it shows is that of the node NODE, in the scene's frame_id. FIT (true, false): the camera looks at
what is in the scene file SCENE, from where all of it can be seen. Panel, tools and legend are left out where they are not built.
"""
import math
import os
import sys

import numpy as np
import rosgraph
import rospkg
import yaml

PLUGINS = 'libverlet_cable_rviz.so'
FIELD_OF_VIEW = math.radians(45)  # rviz's, of the window's height
MARGIN = 1.15  # of what is seen, times what there is
ROBOT_MARGIN = 1.5  # the same with a robot, whose links reach farther than the cables on it
CLOSEST = 0.1  # [m]
AXES = 0.2     # of frames, to the camera's distance


def has_plugins():
    """Whether the libraries of rviz's plugins are built, in a workspace that is sourced."""
    return any(os.path.exists(os.path.join(folder, 'lib', PLUGINS)) for folder in os.environ.get('CMAKE_PREFIX_PATH', '').split(':'))


def numbers(value, count=3):
    """Of a list of so many numbers, or else none."""
    if not isinstance(value, list) or len(value) < count:
        return None
    try:
        return np.array([float(number) for number in value[:count]])
    except (TypeError, ValueError):
        return None


def entries(scene, key):
    """The maps of a list in the scene: whatever else is there, the node complains about."""
    values = scene.get(key)
    return [value for value in values if isinstance(value, dict)] if isinstance(values, list) else []


def known_places(scene):
    """[m] Where the scene says that something is, without obstacles: a floor is everywhere."""
    for cable in entries(scene, 'cables'):
        held, at = [], []
        for attachment in entries(cable, 'attachments'):
            fixed = 'frame' not in attachment and 'body' not in attachment
            place = numbers(attachment.get('offset' if fixed else 'initial_pose'))
            if place is not None:
                held.append(place)
                at.append(attachment.get('at'))
        yield from held
        yield from sagging(cable, held)
        yield from overhanging(cable, held, at)
        initial = cable.get('initial')
        points = initial.get('points') if isinstance(initial, dict) else None
        for point in points if isinstance(points, list) else []:
            if numbers(point) is not None:
                yield numbers(point)
    for body in entries(scene, 'bodies'):
        if numbers(body.get('pose')) is not None:
            yield numbers(body['pose'])


def sagging(cable, held):
    """[m] As low as a cable may hang between its ends, or below the only one."""
    length = cable.get('length')
    if not isinstance(length, (int, float)) or not held:
        return []
    span = np.linalg.norm(held[-1] - held[0])
    depth = length if len(held) == 1 else 0.4 * math.sqrt(max(length**2 - span**2, 0))
    return [(held[0] + held[-1]) / 2 - [0, 0, depth]]


def overhanging(cable, held, at):
    """[m] As far as its ends may stick out beyond where it is held."""
    length = cable.get('length')
    at = [{'start': 0, 'end': length}.get(place, place) if isinstance(place, str) else place for place in at]
    if len(held) < 2 or not all(isinstance(value, (int, float)) for value in [length, at[0], at[-1]]):
        return []
    span = np.linalg.norm(held[-1] - held[0])
    if not span > 0:
        return []
    along = (held[-1] - held[0]) / span
    return [held[0] - along * at[0], held[-1] + along * (length - at[-1])]


def longest(scene):
    """[m] Of its cables; 1 without any."""
    lengths = [cable.get('length') for cable in entries(scene, 'cables')]
    return max((length for length in lengths if isinstance(length, (int, float))), default=1.0)


def fitted(scene):
    """Focal point [m] and distance [m] of a camera that sees what is in the scene."""
    places = np.array(list(known_places(scene)))
    if len(places) == 0:
        return np.zeros(3), max(CLOSEST, 1.5 * longest(scene))
    low, high = places.min(axis=0), places.max(axis=0)
    size = max(np.linalg.norm(high - low), 0.3 * longest(scene))
    margin = ROBOT_MARGIN if 'robot' in scene else MARGIN
    return (low + high) / 2, max(CLOSEST, margin * size / 2 / math.sin(FIELD_OF_VIEW / 2))


def renamed(value, node):
    """The configuration, with the node's topics in place of those of /cable."""
    if isinstance(value, dict):
        return {key: renamed(item, node) for key, item in value.items()}
    if isinstance(value, list):
        return [renamed(item, node) for item in value]
    if isinstance(value, str) and (value == '/cable' or value.startswith('/cable/')):
        return node + value[len('/cable'):]
    return value


def without_plugins(view):
    """The view without what this package adds to rviz."""
    def kept(items):
        return [item for item in items if not item['Class'].startswith('verlet_cable/')]

    manager = view['Visualization Manager']
    view['Panels'] = kept(view['Panels'])
    manager['Displays'] = kept(manager['Displays'])
    manager['Tools'] = kept(manager['Tools'])


def aim(view, scene):
    """Points the camera at the scene."""
    focus, distance = fitted(scene)
    camera = view['Visualization Manager']['Views']['Current']
    camera['Focal Point'] = dict(zip('XYZ', focus.tolist()))
    camera['Distance'] = float(distance)
    for display in view['Visualization Manager']['Displays']:
        if display['Class'] == 'rviz/Grid':
            display['Cell Size'] = float(cell_size(distance))
        if display['Class'] == 'rviz/TF':
            display['Marker Scale'] = float(AXES * distance)


def cell_size(distance):
    """[m] Of a grid, 1, 2 or 5 times a power of ten: about fifteen cells across the picture."""
    size = distance / 15
    power = 10.0 ** math.floor(math.log10(size))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= size)


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__.split('\n', maxsplit=1)[0])
    path, node, scene_path, fit = sys.argv[1:5]
    try:
        with open(path, encoding='utf-8') as file:
            view = yaml.safe_load(file)
    except (OSError, yaml.YAMLError) as error:
        sys.exit(f'rviz_view.py: {path}: cannot be read: {error}')
    try:
        with open(scene_path, encoding='utf-8') as file:
            scene = yaml.safe_load(file)
    except (OSError, yaml.YAMLError):
        scene = None  # the node says what is wrong with it
    if not isinstance(scene, dict):
        scene = {}
    node = rosgraph.names.ns_join(rosgraph.names.get_ros_namespace(), node)
    view = renamed(view, node)
    view['Visualization Manager']['Global Options']['Fixed Frame'] = str(scene.get('frame_id', 'world'))
    if not has_plugins():
        without_plugins(view)
        print(f'rviz_view.py: {PLUGINS} is not built: rviz opens without panel, tools and legend. With librviz-dev installed, '
              'configure and build the workspace again (catkin_make --force-cmake)', file=sys.stderr)
    if fit.lower() == 'true':  # roslaunch's own are capitalized
        aim(view, scene)
    adapted = os.path.join(rospkg.get_ros_home(), f'verlet_cable{node.replace("/", "_")}.rviz')
    with open(adapted, 'w', encoding='utf-8') as file:
        yaml.safe_dump(view, file, sort_keys=False)
    try:
        os.execvp('rviz', ['rviz', '-d', adapted, *sys.argv[5:]])
    except FileNotFoundError:
        sys.exit('rviz_view.py: rviz is not installed: sudo apt install rviz (on Ubuntu 20.04: ros-noetic-rviz)')


if __name__ == '__main__':
    main()
