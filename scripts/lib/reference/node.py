"""doc/reference/node.md from the sources of the node: comments of classes that begin with a topic, the calls that make services,
the parameters in the scene's template, the constants of CableEvent.msg, and the keys of the diagnostics."""
import re

from reference.interfaces import fields_table, message_names, read_interface, type_link
from reference.markdown import anchor, generated, table, with_code
from reference.scene import read_keys, row

TOPIC = re.compile(r'^/// (Topic|Subscribed topic) `([^`]+)` \(([\w/]+)\)(, latched)?((?:[,:]| ).*(?:\n///.*)*)\n(?:class|struct)', re.M)
SERVICE = re.compile(r'(?:^ *// (?P<comment>.*)\n)?^ *serve(?:_aside)?<(?P<type>\w+)>\(\s*node, "(?P<name>\w+)"', re.M)
REPORT = re.compile(r'void Diagnostics::report_(\w+)\(Status& status\)(?: const)? \{(.*?)\n\}', re.S)
REPORTED = re.compile(r'status\.add\("(?P<key>[^"]+)"(?P<more> \+)?[^\n]*?[;,](?: +// (?P<comment>.*))?$', re.M)
STATUS = re.compile(r'updater_\.add\("(\w+)"')
TUNABLE = re.compile(r'&MaterialDesc::(\w+)')


def own_type(name, messages):
    package, _, base = name.partition('/')
    return type_link(base, messages) if package == 'verlet_cable' else f'`{package}/`<br>`{base}`'


def text_of(comment):
    """A comment of several lines, in one; its list as a list in a cell of a table."""
    lines = [re.sub(r'^/// ?', '', line) for line in comment.lstrip(',: ').splitlines()]
    text = ' '.join(line.replace(' * ', '<br>• ', 1) if line.startswith(' * ') else line.strip() for line in lines)
    return with_code(text[:1].upper() + text[1:])


def topic_rows(checkout, kind, of_camera=False):
    for path in sorted((checkout / 'src/ros').rglob('*.h')):
        if (path.parent.name == 'camera') != of_camera:
            continue
        for found, name, type_name, latched, comment in TOPIC.findall(path.read_text(encoding='utf-8')):
            if found == kind:
                yield [anchor(kind.lower().replace(' ', '-') + '-' + name.strip('/').replace('/', '-').lower()) + f'`{name}`',
                       own_type(type_name, message_names(checkout)), ('Latched. ' if latched else '') + text_of(comment)]


def service_rows(checkout):
    code = (checkout / 'src/ros/requests/cable_services.cpp').read_text(encoding='utf-8')
    for match in SERVICE.finditer(code):
        file = checkout / f'srv/{match["type"]}.srv'
        if file.exists():
            description = read_interface(file.read_text(encoding='utf-8'))[0]
            type_cell = f'[`{match["type"]}`](services.md#{match["type"].lower()})'
        else:
            description, type_cell = match['comment'], own_type(f'std_srvs/{match["type"]}', ())
        yield [anchor('service-' + match['name']) + f'`{match["name"]}`', type_cell, with_code(description)]


def parameter_rows(checkout):
    """The scene's keys that are for the node: those below that remark, up to the next remark or table, and one that stands alone."""
    keys = read_keys((checkout / 'config/scene_template.yaml').read_text(encoding='utf-8')).keys
    first = next(i for i, key in enumerate(keys) if not key.name and 'for the node' in ' '.join(key.comment))
    last = next(i for i, key in enumerate(keys) if key.name == 'limits')
    for key in [*keys[first + 1:last], *(key for key in keys if key.name == 'broadcast_tf')]:
        cells = row(key, key.name)
        yield [f'[`{key.name}`](scene.md#{key.name})', *cells[1:]]


def tuning_text(checkout):
    code = (checkout / 'src/edit_requests/tunable_numbers.cpp').read_text(encoding='utf-8')
    keys = dict.fromkeys(TUNABLE.findall(code.partition('};')[0]))
    names = ', '.join(f'[`{key}`](scene.md#materials-name-{key.lower()})' for key in ['bending_stiffness', *keys])
    return ('`tuning` is dynamic_reconfigure: `gravity_x`, `gravity_y`, `gravity_z` [m/s^2], `wind_x`, `wind_y`, `wind_z` [m/s], '
            f'`contact_friction`, and of every material, as `MATERIAL_KEY`, {names}. Where the axes differ, there are '
            '`MATERIAL_bending_stiffness_y` and `_z`. Infinite stiffness and central gravity are not tuned.\n\n')


def diagnostics_text(checkout):
    code = (checkout / 'src/ros/node/diagnostics.cpp').read_text(encoding='utf-8')
    sections, last = {}, ''  # what no status is named after goes on with the one before
    for name, body in REPORT.findall(code):
        rows = [[anchor('diagnostics-' + match['key'].strip().replace(' ', '-')) + f'`{match["key"]}{"NAME" if match["more"] else ""}`', with_code(match['comment'] or '')] for match in REPORTED.finditer(body)]
        last = name if name in STATUS.findall(code) else last
        sections.setdefault(last, []).extend(rows)
    return ''.join(f'Status `{name}`:\n\n' + table(['key', 'value'], rows) for name, rows in sections.items())


def page(checkout):
    _, (events,) = read_interface((checkout / 'msg/CableEvent.msg').read_text(encoding='utf-8'))
    topics = ['topic', 'type', 'content']
    return (generated('Topics, services and parameters', 'src/ros, msg and config/scene_template.yaml')
            + 'Names are in the private namespace of the node, `/cable` with the launch files; those with a slash in front are global.\n\n'
            + '## Published topics\n\n' + table(topics, topic_rows(checkout, 'Topic'))
            + '## Subscribed topics\n\n' + table(topics, topic_rows(checkout, 'Subscribed topic'))
            + '## Services\n\n' + table(['service', 'type', 'what it does'], service_rows(checkout))
            + 'The action `rollout` has the type [`Rollout`](services.md#rollout), and the topics `rollout/goal`, `rollout/cancel`, '
            '`rollout/status`, `rollout/feedback` and `rollout/result`.\n\n'
            + '## Parameters\n\nThe private parameters are the keys of a [scene](scene.md). Those that are for the node alone:\n\n'
            + table(['parameter', 'default', 'unit', 'meaning, range'], parameter_rows(checkout))
            + '## Tuning\n\n' + tuning_text(checkout)
            + '## Events\n\nValues of `type` in [`CableEvent`](messages.md#cableevent):\n\n'
            + fields_table([event for event in events if event.value], message_names(checkout), 'event')
            + '## Diagnostics\n\n' + diagnostics_text(checkout))
