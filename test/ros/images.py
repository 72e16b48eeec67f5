"""Images and clouds of a camera as arrays."""
import numpy as np

TYPES = {'32FC1': np.float32, '16UC1': np.uint16, 'rgb8': np.uint8}


def array(image):
    """Rows, columns and, of colors, channels."""
    return np.frombuffer(image.data, TYPES[image.encoding]).reshape(image.height, image.width, -1).squeeze()


def field_of(cloud, name, kind):
    """Rows and columns."""
    offset = next(field.offset for field in cloud.fields if field.name == name)
    raw = np.frombuffer(cloud.data, np.uint8).reshape(cloud.height, cloud.width, cloud.point_step)
    return raw[..., offset:offset + 4].copy().view(kind)[..., 0]


def points_of(cloud):
    """Rows, columns, x y z."""
    return np.stack([field_of(cloud, axis, np.float32) for axis in 'xyz'], axis=-1)


def labels_of(cloud):
    return field_of(cloud, 'label', np.uint32)
