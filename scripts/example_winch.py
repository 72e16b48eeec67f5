#!/usr/bin/python3
"""example_winch.py: winds a cable to one length after the other: `~cable`, `~lengths` [m], `~speed` [m/s], `~pause` [s] after each."""
import itertools

import rospy

from verlet_cable.srv import SetLength


def main():
    rospy.init_node('example_winch')
    cable, lengths = rospy.get_param('~cable'), rospy.get_param('~lengths')
    speed, pause = rospy.get_param('~speed'), rospy.get_param('~pause')
    rospy.wait_for_service('cable/set_length')
    set_length = rospy.ServiceProxy('cable/set_length', SetLength)
    before = lengths[-1]
    for length in itertools.cycle(lengths):
        rospy.sleep(pause + abs(length - before) / speed)
        if rospy.is_shutdown():
            return
        try:
            answer = set_length(cable=cable, at_end=False, length=length, speed=speed)
        except rospy.ServiceException as problem:  # the node went away; perhaps it comes back
            if not rospy.core.is_shutdown_requested():
                rospy.logwarn('%s', problem)
            continue
        if not answer.success:
            rospy.logwarn('%s', answer.message)
        before = length


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:
        pass
