"""doc/reference/camera_node.md from the sources of the camera: comments of classes that begin with a topic, and the template of its
parameters."""
from reference.markdown import generated, table
from reference.node import topic_rows
from reference.scene import read_keys, row


def parameter_rows(checkout):
    """Those of a map are rows of their own."""
    for key in read_keys((checkout / 'config/cameras/template.yaml').read_text(encoding='utf-8')).keys:
        if not key.name:
            continue
        name, *others = row(key, key.name)
        yield [name.replace(f'[`{key.name}`](#{key.name})', f'`{key.name}`'), *others]
        for inner in key.keys:
            name, *others = row(inner, f'{key.name}.{inner.name}')
            yield [name.replace(f'`{inner.name}`', f'`{key.name}.{inner.name}`'), *others]


def page(checkout):
    topics = ['topic', 'type', 'content']
    return (generated('Topics and parameters of the camera', 'src/ros/camera and config/cameras/template.yaml')
            + '`camera_node`, and the nodelet `verlet_cable/CameraNodelet`, publish what a depth camera sees: [how to use '
            'them](../how_to/camera_node.md). They are built where Embree is installed. Names are in the private namespace of the node, '
            '`/camera` with `camera.launch`.\n\n'
            + '## Published topics\n\n' + table(topics, topic_rows(checkout, 'Topic', of_camera=True))
            + '## Subscribed topics\n\n' + table(topics, topic_rows(checkout, 'Subscribed topic', of_camera=True))
            + '## Parameters\n\nThe private parameters, all of which have defaults. The same in one file: '
            '[template.yaml](../../config/cameras/template.yaml).\n\n'
            + table(['parameter', 'default', 'unit', 'meaning, range'], parameter_rows(checkout)))
