"""cable_convert makes scenes of USD curves and MuJoCo cables, and cable_sim --usd and --vtk write what --output has."""
import json
import math
import os
import subprocess
import sys
import xml.etree.ElementTree
from pathlib import Path

import numpy as np
import pytest

from verlet_cable.convert.cables import scene_text
from verlet_cable.convert.errors import ConvertError
from verlet_cable.convert.mujoco_cables import mujoco_cables
from verlet_cable.convert.usd_cables import usd_cables
from verlet_cable.convert.usda import read_usda
from verlet_cable.sim import Scene, World

DEVEL = Path(os.environ['VERLET_CABLE_DEVEL'])

USD = '''#usda 1.0
(
    upAxis = "Y"
    metersPerUnit = 0.01
)
def Xform "rig" (
    kind = "group"
)
{
    double3 xformOp:translate = (0, 100, 0)
    float3 xformOp:rotateXYZ = (0, 0, 90)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ"]
    # Two curves.
    def BasisCurves "hair 1"
    {
        uniform token type = "linear"
        int[] curveVertexCounts = [2, 3]
        point3f[] points.timeSamples = {
            0: [(0, 0, 0), (10, 0, 0), (0, 0, 5), (10, 0, 5), (10, 10, 5)],
            1: None,
        }
        float[] widths = [1, 2] (interpolation = "uniform")
        color3f[] primvars:displayColor = [(1, 0.5, 0)]
        custom rel skel:target = </rig>
    }
    def Cube "box" { double size = 2 }
}
'''
MUJOCO = '''<mujoco>
  <option timestep="0.004" gravity="0 0 -9.8"/>
  <worldbody>
    <body pos="0 0 1" euler="0 0 90">
      <composite prefix="wire" type="cable" curve="s" count="11 1 1" size="0.5" offset="0.2 0 0" initial="none">
        <plugin plugin="mujoco.elasticity.cable">
          <config key="twist" value="1e6"/> <config key="bend" value="2e6"/> <config key="flat" value="false"/>
        </plugin>
        <geom type="capsule" size=".005" rgba=".8 .2 .1 1" density="1200"/>
      </composite>
    </body>
  </worldbody>
  <equality><connect body1="a" body2="b"/></equality>
</mujoco>
'''


def run(*arguments):
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))
    return subprocess.run([sys.executable, str(DEVEL / 'lib/verlet_cable/cable_convert'), *map(str, arguments)], env=environment,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def test_curves_are_placed_and_scaled():
    found = usd_cables(USD)
    first, second = found.cables
    # x of the rig is y of the file, which is z here; its origin is 1 m up.
    np.testing.assert_allclose(first.points, [[0, 0, 1], [0, 0, 1.1]], atol=1e-12)
    np.testing.assert_allclose(second.points, [[0, -0.05, 1], [0, -0.05, 1.1], [-0.1, -0.05, 1.1]], atol=1e-12)
    assert (first.radius, second.radius) == pytest.approx((0.005, 0.01))
    assert first.color == (1, 0.5, 0, 1)
    notes = '\n'.join(found.notes)
    for text in ('/rig/hair 1: it moves over time', '/rig/box: a Cube is not converted', 'y is up', 'weigh as much as water'):
        assert text in notes


def test_cables_of_mujoco_keep_their_material():
    found = mujoco_cables(MUJOCO)
    cable, = found.cables
    assert len(cable.points) == 11
    np.testing.assert_allclose(cable.points[[0, -1]], [[0, 0.2, 1], [0, 0.7, 1]], atol=1e-12)
    second = math.pi * 0.005 ** 4 / 4
    assert cable.bending_stiffness == pytest.approx([2e6 * second] * 2)
    assert cable.torsional_stiffness == pytest.approx(1e6 * 2 * second)
    assert cable.linear_density == pytest.approx(1200 * math.pi * 0.005 ** 2)
    assert (found.gravity, found.time_step, cable.start, cable.rest_curvature) == ([0, 0, -9.8], 0.004, 'clamp', 'straight')
    assert any(note.startswith('<equality>: ') for note in found.notes)


def test_what_is_curved_at_rest_stays_so():
    curved = MUJOCO.replace('curve="s"', 'curve="cos(s) sin(s) 0"').replace('size="0.5"', 'size="0 0.1 0.5"')
    cable, = mujoco_cables(curved).cables
    assert cable.rest_curvature == 'initial'
    np.testing.assert_allclose(np.linalg.norm(cable.points - [0, 0.2, 1], axis=1), 0.1)  # a quarter of a circle
    assert mujoco_cables(curved.replace('value="false"', 'value="true"')).cables[0].rest_curvature == 'straight'


@pytest.mark.parametrize('initial, start', [('initial="none"', 'clamp'), ('initial="ball"', 'hinge'), ('', 'hinge'), ('initial="free"', None)])
def test_starts_are_held_as_in_mujoco(initial, start):
    assert mujoco_cables(MUJOCO.replace('initial="none"', initial)).cables[0].start == start
    moving = mujoco_cables(MUJOCO.replace('initial="none"', initial).replace('<composite', '<freejoint/><composite'))
    assert moving.cables[0].start is None
    assert any('its start is not held' in note for note in moving.notes) == (start is not None)


def test_a_flat_cable_is_stiffer_across():
    flat = MUJOCO.replace('type="capsule" size=".005"', 'type="box" size="0.01 0.004 0.001"')
    cable, = mujoco_cables(flat).cables
    about_y, about_z = cable.bending_stiffness
    assert about_y == pytest.approx(2e6 * 0.002 ** 3 * 0.008 / 12) and about_z == pytest.approx(16 * about_y)
    assert cable.radius == pytest.approx(math.sqrt(4 * 0.004 * 0.001 / math.pi))


FLAT = (MUJOCO.replace('type="capsule" size=".005"', 'type="box" size="0.025 0.02 0.0015"').replace('value="2e6"', 'value="1e7"')
        .replace('value="1e6"', 'value="1e8"'))


@pytest.mark.parametrize('initial', ['none', 'ball'])
def test_a_flat_cable_lies_as_in_mujoco(initial):
    """A belt on its edge, as its body is turned by a quarter: it sinks by its own weight as a beam of its height does."""
    model = FLAT.replace('initial="none"', f'initial="{initial}"').replace('euler="0 0 90"', 'euler="90 0 0"')
    found = mujoco_cables(model)
    cable, = found.cables
    if initial == 'ball':
        # Without a clamp, y is level: the stiffnesses change places.
        assert cable.bending_stiffness == pytest.approx([0.16, 0.0009])
        return
    world = World(Scene.from_yaml(scene_text(found, 'belt.xml')))
    assert world.settle()
    weight = 1200 * 0.04 * 0.003 * 9.8
    assert 1 - world.positions('wire')[-1, 2] == pytest.approx(weight * 0.5 ** 4 / 8 / 0.16, rel=0.01)


def test_a_flat_cable_bends_about_its_first_bend():
    """Its first body has y in the plane of the first two segments."""
    bent = FLAT.replace('curve="s" count="11 1 1" size="0.5"', 'vertex="0 0 0 1 0 0 1 1 0 0 1 0"')
    bent = bent.replace('euler="0 0 90"', 'euler="90 0 0"')
    cable, = mujoco_cables(bent).cables
    np.testing.assert_allclose(cable.y_axis, [0, 0, 1], atol=1e-12)
    free, = mujoco_cables(bent.replace('initial="none"', 'initial="free"').replace('euler="90 0 0"', 'euler="45 0 0"')).cables
    assert free.y_axis is None
    turned = mujoco_cables(bent.replace('initial="none"', 'initial="free"').replace('euler="90 0 0"', 'euler="30 0 0"')).notes
    assert any('its section is turned by 30 degrees about it' in note for note in turned)


def test_options_of_mujoco_are_followed():
    assert mujoco_cables(MUJOCO.replace('timestep="0.004" ', '')).time_step == 0.002
    assert mujoco_cables(MUJOCO.replace('<option timestep="0.004" gravity="0 0 -9.8"/>', '')).time_step == 0.002
    still = MUJOCO.replace('-9.8"/>', '-9.8"><flag gravity="disable"/></option>')
    assert mujoco_cables(still).gravity == [0, 0, 0]


def test_the_weight_of_caps_is_told():
    # 10 capsules of 0.05 m and 4/3 of 5 mm each more.
    assert any('it weighs 13.3 % more in MuJoCo' in note for note in mujoco_cables(MUJOCO).notes)
    assert not any('capsules' in note for note in mujoco_cables(MUJOCO.replace('density="1200"', 'mass="0.1"')).notes)


CURVE = """#usda 1.0
(
    metersPerUnit = 1
    upAxis = "Z"
)
def Xform "rig" HEAD
{
    token visibility = "SEEN"
    def BasisCurves "hair"
    {
        KIND
        int[] curveVertexCounts = [COUNT]
        point3f[] points = [POINTS]
        float[] widths = [0.02]
    }
}
"""


def curve(points=((0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)), kind='', head='', seen='inherited'):
    text = CURVE.replace('KIND', kind).replace('HEAD', head).replace('SEEN', seen).replace('COUNT', str(len(points)))
    return text.replace('POINTS', ', '.join(map(str, points)))


@pytest.mark.parametrize('kind, points, ends, middle', [
    ('uniform token basis = "bezier"', [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)], [(0, 0, 0), (1, 0, 0)], (0.5, 0.75, 0)),
    ('', [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)], [(0, 0, 0), (1, 0, 0)], (0.5, 0.75, 0)),
    ('uniform token basis = "bspline"', [(0, 0, 0), (0, 6, 0), (6, 6, 0), (6, 0, 0)], [(1, 5, 0), (5, 5, 0)], (3, 5.75, 0)),
    ('uniform token basis = "catmullRom"', [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)], [(0, 1, 0), (1, 1, 0)], (0.5, 1.125, 0)),
    ('uniform token basis = "catmullRom"\nuniform token wrap = "pinned"', [(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 0, 0), (2, 0, 0)],
     (1, 0, 0)),
])
def test_cubic_curves_are_evaluated(kind, points, ends, middle):
    cable, = usd_cables(curve(points, kind)).cables
    np.testing.assert_allclose(cable.points[[0, -1]], ends, atol=1e-12)
    np.testing.assert_allclose(cable.points[len(cable.points) // 2], middle, atol=1e-12)


@pytest.mark.parametrize('changed, why', [({'head': '(active = false)'}, 'it is not active'),
                                          ({'seen': 'invisible'}, 'it is invisible at the start')])
def test_what_is_not_there_is_no_cable(changed, why):
    other = curve().split(')', 1)[1].replace('"rig"', '"other"')
    found = usd_cables(curve(**changed) + other)
    assert [cable.element for cable in found.cables] == ['/other/hair']
    assert f'/rig: {why}: left out' in found.notes
    with pytest.raises(ConvertError, match=f'no BasisCurves.*\n/rig: {why}'):
        usd_cables(curve(**changed))
    with pytest.raises(ConvertError, match='it only changes a prim of another file'):
        usd_cables(curve().replace('def Xform', 'over'))


@pytest.mark.parametrize('name, text, error', [
    ('a.usda', '#usda 1.0\n' + 'def Xform "X" {\n' * 20000, 'line 103: more than 100 brackets in each other'),
    ('a.usda', '#usda 1.0\ndef Xform "X" { float[] a = ' + '[' * 20000, 'line 2: more than 100 brackets in each other'),
    ('a.xml', '<mujoco><worldbody>' + '<body>' * 5000 + '</body>' * 5000 + '</worldbody></mujoco>', '<body>: inside of 101 others'),
    ('a.xml', MUJOCO.replace('11 1 1', '1000000000 1 1'), "count: '1000000000 1 1'; allowed: at most 100001"),
    ('a.usda', curve([(0, 0, 0)] * 5), '/rig/hair.curveVertexCounts: 5; allowed: at least 4 for a curve of basis "bezier", 3 more'),
], ids=['prims', 'lists', 'bodies', 'points', 'bezier'])
def test_files_without_measure_are_refused(tmp_path, name, text, error):
    (tmp_path / name).write_text(text)
    done = run(tmp_path / name, tmp_path / 'out.yaml')
    assert done.returncode == 2 and error in done.stderr and 'Traceback' not in done.stderr, done.stderr


@pytest.mark.parametrize('name, text', [('a.usda', USD), ('a.xml', MUJOCO)])
def test_the_program_writes_scenes_that_run(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    done = run(tmp_path / name, tmp_path / 'out.yaml')
    assert done.returncode == 0, done.stderr
    assert 'cable_convert: note: ' in done.stderr and 'segments' in done.stdout
    world = World(Scene.load(tmp_path / 'out.yaml'))
    expected = (usd_cables if name == 'a.usda' else mujoco_cables)(text).cables
    assert len(world.cable_names) == len(expected)
    for cable, found in zip(world.cable_names, expected):
        np.testing.assert_allclose(world.positions(cable), found.points, atol=1e-9)
    assert world.step(20) == 'ok'


@pytest.mark.parametrize('name, text, error', [
    ('a.usda', '#usda 2.0', "line 1: '#usda 2.0'; allowed: #usda 1.0"),
    ('a.usda', USD.replace('[2, 3]', '[2, 4]'), '/rig/hair 1.curveVertexCounts: '),
    ('a.usda', USD.replace('[1, 2] (', '[1, -2] ('), '/rig/hair 1.widths: -2; allowed: above 0'),
    ('a.usda', USD.replace('"linear"', '"round"'), '''/rig/hair 1.type: 'round'; allowed: "linear", "cubic"'''),
    ('a.usda', USD.replace('(10, 0, 0)', '(10, 0)'), '/rig/hair 1.points: '),
    ('a.usda', USD.replace('(10, 0, 0)', '(0, 0, 0)'), '/rig/hair 1, curve 0: points 0 and 1 are at one place'),
    ('a.usda', USD.replace('double size = 2 }', 'double size 2 }'), "line 26: '2'; allowed: "),
    ('a.usda', '#usda 1.0\ndef Cube "a" {}', 'no BasisCurves; allowed: a file with at least one'),
    ('a.xml', '<mujoco>', 'no element found'),
    ('a.xml', '<robot/>', '<robot>; allowed: <mujoco>'),
    ('a.xml', MUJOCO.replace('11 1 1', '1.5'), '<composite prefix="wire"> count: \'1.5\'; allowed: an integer from 2'),
    ('a.xml', MUJOCO.replace('curve="s"', 'curve="tan(s)"'), '<composite prefix="wire"> curve: \'tan(s)\'; allowed: up to three of'),
    ('a.xml', MUJOCO.replace('2e6', 'stiff'), "<config> value: 'stiff'; allowed: a finite number"),
    ('a.xml', MUJOCO.replace('2e6', '-1'), '<composite prefix="wire"> bend: -1; allowed: 0 or more [Pa]'),
    ('a.xml', MUJOCO.replace('elasticity.cable"', 'elasticity.shell"'), "plugin: 'mujoco.elasticity.shell'; allowed: "),
    ('a.xml', MUJOCO.replace('.005"', '0"'), "geom size: '0'; allowed: numbers above 0 [m]"),
    ('a.xml', MUJOCO.replace('curve="s"', ''), '<composite prefix="wire"> curve: missing; allowed: up to three of'),
    ('a.obj', '', "a name that ends in '.obj'; allowed: .usda, .xml, .mjcf"),
], ids=lambda value: value[-30:])
def test_what_cannot_be_converted_is_named(tmp_path, name, text, error):
    (tmp_path / name).write_text(text)
    done = run(tmp_path / name, tmp_path / 'out.yaml')
    assert done.returncode == 2
    assert done.stderr.startswith(f'cable_convert: {tmp_path / name}: ') and error in done.stderr, done.stderr
    assert not (tmp_path / 'out.yaml').exists()


def test_files_that_are_not_there_or_cannot_be_written_are_named(tmp_path):
    (tmp_path / 'a.xml').write_text(MUJOCO)
    done = run(tmp_path / 'b.xml', tmp_path / 'out.yaml')
    assert (done.returncode, 'cannot read it: No such file' in done.stderr) == (2, True)
    done = run(tmp_path / 'a.xml', tmp_path / 'out.txt')
    assert (done.returncode, 'allowed: a name that ends in .yaml' in done.stderr) == (2, True)
    done = run(tmp_path / 'a.xml', tmp_path / 'nowhere/out.yaml')
    assert (done.returncode, 'cannot write' in done.stderr) == (3, True)


BREAKING = {
    'time_step': 0.005,
    'materials': {'m': {'linear_density': 0.1, 'radius': 0.005, 'breaking_tension': 4.0},
                  'thick': {'linear_density': 0.1, 'radius': 0.02}},
    'cables': [{'name': 'rope', 'length': 1.0, 'segments': 10, 'material': 'm', 'point_masses': [{'at': 'end', 'mass': 0.5}],
                'attachments': [{'name': 'hand', 'at': 'start', 'offset': [0, 0, 2]}],
                'initial': {'type': 'straight', 'from': [0, 0, 2], 'to': [0.8, 0, 1.4]}},
               {'name': 'other', 'length': 1.0, 'segments': 4, 'material': 'm',
                'sections': [{'from': 0.5, 'to': 1.0, 'material': 'thick'}],
                'initial': {'type': 'straight', 'from': [0, 1, 2], 'to': [1, 1, 2]}}],
    'bodies': [{'name': 'plug', 'mass': 0.1, 'shapes': [{'type': 'box', 'size': [0.1, 0.2, 0.3]}], 'pose': [5, 0, 1, 0, 0, 0]}],
    'obstacles': [{'name': 'floor', 'type': 'plane', 'pose': [0, 0, -20, 0, 0, 0]}],
}


@pytest.fixture
def exported(cable_sim, tmp_path):
    """({time: {cable: rows x, y, z, vx, vy, vz, tension}}, folder)"""
    cable_sim(BREAKING, '--duration', '0.5', '--rate', '50', '--usd', 'a.usda', '--vtk', 'vtk')
    rows = {}
    for line in (tmp_path / 'rows.csv').read_text().splitlines()[1:]:
        time, cable, _, *numbers = line.split(',')
        rows.setdefault(float(time), {}).setdefault(cable, []).append([float(number) for number in numbers])
    assert len({tuple(cables) for cables in rows.values()}) > 1, 'the rope must break'
    return rows, tmp_path


def at(attribute, code):
    """Held from sample to sample, as USD has arrays of other lengths and texts."""
    if not attribute.samples:
        return attribute.value
    earlier = [time for time in attribute.samples if time <= code]
    return attribute.samples[max(earlier or attribute.samples)]


def test_usd_has_the_rows_of_the_output(exported):
    rows, folder = exported
    metadata, (world,) = read_usda((folder / 'a.usda').read_text())
    assert {key: metadata[key] for key in ('upAxis', 'metersPerUnit', 'timeCodesPerSecond', 'startTimeCode', 'endTimeCode')} == {
        'upAxis': 'Z', 'metersPerUnit': 1, 'timeCodesPerSecond': 50, 'startTimeCode': 0, 'endTimeCode': 25}
    assert metadata['defaultPrim'] == world.name
    folders = {folder.name: {prim.name: prim for prim in folder.children} for folder in world.children}
    assert set(folders) == {'Cables', 'Bodies', 'Obstacles'}
    for time, cables in rows.items():
        visible = set()
        for name, prim in folders['Cables'].items():
            assert prim.type == 'BasisCurves' and prim.attributes['type'].value == 'linear'
            if at(prim.attributes['visibility'], round(time * 50)) == 'invisible':
                continue
            visible.add(name)
            points = np.array(at(prim.attributes['points'], round(time * 50)))
            np.testing.assert_array_equal(points, np.array(cables[name])[:, :3])
            assert at(prim.attributes['curveVertexCounts'], round(time * 50)) == [len(points)]
        assert visible == set(cables)
    widths = {name: folders['Cables'][name].attributes['widths'] for name in ('rope', 'other')}
    assert widths['rope'].value == [0.01] and widths['rope'].metadata == {'interpolation': 'constant'}
    assert widths['other'].value == [0.01, 0.01, 0.025, 0.04, 0.04] and widths['other'].metadata == {'interpolation': 'vertex'}
    plug = folders['Bodies']['plug']
    assert plug.children[0].type == 'Cube' and plug.children[0].attributes['xformOp:scale'].value == (0.1, 0.2, 0.3)
    assert len(plug.attributes['xformOp:translate'].samples) == 26
    # Each operation in the order is an attribute.
    for prim in (plug, plug.children[0], folders['Obstacles']['floor']):
        assert set(prim.attributes['xformOpOrder'].value) <= set(prim.attributes)


def test_what_was_written_can_be_converted(exported):
    rows, folder = exported
    found = usd_cables((folder / 'a.usda').read_text())
    for cable in found.cables:
        if cable.name in rows[0]:
            np.testing.assert_array_equal(cable.points, np.array(rows[0][cable.name])[:, :3])


def test_usd_has_a_width_for_each_point_after_a_break_too(cable_sim, tmp_path):
    rope, other = BREAKING['cables']
    sections = dict(rope, sections=[{'from': 0.5, 'to': 1.0, 'material': 'thick'}])
    cable_sim(dict(BREAKING, cables=[sections, other]), '--duration', '0.5', '--rate', '50', '--usd', 'a.usda')
    _, (world,) = read_usda((tmp_path / 'a.usda').read_text())
    curves = {prim.name: prim.attributes for prim in world.children[0].children}
    assert len(curves) > 2, 'the rope must break'
    for attributes in curves.values():
        if attributes['widths'].metadata['interpolation'] == 'constant':
            assert len(attributes['widths'].value) == 1
            continue
        for code in range(26):
            assert len(at(attributes['widths'], code)) == len(at(attributes['points'], code))
    # Its first piece has one radius.
    np.testing.assert_allclose(sorted(set(at(curves['rope']['widths'], 0))), [0.01, 0.025, 0.04])
    assert set(at(curves['rope']['widths'], 25)) == {0.01}


def vtk_names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_vtk_leaves_nothing_of_an_earlier_run(cable_sim, tmp_path):
    cable_sim(BREAKING, '--duration', '0.1', '--rate', '50', '--vtk', 'new')
    cable_sim(BREAKING, '--duration', '0.2', '--rate', '50', '--vtk', 'old')
    (tmp_path / 'old/notes.txt').write_text('kept')
    assert 'cables_0010.vtp' in vtk_names(tmp_path / 'old')
    cable_sim(BREAKING, '--duration', '0.1', '--rate', '50', '--vtk', 'old')
    assert vtk_names(tmp_path / 'old') == sorted(vtk_names(tmp_path / 'new') + ['notes.txt'])
    bare = dict(BREAKING, bodies=[], obstacles=[])
    cable_sim(bare, '--duration', '0.1', '--rate', '50', '--vtk', 'old')
    assert vtk_names(tmp_path / 'old') == [name for name in vtk_names(tmp_path / 'new') if name.startswith('cables')] + ['notes.txt']


@pytest.mark.parametrize('output', ['v', 'v/', 'v/../v', 'v/cables.pvd', 'v/bodies_0003.vtp'])
def test_what_vtk_writes_is_nothing_else(tmp_path, output):
    (tmp_path / 'scene.yaml').write_text(json.dumps(BREAKING))
    for makes in (False, True):
        if makes:
            (tmp_path / 'v').mkdir()
        command = [str(DEVEL / 'lib/verlet_cable/cable_sim'), 'scene.yaml', '--duration', '0.01', '--vtk', 'v', '--output', output]
        done = subprocess.run(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert done.returncode == 2 and 'cable_sim: --output: ' in done.stderr, done.stderr
        if output in ('v/cables.pvd', 'v/bodies_0003.vtp') and makes:
            assert f'--output: "{output}" is what --vtk "v" writes; allowed: another file' in done.stderr
    assert list((tmp_path / 'v').iterdir()) == []


def test_vtk_has_the_rows_of_the_output(exported):
    rows, folder = exported
    index = xml.etree.ElementTree.parse(folder / 'vtk/cables.pvd').getroot()
    sets = index.findall('./Collection/DataSet')
    assert [float(entry.get('timestep')) for entry in sets] == list(rows)
    for entry, cables in zip(sets, rows.values()):
        piece = xml.etree.ElementTree.parse(folder / 'vtk' / entry.get('file')).getroot().find('./PolyData/Piece')

        def array(path, name, width=1):
            found = piece.find(f'./{path}/DataArray[@Name="{name}"]')
            assert int(found.get('NumberOfComponents', 1)) == width
            numbers = np.array(found.text.split(), float)
            return numbers.reshape(-1, width) if width > 1 else numbers

        expected = np.concatenate([np.array(nodes) for nodes in cables.values()])
        assert int(piece.get('NumberOfPoints')) == len(expected)
        np.testing.assert_array_equal(array('Points', 'points', 3), expected[:, :3])
        np.testing.assert_array_equal(array('PointData', 'velocity', 3), expected[:, 3:6])
        np.testing.assert_array_equal(array('PointData', 'tension'), expected[:, 6])
        radius = array('PointData', 'radius')
        assert set(radius) == {0.005, 0.0125, 0.02} and len(radius) == len(expected)
        lines = array('Lines', 'connectivity').astype(int).reshape(-1, 2)
        assert len(lines) == int(piece.get('NumberOfLines')) == len(expected) - len(cables)
        np.testing.assert_array_equal(array('Lines', 'offsets'), 2 * np.arange(1, len(lines) + 1))
        assert (lines[:, 1] - lines[:, 0] == 1).all()
        np.testing.assert_array_equal(array('CellData', 'tension'), expected[lines[:, 0], 6])
        assert set(array('CellData', 'radius')) == {0.005, 0.02}
        assert set(array('CellData', 'object')) == set(range(len(cables)))


def test_text_of_usd_is_read():
    metadata, (prim,) = read_usda('''#usda 1.0
( "a comment" customLayerData = { string a = "b" } subLayers = [@./other.usda@] )
over "a" ( prepend references = @x.usd@</y> )
{
    uniform token[] b = ["c", 'd'] ( doc = """two
lines""" )
    double e.timeSamples = { 0: 1.5e-3, 2: -.5, }
    prepend rel f = [</a>, </b>]
    variantSet "v" = { "w" { def Cube "z" {} } }
    reorder properties = ["b"]
}
''')
    assert metadata['subLayers'] == ['@./other.usda@'] and prim.metadata['references'] == '@x.usd@'
    assert prim.attributes['b'].value == ['c', 'd'] and prim.attributes['b'].metadata['doc'] == 'two\nlines'
    assert prim.attributes['e'].samples == {0: 0.0015, 2: -0.5} and prim.attributes['e'].first() == 0.0015
    with pytest.raises(ConvertError, match="line 2: 'the end of the file'; allowed: "):
        read_usda('#usda 1.0\ndef Cube "a" {')
