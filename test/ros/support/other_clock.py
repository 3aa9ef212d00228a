# SPDX-License-Identifier: Apache-2.0
"""Makes a node one whose clock goes otherwise, at the end of a slow network: rewrites the times of function codes 65 and 66
(docs/time.md) and delays what goes each way."""
import socket
import struct
import threading
import time

from support.relay import Relay, next_frame

CHANGES, SCHEDULE = 65, 66
PDU = 7  # where it begins in a frame
CHANGE_SIZE, CHANGE_TIME = 12, 4
NS = 1_000_000_000


class OtherClock(Relay):
    """`offset` in ns may be changed at any time, as a clock that jumps; `drift`: how much faster it goes, 1e-6 is 1 ppm;
    `to_node`, `to_driver`: functions that return the delay of the next frame in seconds."""

    def __init__(self, node_port, offset=0, drift=0.0, to_node=lambda: 0, to_driver=lambda: 0):
        self.offset = offset
        self.drift = drift
        self._begun = time.monotonic_ns()
        self._to_node, self._to_driver = to_node, to_driver
        super().__init__(node_port)

    def serve(self, client, node):
        threading.Thread(target=self._hand_on, args=(node, client, self._to_driver, self._reply), daemon=True).start()
        self._hand_on(client, node, self._to_node, self._request)

    @staticmethod
    def _hand_on(source, target, delay, rewrite):
        try:
            with source.makefile("rb") as frames:
                while frame := bytearray(next_frame(frames)):
                    time.sleep(delay())
                    rewrite(frame)
                    target.sendall(frame)
        except OSError:
            pass
        for end in (source, target):
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass

    def _reply(self, frame):
        if frame[PDU] == CHANGES:
            count = frame[PDU + 34]
            changes = range(PDU + 35, PDU + 35 + CHANGE_SIZE * count, CHANGE_SIZE)
            places = [PDU + 6, PDU + 14, *(change + CHANGE_TIME for change in changes)]
        elif frame[PDU] == SCHEDULE:
            places = [PDU + 4, PDU + 12]
        else:
            return
        offset = self.offset  # one for the whole frame
        for place in places:
            at, = struct.unpack_from(">Q", frame, place)
            struct.pack_into(">Q", frame, place, at + offset + round((at - self._begun) * self.drift))

    def _request(self, frame):
        is_to_schedule = frame[PDU] == SCHEDULE and frame[PDU + 2] == 1
        if is_to_schedule:
            due, = struct.unpack_from(">Q", frame, PDU + 7)
            true = self._begun + round((due - self.offset - self._begun) / (1 + self.drift))
            struct.pack_into(">Q", frame, PDU + 7, true)
