#!/usr/bin/env python3
"""A drone that is a body flies from place to place by the thrust that its pilot sends, and falls when the pilot falls silent."""
import contextlib
import math
import sys
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest

from cable_client import CableClient
from verlet_cable.msg import CableEvent

NEAR = 0.3  # [m] at a place: its tether pulls, and the wind


def place_of(state):
    position = next(body for body in state.bodies if body.name == 'drone').pose.position
    return position.x, position.y, position.z


class FlyingDroneTest(unittest.TestCase):
    def test_it_flies_and_falls(self):
        rospy.init_node('flying_drone_test')
        node = CableClient('/cable')
        places = rospy.get_param('/example_pilot/places')
        with node.states() as states:
            for place in places:
                states.wait_for(lambda state: math.dist(place_of(state), place) < NEAR, f'drone at {place}', 30.0)
            flying = states.next()
            tether = next(c for c in flying.cables if c.name == 'tether')
            self.assertGreater(max(tether.tension), 0.1)
            with node.events() as events:
                pilot = rosgraph.Master('/flying_drone_test').lookupNode('/example_pilot')
                with contextlib.suppress(OSError):  # it may end before it answers
                    xmlrpc.client.ServerProxy(pilot).shutdown('/flying_drone_test', 'falls silent')
                events.wait_for(lambda event: event.type == CableEvent.LOAD_ENDED, 'the end of the thrust')
            states.wait_for(lambda state: place_of(state)[2] < 0.3, 'drone on the ground', 20.0)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'flying_drone', FlyingDroneTest, sys.argv)
