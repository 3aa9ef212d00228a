# SPDX-License-Identifier: Apache-2.0
"""This process's part in ROS 2: a domain of its own and two nodes."""
import os
import threading

from support import ros2_domain

os.environ["ROS_DOMAIN_ID"] = str(ros2_domain.take())  # for this process and its children

# pylint: disable=wrong-import-position
import rclpy  # noqa: E402
from rclpy.context import Context  # noqa: E402
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor  # noqa: E402
from rclpy.impl.implementation_singleton import rclpy_implementation  # noqa: E402
from rclpy.signals import SignalHandlerOptions  # noqa: E402

from support.patience import PATIENCE, wait_until  # noqa: E402

rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)

# Publishers and subscriptions. Nobody spins it: who waits for a message takes it, so that thousands a second cost a test
# nothing that it does not look at.
polled = rclpy.create_node("test", start_parameter_services=False, enable_rosout=False)

# Clients and events, by a thread.
spun = rclpy.create_node("test_client", start_parameter_services=False, enable_rosout=False)
_OWN = (polled.get_name(), spun.get_name())
_executor = SingleThreadedExecutor()
_executor.add_node(spun)


def _spin():
    try:
        _executor.spin()
    except ExternalShutdownException:
        pass


_thread = threading.Thread(target=_spin, daemon=True)
_thread.start()


def made_by_thread(make):
    """What make() returns, which the thread calls: it sees an action client as soon as that is begun, and ends if that is not
    whole yet."""
    made = _executor.create_task(make)
    wait_until(made.done, "what the thread makes")
    return made.result()


def other_subscribers():
    """The DDS participants, one a process, that subscribe to something: but for this process. The first twelve bytes of an
    endpoint's id are its participant's (DDSI-RTPS 2.3, 9.3.1.5)."""
    return {bytes(info.endpoint_gid[:12]) for topic, _ in polled.get_topic_names_and_types()
            for info in polled.get_subscriptions_info_by_topic(topic) if info.node_name not in _OWN}


def wait_for_graph(condition, what):
    """Until condition(node) is true: there is something that a node knows of another by its name. Participants tell each other
    the names in a topic, and on a busy machine Fast DDS may take nothing of it any more (ros2/rmw_fastrtps#749): then another
    one is asked."""
    def holds(node):
        try:
            return condition(node)
        except rclpy_implementation.NodeNameNonExistentError:
            return False

    try:
        wait_until(lambda: holds(polled), what, PATIENCE / 6)
    except AssertionError:
        with Context() as context:
            other = rclpy.create_node("test_other", context=context, start_parameter_services=False, enable_rosout=False)
            wait_until(lambda: holds(other), what)
            other.destroy_node()


def shut_down():
    _executor.shutdown()
    _thread.join()
    rclpy.shutdown()
