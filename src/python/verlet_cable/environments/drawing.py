"""Pictures seen from above, as arrays of pixels."""
import numpy

BACKGROUND = (244, 242, 236)


class View:
    """A picture of a rectangle of the x-y plane, x to the right and y upwards: `low` and `high` (2,) are its corners [m]."""

    def __init__(self, low, high, width=480):
        self.low = numpy.asarray(low, dtype=float)
        self.scale = width / (high[0] - low[0])  # [pixels/m]
        height = int(round((high[1] - low[1]) * self.scale))
        self.pixels = numpy.empty((height, width, 3), dtype=numpy.uint8)
        self.pixels[:] = BACKGROUND
        rows, columns = numpy.mgrid[:height, :width]
        self._places = numpy.stack([columns + 0.5, height - rows - 0.5], axis=-1) / self.scale + self.low

    def rectangle(self, middle, direction, size, color):
        """Draws a filled rectangle; size[0] is its extent along the unit vector `direction` (2,)."""
        away = self._places - middle
        along = away @ direction
        across = away @ numpy.array([-direction[1], direction[0]])
        self.pixels[(abs(along) <= size[0] / 2) & (abs(across) <= size[1] / 2)] = color

    def disc(self, middle, radius, color):
        away = self._places - middle
        self.pixels[(away ** 2).sum(axis=-1) <= radius ** 2] = color

    def polyline(self, points, width, color):
        """Draws a line through points (n, 2) [m] that is `width` [m] wide, but at least two pixels."""
        points = numpy.asarray(points, dtype=float)
        spacing = 0.5 / self.scale
        radius = max(width * self.scale / 2, 1.0)
        reach = int(numpy.ceil(radius))
        offsets = numpy.stack(numpy.mgrid[-reach:reach + 1, -reach:reach + 1], axis=-1).reshape(-1, 2)
        offsets = offsets[(offsets ** 2).sum(axis=1) <= radius ** 2]
        dense = [points[:1]]
        for first, last in zip(points[:-1], points[1:]):
            count = int(numpy.ceil(numpy.sqrt(((last - first) ** 2).sum()) / spacing)) + 1
            dense.append(first + (last - first) * numpy.linspace(0, 1, count)[:, None])
        at = (numpy.concatenate(dense) - self.low) * self.scale
        height, width_in_pixels = self.pixels.shape[:2]
        spots = numpy.stack([height - 1 - numpy.floor(at[:, 1]), numpy.floor(at[:, 0])], axis=1).astype(int)
        spots = (spots[:, None] + offsets).reshape(-1, 2)
        inside = ((spots >= 0) & (spots < (height, width_in_pixels))).all(axis=1)
        self.pixels[tuple(spots[inside].T)] = color
