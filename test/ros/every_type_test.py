# SPDX-License-Identifier: Apache-2.0
"""Every type, in every table, in all four byte and word orders, against pymodbus."""
import pathlib

import yaml

from support import iec, process, testing
from support.patience import NO_TIMEOUT
from support.peer import Peer
from support.topics import wait_until

MAP = pathlib.Path(__file__).resolve().parent.parent / "maps" / "every-type.yaml"
ORDERS = {"AsIs": (False, False), "WordsReversed": (False, True), "BytesReversed": (True, False), "BothReversed": (True, True)}


def value_of(point, index, turn):
    return iec.sample(point.kind, index + turn, point.options.get("length", 0) - 2)


class EveryType:
    """In one order of bytes and words: (byteorder_reverse, wordorder_reverse)."""
    peer = Peer
    order = None

    def setUp(self):
        self.peer = self.enterContext(self.peer())
        document = yaml.safe_load(MAP.read_text())
        document.update(name=self.name, byteorder_reverse=self.order[0], wordorder_reverse=self.order[1])
        self.points = iec.points(document)
        for index, point in enumerate(self.points):
            point.store(self.peer, value_of(point, index, 0))
        path = process.write_map(yaml.safe_dump(document))
        self.driver(f"_map:={path}", *self.peer.way, f"_timeout:={NO_TIMEOUT}").wait_for("connected")

    def test_each_point_is_read_as_a_topic(self):
        topics = {point.name: self.topic(f"/{self.name}/{point.name}", point.message) for point in self.points}
        for index, point in enumerate(self.points):
            expected = value_of(point, index, 0)
            received = topics[point.name].wait_for(lambda _: True)
            self.assertTrue(iec.same(point.kind, received, expected), f"{point.name}: {received}, not {expected}")

    def test_each_writable_point_is_written_by_its_topic_and_nothing_else_is(self):
        values = {point.name: value_of(point, index, 0) for index, point in enumerate(self.points)}
        writable = {index: point for index, point in enumerate(self.points) if point.writable}
        publishers = self.publishers({f"/{self.name}/{p.name}/write": p.message for p in writable.values()})
        for (index, point), publisher in zip(writable.items(), publishers):
            values[point.name] = value_of(point, index, 1)
            publisher.publish(data=values[point.name])
            wait_until(lambda p=point: p.is_stored(self.peer, values[p.name]), f"{point.name} at the peer")
        for point in self.points:  # nothing that shares a register, or stands beside it, was touched
            self.assertTrue(point.is_stored(self.peer, values[point.name]), point.name)


def in_each_order(tests):
    """Classes of these tests, by their names."""
    names = {f"{tests.__name__}{name}": order for name, order in ORDERS.items()}
    return {name: type(name, (tests, testing.RosTest), {"__module__": tests.__module__, "order": order, "at_once": True})
            for name, order in names.items()}


globals().update(in_each_order(EveryType))

if __name__ == "__main__":
    testing.main()
