#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The tools and TLS: at a node, at OpenSSL's s_server (which servers they believe), and what `coupler check` says of
certificates.

    tls_tools_test.py NODE COUPLER MAP
"""
import contextlib
import datetime
import json
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import zlib

import peer
from authority import Authority
from tls_node import Node, make_certificates

NODE, COUPLER, MAP = sys.argv[1:4]
HASTY = "hasty_{}.yaml"  # the same map with a timeout of so many seconds, where no reply is to be expected
if shutil.which("openssl") is None:
    peer.skip("the program openssl is missing; apt install openssl")


def the_tools(node, checks):
    def coupler(*arguments, name="operator"):
        options = ["--certificate", f"{name}.pem", "--key", f"{name}.key"]
        return subprocess.run([COUPLER, *arguments, *options], cwd=node.folder, capture_output=True, text=True,
                              timeout=peer.PATIENCE)

    place = f"tls://127.0.0.1:{node.tls_port}"
    told = coupler("dump", place, "--ca", "ca.pem")
    checks.equal(f"dump with a role that reads all: {told.stderr}", told.returncode, 0)
    told = coupler("status", "--timeout", "20", place, "--ca", "ca.pem").stdout
    checks.equal(f"status names both certificates: {told}",
                 [bool(re.search(each, told)) for each in (r"this side +'operator', until \d{4}-.*, role operator",
                                                           r"the node +'node', until \d{4}-")], [True, True])
    shown = json.loads(coupler("status", "--timeout", "20", place, "--ca", "ca.pem", "--json", name="no_role").stdout)["certificates"]
    checks.equal("and as JSON", [shown["own"]["name"], shown["own"]["role"], shown["device"]["name"]], ["no_role", None, "node"])
    told = coupler("fetch", place, "--ca", "ca.pem")
    checks.equal(f"fetch with such a role: {told.stderr}", (told.returncode, zlib.crc32(told.stdout.encode())),
                 (0, int(json.loads(coupler("status", "--timeout", "20", place, "--ca", "ca.pem", "--json").stdout)["map"]["crc32"], 16)))
    for command in ("fetch", "probe"):
        told = coupler(command, place, "--ca", "ca.pem", name="no_role")
        checks.equal(f"{command} without: {told.stderr}",
                     (told.returncode, "gives its map only to clients that may read every point" in told.stderr), (3, True))
    told = coupler("dump", "cell.yaml", "--at", place, "--ca", "ca.pem", name="viewer")
    checks.equal("dump with another shows what it may", (told.returncode, "this client has no right to read it" in told.stdout),
                 (3, True))
    told = coupler("dump", "cell.yaml", "--at", place, "--ca", "ca.pem", name="expired")
    checks.equal(f"the alert is named: {told.stderr}", "certificate_expired" in told.stderr, True)
    told = coupler("dump", "cell.yaml", "--at", place, "--ca", "ca.pem", "--tls-name", "press")
    checks.equal("and so is a wrong name", "another name or address (it has " in told.stderr, True)
    checks.equal("with one remedy", told.stderr.count("check that"), 0)
    node.await_line("127.0.0.1 did not connect: the other side refuses with the TLS alert bad_certificate: it connects as 'press'")
    pins = [subprocess.run([COUPLER, "pin", where], cwd=node.folder, capture_output=True, text=True).stdout
            for where in (place, "node.pem", "ca.pem")]
    checks.equal("a pin is the same from the node and from the file", (pins[0], pins[0] != pins[2]), (pins[1], True))
    told = coupler("dump", "cell.yaml", "--at", place, "--pin", pins[0].strip())
    checks.equal("it stands for the authority", told.returncode, 0)
    told = coupler("dump", "cell.yaml", "--at", place, "--pin", pins[2].strip())
    checks.equal("another one does not", "has the pin" in told.stderr, True)
    told = coupler("dump", HASTY.format(1), "--at", f"tls://127.0.0.1:{node.port}", "--ca", "ca.pem")
    checks.equal("TLS at the port without", told.returncode, 3)
    told = subprocess.run([COUPLER, "dump", "cell.yaml", "--at", f"tcp://127.0.0.1:{node.tls_port}"], cwd=node.folder,
                          capture_output=True, text=True, timeout=peer.PATIENCE)
    checks.equal(f"and plain Modbus at the port with it: {told.stderr}", "speaks TLS at this port" in told.stderr, True)
    told = subprocess.run([COUPLER, "probe", "--timeout", "20", f"127.0.0.1:{node.tls_port}"], capture_output=True, text=True,
                          timeout=peer.PATIENCE)
    checks.equal(f"which probe finds out, too: {told.stderr}", (told.returncode, "speaks TLS at this port" in told.stderr),
                 (3, True))
    told = subprocess.run([COUPLER, "probe", f"127.0.0.1:{node.port}", "--ca", "ca.pem"], cwd=node.folder,
                          capture_output=True, text=True, timeout=peer.PATIENCE)
    checks.equal(f"certificates without tls://: {told.stderr}", "are for a place with TLS" in told.stderr, True)


def what_check_says(folder, checks):
    """Of the files that the map names, where they are and where not."""
    def check(*options):
        told = subprocess.run([COUPLER, "check", *options, "cell.yaml"], cwd=folder, capture_output=True, text=True)
        return told.returncode, told.stdout + told.stderr

    whole = (folder / "cell.yaml").read_text()
    status, text = check()
    checks.equal(f"good files: {text}", (status, "fits its key; good until 20" in text), (0, True))
    (folder / "node.key").rename(folder / "away.key")
    status, text = check()
    checks.equal(f"the key is elsewhere: {text}", (status, "are not checked here: node.key: No such file" in text), (0, True))
    shutil.copy(folder / "operator.key", folder / "node.key")
    status, text = check()
    checks.equal(f"another key: {text}", (status, "'security': the key does not belong to the certificate" in text), (1, True))
    checks.equal("for programs, too", json.loads(check("--json")[1])["ok"], False)
    (folder / "away.key").rename(folder / "node.key")
    (folder / "node.key").chmod(0o644)
    status, text = check()
    checks.equal(f"everybody's key: {text}", (status, "everybody may read it; 'chmod 600 " in text), (1, True))
    (folder / "node.key").chmod(0o600)
    for what, name, wanted, says in (
            ("one that is not good yet", "future_node", 0, "fits its key; begins on 2090-01-01"),
            ("one that never ends", "endless_node", 0, "fits its key; good until 2262-"),
            ("one with P-224", "small_node", 1, "its key is too weak; have it issued again with P-256")):
        (folder / "cell.yaml").write_text(whole.replace("node.pem", f"{name}.pem").replace("node.key", f"{name}.key"))
        status, text = check()
        checks.equal(f"{what}: {text}", (status, says in text), (wanted, True))
    (folder / "cell.yaml").write_text(whole)


def what_certificates_makes(folder, checks):
    """For peers without ECDSA all of it is RSA. The authority of a folder stays the same."""
    def certificates(*options):
        told = subprocess.run([COUPLER, "certificates", "plant", *options], cwd=folder, capture_output=True, text=True)
        return told.returncode, told.stdout + told.stderr

    def shown(name, *options):
        return subprocess.run(["openssl", "x509", "-in", f"plant/{name}.pem", "-noout", *options], cwd=folder,
                              capture_output=True, text=True).stdout

    status, text = certificates("--rsa", "--node", "press:[fd00::7],127.0.0.1", "--client", "cell:operator")
    checks.equal(f"certificates with RSA: {text}", status, 0)
    checks.equal("the authority's key, and the signatures, are RSA",
                 ["Signature Algorithm: sha256WithRSA" in shown(name, "-text")
                  for name in ("authority/authority", "press/press-rsa", "cell/cell-rsa")], [True] * 3)
    names = shown("press/press-rsa", "-ext", "subjectAltName")
    checks.equal(f"an address in brackets is one: {names}", "IP Address:FD00:0:0:0:0:0:0:7" in names, True)
    (folder / "plant" / "authority").rename(folder / "drawer")
    status, text = certificates("--rsa", "--node", "press:fd00::7,127.0.0.1")
    checks.equal(f"another authority: {text}", (status, "bring back plant/authority" in text), (1, True))
    checks.equal("none is made", (folder / "plant" / "authority").exists(), False)
    certificates("--node", "other")
    status, text = certificates("--rsa", "--node", "press:fd00::7,127.0.0.1")
    checks.equal(f"nor used: {text}", (status, "is of another authority" in text), (1, True))
    shutil.rmtree(folder / "plant")


def what_a_killed_call_leaves(folder, checks):
    """Nothing that stands in the way of the next one, whole files only. It dies when a file becomes longer than this."""
    call = [COUPLER, "certificates", "cut_short", "--node", "press"]
    for size in (0, 400, 1000):  # in the authority's key, its certificate, the node's
        def with_a_limit(size=size):
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

        died = subprocess.run(call, cwd=folder, capture_output=True, preexec_fn=with_a_limit).returncode
        checks.equal(f"killed at {size} bytes", died, -signal.SIGXFSZ)
    left = sorted(file.name for file in (folder / "cut_short").rglob("[!.]*.pem"))
    checks.equal("certificates that are whole", left, ["authority.pem", "authority.pem"])
    told = subprocess.run(call, cwd=folder, capture_output=True, text=True)
    checks.equal(f"then it makes all: {told.stderr}", told.returncode, 0)
    checks.equal("nothing else is left", [file.name for file in (folder / "cut_short").rglob(".*")], [])
    checks.equal("whole", subprocess.run(["openssl", "verify", "-CAfile", "press/authority.pem", "press/press.pem"],
                                         cwd=folder / "cut_short", capture_output=True).returncode, 0)


def what_a_renewal_changes(folder, checks):
    """The contents of the files whose names maps and services have. The old files are kept beside them."""
    plant = folder / "renewed"
    (plant / "authority").mkdir(parents=True)
    authority = Authority(plant / "authority", "authority")
    ends = datetime.datetime.now(datetime.timezone.utc) + datetime.timedelta(days=30)
    dates = "-startdate", "20200101000000Z", "-enddate", f"{ends:%Y%m%d%H%M%SZ}"
    authority.node("press", names="IP:127.0.0.1", dates=dates)
    authority.client("cell", "ASN1:UTF8String:operator", dates=dates)
    old = {}
    for name in ("press", "cell"):
        (plant / name).mkdir()
        for ending in (".pem", ".key"):
            (plant / "authority" / (name + ending)).rename(plant / name / (name + ending))
            old[name + ending] = (plant / name / (name + ending)).read_bytes()

    def certificates(hosts="127.0.0.1", **how):
        return subprocess.run([COUPLER, "certificates", "renewed", "--node", f"press:{hosts}", "--client", "cell:operator"],
                              cwd=folder, capture_output=True, text=True, **how)

    def files(name):
        return sorted(file.name for file in (plant / name).iterdir())

    def fits(certificate, key):
        return subprocess.run(["openssl", "x509", "-in", certificate, "-noout", "-pubkey"], cwd=plant, capture_output=True).stdout \
            == subprocess.run(["openssl", "pkey", "-in", key, "-pubout"], cwd=plant, capture_output=True).stdout

    died = certificates(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (400, 400)))
    checks.equal("a renewal that is killed", died.returncode, -signal.SIGXFSZ)
    checks.equal("leaves both files as they were", {each: (plant / "press" / each).read_bytes() for each in ("press.pem", "press.key")},
                 {each: old[each] for each in ("press.pem", "press.key")})
    told = certificates()
    checks.equal(f"the next one renews both certificates: {told.stdout}{told.stderr}",
                 [f"renewed/{name}: {name}.pem and {name}.key are new" in told.stdout for name in ("press", "cell")], [True] * 2)
    checks.equal("only the node is to be reloaded", told.stdout.count("reload the node"), 1)
    for name in ("press", "cell"):
        former = f"{name}-until-{ends:%Y-%m-%d}"
        checks.equal(f"the files of {name}", files(name),
                     sorted(("authority.pem", f"{name}.pem", f"{name}.key", f"{former}.pem", f"{former}.key")))
        checks.equal("the old ones", [(plant / name / (former + ending)).read_bytes() for ending in (".pem", ".key")],
                     [old[name + ending] for ending in (".pem", ".key")])
        checks.equal("the new ones belong together", fits(f"{name}/{name}.pem", f"{name}/{name}.key"), True)
        checks.equal("whoever owns the keys reads them",
                     [(plant / name / (each + ".key")).stat().st_mode & 0o777 for each in (name, former)], [0o600] * 2)
    checks.equal("then there is nothing to do", certificates().stdout.count("nothing to do"), 2)
    for hosts in ("127.0.0.1,press", "127.0.0.1,press,press.local"):  # both end on the day on which the renewed one ends
        told = certificates(hosts)
        checks.equal(f"with another name, too: {told.stdout}{told.stderr}",
                     "stays good until it ends" in told.stdout and "press.pem and press.key are new" in told.stdout, True)
    checks.equal("no old one has taken another's place", len(set((plant / "press" / each).read_bytes() for each in files("press")
                                                                 if each.startswith("press-until-"))), 6)
    (plant / "cell" / "cell.pem").write_text("nothing")
    checks.equal("what is no certificate is not replaced", "cell/cell.pem cannot be read as a certificate; move it away"
                 in certificates("127.0.0.1,press,press.local").stderr, True)


@contextlib.contextmanager
def s_server(folder, name, *options):
    """The process and its port; it asks clients for a certificate."""
    with subprocess.Popen(["openssl", "s_server", "-accept", "127.0.0.1:0", "-cert", f"{name}.pem", "-key", f"{name}.key",
                           "-CAfile", "ca.pem", "-Verify", "1", "-verify_return_error", *options], cwd=folder, text=True,
                          stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as server:
        try:
            for line in server.stdout:
                if line.startswith("ACCEPT"):
                    yield server, int(line.split(":")[-1])
                    break
        finally:
            server.kill()


def which_servers_are_believed(folder, checks):
    def is_believed_or_not(name, options, says):
        with s_server(folder, name, *options) as (server, port):
            ca = "small_ca.pem" if name == "small_ca_node" else "ca.pem"
            how = ["--at", f"tls://127.0.0.1:{port}", "--certificate", "operator.pem", "--key", "operator.key", "--ca", ca]
            told = peer.run_hasty(lambda seconds: [COUPLER, "dump", HASTY.format(seconds) if says == "no reply within" else
                                                   "cell.yaml", *how], server, cwd=folder).stderr
            checks.equal(f"a server with {name} {' '.join(options)}: {told}", says in told, True)

    old = "-cipher", "DEFAULT@SECLEVEL=0"
    peer.side_by_side(*((is_believed_or_not, *each) for each in (
            ("other_name", (), "another name or address"), ("expired_node", (), "its certificate has expired on 2020-02-01"),
            ("strange_node", (), "from another authority"), ("operator", (), "for another purpose"),
            ("weak_node", old, "weak key"), ("small_ca_node", (), "weak key"), ("node", ("-tls1_1", *old), "protocol_version"),
            ("node", (), "no reply within"), ("node", ("-tls1_2",), "no reply within"))))
    with s_server(folder, "node") as (_, port):
        pin = subprocess.run([COUPLER, "pin", f"tls://127.0.0.1:{port}"], cwd=folder, capture_output=True, text=True).stdout
        own = subprocess.run(["openssl", "x509", "-in", "node.pem", "-noout", "-fingerprint", "-sha256"], cwd=folder,
                             capture_output=True, text=True).stdout
        checks.equal("its pin is OpenSSL's fingerprint", pin.strip(),
                     "sha256:" + own.strip().split("=")[-1].replace(":", "").lower())


def main():
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_certificates(folder)
        shutil.copy(MAP, folder / "cell.yaml")
        for seconds in peer.SLOWER:
            hasty = re.sub("timeout: .*", f"timeout: {seconds}s", pathlib.Path(MAP).read_text())
            (folder / HASTY.format(seconds)).write_text(hasty)
        what_check_says(folder, checks)
        what_a_killed_call_leaves(folder, checks)
        node = Node(folder, NODE, "cell.yaml")
        try:
            peer.side_by_side((the_tools, node, checks), (which_servers_are_believed, folder, checks),
                              (what_certificates_makes, folder, checks), (what_a_renewal_changes, folder, checks))
        finally:
            node.end()
        if checks.failed:
            print(node.text())
    checks.done("tools and TLS: at a node, at OpenSSL's s_server, what check says of certificates, and which it makes")


main()
