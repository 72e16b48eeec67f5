"""What depth cameras see of worlds: depth, colors, masks, points, and where the nodes of cables really are.

    from verlet_cable.camera import Camera
    from verlet_cable.sim import Scene, World

    camera = Camera(noise={'axial': [0.001, 0, 0.002], 'dropout_angle': 80}).look_at(eye=[0.5, -1.5, 1.0], target=[0.5, 0, 0.8])
    world = World(Scene.load('config/hanging_cable.yaml'))  # a file of the package
    images = camera.render(world)
    depth = images['depth']                        # (480, 640) float32 [m], NaN where there is none
    rgb, mask = images['rgb'], images['mask']      # (480, 640, 3) uint8, (480, 640) uint16
    visible = images['truth']['rope']['visible']   # (n + 1,) bool: which nodes are

Needs Embree where it is built (Debian: libembree-dev). `verlet_cable.camera.coco` writes data sets to learn from.
"""
try:
    from verlet_cable import _camera as _camera
except ImportError as error:
    raise ImportError(f'verlet_cable.camera: {error}; the camera is built where Embree is installed: '
                      'sudo apt-get install libembree-dev, and build the package again') from error

from .camera import Camera as Camera
from .camera import Preset as Preset
from .camera import presets as presets

__all__ = ['Camera', 'Preset', 'presets']
