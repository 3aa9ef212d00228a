# SPDX-License-Identifier: Apache-2.0
"""Every type, in every table, in all four byte and word orders, against pymodbus."""
import itertools
import pathlib
import unittest

import yaml

from support import iec, process, testing
from support.patience import NO_TIMEOUT
from support.peer import Peer
from support.topics import Topic, connected_publishers, wait_until

MAP = pathlib.Path(__file__).resolve().parent.parent / "maps" / "every-type.yaml"
ORDERS = list(itertools.product((False, True), repeat=2))


def value_of(point, index, turn):
    return iec.sample(point.kind, index + turn, point.options.get("length", 0) - 2)


class EveryType(unittest.TestCase):
    peer = Peer

    def document(self, byteorder_reverse, wordorder_reverse):
        document = yaml.safe_load(MAP.read_text())
        document.update(byteorder_reverse=byteorder_reverse, wordorder_reverse=wordorder_reverse)
        return document

    def for_each_order(self, check):
        for order in ORDERS:
            with self.subTest(byteorder_reverse=order[0], wordorder_reverse=order[1]):
                document = self.document(*order)
                with self.peer() as peer:
                    points = iec.points(document)
                    for index, point in enumerate(points):
                        point.store(peer, value_of(point, index, 0))
                    path = process.write_map(yaml.safe_dump(document))
                    with process.Driver(f"_map:={path}", *peer.way, f"_timeout:={NO_TIMEOUT}") as driver:
                        driver.wait_for("connected")
                        check(peer, points)

    def check_reading(self, _, points):
        topics = {point.name: Topic(f"/every_type/{point.name}", point.message) for point in points}
        for index, point in enumerate(points):
            expected = value_of(point, index, 0)
            received = topics[point.name].wait_for(lambda _: True)
            self.assertTrue(iec.same(point.kind, received, expected), f"{point.name}: {received}, not {expected}")
        for topic in topics.values():
            topic.close()

    def check_writing(self, peer, points):
        values = {point.name: value_of(point, index, 0) for index, point in enumerate(points)}
        writable = {index: point for index, point in enumerate(points) if point.writable}
        publishers = connected_publishers({f"/every_type/{p.name}/write": p.message for p in writable.values()})
        for (index, point), publisher in zip(writable.items(), publishers):
            values[point.name] = value_of(point, index, 1)
            publisher.publish(data=values[point.name])
            wait_until(lambda p=point: p.is_stored(peer, values[p.name]), f"{point.name} at the peer")
        for publisher in publishers:
            publisher.unregister()
        for point in points:  # nothing that shares a register, or stands beside it, was touched
            self.assertTrue(point.is_stored(peer, values[point.name]), point.name)

    def test_each_point_is_read_as_a_topic(self):
        self.for_each_order(self.check_reading)

    def test_each_writable_point_is_written_by_its_topic_and_nothing_else_is(self):
        self.for_each_order(self.check_writing)


if __name__ == "__main__":
    testing.main()
