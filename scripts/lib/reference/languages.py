"""doc/reference/cpp.md and python.md: which headers and modules there are; Doxygen and autodoc say the rest in the manual."""
import re

from reference.markdown import fence, generated

GROUPS = {
    'Worlds': ['core/world.h', 'core/edit.h', 'core/world_stepper.h', 'core/sensitivity.h', 'core/types.h'],
    'What is simulated': [
        'core/cable.h', 'core/cable_materials.h', 'core/body.h', 'core/body_id.h', 'core/net.h', 'core/guide.h', 'core/ledger.h', 'core/load.h',
        'core/winch.h', 'core/contact.h', 'core/obstacle.h', 'core/surface_point.h'],
    'Scenes': [
        'core/scene_desc.h', 'core/attachment_desc.h', 'core/body_desc.h', 'core/guide_desc.h', 'core/junction_desc.h', 'core/shape_desc.h',
        'core/frame_keys.h', 'core/scene_fields.h'],
    'Scene files': ['scene/scene_reader.h', 'scene/motion.h', 'scene/loads.h', 'scene/resource.h'],
    'Saved worlds': ['core/bytes.h', 'core/scene_numbers.h'],
    'Geometry': ['core/shape.h', 'core/triangle_mesh.h', 'core/rotation.h'],
    'Camera (where Embree is installed)': [
        'view/drawing.h', 'view/camera_model.h', 'view/sensor_model.h', 'view/stage.h', 'view/render.h'],
    'Look-ups and messages': [
        'core/body_name.h', 'core/obstacle_of.h', 'core/pin_rules.h', 'core/excursion_text.h', 'core/jump_text.h', 'core/ended_load_text.h',
        'core/name_list.h', 'core/number_text.h', 'core/quoted_text.h'],
}
MODULES = {
    'verlet_cable.sim': ['Scene', 'World', 'Batch', 'Worlds', 'Event', 'Load', 'Pinned', 'Pieces', 'SceneError'],
    'verlet_cable.camera': ['Camera', 'Preset'],
    'verlet_cable.camera.coco': ['Dataset'],
    'verlet_cable.environments': ['ShapeRope', 'ShapeRopeVector', 'LayCable', 'LayCableVector', 'AutoresetMode', 'Box'],
}
TYPE = re.compile(r'^(?:class|struct|enum class|using) (\w+)[^;\n]*(?: [{=]|\{)', re.M)
FUNCTION = re.compile(r'^(?! )(?:inline |constexpr )*[\w:<>,&* ]*[\w>&*] [&*]?(\w+)\(', re.M)


def declared_names(header):
    found = [match for kind in (TYPE, FUNCTION) for match in kind.finditer(header)]
    return ', '.join(dict.fromkeys(f'`{match[1]}`' for match in sorted(found, key=lambda match: match.start())))


def cpp_page(checkout):
    directory = checkout / 'include/verlet_cable'
    headers = {str(path.relative_to(directory)) for path in directory.rglob('*.h')}
    grouped = [header for group in GROUPS.values() for header in group]
    if sorted(grouped) != sorted(headers):
        raise ValueError(f'{__file__}: GROUPS differs from the headers: {sorted(headers.symmetric_difference(grouped))}')
    text = generated('C++', 'include/verlet_cable') + (
        'All is in the namespace `verlet_cable`. The libraries are `verlet_cable_core`, without ROS, `verlet_cable_scene`, which reads '
        'scene files, and `verlet_cable_view`, the camera, in the namespace `verlet_cable::view`.\n\n')
    for group, names in GROUPS.items():
        text += f'## {group}\n\n'
        for name in names:
            text += f'### {name}\n\n[`#include <verlet_cable/{name}>`](../../include/verlet_cable/{name})\n\n'
            text += declared_names((directory / name).read_text(encoding='utf-8')) + '\n\n'
            text += fence('', f'{{doxygenfile}} {name}')
    return text


def python_page():
    text = generated('Python', 'the modules') + (
        'In signatures, a `Path` is text, bytes or an `os.PathLike`; a `Motion` is the path of a CSV file as of `cable_sim --motion`, or '
        '`{frame: (times (k,) [s], poses (k, 7))}`; a `Status` is one of the words that `World.step` returns.\n\n')
    for module, names in MODULES.items():
        directives = f'.. automodule:: {module}\n   :no-members:\n'
        text += f'## {module}\n\n' + fence(directives, '{eval-rst}')
        for name in names:
            text += f'### {name}\n\n' + fence(f'.. autoclass:: {module}.{name}\n', '{eval-rst}')
    return text
