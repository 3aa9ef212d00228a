# SPDX-License-Identifier: Apache-2.0
"""The test vectors of a map against the driver: registers at pymodbus become the value of the topic, a value that is
published becomes the registers. RANDOM_MAPS, a folder: with the generated drivers of the random maps in it, too."""
import json
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest

from support import iec, process, testing
from support.patience import NO_TIMEOUT
from support.peer import Peer
from support.topics import type_of, wait_until

TEST = pathlib.Path(__file__).resolve().parent.parent
ROUNDS = 14  # as many as a float has cases


def vectors_of(path):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([process.BUILD / "bin/coupler", "generate", path, "--vectors", "--name", "tested", "--out", folder,
                        "--quiet"], check=True, stdout=subprocess.DEVNULL)
        return json.loads((pathlib.Path(folder) / "tested_vectors.json").read_text())


class Tested:
    """A point with its cases; each point has another one in a round, so that those that share registers differ."""

    def __init__(self, point, index, prefix):
        self.point, self.index = point, index
        self.topic, self.kind = f"{prefix}/{point['name']}", point["type"]
        self.is_read, self.is_written = point["access"] != "write", point["access"] != "read"
        self.place = point["table"], point["address"]
        self.mask = int(point.get("mask", "FFFF"), 16)

    def case(self, number):
        return self.point["cases"][(number + self.index) % len(self.point["cases"])]

    def raw(self, number):
        return [word if "bits" in self.point else int(word, 16) for word in self.case(number)["raw"]]

    def data(self, number):
        """What the message holds."""
        value = self.case(number)["value"]
        values = [self._number(one) for one in (value if "count" in self.point else [value])]
        if self.kind in iec.BITS:
            size = 8 * struct.calcsize(iec.BITS[self.kind])
            return [bool(one >> bit & 1) for one in values for bit in range(size)]
        return values if "count" in self.point else values[0]

    def _number(self, value):
        if self.kind in ("BOOL", "STRING"):
            return value
        return float(value) if value in ("nan", "inf", "-inf") or "scale" in self.point else \
            int(value) if isinstance(value, str) else value

    def has(self, received, number):
        """Bit for bit."""
        expected = self.data(number)
        both = [list(data) if isinstance(expected, list) else [data] for data in (received, expected)]
        if "scale" in self.point or self.kind in ("REAL", "LREAL"):
            letter = "f" if self.kind == "REAL" and "scale" not in self.point else "d"
            both = [[struct.pack(">" + letter, one) for one in data] for data in both]
        return both[0] == both[1]

    def store(self, peer, number):
        old = peer.get(*self.place, len(self.raw(number)))
        peer.set(*self.place, [int(before) & ~self.mask | word for before, word in zip(old, self.raw(number))]
                 if "mask" in self.point else self.raw(number))

    def is_stored(self, peer, number):
        raw = self.raw(number)
        return [int(word) & self.mask for word in peer.get(*self.place, len(raw))] == raw


class Vectors(testing.RosTest):
    at_once = True
    peer = Peer

    def check(self, path, *program, name=None):
        """`program`: a generated driver, or the driver with its map."""
        vectors = vectors_of(path)
        name = name or self.name
        points = [Tested(point, i, "/" + name) for i, point in enumerate(vectors["points"])]
        with self.peer() as peer:
            arguments = (*program, f"_name:={name}", *peer.way, f"_timeout:={NO_TIMEOUT}s")
            with process.Process(*process.driver_arguments(arguments)) as driver:
                driver.wait_for("connected")
                self.check_reading(peer, points)
                self.check_writing(peer, points)

    def check_reading(self, peer, points):
        read = [point for point in points if point.is_read]
        topics = [self.topic(point.topic, self.kind_of(point.topic)) for point in read]
        for number in range(ROUNDS):
            for point in points:
                point.store(peer, number)
            for topic in topics:
                topic.values.clear()
            for point, topic in zip(read, topics):
                topic.wait_for(lambda data, p=point: p.has(data, number))

    def check_writing(self, peer, points):
        written = [point for point in points if point.is_written]
        publishers = self.publishers({f"{point.topic}/write": self.kind_of(f"{point.topic}/write") for point in written})
        for number in range(ROUNDS):
            sent = [point for point in written if not point.case(number).get("only")]
            for point, publisher in zip(written, publishers):
                if point in sent:
                    message = publisher.data_class()
                    message.data = point.data(number)
                    publisher.publish(message)
            for point in sent:
                wait_until(lambda p=point: p.is_stored(peer, number), f"{point.topic}: {point.case(number)} at the peer")

    def kind_of(self, topic):
        kinds = []

        def is_known():
            kinds.append(type_of(topic))
            return kinds[-1] is not None
        wait_until(is_known, f"the type of {topic}")
        return kinds[-1]

    def test_every_type(self):
        path = TEST / "maps/every-type.yaml"
        self.check(path, "coupler_driver", f"_map:={path}")

    def test_scales_arrays_and_orders(self):
        path = process.write_map((TEST / "common/test_vectors/vectors.yaml").read_text())
        self.check(path, "coupler_driver", f"_map:={path}")

    @unittest.skipUnless("RANDOM_MAPS" in os.environ, "test/random/run builds them")
    def test_random_maps_with_generated_drivers(self):
        for number in range(5):
            with self.subTest(map=number):
                path = pathlib.Path(os.environ["RANDOM_MAPS"]) / f"random_{number}.yaml"
                # The master remembers the type of a topic for which a subscriber of the last map is still there.
                self.check(path, process.BUILD / f"test/bin/random_{number}_driver", name=f"{self.name}_{number}")


if __name__ == "__main__":
    testing.main()
