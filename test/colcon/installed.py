#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What `colcon build` or `cmake --install` has installed: it is in ament's index, can be imported, and works.  installed.py PREFIX"""
import os
import re
import subprocess
import sys
import time
import xml.etree.ElementTree

import rclpy
from ament_index_python import get_resource
from ament_index_python.packages import get_package_prefix, get_package_share_directory
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message, serialize_message
from std_msgs.msg import Bool

import coupler_driver
from coupler_driver.msg import PointStatus, Status
from coupler_driver.srv import Read, Write

PATIENCE = 60  # seconds; only tells what hangs from what is slow


def index(prefix):
    assert get_package_prefix("coupler_driver") == prefix, get_package_prefix("coupler_driver")
    share = get_package_share_directory("coupler_driver")
    for name in ("package.xml", "config/example-node.yaml", "config/sorter.yaml", "msg/Status.msg", "srv/Write.srv"):
        assert os.path.isfile(os.path.join(share, name)), name
    interfaces = get_resource("rosidl_interfaces", "coupler_driver")[0].split()
    print("in the index:", *(name for name in interfaces if not name.endswith(".idl")))


def launch_files():
    """They cannot be run here: they are XML, and have the tags that they may have; one is in Python, and compiles."""
    folder = os.path.join(get_package_share_directory("coupler_driver"), "launch")
    with open(os.path.join(folder, "sorter.launch.py"), encoding="utf-8") as file:
        compile(file.read(), file.name, "exec")
    for name in ("device", "devices", "simulated", "sorter"):
        file = os.path.join(folder, name + ".launch.xml")
        tags = {element.tag for element in xml.etree.ElementTree.parse(file).iter()}
        assert tags <= {"launch", "arg", "let", "node", "param", "executable"}, (file, tags)


def messages(prefix):
    assert coupler_driver.__file__.startswith(prefix + "/lib/python3"), coupler_driver.__file__
    assert Read.Request(point="lamp").point == "lamp" and Write.Response.REFUSED == 8
    status = Status(online=True, points=[PointStatus(name="lamp")])
    assert deserialize_message(serialize_message(status), Status) == status
    print("imported:", coupler_driver.__file__)


def application(prefix):
    """The example application is a program of the package, and ends when it is told to."""
    child = subprocess.Popen([prefix + "/lib/coupler_driver/eject"])
    try:
        rclpy.init()
        listener = rclpy.create_node("listener")
        end = time.monotonic() + PATIENCE
        while "eject" not in listener.get_node_names():
            assert time.monotonic() < end, "no node eject"
            time.sleep(0.05)
    finally:
        child.terminate()
        assert child.wait(PATIENCE) == 0
        rclpy.shutdown()
    print("the application ends")


def programs(prefix):
    """A simulated node, the driver for it, and the latched topic that says that both have found each other."""
    example = os.path.join(get_package_share_directory("coupler_driver"), "config/example-node.yaml")
    subprocess.run(["coupler", "check", example], check=True)
    node = subprocess.Popen(["coupler-node", example, "--sim", "--listen", "127.0.0.1", "--port", "0"], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)
    port = next(match[1] for match in (re.search(r" on .*:(\d+)", line) for line in node.stdout) if match)
    driver = subprocess.Popen([prefix + "/lib/coupler_driver/coupler_driver", "--ros-args", "-p", "address:=127.0.0.1", "-p", "port:=" + port])
    try:
        rclpy.init()
        listener = rclpy.create_node("listener")
        latched = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
        online = rclpy.task.Future()
        listener.create_subscription(Bool, "/example/online", lambda message: message.data and online.set_result(True), latched)
        rclpy.spin_until_future_complete(listener, online, timeout_sec=PATIENCE)
        assert online.done(), "no /example/online"
        print("online")
    finally:
        ends = []
        for process in (driver, node):
            process.terminate()
            ends.append(process.wait(PATIENCE))
    assert ends == [0, 0], ends


if __name__ == "__main__":
    index(sys.argv[1])
    launch_files()
    messages(sys.argv[1])
    application(sys.argv[1])
    programs(sys.argv[1])
