"""Mesh files that are not what they seem, by their names: each must be refused, soon, and by name."""
import struct

CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
SIDES = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]

COLLADA = '''<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_geometries><geometry id="box"><mesh>
<source id="p"><float_array id="a" count="24">{floats}</float_array>
<technique_common><accessor source="#a" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">{nodes}</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
'''
NODE = '<node><instance_geometry url="#box"/></node>'


def collada(nodes=NODE, more=''):
    text = COLLADA.format(floats=' '.join('%g %g %g' % c for c in CORNERS), indices=' '.join('%d %d %d' % s for s in SIDES), nodes=nodes)
    return text.replace('<library_visual_scenes>', more + '<library_visual_scenes>')


def obj(head='', corners=CORNERS):
    lines = [head] + ['v %s %s %s' % tuple(c) for c in corners] + ['f %d %d %d' % tuple(i + 1 for i in side) for side in SIDES]
    return '\n'.join(lines) + '\n'


def binary_stl(triangles, count=None):
    parts = [b'\0' * 80, struct.pack('<I', len(triangles) if count is None else count)]
    for corners in triangles:
        parts.append(struct.pack('<12fH', 0, 0, 0, *(x for corner in corners for x in corner), 0))
    return b''.join(parts)


def box():
    return [[CORNERS[i] for i in side] for side in SIDES]


def doubling_nodes(levels):
    library = ''.join('<node id="n%d"><instance_node url="#n%d"/><instance_node url="#n%d"/></node>' % (i, i + 1, i + 1) for i in range(levels))
    return '<library_nodes>%s<node id="n%d"><instance_geometry url="#box"/></node></library_nodes>' % (library, levels)


def bad_files():
    """Name to content."""
    round_face = ['v %g %g 0' % (i % 500, i // 500) for i in range(200000)] + ['f ' + ' '.join(str(i + 1) for i in range(200000))]
    x3d = '<X3D><Scene>' + '<Transform>' * 20000 + '</Transform>' * 20000 + '</Scene></X3D>'
    return {
        # One wrong character each: Assimp allocates without end, and crashes.
        'endless.dae': collada().replace('>0 2 1 1', '>0 2 x 1').encode(),
        'crash.dae': collada().replace('id="a" count', 'id="a" cou2t').encode(),
        'huge_count.dae': collada().replace('count="24"', 'count="4000000000"').encode(),
        'huge_offset.dae': collada().replace('offset="0"', 'offset="4000000000"').encode(),
        'huge_triangles.dae': collada().replace('count="12"', 'count="4000000000"').encode(),
        'deep.dae': collada('<node>' * 20000 + NODE + '</node>' * 20000).encode(),
        'doubling.dae': collada('<node><instance_node url="#n0"/></node>', doubling_nodes(40)).encode(),
        'circle.dae': collada('<node><instance_node url="#n"/></node>',
                              '<library_nodes><node id="n"><instance_node url="#n"/></node></library_nodes>').encode(),
        'cut_off.dae': collada().encode()[:600],
        'wide_text.dae': collada().encode('utf-16'),
        'deep.x3d': x3d.encode(),
        'deep_x3d.dae': x3d.encode(),
        'round_face.obj': '\n'.join(round_face).encode(),
        'nan.obj': obj(corners=[('nan', 0, 0)] + CORNERS[1:]).encode(),
        'far.obj': obj(corners=[('1e300', 0, 0)] + CORNERS[1:]).encode(),
        'beyond.obj': obj(corners=[(x * 1e20, y, z) for x, y, z in CORNERS]).encode(),
        'no_such_vertex.obj': (obj() + 'f 1 2 4000000000\n').encode(),
        'binary.obj': b'v 0 0 0\n\0' * 100,
        'huge_count.stl': binary_stl(box(), 4000000000),
        'wrong_count.stl': binary_stl(box(), 11),
        'cut_off.stl': binary_stl(box())[:-10],
        'nan.stl': binary_stl([[(float('nan'), 0, 0)] * 3] + box()),
        'collada.stl': collada().encode(),
        'empty.stl': b'',
        'empty.obj': b'',
        'empty.dae': b'',
        'blank.stl': b' ' * 1000,
    }
