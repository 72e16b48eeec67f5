#!/usr/bin/env python3
"""play_motion.py: no stamp of a frame comes twice, and where the motion begins again nothing jumps; cables are reset once they are there."""
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import rospkg
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from std_msgs.msg import Empty
from std_srvs.srv import Trigger, TriggerResponse
from tf2_msgs.msg import TFMessage

from verlet_cable.msg import CableArray

MOTION = 't,frame,x,y,z,qx,qy,qz,qw\n0,hand,0,0,1,0,0,0,1\n0.5,hand,0.2,0,1,0,0,0,1\n1,hand,0.5,0,1,0,0,0,1\n'
FASTEST = 4.0      # [m/s] 1 m/s or less between the rows, three times as fast on the way back
BEHIND = 0.3       # [s] the cables run behind ROS time
SCRIPTS = os.path.join(rospkg.RosPack().get_path('verlet_cable'), 'scripts')
LIMIT = 120.0      # [s] far more than anything here takes on a busy machine


class PlayMotionTest(unittest.TestCase):
    def setUp(self):
        self.poses = []   # stamp [s], x [m]
        self.resets = []  # how many poses there were, and the last of them
        self._tf = rospy.Subscriber('/tf', TFMessage, self._on_tf, queue_size=1000)
        self._state = rospy.Publisher('/cable/state', CableArray, queue_size=10)
        self._reset = rospy.Service('/cable/reset', Trigger, self._on_reset)

    def tearDown(self):
        self._tf.unregister()
        self._reset.shutdown()
        self._state.unregister()

    def _on_tf(self, message):
        self.poses += [(t.header.stamp.to_sec(), t.transform.translation.x) for t in message.transforms if t.child_frame_id == 'hand']
        state = CableArray()
        state.header.stamp = message.transforms[-1].header.stamp - rospy.Duration.from_sec(BEHIND)
        self._state.publish(state)

    def _on_reset(self, _):
        self.resets.append(list(self.poses))
        return TriggerResponse(success=True)

    def test_frames_do_not_jump(self):
        with tempfile.NamedTemporaryFile('w', suffix='.csv') as motion:
            motion.write(MOTION)
            motion.flush()
            process = subprocess.Popen(['rosrun', 'verlet_cable', 'play_motion.py', f'_motion:={motion.name}', '_pause:=0.1'],
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)
            try:
                deadline = time.monotonic() + LIMIT
                while len(self.resets) < 2 and time.monotonic() < deadline:
                    time.sleep(0.02)
            finally:
                os.killpg(process.pid, signal.SIGINT)
                output = process.communicate(timeout=LIMIT)[0]
        self.assertEqual(len(self.resets), 2, output)
        for (before, x), (stamp, y) in zip(self.poses, self.poses[1:]):
            self.assertGreater(stamp, before)
            self.assertLessEqual(abs(y - x), FASTEST * (stamp - before) + 1e-6)
        self.assertAlmostEqual(max(x for _, x in self.poses), 0.5, delta=1e-6)
        for poses in self.resets:
            still = [stamp for stamp, x in poses if x > 1e-9][-1]
            self.assertGreater(poses[-1][0] - BEHIND, still)  # what is shown of the cables is of when the hand had arrived
        self.assertNotIn('Traceback', output)

    def warnings(self, frames):
        """What is warned of where the node uses these frames."""
        status = DiagnosticStatus(name='cable: frames', values=[KeyValue(key=f'frame {name}', value=value) for name, value in frames])
        publisher = rospy.Publisher('/diagnostics', DiagnosticArray, queue_size=1)
        with tempfile.NamedTemporaryFile('w', suffix='.csv') as motion:
            motion.write(MOTION)
            motion.flush()
            process = subprocess.Popen(['rosrun', 'verlet_cable', 'play_motion.py', f'_motion:={motion.name}'],
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)
            try:
                deadline = time.monotonic() + LIMIT
                while publisher.get_num_connections() == 0 and time.monotonic() < deadline:
                    time.sleep(0.02)
                for _ in range(5):
                    publisher.publish(status=[DiagnosticStatus(name='other: frames'), status])
                    time.sleep(0.2)
            finally:
                os.killpg(process.pid, signal.SIGINT)
                output = process.communicate(timeout=LIMIT)[0]
                publisher.unregister()
                rospy.delete_param('/play_motion/motion')  # else it holds for the next start, too
        return [line.partition(': ')[2].replace(motion.name, 'FILE') for line in output.splitlines() if 'WARN' in line]

    def test_a_motion_of_frames_that_the_node_does_not_use(self):
        self.assertEqual(self.warnings([('left', 'never seen'), ('hand', 'ok, age 0.01 s')]), [])
        self.assertEqual(self.warnings([('right', 'never seen'), ('left', 'lost'), ('hand', "a body's")]),
                         ['FILE: nothing moves: it has the frames "hand", and the node /cable uses "left", "right"'])
        self.assertEqual(self.warnings([]), ['FILE: nothing moves: it has the frames "hand", and the node /cable uses none'])

    def test_nodes_end_while_they_publish(self):
        program = ("import node_thread, rospy, std_msgs.msg\n"
                   "def publish():\n"
                   "    publisher = rospy.Publisher('ended', std_msgs.msg.Empty, queue_size=1)\n"
                   "    while True:\n"
                   "        publisher.publish()\n"
                   "node_thread.run('publishes', publish)\n")
        for _ in range(10):
            heard = threading.Event()
            subscriber = rospy.Subscriber('ended', Empty, lambda _, heard=heard: heard.set())
            process = subprocess.Popen([sys.executable, '-c', program], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                       env={**os.environ, 'PYTHONPATH': f"{SCRIPTS}:{os.environ['PYTHONPATH']}"})
            self.assertTrue(heard.wait(LIMIT))
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.communicate(timeout=LIMIT)[0], '')
            subscriber.unregister()

    def refuse(self, *arguments, status=1):
        """What is written of a wrong start, after the program's name."""
        done = subprocess.run(['rosrun', 'verlet_cable', 'play_motion.py', *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, timeout=LIMIT)
        self.assertEqual(done.returncode, status, done.stdout)
        program, _, message = done.stdout.partition(': ')
        self.assertEqual(program, 'play_motion.py', done.stdout)
        return message

    def test_motions_that_cannot_be_played(self):
        self.assertEqual(self.refuse('_motion:=nope.csv'), f'motion: "{os.path.abspath("nope.csv")}": no such file\n')
        self.assertEqual(self.refuse('_motion:=/dev/zero'), 'motion: "/dev/zero": not a file; allowed: a CSV file\n')
        header = MOTION.splitlines()[0]
        with tempfile.TemporaryDirectory() as directory:
            pipe = os.path.join(directory, 'pipe')
            os.mkfifo(pipe)
            self.assertEqual(self.refuse(f'_motion:={pipe}'), f'motion: "{pipe}": not a file; allowed: a CSV file\n')
            path = os.path.join(directory, 'motion.csv')
            many = ''.join(f'0,f{i},0,0,0,0,0,0,1\n' for i in range(20001))
            for text, message in (
                    (f'{header}\n{many}', '20001 frames; allowed: at most 20000'),
                    ('', f'empty; allowed: the header {header} and rows'),
                    ('t,x0,y0\n0,1,2\n', f'line 1: header "t,x0,y0"; allowed: {header}'),
                    (f'{header}\n', 'no rows; allowed: at least one pose'),
                    (f'{MOTION}2,hand,0,0,1\n', f'line 5: 5 columns; allowed: 9: {header}'),
                    (f'{MOTION}2,hand,0,high,1,0,0,0,1\n', 'line 5: y "high"; allowed: numbers from -1e+09 to 1e+09'),
                    (f'{MOTION}2,hand,0,nan,1,0,0,0,1\n', 'line 5: y "nan"; allowed: numbers from -1e+09 to 1e+09'),
                    (f'{MOTION}2,,0,0,1,0,0,0,1\n', 'line 5: frame ""; allowed: names of tf frames, without a leading /'),
                    (f'{MOTION}2,hand,0,0,1,0,0,0,0\n', 'line 5: quaternion of length 0; allowed: any other, it is normalized'),
                    (f'{MOTION}1,hand,0,0,1,0,0,0,1\n',
                     'line 5: t 1 of "hand"; allowed: times that ascend, the frame\'s last one is 1')):
                with open(path, 'w', encoding='utf-8') as file:
                    file.write(text)
                self.assertEqual(self.refuse(f'_motion:={path}'), f'{path}: {message}\n')

    def test_arguments(self):
        self.assertIn('_motion:=FILE.csv', self.refuse(status=2))
        without_master = {**os.environ, 'ROS_MASTER_URI': 'http://localhost:1'}
        alone = subprocess.run(['rosrun', 'verlet_cable', 'play_motion.py'], stderr=subprocess.PIPE, text=True, env=without_master, timeout=LIMIT)
        self.assertEqual(alone.returncode, 2)
        self.assertIn('play_motion.py _motion:=FILE.csv', alone.stderr)
        for program, usage in (('play_motion.py', 'play_motion.py _motion:='), ('replay.py', 'replay.py _data:=')):
            refused = subprocess.run(['rosrun', 'verlet_cable', program, 'motion.csv'], stderr=subprocess.PIPE, text=True,
                                     env=without_master, timeout=LIMIT)
            self.assertEqual(refused.returncode, 1)
            self.assertIn('argument "motion.csv"; allowed: _name:=value', refused.stderr)
            output = subprocess.run(['rosrun', 'verlet_cable', program, '--help'], check=True, stdout=subprocess.PIPE, text=True,
                                    env=without_master, timeout=LIMIT).stdout
            self.assertTrue(output.startswith(usage), output)


if __name__ == '__main__':
    rospy.init_node('play_motion_test')
    rostest.rosrun('verlet_cable', 'motion_again', PlayMotionTest)
