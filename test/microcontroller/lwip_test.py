#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What clients see of the node on lwIP: mbpoll, `coupler`, and sockets that misbehave. Started by test/microcontroller/lwip."""
import os
import pathlib
import re
import socket
import struct
import subprocess
import sys
import time
import unittest

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent.parent)]
from support.raw_client import RawClient, adu, read_changes, wait_for_changes  # noqa: E402

BUILD = pathlib.Path(sys.argv.pop(1))
NODE = ("192.0.2.2", 502)
PATIENCE = 60
TIMEOUT = 5  # LwipServer::timeout
CLIENTS = 4  # LwipServer::max_clients


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=PATIENCE, check=False)


def mbpoll(*options, values=()):
    """The values that mbpoll has read by their number, or what it says of an error. Addresses count from 0."""
    done = run("mbpoll", "-m", "tcp", "-o", "10", "-p", NODE[1], "-1", "-0", "-q", *options, NODE[0], *values)
    read = re.findall(r"^\[\d+\]:\s+(\S+)", done.stdout, re.M)
    return [int(value) for value in read] if done.returncode == 0 else done.stdout + done.stderr


READ_COIL = b"\x01\x00\x00\x00\x01"


class Client(RawClient):
    def __init__(self, **options):
        super().__init__(NODE, **options)

    def is_closed(self):
        """Once the node has closed it: reset or ended."""
        try:
            return self.socket.recv(1) == b""
        except ConnectionResetError:
            return True


class Lwip(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.node = subprocess.Popen([BUILD / "lwip" / "lwip_node"], stdout=subprocess.PIPE, text=True,
                                    env=dict(os.environ, PRECONFIGURED_TAPIF="tap0"))
        assert cls.node.stdout.readline() == "lwip_node: serving on 192.0.2.2:502\n"

    @classmethod
    def tearDownClass(cls):
        assert cls.node.poll() is None, f"the node ended with {cls.node.returncode}"
        cls.node.kill()
        cls.node.wait()
        cls.node.stdout.close()

    def client(self, **options):
        client = Client(**options)
        self.addCleanup(client.close)
        return client

    def test_a_pin_follows_its_coil_and_is_read_back(self):
        client, on = self.client(), b"\x05\x00\x00\xFF\x00"
        for table in (0, 1):
            end = time.monotonic() + PATIENCE
            # The watchdog may expire while mbpoll is run.
            while client.ask(on) == on and (seen := mbpoll("-t", table, "-r", 0)) != [1]:
                self.assertLess(time.monotonic(), end, seen)
            self.assertEqual(seen, [1])
        client.ask(b"\x05\x00\x00\x00\x00")
        self.assertEqual(mbpoll("-t", 1, "-r", 0), [0])

    def test_hooks_take_a_value_or_refuse_it_and_set_others(self):
        before = mbpoll("-t", "3:int", "-B", "-r", 1)[0]
        mbpoll("-t", 4, "-r", 0, values=[255])
        self.assertEqual(mbpoll("-t", 4, "-r", 0), [255])
        self.assertEqual(mbpoll("-t", 3, "-r", 0), [255])  # the temperature, which the firmware has set
        self.assertEqual(mbpoll("-t", "3:int", "-B", "-r", 1), [before + 1])
        self.assertIn("Slave device or server failure", mbpoll("-t", 4, "-r", 0, values=[401]))
        self.assertEqual(mbpoll("-t", 4, "-r", 0), [255])

    def test_clients_wait_for_changes(self):
        def told(pdu):
            reply = read_changes(pdu)
            return reply.epoch, reply.newest, reply.lost, [change[:3] for change in reply.changes]

        waiting, writer = self.client(), self.client()
        writer.ask(b"\x05\x00\x00\x00\x00")
        epoch, newest, *nothing = told(waiting.ask(wait_for_changes(0, 0)))
        self.assertEqual(nothing, [0, []])
        self.assertEqual(told(waiting.ask(wait_for_changes(epoch, newest, 10))), (epoch, newest, 0, []))
        waiting.send(wait_for_changes(epoch, newest))
        writer.ask(b"\x05\x00\x00\xFF\x00")  # the relay, whose contact is the button's pin
        changes = told(waiting.receive())[3]
        while (2, 1, 0) not in changes:
            writer.ask(b"\x05\x00\x00\xFF\x00")  # the watchdog may have expired before the node looked at the pin
            changes += told(waiting.ask(wait_for_changes(epoch, newest + len(changes))))[3]
        self.assertIn(changes[:2], ([(1, 1, 0), (2, 1, 0)], [(1, 1, 0), (1, 0, 0)]))
        waiting.send(wait_for_changes(epoch, newest + 2), READ_COIL, first=7)
        for transaction in (7, 8):
            waiting.receive(transaction)

    def test_an_output_is_driven_at_its_time_or_cancelled(self):
        client = self.client()
        end = time.monotonic() + PATIENCE

        def schedule(ahead):
            """What was told before, the relay's number, and the node's time at which it is due."""
            while True:
                self.assertLess(time.monotonic(), end)
                now = read_changes(client.ask(wait_for_changes(0, 0)))
                due = now.replied + ahead
                reply = client.ask(struct.pack(">BBBIQIBHHBB", 66, 1, 1, now.epoch, due, 0, 1, 0, 1, 1, 1))
                if reply != b"\xC2\x03":  # it was past when it came
                    self.assertEqual(reply[:2], b"\x42\x01", reply.hex(" "))
                    return now, reply[2:4], due
                ahead *= 2

        def outcome(now, number):
            changes = []
            while not (told := [change for change in changes if change[1] >= 3 and change[2] == int.from_bytes(number, "big")]):
                self.assertLess(time.monotonic(), end)
                changes += read_changes(client.ask(wait_for_changes(now.epoch, now.newest + len(changes)))).changes
            return told[0], [change[:3] for change in changes]

        def is_undisturbed(reason, kind):
            """False: the node or this test had no processor for a second, and the watchdog has expired."""
            return (reason, kind) != (3, 4)

        while True:
            now, number, due = schedule(50_000_000)
            (reason, kind, _, at), changes = outcome(now, number)
            if is_undisturbed(reason, kind):
                break
        self.assertEqual((reason, kind), (0, 3))
        self.assertGreaterEqual(at, due)
        self.assertIn((1, 1, 0), changes)

        while True:
            now, number, _ = schedule(3_000_000_000_000)
            reply = client.ask(struct.pack(">BBBI", 66, 1, 2, now.epoch) + number)
            (reason, kind, *_), _ = outcome(now, number)
            if is_undisturbed(reason, kind):
                break
        self.assertEqual(reply[:4], b"\x42\x01" + number)
        self.assertEqual((reason, kind), (1, 4))

    def test_an_address_that_is_not_mapped_is_exception_02(self):
        self.assertIn("Illegal data address", mbpoll("-t", 4, "-r", 100))

    def test_outputs_are_safe_when_the_client_that_wrote_is_silent(self):
        writer, reader = self.client(), self.client()
        writer.ask(b"\x05\x00\x00\xFF\x00")
        end = time.monotonic() + PATIENCE
        while reader.ask(READ_COIL) != b"\x01\x01\x00":
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)

    def test_the_map_is_proven_equal_and_the_machine_has_a_name(self):
        coupler = BUILD / "bin" / "coupler"
        status = run(coupler, "status", NODE[0], "--timeout", "20")
        self.assertEqual(status.returncode, 0, status.stdout + status.stderr)
        self.assertIn("board-1", status.stdout)
        dump = run(coupler, "dump", "config/examples/lwip/board.yaml")
        self.assertEqual(dump.returncode, 0, dump.stdout + dump.stderr)
        self.assertIn("unnamed", dump.stdout)

    def test_many_requests_at_once_are_all_answered_in_their_order(self):
        client, count = self.client(), 2000
        client.send(*[READ_COIL] * count, first=0)
        for i in range(count):
            client.receive(i)

    def test_a_client_that_does_not_read_is_closed_and_the_others_are_served(self):
        greedy = self.client(receive_buffer=4096)
        greedy.socket.settimeout(0.2)
        other = self.client()
        end = time.monotonic() + PATIENCE
        identity = adu(b"\x04\xFF\x00\x00\x30")
        with self.assertRaises(OSError) as closed:
            while time.monotonic() < end:
                try:
                    greedy.socket.sendall(identity * 100)
                except socket.timeout:
                    self.assertEqual(other.ask(READ_COIL)[:2], b"\x01\x01")
        self.assertIsInstance(closed.exception, (ConnectionResetError, BrokenPipeError))

    def test_half_a_frame_is_closed_though_bytes_keep_coming(self):
        client = self.client()
        client.socket.sendall(adu(READ_COIL)[:4])
        began = time.monotonic()
        for byte in b"\x00\x06\x01\x01\x00\x00":
            time.sleep(TIMEOUT / 4)
            try:
                client.socket.sendall(bytes([byte]))
            except OSError:
                break
        self.assertTrue(client.is_closed())
        self.assertGreaterEqual(time.monotonic() - began, TIMEOUT - 0.5)

    def test_what_is_no_frame_is_closed_at_once(self):
        client = self.client()
        client.socket.sendall(b"GET / HTTP/1.1\r\n\r\n")
        self.assertTrue(client.is_closed())

    def test_one_more_client_takes_the_place_of_who_has_not_written(self):
        writer = self.client()
        writer.ask(b"\x05\x00\x00\x00\x00")
        others = [self.client() for _ in range(CLIENTS - 1)]
        for other in others:
            other.ask(READ_COIL)
        self.assertEqual(self.client().ask(READ_COIL)[:2], b"\x01\x01")
        self.assertTrue(others[0].is_closed())
        for kept in (writer, *others[1:]):
            self.assertEqual(kept.ask(READ_COIL)[:2], b"\x01\x01")

    def test_after_a_thousand_connections_it_serves(self):
        for i in range(1000):
            client = Client()
            if i % 3 == 0:
                client.ask(READ_COIL)
            if i % 2 == 0:  # reset, not closed
                client.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            client.close()
        self.assertEqual(self.client().ask(READ_COIL)[:2], b"\x01\x01")


if __name__ == "__main__":
    unittest.main(verbosity=2)
