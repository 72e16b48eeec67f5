"""What Gymnasium knows the environments by.

gymnasium.make has a time limit of its own, which `max_episode_steps` of make sets: what it makes has no other one."""
import functools

from verlet_cable.environments import lay_cable, shape_rope


def without_limit(environment):
    make = functools.partial(environment, max_episode_steps=None)
    make.metadata = environment.metadata  # where gymnasium.make looks for render modes
    return make


make_shape_rope = without_limit(shape_rope.ShapeRope)
make_lay_cable = without_limit(lay_cable.LayCable)


def register(gymnasium):
    for name, entry_point, steps in (('ShapeRope', 'make_shape_rope', shape_rope.EPISODE_STEPS),
                                     ('LayCable', 'make_lay_cable', lay_cable.EPISODE_STEPS)):
        gymnasium.register(f'verlet_cable/{name}-v1', entry_point=f'{__name__}:{entry_point}',
                           vector_entry_point=f'verlet_cable.environments:{name}Vector', max_episode_steps=steps)
