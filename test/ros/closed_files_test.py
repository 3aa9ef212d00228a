# SPDX-License-Identifier: Apache-2.0
"""A driver that is started with stdin, stdout and stderr closed gives their numbers to nobody: no line of its log goes
into a connection to a device."""
import os

from std_msgs.msg import Bool, Int16

from support import process, testing
from support.peer import Peer
from support.topics import wait_until

MAP = """
name: closed
address: 127.0.0.1
timeout: 60
mapping:
  coils: {lamp: 3}
  holding_registers: {level: {address: 4, type: INT}}
"""


def start(*arguments):
    """The process id of a driver without the three files."""
    child = os.fork()
    if child:
        return child
    for file in range(3):
        os.close(file)
    program = str(process.BUILD / "bin" / "coupler_driver")
    os.execv(program, [program, *process.driver_arguments(arguments)])


class ClosedFiles(testing.RosTest):
    def test_the_three_are_dev_null_and_a_device_gets_what_it_should(self):
        with Peer() as peer:
            peer.set("holding_registers", 4, [33])
            pid = start(f"_map:={process.write_map(MAP)}", f"_port:={peer.port}", "_rate:=50")
            try:
                self.assertEqual(self.topic("/closed/level", Int16).next(), 33)
                self.assertEqual([os.readlink(f"/proc/{pid}/fd/{file}") for file in range(3)], 3 * ["/dev/null"])
                self.publisher("/closed/lamp/write", Bool).publish(True)
                wait_until(lambda: peer.get("coils", 3) == [True], "the lamp")
            finally:
                os.kill(pid, 2)
                self.assertEqual(os.waitpid(pid, 0)[1], 0)


if __name__ == "__main__":
    testing.main()
