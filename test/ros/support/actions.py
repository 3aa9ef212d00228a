# SPDX-License-Identifier: Apache-2.0
"""Actions by the action client of either ROS: actionlib's or rclpy's."""
import os
import subprocess

from support import process
from support.patience import PATIENCE, once_more, wait_until
from support.times import ros_duration, ros_time

SUCCEEDED, ABORTED, CANCELED = "succeeded", "aborted", "canceled"
IS_ROS2 = os.environ.get("ROS_VERSION") == "2"
REPLACED = ABORTED if IS_ROS2 else CANCELED  # by a newer goal
HAS_CONTROL_MSGS = "without control_msgs" not in subprocess.run([process.BUILD / "bin" / "coupler_driver", "--version"],
                                                                capture_output=True, check=True, text=True).stdout

# pylint: disable=import-outside-toplevel,import-error,no-name-in-module
if IS_ROS2:
    from action_msgs.msg import GoalStatus
    from coupler_driver.action import WaitFor
    from rclpy.action import ActionClient

    from support.ros import made_by_thread, spun

    class _Sent:
        """A goal that was sent."""

        def __init__(self, client, goal):
            def send():
                self.feedback = []
                self._accepted = client.send_goal_async(goal, lambda message: self.feedback.append(message.feedback))
                wait_until(self._accepted.done, "the answer to a goal", PATIENCE / 2)

            once_more(send)  # Fast DDS may lose the first answer to a client (support/topics.py)
            self.is_accepted = self._accepted.result().accepted
            self._result = self._accepted.result().get_result_async()

        def cancel(self):
            self._accepted.result().cancel_goal_async()

        @property
        def is_over(self):
            return self._result.done()

        @property
        def _ending(self):
            words = {GoalStatus.STATUS_SUCCEEDED: SUCCEEDED, GoalStatus.STATUS_ABORTED: ABORTED,
                     GoalStatus.STATUS_CANCELED: CANCELED}
            answer = self._result.result()
            return words[answer.status], answer.result

    def goal_of(action):
        return action.Goal()

    def _topics():
        return spun.get_topic_names_and_types()

    def _client(name, action):
        client = made_by_thread(lambda: ActionClient(spun, action, name))
        wait_until(lambda: client.wait_for_server(0.1), f"the action {name}")
        return client

else:
    import actionlib
    from actionlib import CommState, TerminalState
    from coupler_driver.msg import WaitForAction as WaitFor
    import rospy

    class _Sent:
        def __init__(self, client, goal):
            self.feedback = []
            self._handle = client.send_goal(goal, feedback_cb=lambda _, feedback: self.feedback.append(feedback))
            # A goal that is canceled before is lost for actionlib's client.
            wait_until(lambda: self._handle.get_comm_state() != CommState.WAITING_FOR_GOAL_ACK, "the answer to a goal")

        def cancel(self):
            self._handle.cancel()

        @property
        def is_over(self):
            return self._handle.get_comm_state() == CommState.DONE

        @property
        def _ending(self):
            words = {TerminalState.SUCCEEDED: SUCCEEDED, TerminalState.ABORTED: ABORTED,
                     TerminalState.PREEMPTED: CANCELED}
            return words[self._handle.get_terminal_state()], self._handle.get_result()

    def goal_of(action):
        return action().action_goal.goal

    def _topics():
        return rospy.get_published_topics()

    def _client(name, action):
        client = actionlib.ActionClient(name, action)
        wait_until(lambda: client.wait_for_server(rospy.Duration(0.1)), f"the action {name}")
        return client


def topics_below(name):
    """The topics that begin with it, hidden ones too."""
    return [topic for topic, _ in _topics() if topic.startswith(name)]


class Sent(_Sent):
    def result(self, seconds=PATIENCE):
        """How it ended, and its result."""
        wait_until(lambda: self.is_over, "the result of a goal", seconds)
        return self._ending


class Client:
    """Of an action: the class of ROS 2's action, or of ROS 1's action message."""

    def __init__(self, name, action):
        self._client = _client(name, action)
        self._action = action

    def goal(self):
        return goal_of(self._action)

    def send_goal(self, goal):
        return Sent(self._client, goal)


class WaitForClient(Client):
    def __init__(self, name):
        super().__init__(name, WaitFor)

    def send(self, point, condition, value="", *, timeout=PATIENCE, for_at_least=0, since=None):
        goal = self.goal()
        goal.point, goal.condition, goal.value = point, condition, value
        goal.timeout, goal.for_at_least = ros_duration(timeout), ros_duration(for_at_least)
        if since is not None:
            goal.since = ros_time(since)
        return self.send_goal(goal)
