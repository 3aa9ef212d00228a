# SPDX-License-Identifier: Apache-2.0
"""Every type, in every table, in all four byte and word orders, against pymodbus."""
import pathlib

import yaml

from support import iec, process, testing
from support.patience import NO_TIMEOUT
from support.peer import Peer
from support.topics import wait_until

MAP = pathlib.Path(__file__).resolve().parent.parent / "maps" / "every-type.yaml"


def value_of(point, index, turn):
    return iec.sample(point.kind, index + turn, point.options.get("length", 0) - 2)


class EveryType(testing.RosTest):
    at_once = True
    peer = Peer

    def start(self, bytes_reversed, words_reversed):
        self.device = self.enterContext(self.peer())
        document = yaml.safe_load(MAP.read_text())
        document.update(name=self.name, byteorder_reverse=bytes_reversed, wordorder_reverse=words_reversed,
                        timeout=f"{NO_TIMEOUT}s")
        self.points = iec.points(document)
        for index, point in enumerate(self.points):
            point.store(self.device, value_of(point, index, 0))
        path = process.write_map(yaml.safe_dump(document))
        self.driver(f"_map:={path}", *self.device.way).wait_for("connected")

    def is_read(self, bytes_reversed=False, words_reversed=False):
        """Each point, as a topic."""
        self.start(bytes_reversed, words_reversed)
        topics = {point.name: self.topic(f"/{self.name}/{point.name}", point.message) for point in self.points}
        for index, point in enumerate(self.points):
            expected = value_of(point, index, 0)
            received = topics[point.name].wait_for(lambda _: True)
            self.assertTrue(iec.same(point.kind, received, expected), f"{point.name}: {received}, not {expected}")

    def is_written(self, bytes_reversed=False, words_reversed=False):
        """Each writable point, by its topic, and nothing else is."""
        self.start(bytes_reversed, words_reversed)
        values = {point.name: value_of(point, index, 0) for index, point in enumerate(self.points)}
        writable = {index: point for index, point in enumerate(self.points) if point.writable}
        publishers = self.publishers({f"/{self.name}/{p.name}/write": p.message for p in writable.values()})
        for (index, point), publisher in zip(writable.items(), publishers):
            values[point.name] = value_of(point, index, 1)
            publisher.publish(data=values[point.name])
            wait_until(lambda p=point: p.is_stored(self.device, values[p.name]), f"{point.name} at the peer")
        for point in self.points:  # nothing that shares a register, or stands beside it, was touched
            self.assertTrue(point.is_stored(self.device, values[point.name]), point.name)

    def test_each_point_is_read_as_a_topic(self):
        self.is_read()

    def test_each_point_is_read_with_its_bytes_reversed(self):
        self.is_read(bytes_reversed=True)

    def test_each_point_is_read_with_its_words_reversed(self):
        self.is_read(words_reversed=True)

    def test_each_point_is_read_with_both_reversed(self):
        self.is_read(bytes_reversed=True, words_reversed=True)

    def test_each_writable_point_is_written_by_its_topic_and_nothing_else_is(self):
        self.is_written()

    def test_each_writable_point_is_written_with_its_bytes_reversed(self):
        self.is_written(bytes_reversed=True)

    def test_each_writable_point_is_written_with_its_words_reversed(self):
        self.is_written(words_reversed=True)

    def test_each_writable_point_is_written_with_both_reversed(self):
        self.is_written(bytes_reversed=True, words_reversed=True)


if __name__ == "__main__":
    testing.main()
