# SPDX-License-Identifier: Apache-2.0
"""Random trajectories as planners make them, with many points between, at nodes behind slow networks: the edges that a client
sees that knows nothing of the driver. Nothing is said about how late they are, but never early, and each once.

Ten trajectories; COUPLER_LONG=yes: 500. It prints how late the edges were."""
import contextlib
import os
import queue
import socket
import threading
import time
import unittest

from sensor_msgs.msg import JointState

from support import process, testing
from support.actions import HAS_CONTROL_MSGS, SUCCEEDED
from support.patience import NO_TIMEOUT, QUIET, wait_until
from support.ports import free_port
from support.random_trajectory import RandomTrajectories, described, lateness
from support.raw_client import Listener
from support.relay import Relay
from trajectory_test import SUCCESSFUL, Trajectory

MAP = """
name: {name}
address: 127.0.0.1
timeout: {timeout}s
mapping:
  coils: {{valve_glue: 4, lamp: 7}}
  discrete_inputs: {{glue_flows: 0, lamp_burns: 1}}
axes:
  glue: {{point: valve_glue, joint: glue}}
  lamp: {{point: lamp, joint: lamp}}
sim:
  - {{from: valve_glue, to: glue_flows}}
  - {{from: lamp, to: lamp_burns}}
"""
JOINTS = ["glue", "lamp"]
DELAYS = [0, 0.001, 0.02, 0.1]  # seconds, each way
TRAJECTORIES = 500 if os.environ.get("COUPLER_LONG") else 10
AHEAD = 1.2  # seconds: a goal comes so long before its start
INPUT = 2  # docs/time.md
CLOCKS = 1e-4  # seconds: two programs tell the wall clock from the monotonic one


class SlowRelay(Relay):
    def __init__(self, node_port, delay):
        self._delay = delay
        super().__init__(node_port)

    def serve(self, client, node):
        threading.Thread(target=self._pass_on, args=(node, client), daemon=True).start()
        self._pass_on(client, node)

    def _pass_on(self, source, sink):
        under_way = queue.SimpleQueue()
        threading.Thread(target=self._deliver, args=(under_way, sink), daemon=True).start()
        data = True
        while data:
            try:
                data = source.recv(65536)
            except OSError:
                data = b""
            under_way.put((time.monotonic() + self._delay, data))

    @staticmethod
    def _deliver(under_way, sink):
        data = True
        while data:
            at, data = under_way.get()
            time.sleep(max(0, at - time.monotonic()))
            try:
                sink.sendall(data)
                if not data:
                    sink.shutdown(socket.SHUT_RDWR)
            except OSError:
                return


class Edges(threading.Thread):
    """Of the inputs of a node, as it tells any client: (joint, level, time)."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self._listener = Listener(("127.0.0.1", port))
        self.seen, self.lost = [], 0
        self.start()

    def run(self):
        with contextlib.suppress(OSError, EOFError):  # the node ends
            while True:
                reply = self._listener.take(self._listener.ask(self._listener.request()))
                self.lost += reply.lost
                self.seen += [(JOINTS[address], kind, at / 1e9) for table, kind, address, at in reply.changes if table == INPUT]


class Place:
    """A node behind a network, and what its lines are to do."""

    def __init__(self, test, delay):
        self.name = f"{test.name}_{round(1000 * delay)}"
        self.delay = delay
        path = process.write_map(MAP.format(name=self.name, timeout=NO_TIMEOUT))
        self._node = process.Node(path, port=free_port())
        test.addCleanup(self._node.end)
        self.relay = SlowRelay(self._node.port, delay)
        test.addCleanup(self.relay.stop)
        self.edges = Edges(self._node.port)
        self.map = process.write_map(MAP.format(name=self.name, timeout=NO_TIMEOUT) + f"port: {self.relay.port}\n")
        self.begin, self.wanted, self.late = None, [], []
        self._trajectory = None
        self._random = RandomTrajectories(JOINTS, self.name)

    def connect(self, test):
        joints = test.topic(f"/{self.name}/joint_states", JointState)
        joints.wait_for(lambda message: set(JOINTS) <= set(message.name))
        joints.close()
        self._trajectory = Trajectory(f"/{self.name}/follow_joint_trajectory")

    def send(self):
        points, edges = self._random.next()
        self.begin = time.monotonic() + AHEAD
        self.wanted = [(joint, level, self.begin + at) for joint, level, at in edges]
        return self._trajectory.send(points, JOINTS, start=wall_time_of(self.begin))

    def check(self, test, tolerance):
        """What was seen since the last call."""
        wait_until(lambda: len(self.edges.seen) >= len(self.wanted), f"{len(self.wanted)} edges: {self.edges.seen}")
        seen, self.edges.seen = self.edges.seen, []
        late = lateness(JOINTS, seen, self.wanted)
        test.assertGreaterEqual(min(late, default=0), -tolerance, f"never early: {seen}, wanted {self.wanted}")
        self.late += late


def wall_time_of(monotonic):
    while True:
        before, wall, after = time.monotonic(), time.time(), time.monotonic()
        if after - before < CLOCKS / 2:  # nothing else had the processor meanwhile
            return wall + monotonic - (before + after) / 2


def milliseconds_of(text, word):
    return float(text.split(word)[1].rstrip(")")) if word in text else 0


@unittest.skipUnless(HAS_CONTROL_MSGS and process.has_node(), "the driver was built without control_msgs, or no coupler-node")
class TrajectoryEdges(testing.RosTest):
    def test_each_edge_comes_once_in_its_order_and_never_early(self):
        places = [Place(self, delay) for delay in DELAYS]
        self.driver(f"_maps:=[{','.join(place.map for place in places)}]")
        for place in places:
            place.connect(self)
        for _ in range(0, TRAJECTORIES, len(places)):
            for place, sent in [(place, place.send()) for place in places]:
                how, result = sent.result()
                self.assertEqual((how, result.error_code), (SUCCEEDED, SUCCESSFUL), result.error_string)
                # As exactly as the driver knows the node's clock.
                place.check(self, CLOCKS + milliseconds_of(result.error_string, "± ") / 1000)
        time.sleep(QUIET)
        for place in places:
            self.assertEqual((place.edges.seen, place.edges.lost), ([], 0), "no edge comes twice")
            print(f"{1000 * place.delay:g} ms each way: {len(place.late)} edges, late by (ms): {described(place.late)}")


if __name__ == "__main__":
    testing.main()
