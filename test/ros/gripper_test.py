# SPDX-License-Identifier: Apache-2.0
"""The actions of tools, which MoveIt uses, by the action clients of ROS, and the positions of their joints."""
import math
import time
import unittest

from coupler_driver.msg import ToolState
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from support import testing
from support.actions import ABORTED, CANCELED, HAS_CONTROL_MSGS, IS_ROS2, REPLACED, SUCCEEDED, Client, topics_below
from support.patience import wait_until
from support.times import seconds
from support.tools import CLOSE, CLOSED, OPEN, OPENED, PART, VACUUM, DeviceToolsTest

JOINT = ", joint: fingers, positions: {open: 0.04, closed: 0.0}"


class Gripper(Client):
    """Of control_msgs/GripperCommand."""

    def __init__(self, name):
        # pylint: disable=import-outside-toplevel,import-error
        if IS_ROS2:
            from control_msgs.action import GripperCommand as Action
        else:
            from control_msgs.msg import GripperCommandAction as Action
        super().__init__(name, Action)

    def send(self, position):
        goal = self.goal()
        goal.command.position = position
        return self.send_goal(goal)


class ParallelGripper(Client):
    """Of control_msgs/ParallelGripperCommand."""

    def __init__(self, name):
        from control_msgs.action import ParallelGripperCommand  # pylint: disable=import-outside-toplevel,import-error
        super().__init__(name, ParallelGripperCommand)

    def send(self, position, *joints):
        goal = self.goal()
        goal.command.position = position
        goal.command.name = joints
        return self.send_goal(goal)


class Joints(DeviceToolsTest):
    def joints(self):
        return self.topic(f"/{self.name}/joint_states", JointState)

    def test_the_position_of_a_joint_is_that_of_an_end(self):
        self.start(more=JOINT)
        topic = self.joints()
        message = topic.wait_for(lambda message: True)
        self.assertEqual((message.name[0], message.position[0]), ("fingers", 0.04))
        call = self.call("clamp/close")
        self.becomes(CLOSE, 1)
        topic.wait_for(lambda message: message.position[0] == 0.02)
        self.inputs[OPENED], self.inputs[CLOSED] = 0, 1
        self.assertTrue(call.result()[0])
        topic.wait_for(lambda message: message.position[0] == 0.0)

    def test_the_stamp_advances_even_if_nothing_changes(self):
        self.start(more=JOINT)
        topic = self.joints()
        first = seconds(topic.wait_for(lambda message: True).header.stamp)
        self.assertLessEqual(first, time.time())
        topic.wait_for(lambda message: seconds(message.header.stamp) > first)

    def test_a_joint_whose_position_is_unknown_is_left_out(self):
        self.start()
        topic = self.joints()
        names = [f"{self.name}/clamp", f"{self.name}/cup"]
        message = topic.wait_for(lambda message: list(message.name) == names)
        self.assertEqual(list(message.position), [1.0, 0.5], "the cup has no input, and has not moved")
        self.assertTrue(self.call("cup/close").result()[0])
        topic.wait_for(lambda message: list(message.position) == [1.0, 0.0])
        self.inputs[CLOSED] = 1  # both ends
        topic.wait_for(lambda message: list(message.name) == names[1:])

    def test_stamps_increase_and_the_position_is_published_before_the_result(self):
        self.start(more=JOINT)
        topic = self.joints()
        for _ in range(3):
            for end, inputs, position in (("close", (0, 1), 0.0), ("open", (1, 0), 0.04)):
                call = self.call(f"clamp/{end}")
                self.becomes(CLOSE if end == "close" else OPEN, 1)
                self.inputs[OPENED], self.inputs[CLOSED] = inputs
                self.assertTrue(call.result()[0])
                topic.wait_for(lambda message, position=position: message.position[0] == position)
        stamps = [seconds(message.header.stamp) for message in topic.ever]
        self.assertEqual(stamps, sorted(set(stamps)))

    def test_a_point_with_the_same_name_takes_precedence(self):
        self.start(mapping="input_registers: {joint_states: {address: 0, type: UINT}}")
        self.program.wait_for("'joint_states'")
        self.assertTrue(self.call("cup/close").result()[0])


@unittest.skipUnless(HAS_CONTROL_MSGS, "the driver was built without control_msgs")
class Actions(DeviceToolsTest):
    def start(self, *arguments, more=JOINT, **options):
        super().start(*arguments, more=more, **options)
        self.gripper = Gripper(f"/{self.name}/clamp/gripper_cmd")

    def assert_ends(self, sent, how, *, reached=False, stalled=False, position=None):
        ended, result = sent.result()
        self.assertEqual((ended, result.reached_goal, result.stalled), (how, reached, stalled))
        if position is not None:
            self.assertAlmostEqual(result.position, position)
        return result

    def closing(self, position=0.0):
        """A goal whose output is on."""
        sent = self.gripper.send(position)
        self.becomes(CLOSE, 1)
        return sent

    def test_a_goal_drives_to_the_nearer_end(self):
        self.start()
        sent = self.closing(0.019)
        self.assertEqual(self.coils[OPEN], 0)
        self.inputs[OPENED] = 0
        self.inputs[CLOSED] = 1
        self.assert_ends(sent, SUCCEEDED, reached=True, position=0.0)
        sent = self.gripper.send(1.0)
        self.becomes(OPEN, 1)
        self.inputs[CLOSED], self.inputs[OPENED] = 0, 1
        self.assert_ends(sent, SUCCEEDED, reached=True, position=0.04)

    def test_a_part_that_is_held_is_a_success(self):
        self.start()
        sent = self.closing()
        self.inputs[OPENED], self.inputs[PART] = 0, 1
        self.assert_ends(sent, SUCCEEDED, stalled=True, position=0.02)

    def test_what_does_not_move_is_stalled(self):
        self.start(patience=0.2)
        self.inputs[OPENED] = 0
        self.assert_ends(self.gripper.send(0.0), ABORTED, stalled=True, position=0.02)
        self.program.wait_for(r"a goal of clamp was aborted: stuck: neither end after")

    def test_a_newer_goal_replaces_it_and_so_does_a_service(self):
        self.start()
        first = self.closing()
        second = self.gripper.send(0.0)
        self.assert_ends(first, REPLACED)
        first.cancel()  # it has ended: the second one goes on
        self.assertTrue(self.call("clamp/open").result()[0])
        self.assert_ends(second, REPLACED)

    def test_a_cancelled_goal_leaves_the_outputs_as_they_are(self):
        self.start()
        sent = self.closing()
        sent.cancel()
        self.assert_ends(sent, CANCELED)
        self.assertEqual(self.coils[CLOSE], 1)
        self.assertRegex(self.assert_becomes("clamp", ToolState.OPEN).reason, "cancelled after [0-9]+ ms")

    def test_a_cancelled_goal_opens_the_tool_where_the_map_says_so(self):
        self.start(more=JOINT + ", on_cancel: open")
        sent = self.closing()
        self.inputs[OPENED] = 0
        sent.cancel()
        self.assert_ends(sent, CANCELED)
        self.assertEqual((self.coils[CLOSE], self.coils[OPEN]), (0, 1))
        self.assert_becomes("clamp", ToolState.OPENING)
        self.inputs[OPENED] = 1
        self.assert_becomes("clamp", ToolState.OPEN)

    def test_nan_as_a_position_is_refused(self):
        self.start()
        result = self.assert_ends(self.gripper.send(math.nan), ABORTED)
        self.assertTrue(math.isnan(result.position))
        self.program.wait_for("a goal of clamp was aborted: refused: the position is nan; send 0.04 to open it, 0 to close it")
        self.assertFalse(self.device.seen(5))

    def test_feedback_has_the_position_of_the_tool(self):
        self.start()
        sent = self.closing()
        wait_until(lambda: sent.feedback, "feedback")
        self.assertEqual(sent.feedback[-1].position, 0.02)

    def test_an_output_that_the_device_rejects_aborts_the_goal(self):
        self.start()
        self.reject_writes_of(OPEN)
        self.assert_ends(self.gripper.send(0.0), ABORTED)
        self.assertEqual(self.coils[CLOSE], 0)

    def test_a_write_by_another_client_aborts_the_goal(self):
        self.start()
        sent = self.closing()
        self.coils[CLOSE] = 0
        self.assert_ends(sent, ABORTED)

    def test_a_lost_connection_aborts_the_goal(self):
        self.start(timeout=1)
        sent = self.closing()
        self.device.stop()
        result = self.assert_ends(sent, ABORTED)
        self.assertTrue(math.isnan(result.position))

    def test_safe_values_abort_the_goal(self):
        self.start()
        sent = self.closing()
        self.assertTrue(self.service(f"/{self.name}/safe", Trigger)().success)
        self.assert_ends(sent, ABORTED)

    def test_the_end_of_the_driver_aborts_the_goal(self):
        self.start()
        sent = self.closing()
        self.program.interrupt()
        self.assert_ends(sent, ABORTED)

    def test_a_tool_without_inputs_is_there_after_its_travel_time(self):
        self.start()
        cup = Gripper(f"/{self.name}/cup/gripper_cmd")
        self.assert_ends(cup.send(0.2), SUCCEEDED, reached=True, position=0.0)
        self.assertEqual(self.coils[VACUUM], 1)

    def test_a_point_with_the_same_name_takes_precedence(self):
        self.start(mapping="input_registers: {cup/gripper_cmd: {address: 0, type: UINT}}")
        self.program.wait_for("'cup/gripper_cmd'")
        self.assertEqual(topics_below(f"/{self.name}/cup/gripper_cmd"),
                         [f"/{self.name}/cup/gripper_cmd"])


@unittest.skipUnless(IS_ROS2 and HAS_CONTROL_MSGS, "ROS 1 has no such action, or the driver was built without control_msgs")
class ParallelActions(DeviceToolsTest):
    def start(self, *arguments, **options):
        super().start(*arguments, more=JOINT, **options)
        self.gripper = ParallelGripper(f"/{self.name}/clamp/parallel_gripper_cmd")

    def test_a_goal_drives_to_the_nearer_end(self):
        self.start()
        sent = self.gripper.send([0.0], "fingers")
        self.becomes(CLOSE, 1)
        wait_until(lambda: sent.feedback, "feedback")
        self.assertEqual(list(sent.feedback[-1].state.position), [0.02])
        self.inputs[OPENED] = 0
        self.inputs[CLOSED] = 1
        how, result = sent.result()
        self.assertEqual((how, result.reached_goal, result.stalled), (SUCCEEDED, True, False))
        self.assertEqual((list(result.state.name), list(result.state.position)), (["fingers"], [0.0]))

    def test_a_goal_of_the_other_action_replaces_it(self):
        self.start()
        sent = self.gripper.send([0.0])
        self.becomes(CLOSE, 1)
        other = Gripper(f"/{self.name}/clamp/gripper_cmd").send(0.04)
        self.assertEqual(sent.result()[0], REPLACED)
        sent.cancel()
        self.assertEqual(other.result()[0], SUCCEEDED)

    def test_a_goal_may_omit_the_joint_but_not_name_another(self):
        self.start()
        how, _ = self.gripper.send([0.0], "elbow").result()
        self.assertEqual(how, ABORTED)
        self.program.wait_for("a goal of clamp was aborted: refused: it has no position of the joint fingers; send one")
        how, _ = self.gripper.send([]).result()
        self.assertEqual(how, ABORTED)
        how, result = self.gripper.send([0.04]).result()
        self.assertEqual((how, result.reached_goal), (SUCCEEDED, True))


if __name__ == "__main__":
    testing.main()
