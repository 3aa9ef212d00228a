# SPDX-License-Identifier: Apache-2.0
"""The device answers, but not as it should: exceptions of every code, and replies that are no replies."""
import struct

from coupler_driver.msg import PointStatus

from support import testing
from support.device import (ACKNOWLEDGE, BUSY, FAILURE, ILLEGAL_ADDRESS, ILLEGAL_FUNCTION, ILLEGAL_VALUE, NO_RESPONSE,
                            PATH_UNAVAILABLE, Device, Raw, Refuse, frame)
from support.patience import NO_TIMEOUT
from support.truth import TIMEOUT, Truth

LIE = b"\x03\x02\xFF\xFF"  # -1 as a reply of one register
REJECTED = (ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_VALUE)  # not asked for again while the connection lasts
PASSING = (FAILURE, ACKNOWLEDGE, BUSY, 7, 8, 0x63)  # the last one is in no specification
AWAY = (PATH_UNAVAILABLE, NO_RESPONSE)  # a gateway says that the device does not answer


def adu(request, pdu, protocol=0, unit=None, length=None):
    return Raw(struct.pack(">HHHB", request.transaction, protocol, len(pdu) + 1 if length is None else length,
                           request.unit if unit is None else unit) + pdu)


NO_REPLIES = {
    "garbage": lambda request: Raw(b"HTTP/1.0 400 no\r\n\r\n"),
    "nothing": lambda request: None,
    "an old transaction id": lambda request: frame(request, LIE, transaction=request.transaction - 1),
    "another unit": lambda request: adu(request, LIE, unit=request.unit + 1),
    "another function": lambda request: adu(request, b"\x04" + LIE[1:]),
    "another protocol": lambda request: adu(request, LIE, protocol=1),
    "fewer registers": lambda request: adu(request, b"\x03\x00"),
    "more registers": lambda request: adu(request, b"\x03\x04\xFF\xFF\xFF\xFF"),
    "a byte count that is a lie": lambda request: adu(request, b"\x03\x04\xFF\xFF"),
    "a length that is a lie": lambda request: adu(request, LIE, length=300),
    "half a reply": lambda request: Raw(frame(request, LIE)[:-1]),
}


class Answers(testing.RosTest):
    timeout = NO_TIMEOUT

    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.value = 0
        self.truth = Truth(self, self.device.port, timeout=self.timeout)
        self.all_is_well()

    def all_is_well(self):
        self.device.answer = self.device.serve
        self.value += 1
        self.device.tables["holding_registers"][4] = self.value
        self.truth.is_good(self.value)


class FaultExceptions(Answers):
    def refuse(self, code):
        def answer(request):
            raise Refuse(code)

        self.device.answer = answer

    def test_an_exception_that_passes_is_told_and_the_connection_stays(self):
        for code in PASSING:
            with self.subTest(code=code):
                self.refuse(code)
                self.truth.has_exception(code, PointStatus.EXCEPTION)
                self.all_is_well()
        self.assertEqual(self.device.accepted, 1)

    def test_a_unit_that_its_gateway_cannot_reach_is_offline_and_the_connection_stays(self):
        for code in AWAY:
            with self.subTest(code=code):
                self.refuse(code)
                self.truth.is_offline()
                # It is online for a moment when it asks again: the identity is refused as a foreign coupler refuses it.
                self.truth.status.wait_for(lambda known, text=f"exception {code:02X}": text in known["trouble"])
                self.truth.driver.wait_for(f"plant: the gateway cannot reach unit 1: exception {code:02X}")
                self.all_is_well()
        self.assertEqual(self.device.accepted, 1)
        self.assertNotIn("--verify off", self.truth.driver.output)  # it has answered before

    def test_a_point_that_the_device_has_not_is_told_and_asked_for_again_on_the_next_connection(self):
        for code in REJECTED:
            with self.subTest(code=code):
                self.refuse(code)
                self.truth.has_exception(code, PointStatus.REJECTED)
                self.device.answer = self.device.serve
                self.device.drop()
                self.all_is_well()


class FaultReplies(Answers):
    timeout = TIMEOUT  # there is nothing, or not all of it

    def test_a_reply_that_is_none_is_never_taken(self):
        for name, answer in NO_REPLIES.items():
            with self.subTest(name):
                self.device.answer = answer
                self.truth.is_offline()
                self.assertNotIn(-1, self.truth.level.ever)
                self.all_is_well()


if __name__ == "__main__":
    testing.main()
