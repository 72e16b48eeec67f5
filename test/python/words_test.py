"""What is refused is named in the words of Python, by its key or argument."""
from decimal import Decimal
from pathlib import Path

import numpy
import pytest
from worlds import IDENTITY, world_of

from verlet_cable.sim import Batch, Scene, SceneError, World


def errors_of(scene):
    with pytest.raises(SceneError) as caught:
        Scene.from_dict(scene)
    return caught.value.errors


def cable(**keys):
    return {'materials': {'m': {'linear_density': 0.1, 'radius': 0.005}},
            'cables': [{'name': 'a', 'length': 1, 'segments': 4, 'material': 'm', **keys}]}


NET = {'nets': [{'name': 'flag', 'mass': 0.1, 'links': 'limited', 'grid': {'rows': 3, 'columns': 4, 'spacing': 0.1}}]}


@pytest.mark.parametrize('value, text', [
    (b'1', "<class 'bytes'>"), ((i for i in [1]), "<class 'generator'>"), (object(), "<class 'object'>"), (1j, "<class 'complex'>"),
    ('\ud800', r"'\ud800'"), (Decimal('nan'), '"NaN"'), (None, 'nothing'), ({1, 2}, "<class 'set'>"),
])
def test_values_that_scenes_do_not_have_are_named_by_their_key(value, text):
    scene = dict(cable(length=value), time_step=-1)
    length, step = errors_of(scene)
    assert length.startswith(f'cables[0].length: {text}; allowed: any number above 0') and step.startswith('time_step: -1')
    if not isinstance(value, Decimal):  # which is text
        error, = errors_of(cable(name=value))
        assert error.startswith(f'cables[0].name: {text}; allowed: ')
    assert errors_of(cable(attachments=[{'name': 'l', 'at': 'end', 'offset': [0, value, 0]}]))[0].startswith(
        'cables[0].attachments[0].offset: [0, ')
    assert errors_of(cable(attachments=value))[0].startswith(f'cables[0].attachments: {text}; allowed: a list')


@pytest.mark.parametrize('key, text', [(5, '5'), (None, 'None'), (b'x', "b'x'"), ('\ud800', r"'\ud800'"), ((1, 2), '(1, 2)')])
def test_keys_are_text(key, text):
    error, = errors_of(dict(cable(), **{'fluid': {'density': 1, key: 1}}))
    assert error.startswith(f'fluid: key {text}; allowed: velocity, ')
    scene = cable()
    scene['materials'][key] = scene['materials']['m']
    assert errors_of(scene)[0].startswith(f'materials: name {text}; allowed: ')


def test_a_name_is_no_boolean():
    for key in ('name', 'material'):
        errors = errors_of(cable(**{key: True}))
        assert any(error.startswith(f'cables[0].{key}: "true"; allowed: ') for error in errors), errors
    assert errors_of(dict(cable(), frame_id=False))[0].startswith('frame_id: "false"')
    Scene.from_dict(dict(cable(), numerical_damping=True))


def test_decimals_are_numbers():
    assert World(Scene.from_dict(cable(length=Decimal('1E+1')))).state_hash == World(Scene.from_dict(cable(length=10))).state_hash


def test_what_contains_itself_is_refused():
    endless = []
    endless.append([endless] * 10)
    error, = errors_of(cable(attachments=endless))
    assert error.startswith('cables[0].attachments[0][0]') and 'nested deeper than 32 levels' in error


@pytest.mark.parametrize('call, argument', [
    (lambda s, t: World(s).positions(t), 'name'), (lambda s, t: World(s).wrench(t), 'attachment'),
    (lambda s, t: Batch(s, 2).positions(t), 'name'), (lambda s, t: Batch(s, 2).observations([('positions', t)]), 'parts'),
    (lambda s, t: Batch(s, 2).observations([(t, 'a')]), 'parts'), (lambda s, t: Batch(s, 2).step(fields=[t]), 'fields'),
    (lambda s, t: Batch(s, 2).set_frames(t, numpy.ones((2, 7))), 'name'), (lambda s, t: Batch(s, 2).set_material(t), 'name'),
    (lambda s, t: World(s).set_frame(t, [0, 0, 0], IDENTITY), 'name'), (lambda s, t: Scene.from_yaml(t), 'text'),
    (lambda s, t: World(s).add_frame(t, [0, 0, 0], IDENTITY), 'name'), (lambda s, t: World(s, {t: 1}), 'motion'),
    (lambda s, t: Scene.load(t), 'path'), (lambda s, t: Scene.from_dict({}, t), 'directory'), (lambda s, t: World(s, t), 'motion'),
    (lambda s, t: Scene.from_yaml('', directory=t), 'directory'), (lambda s, t: Batch(s, 2, motion=t), 'motion'),
    (lambda s, t: World(s).move_attachment(t, numpy.zeros(7)), 'name'), (lambda s, t: World(s).set_length(t, True, 1, 1), 'cable'),
])
def test_text_is_unicode(call, argument):
    with pytest.raises(ValueError) as caught:
        call(Scene.from_dict(cable()), '\ud800')
    assert str(caught.value).startswith(f"{argument}: '\\ud800'; allowed: ")


@pytest.mark.parametrize('call, argument', [
    (Scene.load, 'path'), (lambda p: World(Scene.from_dict(cable()), p), 'motion'), (lambda p: Scene.from_dict({}, p), 'directory')])
def test_paths(call, argument):
    for path in ('a\0b', b'a\0b'):
        with pytest.raises(ValueError, match=rf'^{argument}: b?.a\\x00b.; allowed: paths') as caught:
            call(path)
        assert caught.type is ValueError
    with pytest.raises(TypeError, match=f"^{argument}: <class 'int'>; allowed: a path as text, bytes or os.PathLike"):
        call(3)


def test_paths_are_those_of_the_file_system(tmp_path):
    for name in (b'scene.yaml', b'\xff.yaml'):
        path = bytes(tmp_path) + b'/' + name
        with open(path, 'w') as file:
            file.write('materials: {m: {linear_density: 0.1, radius: 0.005}}\n'
                       'cables: [{name: a, length: 1, segments: 4, material: m}]\n')
        text = str(tmp_path / name.decode('utf-8', 'surrogateescape'))
        assert {tuple(Scene.load(given).cable_names) for given in (path, text, Path(text))} == {('a',)}
    with pytest.raises(SceneError, match=r'\\xfe'):
        Scene.load(b'/\xfe')


def test_a_motion_is_named_with_its_path(tmp_path):
    scene = Scene.from_dict(cable())
    with pytest.raises(SceneError, match='^motion: "/nope.csv": cannot read: No such file'):
        World(scene, '/nope.csv')
    (tmp_path / 'bad.csv').write_text('t,frame,x,y,z,qx,qy,qz,qw\n0,f\n0\n')
    with pytest.raises(SceneError) as caught:
        Batch(scene, 2, tmp_path / 'bad.csv')
    assert [line.startswith(f'motion: "{tmp_path}/bad.csv": line {k}: ') for k, line in zip((2, 3), caught.value.errors)] == [True] * 2


@pytest.mark.parametrize('times, text', [
    ([0, 1e10], r'\[0\]\[1\], times: 1e\+10; allowed: finite numbers \[s\] \(from -1e\+09 to 1e\+09\)'),
    ([0, numpy.nan], r'times: nan; allowed: finite numbers \[s\] \(from'),
    ([2, 1], r'\[0\]\[1\], times: 1; allowed: times that ascend, the one before is 2'),
])
def test_times_of_motions(hang, times, text):
    with pytest.raises(ValueError, match=text):
        World(Scene.from_dict(hang), {'hand': (times, numpy.ones((2, 7)))})


def test_what_has_tension_is_allowed(ropes):
    world = world_of({**ropes, **NET})
    with pytest.raises(KeyError, match='name: "p"; allowed: first, second, flag'):
        world.tension('p')
    with pytest.raises(KeyError, match='name: "p"; allowed: first, second"?\'?$'):
        world.curvature('p')
    for call in (world.positions, world.body_pose, lambda name: world.set_frame(name, [0, 0, 0], IDENTITY)):
        with pytest.raises(KeyError, match='name: "p"; allowed: '):
            call('p')


def test_the_node_of_a_net_that_was_given_is_cut():
    world = world_of(NET)
    world.cut('flag', node=6)
    assert world.events()[0][1:5] == ('CUT', 'flag', '', 6)
    with pytest.raises(ValueError, match='^node: net "flag" has no link there'):
        world.cut('flag', node=6)
    with pytest.raises(ValueError, match='^arc_length for net "flag"; allowed: node, point$'):
        world.cut('flag', arc_length=0.1)


def test_gravity_with_a_center_is_not_tuned():
    world = world_of(dict(cable(), gravity={'type': 'central', 'center': [0, 0, -1]}))
    with pytest.raises(SceneError, match='unknown parameter "gravity_x"; allowed: wind_x') as caught:
        world.tune(gravity=[0, 0, 1])
    assert len(caught.value.errors) == 3


def test_an_offset_does_not_count_where_it_is_kept(ropes):
    world, same = world_of(ropes), world_of(ropes)
    world.pin('second', node=5, keep_offset=True, offset=[numpy.nan] * 7)
    same.pin('second', node=5, keep_offset=True)
    assert world.state_hash == same.state_hash
