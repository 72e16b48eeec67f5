"""The stubs say what the compiled module has, and type checkers find them."""
import ast
import os
import re
import subprocess
import sys
from pathlib import Path
from types import WrapperDescriptorType

import pytest

from verlet_cable import _simulation, sim

CHECKOUT = Path(__file__).resolve().parents[2]
PACKAGES = Path(os.environ['VERLET_CABLE_DEVEL']) / 'lib/python3/dist-packages'
STUBS = PACKAGES / 'verlet_cable/_simulation.pyi'
INHERITED = {name for base in (object, Exception) for name in vars(base)} - {'__init__'}

SAMPLE = """
import numpy as np
from verlet_cable.sim import Batch, Scene, SceneError, World

try:
    scene = Scene.load('hose.yaml')
except SceneError as error:
    print(error.errors[0].upper())
world = World(scene, {'hand': ([0.0, 1.0], np.zeros((2, 7)))})
world.set_frame('hand', [0, 0, 1], (0, 0, 0, 1))
status: str = world.step(10)
height: float = float(world.positions('hose')[-1, 2]) + world.energy()['total']
world.track_sensitivity(['drag:hose', 'gravity'], start='given')
by_drag: float = world.sensitivity('positions:hose')[-1, 2, 0] + world.sensitivity(['tension:hose'], 'drag:hose')['tension:hose'].max()
name, node = world.pin('hose', arc_length=0.5, frame_id='hand', clamp=True)
piece: str = world.cut(point=(0, 0, 1)).second
world.set_obstacle('floor', type='plane', pose=[0, 0, -1, 0, 0, 0])
world.tune(wind=[1, 0, 0], materials={'wire': {'drag': 0.1, 'bending_stiffness': [0.1, 0.2]}})
print([event.message for event in world.events() if event.type == 'CUT'], name, node, piece)
batch = Batch(scene, 16, threads=2)
batch.set_world([0, 2], world)
batch.set_world(np.arange(16) < 3, batch.world(0))
batch.worlds[3].set_obstacle('ball', type='sphere', radius=0.1)
batch.cut(3, 'hose', node=5)
moving: list[float] = [world.time for world in batch.worlds]
fewer = Batch([scene, scene], keep_going=True)
print(fewer.errors[0].upper(), fewer.tension('hose', missing=0.0).shape, moving)
print(Batch(world, 16).observations([('positions', 'hose'), ('positions', 'hose', 20)]).shape)
alike = Batch([scene, scene], motion='hands.csv')
batch.set_material('wire', bending_stiffness=np.linspace(1e-3, 1e-2, 16), radius=0.004)
batch.step(100, record_every=10, fields=['positions'])
print(batch.positions('hose').shape, batch.energy()['total'].sum(), batch.state_hash[0], len(alike), status, height)
"""


CAMERA_SAMPLE = """
import numpy as np
from verlet_cable.camera import Camera, coco, presets
from verlet_cable.sim import Batch, Scene, World

world = World(Scene.load('hose.yaml'))
camera = Camera(640, 480, noise={'axial': [0.001, 0, 0.002]}, preset='kinect_v1').look_at([1, 0, 1], (0, 0, 0))
camera.pose = np.array([0, 0, 0, 0, 0, 0, 1.0])
images = camera.render(Batch(world, 3), ['depth', 'rgb'], light={'ambient': 0.5}, looks={'hose': {'color': (1, 0, 0)}})
print(images['depth'].shape, camera.matrix[0, 0], camera.labels(world)[0].upper(), presets()['kinect_v1'].source.upper())
with coco.Dataset('data', keypoints=9) as dataset:
    dataset.add(camera, world, target=[0, 0, 1])
print(len(dataset), coco.crossings(camera.render(world)['truth']))
"""


def split(arguments):
    """`a: tuple[int, str], b: int = 1` at the commas between arguments."""
    pieces, depth = [''], 0
    for character in arguments:
        depth += (character in '([{') - (character in ')]}')
        if character == ',' and depth == 0:
            pieces.append('')
        else:
            pieces[-1] += character
    return [piece.strip() for piece in pieces if piece.strip()]


def compiled_signatures(name, function):
    """Of each overload: ((argument, whether it has a default), ...), as pybind11 writes them into the docstring."""
    lines = re.findall(rf'^(?:\d+\. )?{re.escape(name)}\((.*)\) -> .*$', function.__doc__, re.MULTILINE)
    assert lines, f'no signature of {name} in {function.__doc__!r}'
    return {tuple((argument.split(':')[0].split('=')[0].strip(), '=' in argument) for argument in split(line)) for line in lines}


def stub_signature(function):
    arguments = function.args
    assert not arguments.posonlyargs and not arguments.vararg
    first_default = len(arguments.args) - len(arguments.defaults)
    signature = [(argument.arg, index >= first_default) for index, argument in enumerate(arguments.args)]
    if arguments.kwonlyargs:
        signature.append(('*', False))
    signature += [(argument.arg, default is not None) for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults)]
    if arguments.kwarg:
        signature.append(('**kwargs', False))  # the compiled module does not keep its name
    return tuple(signature)


def has_decorator(function, name):
    return any(isinstance(decorator, ast.Name) and decorator.id == name for decorator in function.decorator_list)


def compiled_members(owner):
    """{name: what it is} of a class or module."""
    if hasattr(owner, '_fields'):  # a named tuple
        return {field: 'variable' for field in owner._fields}
    members = {}
    for name, value in vars(owner).items():
        is_special = name.endswith('__') and callable(value) and not isinstance(value, WrapperDescriptorType)
        if name.startswith('_') and name != '__version__' and (not is_special or name in INHERITED):
            continue
        if isinstance(value, type):
            members[name] = 'class'
        elif isinstance(value, property):
            members[name] = 'property' if value.fset is None else 'variable'
        elif callable(value) or isinstance(value, staticmethod):
            members[name] = compiled_signatures(name, getattr(owner, name))
        else:
            members[name] = 'variable'
    return members


def stub_members(body):
    members = {}
    for node in body:
        if isinstance(node, ast.ClassDef):
            members[node.name] = 'class'
        elif isinstance(node, ast.AnnAssign):
            members[node.target.id] = 'variable'
        elif isinstance(node, ast.FunctionDef) and has_decorator(node, 'property'):
            members[node.name] = 'property'
        elif isinstance(node, ast.FunctionDef):
            members.setdefault(node.name, set()).add(stub_signature(node))
    return members


def differences(owner, body):
    """{name: (in the module, in the stub)} of what is not alike."""
    compiled, stub = compiled_members(owner), stub_members(body)
    return {name: (compiled.get(name), stub.get(name)) for name in {*compiled, *stub} if compiled.get(name) != stub.get(name)}


def test_stubs_are_complete_and_true():
    stubs = ast.parse(STUBS.read_text())
    assert not differences(_simulation, stubs.body)
    classes = {node.name: node for node in stubs.body if isinstance(node, ast.ClassDef)}
    found = {name: differences(getattr(_simulation, name), node.body) for name, node in classes.items() if name != 'SceneError'}
    assert not {name: members for name, members in found.items() if members}
    with pytest.raises(sim.SceneError) as caught:
        sim.Scene.from_dict({})
    assert stub_members(classes['SceneError'].body) == {name: 'variable' for name in vars(caught.value)} == {'errors': 'variable'}


def test_all_is_reexported():
    assert set(sim.__all__) == {name for name in vars(_simulation) if isinstance(getattr(_simulation, name), type)}


def check_types(tmp_path, program, *options):
    (tmp_path / 'program.py').write_text(program)
    checked = subprocess.run([sys.executable, '-m', 'mypy', '--strict', *options, '--cache-dir', str(tmp_path / 'cache'), 'program.py'],
                             cwd=tmp_path, env=dict(os.environ, MYPYPATH=str(PACKAGES)), stdout=subprocess.PIPE, text=True)
    return checked.returncode, checked.stdout


# What there is for the modules that have stubs, and is not in them.
WITHOUT_STUBS = r"""
verlet_cable\.environments\.[a-z_]+
verlet_cable\.(sim|_simulation)\.(Batch|Scene|World|Worlds)
verlet_cable\.(sim|_simulation)\.Worlds\.__init__
"""  # its inner modules; the metaclass of compiled classes; what refuses to make Worlds


def test_stubtest_agrees(tmp_path):
    pytest.importorskip('mypy.stubtest')
    (tmp_path / 'allowed').write_text(WITHOUT_STUBS)
    path = os.pathsep.join([str(PACKAGES), *filter(None, [os.environ.get('PYTHONPATH')])])
    done = subprocess.run([sys.executable, '-m', 'mypy.stubtest', '--concise', '--allowlist', str(tmp_path / 'allowed'), 'verlet_cable.sim',
                           'verlet_cable._simulation', 'verlet_cable.environments'], cwd=tmp_path,
                          env=dict(os.environ, MYPYPATH=str(PACKAGES), PYTHONPATH=path), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True)
    assert done.returncode == 0, done.stdout


# Of the pages only the calls of this package are held to more than what mypy asks of any program.
AS_PAGES = ['--allow-untyped-defs', '--allow-untyped-calls', '--allow-incomplete-defs', '--allow-redefinition', '--ignore-missing-imports',
            '--disable-error-code=import']


@pytest.mark.parametrize('page', sorted(path for folder in ('python', 'how_to') for path in (CHECKOUT / 'doc' / folder).glob('*.md')
                                        if '```python' in path.read_text()) + [CHECKOUT / 'README.md'], ids=lambda path: path.stem)
def test_type_checkers_accept_what_pages_show(tmp_path, page):
    pytest.importorskip('mypy')
    program = '\n'.join(re.findall(r'^```python[^\n]*\n(.*?)^```', page.read_text(), re.DOTALL | re.MULTILINE))
    status, text = check_types(tmp_path, program, *AS_PAGES)
    assert status == 0, text


def test_type_checkers_find_the_stubs(tmp_path):
    pytest.importorskip('mypy')
    pytest.importorskip('numpy.typing')
    status, text = check_types(tmp_path, SAMPLE)
    assert status == 0, text
    wrong = ['batch.worlds["a"]', 'batch.cut("hose", node=5)', 'world.step("many")', 'world.swing()', 'world.cut("hose", 3)', 'batch.status.upper()', 'Scene.load(3)']
    status, text = check_types(tmp_path, SAMPLE + '\n'.join(wrong) + '\n')
    assert status == 1 and text.count('error:') == len(wrong), text
    assert (PACKAGES / 'verlet_cable/py.typed').is_file()


def test_type_checkers_know_the_camera(tmp_path):
    pytest.importorskip('mypy')
    pytest.importorskip('numpy.typing')
    status, text = check_types(tmp_path, CAMERA_SAMPLE)
    assert status == 0, text
    status, text = check_types(tmp_path, CAMERA_SAMPLE + 'Camera("wide")\ncamera.look_at(3)\ncamera.render(3)\n')
    assert status == 1 and text.count('error:') == 3, text
