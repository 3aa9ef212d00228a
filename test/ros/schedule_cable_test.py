# SPDX-License-Identifier: Apache-2.0
"""What a driver has scheduled at a node does not outlive its cable: the node notices within some seconds that nobody is there, and
cancels it. No watchdog is needed for that."""
import struct
import socket
import subprocess
import time

from coupler_driver.srv import Schedule
from std_msgs.msg import Bool

from support import process, testing
from support.network import Network
from support.patience import PATIENCE
from support.times import ros_duration, ros_time

NOTICED = 6  # seconds: docs/time.md
DUE = 10
PORT = 1502


class Cable(testing.RosTest):
    def test_an_output_does_not_move_after_its_client_was_cut_off(self):
        network = self.enterContext(Network())
        path = process.write_map(f"name: cable\naddress: {network.device}\nport: {PORT}\nmapping:\n  coils: {{lamp: 4}}\n")
        subprocess.run(["ip", "-n", network._name, "link", "set", "lo", "up"], check=True)  # pylint: disable=protected-access
        with network.at_the_far_end():
            node = process.Process("coupler-node", path, "--sim", "--listen", "0.0.0.0", "--port", PORT)
        self.addCleanup(node.end)
        node.wait_for("serving")
        with network.at_the_far_end():
            beside = self.enterContext(socket.create_connection(("127.0.0.1", PORT), PATIENCE))
        driver = process.Driver(f"_map:={path}")
        self.addCleanup(driver.end)
        driver.wait_for("connected")
        self.topic("/cable/lamp", Bool).next()
        due = time.time() + DUE
        answer = self.service("/cable/schedule", Schedule)("lamp", "true", ros_time(due), ros_duration(0))
        self.assertEqual((answer.success, answer.message), (True, "accepted: the device does it"))
        network.pull()
        while time.time() < due + 1:
            beside.sendall(struct.pack(">HHHBBHH", 1, 0, 6, 1, 1, 4, 1))
            self.assertEqual(beside.recv(300)[-1], 0, "the lamp moved")
            time.sleep(0.2)
        network.plug()


if __name__ == "__main__":
    testing.main()
