"""Upright posts that hands do not enter: they stop there, or slide along."""
import numpy

from verlet_cable.environments.task import dots, lengths

TINY = 1e-15  # [m] of a way, in the place of none: no division by zero
SKIN = 1e-9   # [m] hands stay so far from a post that they touch: rounding does not take them into it


def move_beside(hand, way, posts, radius, top, limit):
    """Where hands (count, 3) [m] come to that want to go a way (count, 3): to the first post, and with the rest of the way along
    it, until the next one. No hand goes further than its way is long, and the straight line to where it comes to is free of posts.

    posts: their axes, (count, k, 2) [m], all of one radius [m] and with their tops at one height [m].
    limit: of places (count, 3), gives those nearest to them where hands may be, posts aside.
    """
    part, out = first_contact(hand, way, posts, radius, top)
    touching = hand + part[:, None] * way + SKIN * out
    rest = (1 - part)[:, None] * way
    rest = limit(touching + rest - dots(rest, out)[:, None] * out) - touching
    part, out = first_contact(touching, rest, posts, radius, top)
    way = touching + part[:, None] * rest + SKIN * out - hand
    part, _ = first_contact(hand, way, posts, radius, top)
    return hand + part[:, None] * way


def first_contact(hand, way, posts, radius, top):
    """Which part of its way a hand goes until it touches a post, (count,), 1 where it goes all of it; and the direction out of that
    post, (count, 3), 0 where there is none."""
    away, along = hand[:, None, :2] - posts, way[:, None, :2]
    square = numpy.maximum(dots(along, along), TINY ** 2)
    toward = -dots(away, along)
    root = toward ** 2 - square * (dots(away, away) - radius ** 2)
    half = numpy.sqrt(numpy.maximum(root, 0))
    beside, behind = (toward - half) / square, (toward + half) / square

    rise = numpy.where(abs(way[:, 2:]) < TINY, -TINY, way[:, 2:])
    at_top = (top - hand[:, 2:]) / rise
    below = numpy.where(rise < 0, at_top, -numpy.inf)
    above = numpy.where(rise < 0, numpy.inf, at_top)

    enters, leaves = numpy.maximum(beside, below), numpy.minimum(behind, above)
    touches = (root > 0) & (enters < leaves) & (leaves > 0) & (enters < 1)
    parts = numpy.where(touches, numpy.maximum(enters, 0), 1.0)
    first = (numpy.arange(len(hand)), parts.argmin(axis=1))
    part = parts[first]

    out = numpy.zeros_like(hand)
    out[:, :2] = away[first] + part[:, None] * way[:, :2]
    out[:, :2] /= numpy.maximum(lengths(out[:, :2]), TINY)[:, None]
    out[(below > beside)[first]] = (0, 0, 1)
    out[~touches[first]] = 0
    return part, out
