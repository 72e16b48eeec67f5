"""Deformable cables: `verlet_cable.sim` simulates them; `verlet_cable.msg` and `verlet_cable.srv` are the messages of the node."""
from pkgutil import extend_path

# In a devel space what is built and generated lies in another directory than this file.
__path__ = extend_path(__path__, __name__)
