"""The package's version, from its package.xml: the only place that has it."""
import os
import xml.etree.ElementTree

_HERE = os.path.dirname(os.path.abspath(__file__))
# In a checkout src/python/verlet_cable/sweep; installed PREFIX/lib/python3/dist-packages/verlet_cable/sweep.
_PLACES = ('../../../../package.xml', '../../../../../share/verlet_cable/package.xml')


def package_version():
    for place in _PLACES:
        path = os.path.normpath(os.path.join(_HERE, place))
        if os.path.isfile(path):
            return xml.etree.ElementTree.parse(path).findtext('version')
    raise FileNotFoundError(f'package.xml of verlet_cable: not beside {_HERE}')
