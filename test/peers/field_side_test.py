#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A simulated node keeps the rules of a real one, and whoever plays the machine around it sets its inputs: mbpoll, pymodbus
and `coupler panel --field --write`.

    field_side_test.py NODE COUPLER
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

import peer

try:
    import foreign_server
    from panel_client import Page, Panel, is_left_out
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
from recording import Node, Program

if not shutil.which("mbpoll"):
    peer.skip("mbpoll is missing; run scripts/install-packages test")

NODE, COUPLER = sys.argv[1:]
FIELD = 247

MAP = """name: cell
timeout: 20s
watchdog: {timeout: 500ms}
mapping:
  coils:
    lamp: {address: 0, line: {chip: gpiochip0, offset: 1}}
  discrete_inputs:
    door: {address: 0, line: {chip: gpiochip0, offset: 2}}
    lamp_burns: {address: 1, line: {chip: gpiochip0, offset: 3}}
    plain: 2
  input_registers:
    level: {address: 0, type: INT, scale: 0.1, iio: {device: adc, channel: voltage0}}
    opened: {address: 1, type: UINT, counter: {of: door}}
    flow: {address: 2, type: REAL}
  holding_registers:
    fan: {address: 0, type: UINT, safe: 25, pwm: {chip: pwmchip0, channel: 0, period: 1ms}}
sim:
  - {from: lamp, to: lamp_burns}
"""


def mbpoll(port, unit, table, address, *values):
    """What it says; without values it reads."""
    done = subprocess.run(["mbpoll", "-m", "tcp", "-p", str(port), "-a", str(unit), "-0", "-1", "-o", "10", "-t", table, "-r",
                           str(address), "127.0.0.1", *map(str, values)], capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


def mbpoll_plays_the_machine(port, client, checks):
    checks.equal("mbpoll opens the door", "Written" in mbpoll(port, FIELD, "0", 0, 1), True)
    checks.equal("and sets a level", "Written" in mbpoll(port, FIELD, "4", 0, 123), True)
    checks.equal("the node's inputs", client.read_discrete_inputs(0, 3, 1).bits[:3], [True, False, False])
    checks.equal("its registers: level, edges of the door", client.read_input_registers(0, 2, 1).registers, [123, 1])
    checks.equal("an input that a lamp is wired to", "Illegal data address" in mbpoll(port, FIELD, "0", 1, 1), True)
    checks.equal("a counter", "Illegal data address" in mbpoll(port, FIELD, "4", 1, 5), True)


def a_pwm_is_a_pwm(client, checks):
    checks.equal("150 % is exception 03", client.write_register(0, 150, 1).exception_code, 3)
    checks.equal("100 % is not", client.write_register(0, 100, 1).isError(), False)
    checks.equal("the machine sees it", client.read_input_registers(0, 1, FIELD).registers in ([100], [25]), True)
    peer.await_true("when nobody speaks any more, the machine sees its safe value",
                    lambda: client.read_input_registers(0, 1, FIELD).registers == [25], checks)
    checks.equal("and the node's clients do", client.read_holding_registers(0, 1, 1).registers, [25])


def a_page_plays_the_machine(port, client, checks):
    with Panel(COUPLER, f"127.0.0.1:{port}", None, "--field", "--write") as panel, Page(panel) as page:
        page.await_online(True, checks)
        told = {point["name"]: "write" in point for point in panel.get("/points.json", page.token)["points"]}
        checks.equal("what can be set", told, {"lamp": False, "door": True, "lamp_burns": False, "plain": True, "level": True,
                                               "opened": False, "flow": True, "fan": False})
        for point, value in (("door", "false"), ("plain", "true"), ("level", "-4.5"), ("flow", "2.5")):
            checks.equal(f"{point} = {value}", panel.write(page.token, point, value)["outcome"], "ok")
        page.await_value("level", value=-4.5, checks=checks)
        checks.equal("the node's inputs", client.read_discrete_inputs(0, 3, 1).bits[:3], [False, False, True])
        checks.equal("its registers", client.read_input_registers(0, 4, 1).registers, [0x10000 - 45, 1, 0, 0x4020])
        # Again and again: the node's watchdog may switch it off before the page has seen it.
        peer.await_true("the page sees the lamp", lambda: page.value("lamp") is True, checks,
                        poll=lambda: client.write_coil(0, True, 1))



def nothing_else_has_a_field_side(folder, checks):
    """A panel would write to real outputs there."""
    file = folder / "cell.yaml"
    strange = foreign_server.Device({"coils": {0: False}, "holding_registers": {0: 0}, "discrete_inputs": {0: False}})
    with foreign_server.serving(strange) as port, Program(COUPLER, "panel", file, "--at", f"127.0.0.1:{port}", "--field",
                                                          "--write") as panel:
        checks.equal("a foreign device", (panel.wait(), "has no field side" in panel.text()), (3, True))
    file.write_text(MAP.replace("timeout: 20s", "timeout: 20s\nunit: 247"), encoding="utf-8")
    with Node(NODE, file) as node, Program(COUPLER, "panel", file, "--at", f"127.0.0.1:{node.port}", "--field",
                                           "--write") as panel:
        checks.equal("a node whose own unit is 247", (panel.wait(), "has no field side" in panel.text()), (3, True))
    with peer.silent_port() as port, Program(COUPLER, "panel", file, "--at", f"127.0.0.1:{port}", "--field") as panel:
        checks.equal("nobody", (panel.wait(), "check that a node serves there" in panel.text()), (3, True))


def what_was_set_outlasts_a_reload(file, node, client, checks):
    before = (client.read_discrete_inputs(0, 3, 1).bits[:3], client.read_input_registers(0, 4, 1).registers)
    file.write_text(MAP + "    # read again\n", encoding="utf-8")
    said = subprocess.run([NODE, "--reload", str(node.process.pid)], capture_output=True, text=True, check=False)
    checks.equal("the map is read again", said.returncode, 0)
    client.close()
    client.connect()
    after = (client.read_discrete_inputs(0, 3, 1).bits[:3], client.read_input_registers(0, 4, 1).registers)
    checks.equal("what was set is as before", after, before)
    file.write_text(MAP.replace("level: {", "level: {units: 0.1V, ").replace(", scale: 0.1", "").replace("REAL", "NOPE"),
                    encoding="utf-8")
    said = subprocess.run([NODE, "--reload", str(node.process.pid)], capture_output=True, text=True, check=False)
    checks.equal("a wrong map: the first error, and no warning, is the reason",
                 (said.returncode, "error: " in said.stderr and "'NOPE'" in said.stderr, "warning" in said.stderr),
                 (1, True, False))
    file.write_text(MAP, encoding="utf-8")


def main():
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "cell.yaml"
        file.write_text(MAP, encoding="utf-8")
        with Node(NODE, file) as node:
            client = peer.pymodbus_client(node.port)
            client.connect()
            mbpoll_plays_the_machine(node.port, client, checks)
            a_pwm_is_a_pwm(client, checks)
            if not is_left_out(COUPLER):
                a_page_plays_the_machine(node.port, client, checks)
            what_was_set_outlasts_a_reload(file, node, client, checks)
            client.close()
        if not is_left_out(COUPLER):
            nothing_else_has_a_field_side(file.parent, checks)
        file.write_text(MAP.replace("safe: 25", "safe: 125"), encoding="utf-8")
        with Program(NODE, file, "--sim", "--port", "0") as node:
            checks.equal("a PWM's safe value of 125 %", (node.wait(), "a PWM takes 0 to 100 %" in node.text()), (1, True))
    checks.done("a simulated node keeps the rules of a real one, and its inputs can be set from outside")


main()
