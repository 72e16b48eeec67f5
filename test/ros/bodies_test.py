#!/usr/bin/env python3
"""Bodies in messages, markers, wrenches and tf; requests that name them; and that a node with bodies waits for nobody."""
import math
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import InteractiveMarkerInit, InteractiveMarkerUpdate, Marker, MarkerArray

from verlet_cable.msg import Appearance, Solid

from cable_client import CableClient, Messages, cable, distance, node_at

SCENE = open(sys.argv[1]).read()
QUIET = SCENE + 'broadcast_tf: false\n'
GRAVITY = 9.81
LYING = '''
materials: {m: {linear_density: 1.0, radius: 0.01, bending_stiffness: 0.01}}
obstacles:
  - {name: table, type: plane, frame: turned, initial_pose: [0, 0, 0, 1.5707963267948966, 0, 0], pose: [0, 0, 0, -1.5707963267948966, 0, 0]}
cables: [{name: c, length: 1, segments: 10, material: m, initial: {type: straight, from: [0, 0, 0.01], to: [1, 0, 0.01]}}]
bodies: [{name: brick, mass: 2.0, shapes: [{type: box, size: [0.2, 0.2, 0.1]}], pose: [1.25, 0, 0.05, 0, 0, 0]}]
'''
WITHOUT_BODIES = '{materials: {m: {linear_density: 0.1, radius: 0.01}}, cables: [{name: c, length: 1, segments: 5, material: m}]}'


def body(state, name):
    return next((b for b in state.bodies if b.name == name), None)


def transforms(message):
    return {t.child_frame_id: t for t in message.transforms}


class BodiesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('bodies_test')
        cls.node = CableClient('/robot/cable')

    def setUp(self):
        self.assertTrue(self.node.load_scene(yaml=SCENE).success)
        with self.node.states() as states:
            states.wait_for(lambda state: body(state, 'plate'), 'plate')

    def assert_at(self, position, expected):
        # What a clamp holds stays there to the solver's tolerance.
        self.assertLess(distance(position, expected), 1e-6)

    def test_state(self):
        state = self.node.state()
        self.assertEqual([b.name for b in state.bodies], ['plate', 'wheel'])
        plate = body(state, 'plate')
        self.assert_at(plate.pose.position, (0.2, 0, 1.4))
        self.assertAlmostEqual(plate.pose.orientation.z, math.sin(0.5), places=6)
        self.assertAlmostEqual(plate.pose.orientation.w, math.cos(0.5), places=6)
        self.assertLess(distance(plate.twist.linear, (0, 0, 0)), 1e-6)
        self.assertLess(distance(plate.twist.angular, (0, 0, 0)), 1e-6)
        # The rope's end is where the plate has it: 0.1 m along y, turned by 1 rad.
        rope = cable(state, 'rope')
        self.assertEqual(rope.attachments, ['ceiling', 'plugged'])
        self.assertLess(distance(rope.positions[-1], (0.2 - 0.1 * math.sin(1), 0.1 * math.cos(1), 1.45)), 1e-3)

    def test_tf(self):
        with Messages('/tf', TFMessage) as tf, self.node.states() as states:
            state = states.next(3)
            message = tf.wait_for(lambda m: m.transforms[0].header.stamp == state.header.stamp, 'transforms of that time')
            sent = transforms(message)
            self.assertEqual(set(sent), {'plate', 'wheel'})
            for name, transform in sent.items():
                self.assertEqual(transform.header.frame_id, 'world')
                pose = body(state, name).pose
                t, r = transform.transform.translation, transform.transform.rotation
                self.assertEqual((t.x, t.y, t.z), (pose.position.x, pose.position.y, pose.position.z))
                self.assertEqual(r, pose.orientation)
            stamps = [m.transforms[0].header.stamp for m in tf.all()]
            self.assertEqual(stamps, sorted(set(stamps)))

    def test_appearance(self):
        with Messages('/robot/cable/appearance', Appearance) as appearances, self.node.states() as states:
            state = states.next(3)
            seen = appearances.wait_for(lambda a: a.header.stamp == state.header.stamp, 'appearance of that time')
        self.assertEqual(seen.bodies, ['plate', 'wheel'])
        self.assertEqual([(s.name, s.type) for s in seen.solids], [('plate', Solid.BOX), ('plate', Solid.CAPSULE), ('wheel', Solid.CYLINDER)])
        box, capsule, _ = seen.solids
        self.assertEqual(box.pose, body(state, 'plate').pose)
        self.assertEqual((box.size.x, box.size.y, box.size.z, box.owner), (0.4, 0.3, 0.1, Solid.BODY))
        # 0.1 m along x and z of the plate, which is turned by 1 rad.
        self.assert_at(capsule.pose.position, (0.2 + 0.1 * math.cos(1), 0.1 * math.sin(1), 1.5))

    def test_a_standing_time_is_sent_once(self):
        self.assertTrue(self.node.pause(True).success)
        try:
            with Messages('/tf', TFMessage) as tf, self.node.states() as states:
                states.next(5)
                self.assertLessEqual(len(tf.all()), 1)
                before = len(tf.all())
                self.assertTrue(self.node.step(1).success)
                tf.wait_for(lambda _: len(tf.all()) > before, 'transforms of the step')
        finally:
            self.assertTrue(self.node.pause(False).success)

    def test_without_broadcast_nothing_waits(self):
        self.assertTrue(self.node.load_scene(yaml=QUIET).success)
        with self.node.states() as states, Messages('/tf', TFMessage) as tf:
            first = states.wait_for(lambda state: body(state, 'plate'), 'plate')
            tf.clear()
            # No frame of a body is ever on tf, and longer than tf_timeout passes.
            states.wait_for(lambda state: (state.header.stamp - first.header.stamp).to_sec() > 1, 'states that go on')
            self.assertEqual(tf.all(), [])
        self.assertTrue(self.node.reset().success)
        with self.node.states() as states:
            states.wait_for(lambda state: body(state, 'plate') and cable(state, 'rope'), 'state after the reset')

    def test_markers_come_and_go(self):
        with Messages('/robot/cable/markers', MarkerArray) as markers:
            shown = markers.wait_for(lambda m: any(k.ns == 'bodies' for k in m.markers), 'bodies')
            bodies = [m for m in shown.markers if m.ns == 'bodies']
            # A box, a capsule of three and a cylinder.
            self.assertEqual(sorted(m.type for m in bodies),
                             sorted([Marker.CUBE, Marker.CYLINDER, Marker.SPHERE, Marker.SPHERE, Marker.CYLINDER]))
            box = next(m for m in bodies if m.type == Marker.CUBE)
            self.assertEqual((box.scale.x, box.scale.y, box.scale.z), (0.4, 0.3, 0.1))
            self.assert_at(box.pose.position, (0.2, 0, 1.4))
            self.assertEqual(sorted(m.type for m in shown.markers if m.ns == 'pins'),
                             sorted([Marker.SPHERE, Marker.SPHERE, Marker.CUBE, Marker.CYLINDER]))
            markers.clear()
            self.assertTrue(self.node.load_scene(yaml=WITHOUT_BODIES).success)
            gone = markers.wait_for(lambda m: any(k.ns == 'bodies' and k.action == Marker.DELETE for k in m.markers), 'deletions')
            self.assertEqual({m.id for m in gone.markers if m.ns == 'bodies' and m.action == Marker.DELETE}, {m.id for m in bodies})

    def test_wrenches_are_in_the_holders_frame(self):
        for attachment, frame in {'plugged': 'plate', 'bolt': 'world', 'axle': 'world'}.items():
            with Messages(f'/robot/cable/wrench/{attachment}', WrenchStamped) as wrenches:
                self.assertEqual(wrenches.next().header.frame_id, frame)

    def test_what_lies_on_a_table_is_its_contact_force(self):
        self.assertTrue(self.node.load_scene(yaml=LYING).success)
        # The table's frame is turned by a quarter about x: up is its y, and y its -z.
        with Messages('/robot/cable/contact/table', WrenchStamped) as on_table, \
                Messages('/robot/cable/contact/brick', WrenchStamped) as on_brick:
            table = on_table.wait_for(lambda m: abs(m.wrench.force.y + 3.0 * GRAVITY) < 1e-3, 'the weight on the table')
            brick = on_brick.wait_for(lambda m: abs(m.wrench.force.z - 2.0 * GRAVITY) < 1e-3, 'the weight of the brick')
        self.assertEqual([table.header.frame_id, brick.header.frame_id], ['turned', 'brick'])
        # 1 kg of rope at 0.5 m along x, and 2 kg at 1.25 m.
        self.assertAlmostEqual(table.wrench.torque.z, -3.0 * GRAVITY, delta=1e-2)

    def test_a_cable_is_pinned_to_a_body(self):
        pinned = self.node.pin(node_at('rope', 10), frame_id='plate', keep_offset=True, name='tied')
        self.assertTrue(pinned.success, pinned.message)
        with Messages('/robot/cable/wrench/tied', WrenchStamped) as wrenches:
            self.assertEqual(wrenches.next().header.frame_id, 'plate')
        self.assertTrue(self.node.unpin('tied').success)

    def test_requests_that_cannot_be_done(self):
        clamped = self.node.pin(node_at('plate', 0))
        self.assertFalse(clamped.success)
        self.assertIn('body "plate" is held by "bolt"', clamped.message)
        self.assertIn('location.node: 1; allowed: 0', self.node.pin(node_at('wheel', 1)).message)
        self.assertIn('location.cable: "plate"; allowed: rope', self.node.cut(node_at('plate', 0)).message)
        self.assertIn('location.cable: "plat"; allowed: rope, plate, wheel', self.node.pin(node_at('plat', 0)).message)

    def test_snapshots_keep_bodies(self):
        self.assertTrue(self.node.save_state(name='there').success)
        self.assertTrue(self.node.restore_state(name='there').success)
        with self.node.states() as states:
            self.assert_at(body(states.next(3), 'plate').pose.position, (0.2, 0, 1.4))

    def test_handles(self):
        hands = '/robot/cable/hands'
        # Nothing is computed for who does not follow the updates.
        with Messages(f'{hands}/update', InteractiveMarkerUpdate), Messages(f'{hands}/update_full', InteractiveMarkerInit) as full:
            message = full.wait_for(lambda m: any(k.name == 'wheel/0' for k in m.markers), 'wheel')
            markers = {m.name: m for m in message.markers}
            self.assertIn('attachment/bolt', markers)
            self.assertNotIn('plate/0', markers)  # nothing is left of it to take
            self.assertEqual([entry.title for entry in markers['wheel/0'].menu_entries], ['Pin here', 'Reset all'])


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'bodies', BodiesTest, sys.argv)
