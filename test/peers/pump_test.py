# SPDX-License-Identifier: Apache-2.0
"""config/examples/pump: the firmware against pymodbus and against the client, the client against a pymodbus server.

    pump_test.py FIRMWARE CLIENT NODE MAP
"""
import asyncio
import pathlib
import struct
import subprocess
import sys
import tempfile
import threading

from peer import PATIENCE, Checks, pymodbus_client, running_node, side_by_side, skip

try:
    from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
    from pymodbus.server.async_io import ModbusTcpServer
except ImportError:
    skip("pymodbus is not installed")

NODE_FAILURE = 4


def refused(answer):
    return answer.isError() and answer.exception_code == NODE_FAILURE


def floats(registers):
    return list(struct.unpack(f">{len(registers) // 2}f", struct.pack(f">{len(registers)}H", *registers)))


def firmware_obeys_a_foreign_client(firmware, checks):
    with running_node([firmware]) as port:
        client = pymodbus_client(port)
        checks.equal("connected", client.connect(), True)
        checks.equal("what the firmware set before", floats(client.read_input_registers(1, 6, 1).registers), [41.5, 38.25, 17.0])
        checks.equal("run against a closed valve", refused(client.write_coil(1, True, 1)), True)
        checks.equal("a speed below 10 %", refused(client.write_register(0, 99, 1)), True)
        checks.equal("the speed stays", client.read_holding_registers(0, 1, 1).registers, [500])

        checks.equal("valve and run together", client.write_coils(0, [True, True], 1).isError(), False)
        checks.equal("it turns", client.read_discrete_inputs(0, 1, 1).bits[0], True)
        checks.equal("pressure, starts", client.read_input_registers(0, 9, 1).registers[0::8], [300, 1])
        checks.equal("valve closed while it runs", refused(client.write_coils(0, [False, True], 1)), True)
        checks.equal("nothing of it is done", client.read_coils(0, 2, 1).bits[:2], [True, True])

        # The first of the two is accepted, the second is not: the first is taken back.
        client.write_coils(0, [True, False], 1)
        client.write_coils(0, [False, False], 1)
        checks.equal("run with a valve closed in the same request", refused(client.write_coils(0, [False, True], 1)), True)
        checks.equal("open", client.write_coil(0, True, 1).isError(), False)
        checks.equal("start again", client.write_coil(1, True, 1).isError(), False)
        checks.equal("two starts", client.read_input_registers(7, 2, 1).registers, [0, 2])
        client.close()


def control(client, port):
    done = subprocess.run([client, "127.0.0.1", str(port)], capture_output=True, text=True, timeout=PATIENCE)
    return done.returncode, done.stdout.splitlines()


def firmware_and_client(firmware, client, checks):
    with running_node([firmware]) as port:
        status, said = control(client, port)
    checks.equal("status of the client", status, 0)
    for line in ("set the speed to 7000 %: refused: 7000 % is out of range; send 0 to 6553.5 %",
                 "set the speed to 5 %: exception 04 (server device failure)", "start: ok", "the motor turns",
                 "close the valve: exception 04 (server device failure)", "4.80 bar after 1 starts",
                 "stop in 5 s: accepted: the device does it", "it has stopped"):
        checks.equal(f"the client says '{line}'", line in said, True)


def client_and_a_node_of_another_map(node, map_file, client, checks):
    """A scale that was changed on one side only: the same bytes, another speed."""
    with tempfile.NamedTemporaryFile("w", suffix=".yaml") as other:
        text = pathlib.Path(map_file).read_text(encoding="utf-8")
        other.write(text.replace("scale: 0.1", "scale: 0.01"))
        other.flush()
        with running_node([node, other.name]) as port:
            done = subprocess.run([client, "127.0.0.1", str(port)], capture_output=True, text=True, timeout=PATIENCE)
            client = pymodbus_client(port)
            client.connect()
            checks.equal("nothing was written", client.read_coils(0, 2, 1).bits[:2], [False, False])
            client.close()
    checks.equal("status of the client", done.returncode, 3)
    checks.equal("it says what differs", "  ~ speed: scale 0.1 -> 0.01" in done.stderr.splitlines(), True)


def client_and_a_foreign_server(client, checks):
    table = {kind: ModbusSequentialDataBlock(0, [0] * 100) for kind in ("di", "co", "ir", "hr")}
    table["di"].setValues(0, [True])
    table["ir"].setValues(0, [412])
    table["ir"].setValues(7, [1, 2])
    context = ModbusServerContext(slaves=ModbusSlaveContext(zero_mode=True, **table), single=True)
    ready = threading.Event()
    place = {}

    async def serve():
        server = ModbusTcpServer(context, address=("127.0.0.1", 0), allow_reuse_address=True)
        place["loop"] = asyncio.get_running_loop()
        task = asyncio.ensure_future(server.serve_forever())
        await server.serving
        place["port"], place["task"] = server.server.sockets[0].getsockname()[1], task
        ready.set()
        try:
            await task
        except asyncio.CancelledError:
            pass

    thread = threading.Thread(target=lambda: asyncio.run(serve()), daemon=True)
    thread.start()
    checks.equal("the server of pymodbus is ready", ready.wait(PATIENCE), True)
    status, said = control(client, place["port"])
    checks.equal("status of the client", status, 0)
    checks.equal("the client reads", "4.12 bar after 65538 starts" in said, True)
    checks.equal("the client wrote the speed", table["hr"].getValues(0, 1), [800])
    checks.equal("and the coils", [bool(bit) for bit in table["co"].getValues(0, 2)], [False, False])
    place["loop"].call_soon_threadsafe(place["task"].cancel)
    thread.join(PATIENCE)


def main():
    firmware, client, node, map_file = sys.argv[1:]
    checks = Checks()
    side_by_side((firmware_obeys_a_foreign_client, firmware, checks), (firmware_and_client, firmware, client, checks),
                 (client_and_a_node_of_another_map, node, map_file, client, checks), (client_and_a_foreign_server, client, checks))
    checks.done("the pump: its firmware and its client, with each other and with pymodbus")


main()
