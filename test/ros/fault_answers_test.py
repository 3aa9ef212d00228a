# SPDX-License-Identifier: Apache-2.0
"""The device answers, but not as it should: exceptions of every code, and replies that are no replies."""
import struct

from coupler_driver.msg import PointStatus

from support import testing
from support.device import (ACKNOWLEDGE, BUSY, FAILURE, ILLEGAL_ADDRESS, ILLEGAL_FUNCTION, ILLEGAL_VALUE, NO_RESPONSE,
                            PATH_UNAVAILABLE, Device, Raw, Refuse, frame)
from support.patience import NO_TIMEOUT
from support.truth import TIMEOUT, nothing_is_published, start_several

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
    """A device for each of what is answered."""
    at_once = True

    def start(self, answers, timeout=NO_TIMEOUT):
        """`answers`: what each is, for for_each()."""
        self.answers = answers
        self.devices = [Device().start() for _ in answers]
        for device in self.devices:
            self.addCleanup(device.stop)
        self.value = 0
        self.truths = start_several(self, [device.port for device in self.devices], timeout=timeout)
        self.all_is_well()

    def for_each(self, act):
        for answer, device, truth in zip(self.answers, self.devices, self.truths):
            with self.subTest(answer):
                act(answer, device, truth)

    def all_is_well(self):
        self.value += 1
        for device in self.devices:
            device.tables["holding_registers"][4] = self.value
            device.answer = device.serve
        self.for_each(lambda _, __, truth: truth.is_good(self.value))


class FaultExceptions(Answers):
    def refuse(self):
        for code, device in zip(self.answers, self.devices):
            def answer(_, code=code):
                raise Refuse(code)

            device.answer = answer

    def test_an_exception_that_passes_is_told_and_the_connection_stays(self):
        self.start(PASSING)
        self.refuse()
        self.for_each(lambda code, _, truth: truth.has_exception(code, PointStatus.EXCEPTION))
        nothing_is_published(self.truths)
        self.all_is_well()
        self.for_each(lambda _, device, __: self.assertEqual(device.accepted, 1))

    def test_a_unit_that_its_gateway_cannot_reach_is_offline_and_the_connection_stays(self):
        def is_away(code, _, truth):
            truth.is_offline()
            # It is online for a moment when it asks again: the identity is refused as a foreign coupler refuses it.
            truth.status.wait_for(lambda known: f"exception {code:02X}" in known["trouble"])
            truth.driver.wait_for(f"{truth.name}: the gateway cannot reach unit 1: exception {code:02X}")

        self.start(AWAY)
        self.refuse()
        self.for_each(is_away)
        nothing_is_published(self.truths)
        self.all_is_well()
        self.for_each(lambda _, device, __: self.assertEqual(device.accepted, 1))
        self.assertNotIn("--verify off", self.truths[0].driver.output)  # they have answered before

    def test_a_point_that_the_device_has_not_is_told_and_asked_for_again_on_the_next_connection(self):
        self.start(REJECTED)
        self.refuse()
        self.for_each(lambda code, _, truth: truth.has_exception(code, PointStatus.REJECTED))
        nothing_is_published(self.truths)
        for device in self.devices:
            device.answer = device.serve
            device.drop()
        self.all_is_well()


class FaultReplies(Answers):
    def test_a_reply_that_is_none_is_never_taken(self):
        self.start(NO_REPLIES, timeout=TIMEOUT)  # there is nothing, or not all of it
        for device, answer in zip(self.devices, NO_REPLIES.values()):
            device.answer = answer
        self.for_each(lambda _, __, truth: truth.is_offline())
        nothing_is_published(self.truths)
        self.for_each(lambda _, __, truth: self.assertNotIn(-1, truth.level.ever))
        self.all_is_well()


if __name__ == "__main__":
    testing.main()
