#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Clients wait for changes (function code 65, docs/time.md) at a node that serves peers.yaml, beside clients that know
nothing of it.

    changes_test.py NODE_COMMAND…
"""
import contextlib
import os
import pathlib
import signal
import socket
import struct
import sys
import threading
import time

import peer

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent.parent)]
from support.raw_client import LONGEST_WAIT, Listener, read_changes, wait, wait_for_changes  # noqa: E402
from support.served import Served  # noqa: E402

try:
    from pymodbus.factory import ClientDecoder
    from pymodbus.pdu import ModbusRequest, ModbusResponse
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")

COIL, INPUT = 1, 2  # tables
KEPT = 1024  # changes: coupler/device/node/io_service.cpp
OUTPUTS = 10  # coils 0 … 9; coil 0 is wired to input 0, coil 1 inverted to input 1
READ = struct.pack(">BHH", 1, 0, OUTPUTS)


class Client(Listener):
    def write(self, coil, level):
        assert self.ask(struct.pack(">BHH", 5, coil, 0xFF00 if level else 0))[0] == 5

    def has_answer(self):
        self.socket.setblocking(False)
        with contextlib.suppress(BlockingIOError):
            return self.socket.recv(1, socket.MSG_PEEK) != b""
        self.socket.settimeout(peer.PATIENCE)
        return False

    def news(self):
        """What has changed and was not told, without waiting; the changes are those of several replies."""
        total = self.take(self.ask(self.request(0)))
        while self.seen < total.newest:
            more = self.take(self.ask(self.request(0)))
            total.changes += more.changes
            total.lost += more.lost
        return total


def bits(reply):
    return [change[:3] for change in reply.changes]


def the_clock():
    return time.clock_gettime_ns(time.CLOCK_MONOTONIC)


@contextlib.contextmanager
def connected(port, count=1):
    with contextlib.ExitStack() as stack:
        yield [stack.enter_context(Client(("127.0.0.1", port))) for _ in range(count)]


def an_edge_announces_itself(port, checks):
    with connected(port, 2) as (listener, writer):
        sent = the_clock()
        wait(listener, writer)
        checks.equal("nothing has changed: it waits", listener.has_answer(), False)
        before = the_clock()
        writer.write(0, True)
        reply = listener.take(listener.receive())
        told = reply.changes
        while len(told) < 2:  # the coil, and the input that is wired to it
            told += listener.take(listener.ask(listener.request())).changes
        after = the_clock()
        checks.equal("what has changed", sorted(change[:3] for change in told), [(COIL, 1, 0), (INPUT, 1, 0)])
        for *_, at in told:
            checks.equal("when", before <= at <= after, True)
        checks.equal("the node's clock", sent <= reply.arrived <= before <= reply.replied <= after, True)
        checks.equal("lost", reply.lost, 0)
        writer.write(0, True)
        writer.write(0, False)
        checks.equal("no change is told twice, and none where a bit has its level already", bits(listener.news()),
                     [(COIL, 0, 0), (INPUT, 0, 0)])


def a_wait_ends_by_itself(port, checks):
    with connected(port) as (client,):
        reply = client.take(client.ask(client.request(50)))
        checks.equal("no changes", reply.changes, [])
        checks.equal("it has waited", reply.replied - reply.arrived >= 50_000_000, True)
        checks.equal("a wait that is too long", client.ask(client.request(LONGEST_WAIT + 1)), b"\xC1\x03")


def another_epoch_begins_anew(port, checks):
    with connected(port) as (client,):
        client.write(2, True)
        for epoch in (0, client.epoch ^ 1):
            reply = read_changes(client.ask(wait_for_changes(epoch, 0)))
            checks.equal("epoch and changes", (reply.epoch, reply.changes, reply.lost), (client.epoch, [], 0))
            checks.equal("newest", reply.newest > client.seen, True)
        client.write(2, False)
        checks.equal("the epoch is not 0", client.epoch != 0, True)


def replies_stay_in_order(port, checks):
    with connected(port) as (client,):
        client.send(client.request(), READ, client.request(), READ, READ)
        checks.equal("the wait ends before the poll is answered", read_changes(client.receive(1)).changes, [])
        checks.equal("the poll", client.receive(2)[0], 1)
        checks.equal("the second wait", read_changes(client.receive(3)).changes, [])
        checks.equal("the last polls", [client.receive(i)[0] for i in (4, 5)], [1, 1])


def what_is_overwritten_is_lost(port, checks):
    with connected(port) as (client,):
        made = 0
        for i in range(KEPT // OUTPUTS // 2 * 2 + 2):  # all are off again at the end
            client.ask(struct.pack(">BHHBH", 15, 0, OUTPUTS, 2, 0xFF03 if i % 2 == 0 else 0))
            made += OUTPUTS + 2
        total = client.news()
        checks.equal("seen and lost are all", total.lost + len(total.changes), made)
        checks.equal("some are lost", total.lost > 0, True)
        checks.equal("the newest are kept", len(total.changes) >= KEPT - OUTPUTS, True)


def everybody_who_waits_is_woken(port, checks):
    plain = peer.pymodbus_client(port)
    with connected(port, 21) as (writer, *crowd):
        for client in crowd:
            client.send(client.request())
        for level in (True, False):  # others are served meanwhile
            checks.equal("a plain write", plain.write_register(0, 7, 1).isError(), False)
            checks.equal("a plain read", plain.read_coils(0, 1, 1).bits[0], not level)
            writer.write(0, level)
            for client in crowd:
                told = client.take(client.receive()).changes
                while len(told) < 2:
                    told += client.take(client.ask(client.request())).changes
                checks.equal("each hears of it", sorted(change[:3] for change in told),
                             [(COIL, int(level), 0), (INPUT, int(level), 0)])
            for client in crowd:
                client.send(client.request())
            checks.equal("a plain read", plain.read_coils(0, 1, 1).bits[0], level)
    plain.close()


class ChangesResponse(ModbusResponse):
    function_code = 65

    def decode(self, data):
        self.told = read_changes(b"\x41" + data)


class ChangesRequest(ModbusRequest):
    function_code = 65

    def __init__(self, epoch=0, seen=0, wait=0, **header):
        super().__init__(**header)
        self.asked = wait_for_changes(epoch, seen, wait)

    def encode(self):
        return self.asked[1:]

    def get_response_pdu_size(self):
        return 0  # any


def pymodbus_waits(port, checks):
    client = peer.pymodbus_client(port)
    ClientDecoder().register(ChangesResponse)
    client.framer.decoder.register(ChangesResponse)
    begun = client.execute(ChangesRequest(unit=1)).told
    client.write_coil(5, True, 1)
    told = client.execute(ChangesRequest(begun.epoch, begun.newest, LONGEST_WAIT, unit=1)).told
    checks.equal("pymodbus hears of a change", bits(told), [(COIL, 1, 5)])
    again = threading.Thread(target=write_coil, args=(port, 5, False))
    again.start()
    told = client.execute(ChangesRequest(told.epoch, told.newest, LONGEST_WAIT, unit=1)).told
    checks.equal("and waits for the next one", bits(told), [(COIL, 0, 5)])
    again.join()
    client.close()


def write_coil(port, coil, level):
    client = peer.pymodbus_client(port)
    client.write_coil(coil, level, 1)
    client.close()


def a_reload_is_a_new_epoch(node, checks):
    with connected(node.port, 2) as (client, other):
        before = client.epoch
        wait(client, other)
        os.kill(node.processes()[0], signal.SIGHUP)
        reply = client.take(client.receive())
        checks.equal("the wait is answered before the reload", (reply.epoch, reply.changes), (before, []))
        checks.equal("since it did not end by itself", reply.replied - reply.arrived < LONGEST_WAIT * 1_000_000, True)
        reply = client.take(client.ask(client.request()))
        checks.equal("then the epoch is another one", reply.epoch not in (0, before), True)
        checks.equal("it begins anew", (reply.changes, reply.lost), ([], 0))
        client.write(4, True)
        checks.equal("and goes on", bits(client.news()), [(COIL, 1, 4)])


def the_end_answers_who_waits(node, checks):
    with connected(node.port, 2) as (client, other):
        wait(client, other)
        checks.equal("the node ends in order", node.stop(), 0)
        checks.equal("the wait is answered before the end", read_changes(client.receive()).epoch, client.epoch)


def main():
    checks = peer.Checks()
    node = Served([*sys.argv[1:], "--listen", "127.0.0.1", "--port", "0"])
    try:
        for test in (an_edge_announces_itself, a_wait_ends_by_itself, another_epoch_begins_anew, replies_stay_in_order,
                     what_is_overwritten_is_lost, everybody_who_waits_is_woken, pymodbus_waits):
            test(node.port, checks)
        if any(word.endswith(".yaml") for word in sys.argv):  # else its map is built in
            a_reload_is_a_new_epoch(node, checks)
        the_end_answers_who_waits(node, checks)
    finally:
        node.stop()
    checks.done("clients hear of changes as they happen, beside clients that poll")


main()
