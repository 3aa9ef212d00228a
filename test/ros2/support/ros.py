# SPDX-License-Identifier: Apache-2.0
"""This process's part in ROS 2: a domain of its own and two nodes."""
import os
import socket
import threading

DOMAINS = 101  # 1 to 101: the ports of those above may be the kernel's choice for somebody else
_lock = None   # of the domain, held until this process ends


def take_domain():
    """For this process and its children: one in which no other test of this machine is. Nobody else's programs, either,
    if they were there before."""
    global _lock  # pylint: disable=global-statement
    for number in range(DOMAINS):
        domain = 1 + (os.getpid() + number) % DOMAINS
        lock, probe = socket.socket(socket.AF_UNIX), socket.socket(type=socket.SOCK_DGRAM)
        try:
            lock.bind(f"\0coupler-ros2-domain-{domain}")
            probe.bind(("", 7410 + 250 * domain))  # of the first participant
        except OSError:
            lock.close()
            continue
        finally:
            probe.close()
        _lock = lock
        os.environ["ROS_DOMAIN_ID"] = str(domain)
        return
    raise RuntimeError("every ROS 2 domain of this machine is in use")


take_domain()

# pylint: disable=wrong-import-position
import rclpy  # noqa: E402
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor  # noqa: E402
from rclpy.signals import SignalHandlerOptions  # noqa: E402

rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)

# Publishers and subscriptions. Nobody spins it: who waits for a message takes it, so that thousands a second cost a test
# nothing that it does not look at.
polled = rclpy.create_node("test", start_parameter_services=False, enable_rosout=False)

# Clients and events, by a thread.
spun = rclpy.create_node("test_client", start_parameter_services=False, enable_rosout=False)
_executor = SingleThreadedExecutor()
_executor.add_node(spun)


def _spin():
    try:
        _executor.spin()
    except ExternalShutdownException:
        pass


_thread = threading.Thread(target=_spin, daemon=True)
_thread.start()


def shut_down():
    _executor.shutdown()
    _thread.join()
    rclpy.shutdown()
