"""Runs what a node does in a thread of its own."""
import sys
import threading
import time

import rosgraph
import rospy


def wait_for_time():
    """Until the first /clock where use_sim_time is true: what begins at time 0 leaps to the time that there is then."""
    while rospy.Time.now().is_zero() and not rospy.core.is_shutdown_requested():
        time.sleep(0.01)


def run(name, work):
    """A node of this name, once there is a time, until `work()` has ended or the node is shut down; raises what `work` raised, unless
    that came of the shutdown. Arguments other than ROS's own are refused, but for `--help`: that prints what the program says of itself.

    rospy shuts a node down in the main thread, wherever that is. A thread that publishes holds the lock of a queue that the shutdown
    takes, too: were it the main thread, Ctrl-C could wait for ever (QueuedConnection in rospy/impl/tcpros_pubsub.py).
    """
    arguments = rospy.myargv()[1:]
    if {'-h', '--help'} & set(arguments):
        print(work.__globals__['__doc__'].strip())  # of its file: in a devel space, another one is __main__
        return
    if arguments:
        sys.exit(f'{name}: argument "{arguments[0]}"; allowed: _name:=value (--help: which ones there are)')
    problems = []

    def guarded_work():
        try:
            wait_for_time()
            work()
        except BaseException as problem:  # SystemExit, too: a thread cannot end the program with it
            ended = rospy.core.is_shutdown_requested() and isinstance(problem, (rospy.ROSException, rospy.ServiceException))
            if not ended:
                problems.append(problem)
        finally:
            rospy.signal_shutdown('its work has ended')

    if not rosgraph.is_master_online():
        print(f'{name}: waits for a ROS master at {rosgraph.get_master_uri()}: start roscore', file=sys.stderr)
    try:
        rospy.init_node(name)
    except rospy.exceptions.ROSInitException:
        if rospy.core.is_shutdown_requested():
            return
        raise
    except OSError as problem:  # parameters of the command line go to the master at once
        sys.exit(f'{name}: no ROS master at {rosgraph.get_master_uri()}: start roscore, or use roslaunch ({problem})')
    thread = threading.Thread(target=guarded_work, daemon=True)
    thread.start()
    rospy.spin()
    thread.join(1.0)
    if problems:
        raise problems[0]
