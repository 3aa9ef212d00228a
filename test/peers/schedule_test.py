#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Outputs at a time (function code 66), by the bytes of docs/time.md: when they are driven, when they end, what cancels
them. The node's clock is this machine's, so times can be compared. Nothing is said about how late they are, but never early.

    schedule_test.py NODE MAP MAP_WITH_WATCHDOG
"""
import os
import pathlib
import signal
import struct
import sys
import tempfile
import time

import peer
from scheduling import (BRAKE, BY_CLIENT, CANCELLED, COIL, CONNECTION, DONE, EJECTOR, HOUR, INPUT, LAMP, LOCKED, MOTOR, MS,
                        NO_ADDRESS, NO_PLACE, NOT_ALLOWED, OFF, ON, OVERWRITTEN, RELOAD, SOON, WATCHDOG, clients, number_of)

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent.parent)]
from support.raw_client import wait  # noqa: E402

LONGEST = 3_600_000  # ms: a duration of which the test does not see the end
LENGTHS = (1, 4, 16, 64)  # seconds to try, one after the other, until this machine was in time


def they_are_driven_at_their_times_in_their_order(port, checks):
    with clients(port) as client:
        lead, replies = SOON, [NOT_ALLOWED]
        while NOT_ALLOWED in replies and lead < HOUR // 2:
            for reply in replies:  # one of them came too late
                if reply != NOT_ALLOWED:
                    client.cancel(number_of(reply))
            now = time.monotonic_ns()
            late, early = now + lead + 200 * MS, now + lead
            replies = [client.schedule(late, MOTOR, [0, 1]), client.schedule(early, MOTOR, [1, 0])]
            lead *= 2
        second, first = replies
        arrived, replied = struct.unpack(">QQ", first[4:])
        checks.equal("the times in the reply", now <= arrived <= replied <= time.monotonic_ns(), True)
        outcomes = client.outcomes(number_of(first), number_of(second))
        checks.equal("in the order of their times", [outcome[:3] for outcome in outcomes],
                     [(DONE, 0, number_of(first)), (DONE, 0, number_of(second))])
        checks.equal("none is early", [at >= due for (*_, at), due in zip(outcomes, (early, late))], [True, True])
        checks.equal("the wires", client.inputs(), [0, 1, 0])
        client.write(BRAKE, 0)


def a_duration_ends_though_its_client_is_gone(port, checks):
    with clients(port) as watcher:
        with clients(port) as client:
            due, _ = client.ahead(MOTOR, [1], 200)
            on = watcher.coil_changes(MOTOR, 1)
        changes = on + watcher.coil_changes(MOTOR, 2 - len(on))
        checks.equal("on, then off", [level for level, _ in changes], [ON, OFF])
        checks.equal("neither is early", [changes[0][1] >= due, changes[1][1] >= due + 200 * MS], [True, True])
        checks.equal("the wires", watcher.inputs(), [0, 0, 0])


def a_pulse_ends_by_itself(port, checks):
    """A client that knows of nothing writes it."""
    with clients(port) as watcher:
        plain = peer.pymodbus_client(port)
        before = time.monotonic_ns()
        checks.equal("pymodbus writes", plain.write_coil(EJECTOR, True, 1).isError(), False)
        plain.close()
        changes = watcher.coil_changes(EJECTOR, 2)
        checks.equal("on, then off", [level for level, _ in changes], [ON, OFF])
        checks.equal("not early", changes[0][1] >= before and changes[1][1] - changes[0][1] >= 200 * MS, True)


def what_cancels(port, checks):
    with clients(port, 2) as (client, other):
        number = number_of(client.later(MOTOR, [1]))
        checks.equal("another client cannot cancel it", other.cancel(number), NO_ADDRESS)
        checks.equal("its client can", number_of(client.cancel(number)), number)
        checks.equal("and hears so", [o[:3] for o in client.outcomes(number)], [(CANCELLED, BY_CLIENT, number)])
        checks.equal("only once", client.cancel(number), NO_ADDRESS)

        number = number_of(client.later(MOTOR, [1, 1]))
        other.write(BRAKE, 0)
        checks.equal("a plain write of another client", [o[:3] for o in client.outcomes(number)],
                     [(CANCELLED, OVERWRITTEN, number)])

        number = number_of(client.later(MOTOR, [1]))
        client.close()
        checks.equal("the end of the connection", [o[:3] for o in other.outcomes(number)], [(CANCELLED, CONNECTION, number)])


def a_client_cancels_many(port, checks):
    with clients(port, 2) as (client, other):
        soon = time.monotonic_ns() + HOUR // 4
        kept = [number_of(client.schedule(soon - 1, MOTOR, [1])), number_of(client.schedule(soon, LAMP, [1])),
                number_of(other.schedule(soon, MOTOR, [1]))]
        numbers = [number_of(client.schedule(soon + i, (MOTOR, BRAKE)[i % 2], [1])) for i in range(40)]
        checks.equal("in another epoch", client.cancel_from(soon, MOTOR, 2, epoch=client.epoch ^ 1), NOT_ALLOWED)
        checks.equal("no coil", client.cancel_from(soon, MOTOR, 0), NOT_ALLOWED)
        checks.equal("past the last address", client.cancel_from(soon, 2, 65535), NO_ADDRESS)
        before = time.monotonic_ns()
        reply = client.cancel_from(soon, MOTOR, 2)
        checks.equal("how many", number_of(reply), len(numbers))
        arrived, replied = struct.unpack(">QQ", reply[4:])
        checks.equal("the times in the reply", before <= arrived <= replied <= time.monotonic_ns(), True)
        checks.equal("each is told", sorted(o[:3] for o in client.outcomes(*numbers)),
                     sorted((CANCELLED, BY_CLIENT, number) for number in numbers))
        checks.equal("none is left", number_of(client.cancel_from(soon, MOTOR, 2)), 0)
        checks.equal("the others stay", [number_of(each.cancel(number)) for each, number in
                                         zip((client, client, other), kept)], kept)


def what_is_refused(port, checks):
    with clients(port) as client:
        due = time.monotonic_ns() + HOUR // 2
        checks.equal("the epoch of another boot", client.schedule(due, MOTOR, [1], epoch=client.epoch ^ 1), NOT_ALLOWED)
        checks.equal("past", client.schedule(time.monotonic_ns() - 10 * MS, MOTOR, [1]), NOT_ALLOWED)
        checks.equal("too far", client.schedule(time.monotonic_ns() + 2 * HOUR, MOTOR, [1]), NOT_ALLOWED)
        checks.equal("no such coil", client.schedule(due, EJECTOR, [1, 1]), NO_ADDRESS)
        checks.equal("above its largest", client.schedule_register(due, 0, 1001), NOT_ALLOWED)
        checks.equal("nothing happened", client.inputs(), [0, 0, 0])


def sixty_four_places_for_all_clients(port, checks):
    with clients(port) as watcher:
        with clients(port, 4) as every:
            numbers = [number_of(every[i % 4].later(MOTOR, [1])) for i in range(64)]
            checks.equal("64 numbers", len(set(numbers)), 64)
            checks.equal("0 is none", 0 in numbers or None in numbers, False)
            for client in (*every, watcher):
                checks.equal("no place", client.later(BRAKE, [1]), NO_PLACE)
        outcomes = watcher.outcomes(*numbers)
        checks.equal("their connections have ended", sorted(o[2] for o in outcomes if o[:2] == (CANCELLED, CONNECTION)),
                     sorted(numbers))
        again = watcher.later(BRAKE, [1])
        checks.equal("there is room again", again[0], 66)
        watcher.cancel(number_of(again))


def two_clients_schedule_the_same_output(port, checks):
    with clients(port, 2) as (first, second):
        lead = SOON
        while True:
            due = time.monotonic_ns() + lead
            replies = first.schedule(due + SOON, MOTOR, [0]), second.schedule(due, MOTOR, [1])
            if NOT_ALLOWED not in replies or lead > HOUR // 2:
                break
            first.cancel(number_of(replies[0]) or 0)
            lead *= 2
        off, on = map(number_of, replies)
        checks.equal("neither cancels the other's", [o[:3] for o in first.outcomes(off, on)], [(DONE, 0, on), (DONE, 0, off)])
        checks.equal("the output follows both", [level for level, _ in second.coil_changes(MOTOR, 2)], [1, 0])


def a_reload_cancels_and_durations_go_on(port, checks):
    def is_in_time(duration):
        """True if it lasted for longer than the reload took; otherwise it shows nothing."""
        before = client.epoch
        due, begun = client.ahead(LAMP, [1], duration)
        it_burns = {(ON, COIL, LAMP), (ON, INPUT, LAMP), (DONE, 0, number_of(begun))}
        # All three, or else the last ones end the wait.
        told = client.await_changes(3, lambda change: change[:3] in it_burns)
        number = number_of(client.later(MOTOR, [1]))
        wait(client, other)  # who asks only afterwards asks the next process, which does not know
        os.kill(peer.the_node(), signal.SIGHUP)
        heard = client.take(client.receive()).changes
        peer.await_true("a new epoch", lambda: client.changes() is not None and client.epoch != before, peer.Checks())
        refused = client.schedule(time.monotonic_ns() + HOUR // 2, MOTOR, [1], epoch=before)
        in_time = time.monotonic_ns() < due + duration * MS
        peer.await_true("it ends", lambda: client.inputs() == [0, 0, 0], checks)
        if in_time:
            checks.equal("it has begun", {change[:3] for change in told}, it_burns)
            checks.equal("told before the reload", [change[:3] for change in heard], [(RELOAD, CANCELLED, number)])
            checks.equal("a new epoch", client.epoch != before, True)
            checks.equal("the epoch before", refused, NOT_ALLOWED)
            checks.equal("not early", time.monotonic_ns() >= due + duration * MS, True)
        return in_time

    with clients(port, 2) as (client, other):
        checks.equal("a reload within a duration", any(is_in_time(1000 * seconds) for seconds in LENGTHS), True)


def a_killed_worker_process_leaves_nothing_on(port, checks):
    with clients(port) as client:
        _, begun = client.ahead(MOTOR, [1, 0, 1], LONGEST)
        checks.equal("it has begun", [o[0] for o in client.outcomes(number_of(begun))], [DONE])
        due, _ = client.ahead(BRAKE, [1], lead=3 * SOON)
        killed = peer.the_worker()
        os.kill(killed, signal.SIGKILL)
    peer.await_true("another one serves", lambda: peer.the_worker() not in (None, killed), checks)
    with clients(port) as client:
        checks.equal("safe, and the lamp as it was before", client.inputs(), [0, 0, 0])
        while time.monotonic_ns() < due:
            time.sleep(0.05)
        checks.equal("what the killed one had to do is not done", client.inputs(), [0, 0, 0])
        taken = client.later(MOTOR, [1])
        checks.equal("and the new one takes orders", taken[0], 66)
        client.cancel(number_of(taken))


def another_map_ends_what_it_has_elsewhere(port, checks, served):
    with clients(port) as client:
        begun = [client.ahead(coil, [1], LONGEST)[1] for coil in (MOTOR, LAMP)]
        client.outcomes(*map(number_of, begun))
        checks.equal("both are on", client.inputs(), [1, 0, 1])
    before = peer.the_worker()
    moved = served.read_text(encoding="utf-8").replace("lamp:  {address: 2", "lamp:  {address: 7")
    served.write_text(moved, encoding="utf-8")
    os.kill(peer.the_node(), signal.SIGHUP)
    peer.await_true("another process serves", lambda: peer.the_worker() not in (None, before), checks)
    with clients(port) as client:
        checks.equal("what has moved is as it was before, the other goes on", client.inputs(), [1, 0, 0])


def the_watchdog_cancels(node, guarded, folder, checks):
    def is_in_time(timeout):
        """True if nothing but its client's silence made the watchdog expire, and the duration lasted for longer."""
        served = folder / f"watchdog_{timeout}s.yaml"
        served.write_text(guarded.read_text(encoding="utf-8").replace("timeout: 500ms", f"timeout: {timeout}s"), encoding="utf-8")
        silence = peer.Silence()
        with peer.running_node([node, str(served), "--sim"]) as port, clients(port, 2) as (client, monitor):
            silence.ask(client.inputs)
            due, begun = client.ahead(LAMP, [1], 2000 * timeout)
            told = []
            end = time.monotonic() + peer.PATIENCE
            while not told and time.monotonic() < end:
                silence.ask(client.inputs)  # feeds the watchdog
                told += [change for change in monitor.changes() if change[0] >= DONE]
            number = number_of(silence.ask(lambda: client.later(MOTOR, [1])))
            cancelled = monitor.outcomes(number) if number else []
            levels, locked = monitor.inputs(), client.later(MOTOR, [1])
            in_time = silence.longest < timeout and time.monotonic_ns() < due + 2000 * timeout * MS
            if in_time:
                checks.equal("the monitor hears it", [o[:3] for o in told], [(DONE, 0, number_of(begun))])
                checks.equal("then its client is silent", [o[:3] for o in cancelled], [(CANCELLED, WATCHDOG, number)])
                checks.equal("the lamp holds", levels, [0, 1, 1])
                checks.equal("locked", locked, LOCKED)
                peer.await_true("the duration ends all the same", lambda: monitor.inputs() == [0, 1, 0], checks)
            return in_time

    checks.equal("a watchdog that expires within a duration", any(is_in_time(seconds) for seconds in LENGTHS), True)


def without_watchdog(node, served, checks):
    with peer.running_node([node, str(served), "--sim"]) as port:
        for test in (they_are_driven_at_their_times_in_their_order, a_duration_ends_though_its_client_is_gone,
                     a_pulse_ends_by_itself,
                     what_cancels, a_client_cancels_many, what_is_refused, sixty_four_places_for_all_clients,
                     two_clients_schedule_the_same_output, a_reload_cancels_and_durations_go_on,
                     a_killed_worker_process_leaves_nothing_on):
            test(port, checks)
        another_map_ends_what_it_has_elsewhere(port, checks, served)


def main():
    node, served, guarded = sys.argv[1:4]
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        own = folder / "schedule.yaml"
        own.write_text(pathlib.Path(served).read_text(encoding="utf-8"), encoding="utf-8")
        without_watchdog(node, own, checks)
        the_watchdog_cancels(node, pathlib.Path(guarded), folder, checks)
    checks.done("outputs are driven at their times, end, and are cancelled as docs/time.md says")


if __name__ == "__main__":
    main()
