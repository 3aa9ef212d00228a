#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A node with TLS against Python's ssl and OpenSSL's s_client: whom it lets in, what each may do, and what becomes of
them when it reads its map again, and when one of its processes dies. Certificates are made by OpenSSL's own program.

    tls_test.py NODE GENERATED_NODE MAP
"""
import os
import pathlib
import re
import shutil
import signal
import socket
import ssl
import subprocess
import sys
import tempfile

import peer
from tls_node import (ECHO, LAMP_ON, READ_IDENTITY, READ_LAMP, READ_MAP, READ_SPEED, READ_STATISTICS, SPEED_7, Client, Node,
                      make_certificates)

NODE, GENERATED, MAP = sys.argv[1:4]
if shutil.which("openssl") is None:
    peer.skip("the program openssl is missing; apt install openssl")


def who_is_let_in(node, checks):
    for name in ("operator", "operator_2", "operator_critical", "viewer", "no_role", "unknown_role"):
        for version in (ssl.TLSVersion.TLSv1_2, ssl.TLSVersion.TLSv1_3):
            client = Client(node, name, version)
            checks.equal(f"{name} by {version.name}", client.problem, "")
            client.close()
    for name, alert in (("printable_role", "BAD_CERTIFICATE"), ("sequence_role", "BAD_CERTIFICATE"),
                        ("long_role", "BAD_CERTIFICATE"), ("trailing_role", "BAD_CERTIFICATE"),
                        ("empty_role", "BAD_CERTIFICATE"), ("control_role", "BAD_CERTIFICATE"),
                        ("expired", "CERTIFICATE_EXPIRED"), ("not_yet_valid", "BAD_CERTIFICATE"),
                        ("revoked", "CERTIFICATE_REVOKED"), ("stranger", "UNKNOWN_CA"),
                        ("node_as_client", "UNSUPPORTED_CERTIFICATE"), (None, "CERTIFICATE_REQUIRED")):
        client = Client(node, name)
        checks.equal(f"{name} is refused by {alert}: {client.problem}", alert in client.problem.upper().replace(" ", "_"),
                     True)
        client.close()
    # Who is let in is named, though others with the same role come within the same second.
    for name in ("operator", "operator_2", "operator_critical", "viewer", "no_role", "unknown_role"):
        node.await_line(f"'{name}' (127.0.0.1) connected by")
    # The reasons that an alert does not have are in the log.
    for reason in ("not an ASN.1 UTF8String", "shows no certificate", "has expired on 2020-02-01", "is revoked",
                   "another authority", "another purpose"):
        node.await_line(reason)


def a_weak_key_and_old_versions(node, checks):
    """OpenSSL as Debian builds it would not even send them; s_client is told to."""
    def s_client(*options):
        return subprocess.run(["openssl", "s_client", "-connect", f"127.0.0.1:{node.tls_port}", *options],
                              cwd=node.folder, input="", capture_output=True, text=True, timeout=peer.PATIENCE)

    weak = s_client("-cert", "weak_key.pem", "-key", "weak_key.key", "-cipher", "DEFAULT@SECLEVEL=0", "-tls1_2")
    checks.equal("a weak key is refused", "alert" in weak.stderr, True)
    for old in ("-tls1", "-tls1_1"):
        said = s_client(old, "-cipher", "DEFAULT@SECLEVEL=0")
        checks.equal(f"{old} is refused", "alert protocol version" in said.stderr, True)
    renegotiating = subprocess.run(
        ["openssl", "s_client", "-connect", f"127.0.0.1:{node.tls_port}", "-tls1_2", "-cert", "operator.pem", "-key",
         "operator.key"], cwd=node.folder, input="R\n", capture_output=True, text=True, timeout=peer.PATIENCE)
    checks.equal("renegotiation is refused", "no renegotiation" in renegotiating.stderr, True)


def what_each_may_do(node, checks):
    wanted = {
        "operator": {"lamp": 1, "speed": 3, "identity": 4, "statistics": 4, "map": 20, "lamp on": 5,
                     "speed 7": "exception 01", "echo": 8},
        "viewer": {"lamp": 1, "speed": "exception 01", "identity": 4, "statistics": "exception 01",
                   "map": "exception 01", "lamp on": "exception 01", "speed 7": "exception 01", "echo": 8},
    }
    wanted["no_role"] = wanted["unknown_role"] = {**wanted["viewer"], "lamp": "exception 01"}
    requests = {"lamp": READ_LAMP, "speed": READ_SPEED, "identity": READ_IDENTITY, "statistics": READ_STATISTICS,
                "map": READ_MAP, "lamp on": LAMP_ON, "speed 7": SPEED_7, "echo": ECHO}
    for name, answers in wanted.items():
        client = Client(node, name)
        for what, answer in answers.items():
            checks.equal(f"{name}: {what}", client.code(requests[what]), answer)
        client.close()
    with socket.create_connection(("127.0.0.1", node.port), peer.PATIENCE) as plain:
        plain.sendall(READ_LAMP)
        checks.equal("without TLS", plain.recv(300)[7:], b"\x81\x01")


def records_and_frames(node, checks):
    client = Client(node, "operator")
    client.socket.sendall(READ_LAMP + ECHO + READ_SPEED)
    checks.equal("three frames in a record", [client.receive()[0] for _ in range(3)], [1, 8, 3])
    for byte in READ_LAMP:
        client.socket.sendall(bytes([byte]))
    checks.equal("a frame in twelve records", client.receive()[0], 1)
    client.close()


def a_reload(node, ca, checks):
    text = (node.folder / "cell.yaml").read_text()
    operator, viewer, doomed = (Client(node, name) for name in ("operator", "viewer", "revoked_later"))
    node.reload(text)
    checks.equal("the same map: all stay", [c.code(READ_LAMP) for c in (operator, viewer, doomed)], [1, 1, 1])
    node.reload(text.replace("viewer: {read: [door, lamp]}", "viewer: {read: all}"))
    checks.equal("other rights: all stay, and have them", [c.code(READ_SPEED) for c in (operator, viewer)], [3, 3])
    # Only the newest list of an authority counts, wherever it is in the file, though an older one is still in date.
    def dates(last, following):
        return ("-crl_lastupdate", f"{last}0101000000Z", "-crl_nextupdate", f"{following}0101000000Z")

    older = ca.list(options=dates(2020, 2090))
    ca.revoke("revoked_later", options=dates(2021, 2022))
    with open(node.folder / "list.pem", "a", encoding="ascii") as lists:
        lists.write(older)
    node.reload(text)
    checks.equal("who is revoked is closed", [c.code(READ_LAMP) for c in (operator, doomed)], [1, "closed"])
    without_viewer = "".join(line for line in text.splitlines(True) if "viewer" not in line)
    node.reload(without_viewer)
    checks.equal("whose role is gone is closed", [c.code(READ_LAMP) for c in (operator, viewer)], [1, "closed"])
    node.reload(without_viewer.replace("node.key", "operator.key"), "the new map is refused")
    node.await_line("the key does not belong to the certificate")
    checks.equal("a key that does not belong to its certificate changes nothing", operator.code(READ_LAMP), 1)
    node.reload(without_viewer.replace("list.pem", "strange_list.pem"), "the new map is refused")
    node.await_line("comes from none of the authorities in 'ca'")
    checks.equal("nor does a list of another authority", operator.code(READ_LAMP), 1)
    whole = (node.folder / "list.pem").read_text()
    ca.list(options=("-crlexts", "delta"))
    node.reload(without_viewer, "the new map is refused")
    node.await_line("tells only what has changed since another one")
    checks.equal("nor does one of changes only", operator.code(READ_LAMP), 1)
    (node.folder / "list.pem").write_text(whole)
    whole = (node.folder / "ca.pem").read_text()
    (node.folder / "ca.pem").write_text(whole + whole[:200])
    node.reload(text, "the new map is refused")
    node.await_line("the authority's file: block 2 of 2, or what stands before it, is cut")
    checks.equal("nor does a file that is cut", operator.code(READ_LAMP), 1)
    (node.folder / "ca.pem").write_text(whole)
    (node.folder / "node.key").chmod(0o644)
    node.reload(text, "the new map is refused")
    node.await_line("everybody may read it")
    (node.folder / "node.key").chmod(0o600)
    checks.equal("nor does one that everybody may read", operator.code(READ_LAMP), 1)
    no_tls = "".join(line for line in text.splitlines(True) if not re.search(r"^  (certificate|key|ca|revoked):", line))
    node.reload(no_tls)
    checks.equal("a map without TLS ends it", operator.code(READ_LAMP), "closed")
    node.reload(text)
    found = re.findall(r"TLS at 127\.0\.0\.1:(\d+)", node.text())
    node.tls_port = int(found[-1])
    again = Client(node, "operator")
    checks.equal("and one that has it begins it again", again.code(READ_LAMP), 1)
    again.close()
    for client in (operator, viewer, doomed):
        client.close()


def a_process_that_hangs(folder, checks):
    node = Node(folder, NODE, "cell.yaml")
    try:
        client = Client(node, "operator")
        os.kill(node.child("coupler-tls"), signal.SIGSTOP)
        node.await_line("the TLS process was silent for")
        checks.equal("its clients lose their connections", client.code(READ_LAMP), "closed")
        again = Client(node, "operator")
        checks.equal("another one lets in", again.code(READ_LAMP), 1)
        client.close()
        again.close()
    finally:
        node.end()
    checks.equal("the node ends well all the same", node.process.returncode, 0)


def a_node_and_its_clients(folder, ca, checks):
    node = Node(folder, NODE, "cell.yaml")
    try:
        who_is_let_in(node, checks)
        a_weak_key_and_old_versions(node, checks)
        what_each_may_do(node, checks)
        records_and_frames(node, checks)
        processes_that_die(node, checks)
        a_reload(node, ca, checks)
    finally:
        node.end()
    checks.equal("the node ends well", node.process.returncode, 0)
    if checks.failed:
        print(node.text())


def processes_that_die(node, checks):
    client = Client(node, "operator")
    tls = node.child("coupler-tls")
    os.kill(tls, signal.SIGKILL)
    node.await_line("the TLS process was killed by signal 9")
    checks.equal("its clients lose their connections", client.code(READ_LAMP), "closed")
    with socket.create_connection(("127.0.0.1", node.port), peer.PATIENCE) as plain:
        plain.sendall(ECHO)
        checks.equal("those without TLS are answered", plain.recv(300)[7], 8)
    again = Client(node, "operator")
    checks.equal("another one lets in", again.code(READ_LAMP), 1)
    os.kill(node.child("coupler-node-io"), signal.SIGKILL)
    node.await_line("the worker process was killed by signal 9")
    checks.equal("as with plain clients, the process that answers takes its connections with it",
                 again.code(READ_LAMP), "closed")
    last = Client(node, "operator")
    checks.equal("and another one goes on", last.code(READ_LAMP), 1)
    for each in (client, again, last):
        each.close()


def a_generated_node(folder, checks):
    """Its map is built in, and its certificates are files all the same."""
    node = Node(folder, GENERATED)
    try:
        who_is_let_in(node, checks)
        what_each_may_do(node, checks)
        client = Client(node, "operator")
        node.process.send_signal(signal.SIGHUP)
        node.await_line("read the certificates again")
        checks.equal("generated: a client stays when the certificates are read again", client.code(READ_LAMP), 1)
        client.close()
    finally:
        node.end()
    checks.equal("generated: the node ends well", node.process.returncode, 0)


def a_start_that_fails(folder, checks):
    """A service is started again after exit status 3, and not after 1: what may work the next time is not a wrong map."""
    beside = folder / "beside"
    beside.mkdir()
    node = shutil.copy(NODE, beside)
    tls = beside / "coupler-node-tls"

    def start(program):
        ended = subprocess.run([program, "cell.yaml", "--sim", "--listen", "127.0.0.1", "--port", "0", "--tls-port", "0"],
                               cwd=folder, stderr=subprocess.PIPE, text=True, timeout=peer.PATIENCE)
        return ended.returncode, ended.stderr

    # How it ended is seen only if the kernel is done with it soon.
    for script, problem in (("kill -KILL $$", "error: the TLS process "),
                            ("exec sleep 1000", "error: coupler-node-tls did not answer within 5 s")):
        tls.write_text(f"#!/bin/sh\n{script}\n")
        tls.chmod(0o755)
        status, said = start(node)
        checks.equal(f"a TLS process that does '{script}' ends the start with 3", status, 3)
        checks.equal(f"and is told: {said}", problem in said, True)
    text = (folder / "cell.yaml").read_text()
    (folder / "not_a.pem").write_text("no certificate\n")
    for file in ("no_such.pem", "not_a.pem"):
        (folder / "cell.yaml").write_text(text.replace("certificate: node.pem", f"certificate: {file}"))
        status, said = start(NODE)
        checks.equal(f"the certificate {file} ends it with 1", status, 1)
        checks.equal(f"and is told: {said}", "error: 'security': " in said, True)
    (folder / "cell.yaml").write_text(text)


def main():
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        ca = make_certificates(folder)
        shutil.copy(MAP, folder / "cell.yaml")
        # Each part has a copy, since some of them change the files.
        copies = [shutil.copytree(folder, f"{name}/copy_{i}", ignore=shutil.ignore_patterns("copy_*")) for i in range(3)]
        starts, hangs, generated = map(pathlib.Path, copies)
        peer.side_by_side((a_node_and_its_clients, folder, ca, checks), (a_start_that_fails, starts, checks),
                          (a_process_that_hangs, hangs, checks), (a_generated_node, generated, checks))
    checks.done("a node with TLS against Python's ssl and OpenSSL: who is let in, what each may do, reloads, deaths")


main()
