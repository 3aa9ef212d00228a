# SPDX-License-Identifier: Apache-2.0
import contextlib
import threading
import time
import xmlrpc.client

import rosgraph
import rospy
from rospy.impl.registration import get_registration_listeners, get_topic_manager

from support import at_once, case
from support.topics import Topic


class RosTest(case.Case):
    @staticmethod
    def before_all():
        """On a parameter server as a new roscore has it: a launch file's parameters outlive its nodes."""
        for name in rospy.get_param_names():
            if name not in ("/rosdistro", "/rosversion", "/run_id") and not name.startswith("/roslaunch/"):
                rospy.delete_param(name)

    def run(self, result=None):
        if not self.at_once:
            self.before_all()
        return super().run(result)

    def topic(self, name, kind, latched=False):  # pylint: disable=unused-argument
        """ROS 2 must be told that the last value is wanted; in ROS 1 it comes with the topic."""
        topic = Topic(name, kind)
        self.addCleanup(topic.close)
        return topic


class _Suite(at_once.Suite):
    @staticmethod
    def begin():
        rospy.init_node("test", anonymous=True, disable_signals=True)
        threading.Thread(target=_tell_of_publishers, daemon=True).start()

    @staticmethod
    def end():
        """rospy's end waits for its registrar, which looks for the end twice a second: it is woken."""
        registrars = list(get_registration_listeners().listeners)  # it has none any more when the hook is called

        def wake(_):
            for registrar in registrars:
                with registrar.cond:
                    registrar.cond.notify_all()

        rospy.core.add_shutdown_hook(wake)
        rospy.signal_shutdown("the tests are over")


def main():
    """Runs the tests of the calling file as ROS nodes."""
    case.run(lambda: _Suite.end() if rospy.core.is_initialized() else None, _Suite)


def _tell_of_publishers():
    """rospy handles what it hears of a topic's publishers last in, first out, and drops what is older: on a busy machine the
    answer to its own registration, in which there was no publisher yet, may so undo the news of one. It would never hear of
    that one again."""
    master = rosgraph.Master(rospy.get_name())
    this_node = xmlrpc.client.ServerProxy(rospy.get_node_uri())
    while True:
        time.sleep(5)
        with contextlib.suppress(OSError, rosgraph.MasterException, xmlrpc.client.Fault):  # a master that comes and goes
            publishers = dict(master.getSystemState()[0])
            for name, subscriber in list(get_topic_manager().subs.items()):
                if subscriber.get_num_connections() == 0 and name in publishers:
                    uris = [master.lookupNode(node) for node in publishers[name]]
                    this_node.publisherUpdate("/test", name, uris)
