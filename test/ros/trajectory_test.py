# SPDX-License-Identifier: Apache-2.0
"""Trajectories, which MoveIt sends, by the action clients of ROS: at a device that the driver's timer serves, and at a node."""
import math
import signal
import time
import unittest

from coupler_driver.msg import Scheduled
from coupler_driver.srv import Write
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from support import process, testing
from support.actions import ABORTED, CANCELED, HAS_CONTROL_MSGS, IS_ROS2, REPLACED, SUCCEEDED, Client
from support.device import FAILURE, Device, Refuse
from support.patience import NO_TIMEOUT, PATIENCE, wait_until
from support.ports import free_port
from support.times import ros_duration, ros_time, seconds

MAP = """
name: {name}
address: 127.0.0.1
rate: 50
timeout: {timeout}s
{head}
mapping:
  coils: {{valve_close: 0, valve_open: 1, valve_glue: 4, lamp: 7}}
  discrete_inputs: {{sensor_closed: 0, sensor_open: 1}}
  holding_registers:
    speed: {{address: 2, type: UINT, max: 1000}}
    {mapping}
tools:
  clamp: {{close: valve_close, open: valve_open, closed: sensor_closed, opened: sensor_open, timeout: {patience}s, joint: fingers}}
axes:
  glue: {{point: valve_glue, joint: glue}}
  belt: {{point: speed, joint: belt}}
"""
GLUE, SPEED, CLOSE, OPEN, CLOSED, OPENED = 4, 2, 0, 1, 0, 1
SUCCESSFUL, INVALID_GOAL, INVALID_JOINTS, OLD, PATH, GOAL = 0, -1, -2, -3, -4, -5
SOON = 0.3  # seconds
NEVER = 3000


class Trajectory(Client):
    """Of control_msgs/FollowJointTrajectory."""

    def __init__(self, name):
        # pylint: disable=import-outside-toplevel,import-error
        from trajectory_msgs.msg import JointTrajectoryPoint
        if IS_ROS2:
            from control_msgs.action import FollowJointTrajectory as Action
            from control_msgs.msg import JointTolerance
        else:
            from control_msgs.msg import FollowJointTrajectoryAction as Action, JointTolerance
        super().__init__(name, Action)
        self._point, self._tolerance = JointTrajectoryPoint, JointTolerance

    def send(self, points, joints=("glue",), *, start=None, tolerance=None):
        """`points`: a time and the positions of each."""
        goal = self.goal()
        goal.trajectory.joint_names = list(joints)
        for at, *positions in points:
            goal.trajectory.points.append(self._point(positions=[float(each) for each in positions],
                                                      time_from_start=ros_duration(at)))
        if start is not None:
            goal.trajectory.header.stamp = ros_time(start)
        if tolerance is not None:
            goal.goal_tolerance.append(self._tolerance(name=joints[0], position=float(tolerance)))
        return self.send_goal(goal)


def ramp(*positions, step=SOON, between=50):
    """As planners make it: many points between those where it turns."""
    points = [(0.0, positions[0])]
    for number, (start, end) in enumerate(zip(positions, positions[1:])):
        points += [(step * (number + i / between), start + (end - start) * i / between) for i in range(1, between + 1)]
    return points


@unittest.skipUnless(HAS_CONTROL_MSGS, "the driver was built without control_msgs")
class TrajectoryTest(testing.RosTest):
    at_once = True

    def start(self, port, path):
        self.program = self.driver(f"_map:={path}", f"_port:={port}")
        self.program.wait_for("connected")
        self.scheduled = self.topic(f"/{self.name}/scheduled", Scheduled)
        self.joints = self.topic(f"/{self.name}/joint_states", JointState)
        self.write = self.service(f"/{self.name}/write", Write)
        self.trajectory = Trajectory(f"/{self.name}/follow_joint_trajectory")
        self.joints.wait_for(lambda message: {"glue", "belt"} <= set(message.name))

    def write_map(self, head="", mapping="", patience=PATIENCE):
        return process.write_map(MAP.format(name=self.name, timeout=NO_TIMEOUT, head=head, mapping=mapping, patience=patience))

    def assert_ends(self, sent, how, code=SUCCESSFUL, text="."):
        ended, result = sent.result()
        self.assertEqual((ended, result.error_code), (how, code), result.error_string)
        self.assertRegex(result.error_string, text)
        return result

    def waits(self):
        """Until a change has been made and others wait."""
        self.scheduled.wait_for(lambda message: message.result == Scheduled.DONE)


class AtADevice(TrajectoryTest):
    """A foreign device: the driver's timer."""

    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.coils, self.inputs = self.device.tables["coils"], self.device.tables["discrete_inputs"]
        self.inputs[OPENED] = 1

    def begin(self, **options):
        self.start(self.device.port, self.write_map(**options))

    def becomes(self, output, level):
        wait_until(lambda: self.coils[output] == level, f"coil {output} to be {level}")

    def levels_of(self, coil):
        return [request.data[3] for request in self.device.seen(5) if request.address == coil]


class ByTheDriver(AtADevice):
    def test_a_switch_follows_the_line_between_many_points(self):
        self.begin()
        begun = time.monotonic()
        self.assert_ends(self.trajectory.send(ramp(0, 1, 0, 1)), SUCCEEDED, text=r"^4 changes, at most [0-9.]+ ms late \(± [0-9.]+\)$")
        self.assertGreaterEqual(time.monotonic() - begun, 3 * SOON)
        self.assertEqual(self.levels_of(GLUE), [0, 0xFF, 0, 0xFF])
        writes = [request.at for request in self.device.seen(5)]
        for number, at in enumerate(writes[1:]):
            self.assertGreaterEqual(at - begun, SOON * (number + 0.5), "never early")

    def test_a_number_has_the_values_of_the_points(self):
        self.begin()
        self.assert_ends(self.trajectory.send([(0, 10), (0.1, 250), (0.2, 1000)], ["belt"]), SUCCEEDED)
        self.assertEqual(self.device.tables["holding_registers"][SPEED], 1000)
        self.joints.wait_for(lambda message: 1000.0 in message.position)

    def test_several_joints_and_feedback(self):
        self.begin()
        sent = self.trajectory.send([(0, 0, 5), (2 * SOON, 1, 6)], ["glue", "belt"])
        wait_until(lambda: sent.feedback, "feedback")
        self.assertEqual(list(sent.feedback[0].joint_names), ["glue", "belt"])
        self.assertEqual(len(sent.feedback[0].desired.positions), 2)
        self.assert_ends(sent, SUCCEEDED)
        self.assertEqual((self.coils[GLUE], self.device.tables["holding_registers"][SPEED]), (1, 6))

    def test_a_tool_is_a_joint_and_its_result_counts(self):
        self.begin()
        self.joints.wait_for(lambda message: "fingers" in message.name)
        sent = self.trajectory.send(ramp(1, 0), ["fingers"])
        self.becomes(CLOSE, 1)
        self.assertEqual(self.coils[OPEN], 0)
        self.inputs[OPENED], self.inputs[CLOSED] = 0, 1
        self.assert_ends(sent, SUCCEEDED, text="^2 changes$")

    def test_a_tool_that_is_stuck_aborts_it(self):
        self.begin(patience=0.2)
        self.joints.wait_for(lambda message: "fingers" in message.name)
        self.assert_ends(self.trajectory.send(ramp(1, 0), ["fingers"]), ABORTED, PATH, "fingers to [01] at 0.[0-9]+ s: .*; [01] of 2 changes")

    def test_what_cannot_be_is_refused_before_anything_is_driven(self):
        self.begin()
        for points, joints, code, text in (
                ([(0, 1)], ["glu"], INVALID_JOINTS, "did you mean 'glue'"),
                ([(0, 1)], [], INVALID_JOINTS, "joint_names"),
                ([(0, 0), (1, math.nan)], ["glue"], INVALID_GOAL, "point 1"),
                ([(0, 0), (1, 1.2)], ["glue"], INVALID_GOAL, "send 0 to 1"),
                ([(0, 2000)], ["belt"], INVALID_GOAL, "at most 1000"),
                ([(1, 0), (1, 1)], ["glue"], INVALID_GOAL, "not later"),
                ([], ["glue"], INVALID_GOAL, "no points")):
            self.assert_ends(self.trajectory.send(points, joints), ABORTED, code, text)
        self.assert_ends(self.trajectory.send([(0, 1)], start=time.time() - 5), ABORTED, OLD, "in the past")
        self.assertEqual(self.device.seen(5, 6, 15, 16), [])

    def test_a_cancelled_goal_makes_no_more_changes(self):
        self.begin()
        sent = self.trajectory.send([(0, 1), (NEVER, 0)])
        self.waits()
        sent.cancel()
        self.assert_ends(sent, CANCELED, text="^cancelled; 1 of 2 changes had been made$")
        self.assertEqual(self.levels_of(GLUE), [0xFF])

    def test_a_newer_goal_replaces_it_from_its_start_on(self):
        self.begin()
        first = self.trajectory.send([(0, 1), (SOON, 0), (NEVER, 1)])
        second = self.trajectory.send([(0, 1), (0.1, 0)], start=time.time() + 3 * SOON)
        self.assert_ends(first, REPLACED, INVALID_GOAL, "a newer goal replaces it; 2 of 3 changes")
        self.assert_ends(second, SUCCEEDED)
        self.assertEqual(self.levels_of(GLUE), [0xFF, 0, 0xFF, 0])

    def test_a_write_by_somebody_else_aborts_it(self):
        self.begin()
        sent = self.trajectory.send([(0, 1), (NEVER, 0)])
        self.waits()
        self.assertTrue(self.write("lamp", "true").success)
        self.assertTrue(self.write("valve_glue", "false").success)
        self.assert_ends(sent, ABORTED, PATH, "valve_glue was written directly; 1 of 2")

    def test_safe_aborts_it(self):
        self.begin()
        sent = self.trajectory.send([(0, 1), (NEVER, 0)])
        self.waits()
        self.assertTrue(self.service(f"/{self.name}/safe", Trigger)().success)
        self.assert_ends(sent, ABORTED, PATH, "safe values were requested")

    def test_a_lost_connection_aborts_it_and_nothing_is_made_later(self):
        self.begin()
        sent = self.trajectory.send([(0, 1), (20 * SOON, 0)])
        self.waits()
        self.device.stop()
        self.assert_ends(sent, ABORTED, PATH, "; 1 of 2")
        self.assert_ends(self.trajectory.send([(0, 0)]), ABORTED, PATH, "refused: the device is offline")
        self.device.start()
        self.joints.values.clear()
        self.joints.wait_for(lambda message: "glue" in message.name)
        self.assertEqual(self.coils[GLUE], 1)

    def test_an_output_that_fails_aborts_it(self):
        self.begin()

        def answer(request):
            if request.function == 5 and request.data[3] == 0:
                raise Refuse(FAILURE)
            return self.device.serve(request)
        self.device.answer = answer
        self.assert_ends(self.trajectory.send([(0, 1), (SOON, 0), (2 * SOON, 1)]), ABORTED, PATH,
                         r"^glue to 0 at 0\.150 s: .*exception 04.*; 1 of 3 changes had been made$")

    def test_the_end_of_the_driver_is_a_result(self):
        self.begin()
        sent = self.trajectory.send([(0, 1), (NEVER, 0)])
        self.waits()
        self.program.end()
        if not IS_ROS2:  # whose client hears no more of a server that ends
            self.assert_ends(sent, ABORTED, PATH, "the driver ends")

    def test_an_axis_that_is_elsewhere_at_the_end_violates_its_tolerance(self):
        self.begin()
        registers = self.device.tables["holding_registers"]

        def answer(request):
            data = self.device.serve(request)
            if request.function == 6:
                registers[SPEED] = 80
            return data
        self.device.answer = answer
        self.assert_ends(self.trajectory.send([(0, 100)], ["belt"], tolerance=30), SUCCEEDED)
        self.assert_ends(self.trajectory.send([(0, 200)], ["belt"], tolerance=30), ABORTED, GOAL, "belt is at 80, which is not within 30 of 200")

    def test_a_point_with_the_same_name_takes_precedence(self):
        path = self.write_map(mapping="follow_joint_trajectory: {address: 90, type: UINT}")
        self.program = self.driver(f"_map:={path}", f"_port:={self.device.port}")
        self.program.wait_for("'follow_joint_trajectory'")
        self.program.wait_for("connected")


@unittest.skipUnless(process.has_node(), "coupler-node was not built")
class ByTheNode(TrajectoryTest):
    def setUp(self):
        path = self.write_map(head="watchdog: {timeout: 2s}")
        self.node = process.Node(path, port=free_port())
        self.addCleanup(lambda: self.node.end())  # pylint: disable=unnecessary-lambda
        self.start(self.node.port, path)

    def test_a_switch_follows_the_line_between_many_points(self):
        sent = self.trajectory.send(ramp(0, 1, 0, 1, 0, 1, 0), start=time.time() + SOON)
        self.assert_ends(sent, SUCCEEDED, text="^7 changes, at most")
        told = [message for message in self.scheduled.values if message.result == Scheduled.DONE]
        self.assertEqual(len(told), 7)
        for before, after in zip(told[1:], told[2:]):
            self.assertAlmostEqual(seconds(after.due) - seconds(before.due), SOON, places=3)

    def test_what_waits_at_the_node_is_cancelled(self):
        sent = self.trajectory.send([(0, 1), (2 * SOON, 0), (4 * SOON, 1)])
        self.waits()
        sent.cancel()
        result = self.assert_ends(sent, CANCELED, text="; [123] of 3")
        made = [message for message in self.scheduled.values if message.result == Scheduled.DONE]
        self.assertIn(f"; {len(made)} of 3", result.error_string)

    def test_the_end_of_the_node_aborts_it(self):
        sent = self.trajectory.send([(0, 1), (NEVER, 0)])
        self.waits()
        self.node.signal(signal.SIGKILL)
        self.assert_ends(sent, ABORTED, PATH, "; 1 of 2")

    def test_a_new_map_aborts_it(self):
        sent = self.trajectory.send([(SOON * number, number % 2) for number in range(1, 600)])
        self.waits()
        self.node.reload()
        self.assert_ends(sent, ABORTED, PATH, "read a new map.*; [0-9]+ of [0-9]+")


if __name__ == "__main__":
    testing.main()
