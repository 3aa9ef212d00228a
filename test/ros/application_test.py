# SPDX-License-Identifier: Apache-2.0
"""The example application (config/examples/sorter) as a user meets it: with the driver and a simulated node, in either ROS."""
import os
import pathlib
import signal
import time
import unittest

from coupler_driver.msg import BoolSample
from coupler_driver.srv import Write
from std_msgs.msg import Bool

from support import process, testing
from support.patience import NO_TIMEOUT, wait_until
from support.ports import free_port
from support.times import ROUNDING, ros_time, seconds

ROS2 = os.environ.get("ROS_VERSION") == "2"
SORTER = pathlib.Path(__file__).resolve().parent.parent.parent / "config" / "examples" / "sorter"
# `part` stands for a part in the light barrier: there is one when the node starts.
MAP = """
name: {name}
address: 127.0.0.1
timeout: {timeout}s
mapping:
  discrete_inputs: {{part_seen: {{address: 0, stamped: true}}}}
  coils: {{ejector: {{address: 0, stamped: true}}, part: {{address: 1, initial: on}}}}
sim: [{{from: part, to: part_seen}}]
"""
DELAY, DURATION = 0.5, 0.2  # seconds


class ApplicationTest(testing.RosTest):
    at_once = True

    def eject(self, **parameters):
        words = [f"_{key}:={value}" for key, value in parameters.items()]
        if ROS2:
            words = ["--ros-args"] + [word for key, value in parameters.items() for word in ("-p", f"{key}:={value}")]
        name = f"__name:={self.name}_eject"
        self.program = process.Process(SORTER / ("eject_rclpy.py" if ROS2 else "eject_rospy.py"), *words,
                                       *(["-r", f"__node:={self.name}_eject"] if ROS2 else [name]),
                                       environment={**os.environ, "PYTHONUNBUFFERED": "1"})  # rospy does not flush
        self.addCleanup(self.program.end)
        return self.program


@unittest.skipUnless(process.has_node(), "coupler-node was not built")
class WithADriver(ApplicationTest):
    def begin(self, head="", **parameters):
        self.path = process.write_map(head + MAP.format(name=self.name, timeout=NO_TIMEOUT))
        self.port = free_port()
        self.start_node()
        self.driver(f"_map:={self.path}", f"_port:={self.port}").wait_for("connected")
        self.seen = self.topic(f"/{self.name}/part_seen/sample", BoolSample)
        self.ejector = self.topic(f"/{self.name}/ejector/sample", BoolSample)
        self.write = self.service(f"/{self.name}/write", Write)
        self.seen.wait_for(lambda sample: sample.value)
        self.ejector.next()
        self.eject(**{"device": self.name, "delay": DELAY, "duration": DURATION, **parameters})
        self.program.wait_for("the device is online")

    def start_node(self):
        self.node = process.Node(self.path, port=self.port)
        self.addCleanup(self.node.end)
        self.node.wait_for("serving")

    def part(self, there):
        self.assertTrue(self.write("part", there).success)
        self.seen.wait_for(lambda _: self.seen.values[-1].value == (there == "true"))

    def edges_until(self, text):
        """A part comes and goes until the application says that. The first one may be before it listens, and on a busy machine a call
        may come after its time."""
        def is_said():
            self.part("false")
            self.part("true")
            end = time.monotonic() + 4 * (DELAY + DURATION)
            while time.monotonic() < end and text not in self.program.output:
                time.sleep(0.02)
            return text in self.program.output

        wait_until(is_said, f"'{text}'")

    def test_the_output_is_on_for_its_duration_after_the_delay(self):
        self.begin()
        self.edges_until("done, ")
        on = self.ejector.wait_for(lambda sample: sample.value)
        self.ejector.wait_for(lambda sample: not sample.value and seconds(sample.since) > seconds(on.since))
        times = [seconds(on.since) - seconds(sample.since) for sample in self.seen.ever if sample.value]
        late = min(one - DELAY for one in times if one > DELAY - on.uncertainty - 0.1)
        self.assertGreaterEqual(late, -on.uncertainty - max(sample.uncertainty for sample in self.seen.ever) - ROUNDING)

    def test_a_part_that_is_there_at_the_start_is_no_edge(self):
        self.begin()
        self.edges_until("done, ")
        self.assertIn("write 1 done", self.program.output)

    def test_a_part_that_is_there_after_a_reconnect_is_no_edge(self):
        self.begin()
        self.edges_until("write 1 done")
        self.part("false")
        self.node.end()
        self.program.wait_for("the device is offline")
        self.start_node()
        wait_until(lambda: self.program.output.count("is online") == 2, "the device to be online again")
        self.seen.wait_for(lambda _: self.seen.values[-1].value)
        self.edges_until("write 2 done")
        self.assertEqual(self.program.output.count("write 2"), 1)

    def test_what_the_driver_refuses_is_told(self):
        self.begin(output="nothing")
        self.edges_until("nothing true was refused: there is no point 'nothing'")

    def test_a_coupler_that_cannot_end_it_needs_a_second_write(self):
        self.begin("changes: off\n")
        self.edges_until("Schedule a second write of ejector")

    def test_a_second_write_ends_it(self):
        self.begin("changes: off\n", second_write="true")
        self.edges_until("write 2 done")
        on = self.ejector.wait_for(lambda sample: sample.value)
        self.ejector.wait_for(lambda sample: not sample.value and seconds(sample.since) > seconds(on.since))


class Alone(ApplicationTest):
    """The test is the driver."""

    def setUp(self):
        self.eject(device=self.name)
        self.samples = self.publisher(f"/{self.name}/part_seen/sample", BoolSample)

    def sample(self, sequence, value):
        self.samples.publish(BoolSample(sequence=sequence, value=value, since=ros_time(time.time())))

    def test_lost_messages_and_a_missing_service_are_told(self):
        self.sample(7, False)
        self.sample(8, False)
        self.sample(11, True)
        self.program.wait_for("2 messages of part_seen were lost")
        self.program.wait_for("ejector true was not scheduled")

    def test_a_driver_that_starts_again_is_no_edge(self):
        self.sample(7, False)
        self.sample(1, True)
        self.sample(5, False)
        self.program.wait_for("3 messages of part_seen were lost")
        self.assertNotIn("not scheduled", self.program.output)

    def test_it_ends_with_sigterm_as_well(self):
        self.assertEqual(self.program.interrupt(signal.SIGTERM), 0)


if __name__ == "__main__":
    testing.main()
