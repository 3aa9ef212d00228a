#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A pymodbus client reads and writes every table of a node that serves peers.yaml, with every function code.

    pymodbus_test.py MAP NODE_COMMAND…
"""
import pathlib
import socket
import sys

import peer

try:
    from pymodbus.constants import Endian
    from pymodbus.diag_message import ReturnQueryDataRequest
    from pymodbus.file_message import FileRecord, ReadFileRecordRequest
    from pymodbus.mei_message import ReadDeviceInformationRequest
    from pymodbus.payload import BinaryPayloadBuilder, BinaryPayloadDecoder
    from pymodbus.register_write_message import MaskWriteRegisterRequest
    from pymodbus.register_read_message import ReadWriteMultipleRegistersRequest
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")

IDENTITY = 0xFF00


def bits_are_written_and_read(client, checks):
    for coil in (0, 9, 20):
        for level in (True, False, True):
            checks.equal("FC 5", client.write_coil(coil, level, 1).isError(), False)
            checks.equal(f"FC 1 coil {coil}", client.read_coils(coil, 1, 1).bits[0], level)
    pattern = [bool(0x2CD >> i & 1) for i in range(10)]
    checks.equal("FC 15", client.write_coils(0, pattern, 1).isError(), False)
    checks.equal("FC 1", client.read_coils(0, 10, 1).bits[:10], pattern)
    checks.equal("FC 1 within", client.read_coils(3, 4, 1).bits[:4], pattern[3:7])


def inputs_follow_their_wires(client, checks):
    for level in (True, False):
        client.write_coils(0, [level, level], 1)
        checks.equal("FC 2", client.read_discrete_inputs(0, 4, 1).bits[:4], [level, not level, True, False])


def registers_are_read(client, checks):
    got = BinaryPayloadDecoder.fromRegisters(
        client.read_input_registers(0, 5, 1).registers, byteorder=Endian.Big, wordorder=Endian.Big)
    checks.equal("FC 4 INT", got.decode_16bit_int(), -2)
    checks.equal("FC 4 UDINT", got.decode_32bit_uint(), 305419896)
    checks.equal("FC 4 REAL", got.decode_32bit_float(), 1.5)


def registers_are_written_and_read(client, checks):
    for value in (0, 1, 0x8000, 0xFFFF):
        checks.equal("FC 6", client.write_register(0, value, 1).isError(), False)
        checks.equal("FC 3", client.read_holding_registers(0, 1, 1).registers, [value])
    client.write_register(65279, 0xBEEF, 1)
    checks.equal("FC 3, the last address below the identity area",
                 client.read_holding_registers(65279, 1, 1).registers, [0xBEEF])

    values = BinaryPayloadBuilder(byteorder=Endian.Big, wordorder=Endian.Big)
    values.add_16bit_int(-12345)
    values.add_32bit_uint(0xCAFEF00D)
    values.add_64bit_float(-1.0e-300)
    values.add_string("twenty characters ok")
    checks.equal("FC 16", client.write_registers(0, values.to_registers(), 1).isError(), False)
    got = BinaryPayloadDecoder.fromRegisters(
        client.read_holding_registers(0, 17, 1).registers, byteorder=Endian.Big, wordorder=Endian.Big)
    checks.equal("FC 3 INT", got.decode_16bit_int(), -12345)
    checks.equal("FC 3 UDINT", got.decode_32bit_uint(), 0xCAFEF00D)
    checks.equal("FC 3 LREAL", got.decode_64bit_float(), -1.0e-300)
    checks.equal("FC 3 STRING", got.decode_string(20), b"twenty characters ok")

    client.write_register(0, 0x0012, 1)
    client.execute(MaskWriteRegisterRequest(0, 0x00F2, 0x0025, unit=1))
    checks.equal("FC 22", client.read_holding_registers(0, 1, 1).registers, [0x0017])
    both = client.execute(ReadWriteMultipleRegistersRequest(
        read_address=0, read_count=3, write_address=1, write_registers=[7, 8], unit=1))
    checks.equal("FC 23", both.registers, [0x0017, 7, 8])


def what_is_not_mapped_is_refused(client, checks):
    refused = [
        ("FC 1", client.read_coils(0, 11, 1)),
        ("FC 2", client.read_discrete_inputs(4, 1, 1)),
        ("FC 3", client.read_holding_registers(17, 1, 1)),
        ("FC 4", client.read_input_registers(4, 2, 1)),
        ("FC 5", client.write_coil(10, True, 1)),
        ("FC 6", client.write_register(17, 1, 1)),
        ("FC 15", client.write_coils(9, [True, True], 1)),
        ("FC 16", client.write_registers(16, [1, 2], 1)),
        ("FC 3 past 65535", client.read_holding_registers(65535, 2, 1)),
    ]
    for name, reply in refused:
        checks.equal(f"{name} outside the map", getattr(reply, "exception_code", None), 2)


def the_node_says_what_it_is(client, checks, text):
    head = client.read_input_registers(IDENTITY, 13, 1).registers
    checks.equal("magic", head[0:3], [0x4F43, 0x504C, 1])
    size = head[7] << 16 | head[8]
    checks.equal("map size", size, len(text))
    registers = (size + 1) // 2
    got = b""
    for first in range(0, registers, 100):
        count = min(100, registers - first)
        reply = client.execute(ReadFileRecordRequest(
            [FileRecord(reference_type=6, file_number=1, record_number=first, record_length=count)], unit=1))
        got += reply.records[0].record_data
    checks.equal("FC 20", got[:size], text)


def the_node_identifies_itself(client, checks):
    def objects(access, first=0):
        reply = client.execute(ReadDeviceInformationRequest(access, first, unit=1))
        checks.equal(f"FC 43/14 access {access} from {first}", reply.isError(), False)
        return {number: value.decode() for number, value in reply.information.items()}

    head = client.read_input_registers(IDENTITY, 13, 1).registers
    fingerprint = "".join(f"{word:04x}" for word in head[3:7])
    basic = objects(1)
    checks.equal("FC 43/14 basic", list(basic), [0, 1, 2])
    checks.equal("FC 43/14 vendor", basic[0], "OpenCoupler")
    checks.equal("FC 43/14 product", basic[1], "peers")
    regular = objects(2)
    further = client.read_input_registers(IDENTITY + 45, 37, 1).registers
    serial = "".join(f"{word:04x}" for word in further[1:5])
    checks.equal("registers of further fields", further[0], 39)
    hostname = b"".join(word.to_bytes(2, "big") for word in further[5:]).rstrip(b"\0").decode()
    checks.equal("hostname", hostname, socket.gethostname())
    checks.equal("FC 43/14 regular", regular, {**basic, 4: "peers", 5: fingerprint, 6: hostname})
    private = {} if int(serial, 16) == 0 else {0x80: serial}  # a machine may have nothing to tell it by
    checks.equal("FC 43/14 extended", objects(3), {**regular, **private})
    for number, text in private.items():
        checks.equal(f"FC 43/14 object {number}", objects(4, number), {number: text})
    checks.equal("FC 43/14 regular, from 2", objects(2, 2), {n: text for n, text in regular.items() if n >= 2})
    for number, text in regular.items():
        checks.equal(f"FC 43/14 object {number}", objects(4, number), {number: text})
    absent = client.execute(ReadDeviceInformationRequest(4, 3, unit=1))
    checks.equal("FC 43/14 absent object", getattr(absent, "exception_code", None), 2)
    for word in (0, 0xA537, 0xFFFF):
        checks.equal("FC 8/00", list(client.execute(ReturnQueryDataRequest(word, unit=1)).message), [word])


def every_unit_id_of_its_own_is_answered(port, checks):
    for unit, answered in ((1, True), (0xFF, True), (2, False)):
        patience = {} if answered else {"timeout": 1}  # silence is not waited for in vain
        client = peer.pymodbus_client(port, retries=0, retry_on_empty=False, **patience)
        client.connect()
        reply = client.read_holding_registers(0, 1, unit)
        checks.equal(f"unit {unit}", not reply.isError(), answered)
        client.close()


def main():
    map_file, command = pathlib.Path(sys.argv[1]), sys.argv[2:]
    checks = peer.Checks()
    with peer.running_node(command) as port:
        client = peer.pymodbus_client(port)
        if not client.connect():
            print("FAILED: pymodbus cannot connect")
            sys.exit(1)
        bits_are_written_and_read(client, checks)
        inputs_follow_their_wires(client, checks)
        registers_are_read(client, checks)
        registers_are_written_and_read(client, checks)
        what_is_not_mapped_is_refused(client, checks)
        the_node_says_what_it_is(client, checks, map_file.read_bytes())
        the_node_identifies_itself(client, checks)
        client.close()
        every_unit_id_of_its_own_is_answered(port, checks)
    checks.done(f"a pymodbus client reads and writes every table of {pathlib.Path(command[0]).name}, FC 1-6 8 15 16 20 22 23 43")


main()
