# SPDX-License-Identifier: Apache-2.0
"""Latency beside other programs: the node and libmodbus's own server, each as started and with real-time priority,
without load and with a busy loop of ordinary priority on each core. The client is always ahead of the loops: what
is measured is the server."""
import contextlib
import itertools
import json
import statistics
import subprocess

from support.busy_loops import busy_loops
from support.served import Served

PRIORITY = 10  # of the process that answers under --realtime, coupler/device/node/realtime.hpp
AHEAD = 20
CASES = {"fc3": "FC 3, 10 registers", "fc5": "FC 5"}
CONNECTIONS = (1, 16)
FIGURES = ("p50_us", "p99_us", "max_us")


def compare(commands, machine, load_program, options):
    """The rows, which it prints; none where nobody may have real-time priority."""
    if not machine.permits_priority:
        print("beside other programs: not measured, since real-time priority is not permitted here (it needs root)\n")
        return []
    sides = {"node": machine.as_server(*commands["node"], priority=0),
             "node --realtime": machine.as_server(*commands["node"], "--realtime", priority=0),
             "floor": machine.as_server(*commands["floor"], priority=0),
             "floor, chrt --fifo": machine.as_server(*commands["floor"], priority=PRIORITY)}
    load = machine.as_client(load_program, priority=AHEAD)
    requests = max(options.requests // 5, 1)
    rows = []
    with contextlib.ExitStack() as stack:
        servers = {side: stack.enter_context(Served(command)) for side, command in sides.items()}
        print(f"{'':47}{'without load, µs':^27} {'with load, µs':^27}\n{'case':20}{'conn':>5} {'':21} "
              + f"{'p50':>8}{'p99':>9}{'max':>9} " * 2)
        for case, connections in itertools.product(CASES, CONNECTIONS):
            arguments = (case, connections, 0, requests)
            row = {"case": case, "connections": connections,
                   "without_load": measure(servers, load, arguments, options.repetitions)}
            with busy_loops(machine.cores):
                row["with_load"] = measure(servers, load, arguments, options.repetitions)
            rows.append(row)
            print_row(row)
    print(f"\np50 and p99: medians of {options.repetitions} runs of {requests} requests; max: of all runs\n")
    return rows


def measure(servers, load, arguments, repetitions):
    """All sides in turn, each as often: the figures of each."""
    runs = {side: [] for side in servers}
    for _ in range(repetitions):
        for side, server in servers.items():
            command = [str(word) for word in (*load, server.port, *arguments)]
            done = subprocess.run(command, stdout=subprocess.PIPE, check=False)
            if done.returncode != 0:
                raise SystemExit(f"'{side}' failed: {' '.join(command)}")
            runs[side].append(json.loads(done.stdout))
    return {side: {figure: (max if figure == "max_us" else statistics.median)(result[figure] for result in results)
                   for figure in FIGURES} for side, results in runs.items()}


def print_row(row):
    for side in row["without_load"]:
        figures = [f"{row[when][side]['p50_us']:8.0f}{row[when][side]['p99_us']:9.0f}{row[when][side]['max_us']:9.0f} "
                   for when in ("without_load", "with_load")]
        print(f"{CASES[row['case']]:20}{row['connections']:5} {side:21} " + "".join(figures), flush=True)
