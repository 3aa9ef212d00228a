#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A pulse is not lost: counters and latched points of coupler-node on a chip of the kernel, at the shortest pulses of
# which a bare gpiomon misses none in the same run.
#   test/kernel/run test/kernel/edges.sh BUILD_DIR [PULSES]      default 1000; 10000 take 5 minutes
# All of them are counted; after that the latch is cleared before each of a twentieth as many.
set -euo pipefail
bin=$(realpath "${1:?the build folder}")/bin
pulses=${2:-1000}
cd "$(dirname "$0")"
# shellcheck source=plant.sh
. ./plant.sh
plant_chip
chip=$(sim_chip plant)
readonly button=2 wave=3 bouncy=4 control=5
mkfifo "$check_folder/never"

# A builtin: a process for every pause would take longer than the pulse.
pause() { read -rt "$1" <>"$check_folder/never" || true; }

# Sends pulses to LINES at once: COUNT times up and down, WIDTH seconds each.
pulse() {
  local count=$1 width=$2 wires=() wire line
  shift 2
  for line in "$@"; do wires+=("$(sim_wire plant "$line")/pull"); done
  while ((count-- > 0)); do
    for wire in "${wires[@]}"; do echo pull-up >"$wire"; done
    pause "$width"
    for wire in "${wires[@]}"; do echo pull-down >"$wire"; done
    pause "$width"
  done
}

watch_control() {
  start "$1" monitor "$chip" "$control"
  check "gpiomon watches its line" wait_until is_watched "$chip"
}
rising_seen() { grep -ciE 'rising' "$(log "$1")" || true; }
saw() { [ "$(rising_seen "$1")" -ge "$2" ]; }

pair() { answered client -t "$1" -r "$2" -c 2 127.0.0.1 | sed -nE 's/^\[[0-9]+\]:[[:space:]]*([0-9]+).*/\1/p'; }
# Counters stand in the map's order, CDAB; statistics with the most significant register first.
counter() {
  local words
  mapfile -t words < <(pair "$1" "$2")
  [ ${#words[@]} -eq 2 ] && echo $((words[1] * 65536 + words[0]))
}
lost() { local words; mapfile -t words < <(pair 3 65305); echo $((words[0] * 65536 + words[1])); }

# Clears the latch, sees that it is clear, and sends one pulse, so many times; prints how often it was set then.
count_latched() {
  python3 -c '
import os, socket, sys, time
rounds, width, wire = int(sys.argv[1]), float(sys.argv[2]), os.open(sys.argv[3], os.O_WRONLY)
node = socket.create_connection(("127.0.0.1", 1502))
def ask(pdu):
    node.sendall(bytes([0, 0, 0, 0, 0, 1 + len(pdu), 1]) + pdu)
    return node.recv(260)
def latch():
    return ask(bytes([1, 0, 0, 0, 1]))[-1]
def pull(level):
    os.pwrite(wire, level, 0)
    time.sleep(width)
latched = 0
for _ in range(rounds):
    ask(bytes([5, 0, 0, 0, 0]))
    if latch():
        continue
    pull(b"pull-up")
    pull(b"pull-down")
    latched += latch()
print(latched)
' "$1" "$width" "$(sim_wire plant "$button")/pull"
}

width=
for try in 0.001 0.002 0.005 0.01 0.02 0.05; do
  watch_control "try-$try"
  pulse 200 "$try" "$control"
  within 1 saw "try-$try" 200 >/dev/null || true
  echo "# bare gpiomon, both edges, pulses of $try s: $(rising_seen "try-$try") of 200"
  stop "try-$try" INT || true
  if [ "$(rising_seen "try-$try")" -eq 200 ]; then width=$try; break; fi
done
check "gpiomon sees all pulses of some width" test -n "$width"

plant_node edges.yaml
echo "# $pulses pulses of $width s"
watch_control beside
pulse "$pulses" "$width" "$button" "$control"
within 10 saw beside "$pulses" >/dev/null || true
echo "# bare gpiomon beside it saw $(rising_seen beside)"
stop beside INT || true
expect "the counter of rising edges has them all" "$pulses" "$(counter 3 0)"
expect "the counter of falling edges too" "$pulses" "$(counter 4 0)"
expect "nothing was lost" 0 "$(lost)"
refuse "the log does not speak of it" says node lost

echo "# latch and preset"
expect "the latch is set" 1 "$(coil 0)"
expect "cleared, it is set again by each single pulse" $((pulses / 20)) "$(count_latched $((pulses / 20)))"
check "writing 1 is allowed" set_coil 0 1
check "a counter is preset as a whole" answered client -t 4:int -r 0 127.0.0.1 -- 4000000
pulse 5 "$width" "$button"
expect "and counts on from there" 4000005 "$(counter 4 0)"
refuse "half of it cannot be written" answered client -t 4 -r 0 127.0.0.1 -- 7

echo "# debounce"
# A round in which this program had to wait between two pulses has other presses, and is made again.
bounce() {
  local begun took wire
  wire=$(sim_wire plant "$bouncy")
  begun=$(microseconds)
  pulse 5 0.01 "$bouncy"
  [ "$1" = released ] || echo pull-up >"$wire/pull"
  pause 1.2
  took=$(($(microseconds) - begun - 1200000)) # now that the last edge has come, too
  slowest=$((took > slowest ? took : slowest))
}
for _ in 1 2 3 4 5; do
  before=$(counter 3 4) slowest=0
  for _ in 1 2 3; do bounce pressed; bounce released; done
  pressed=$(($(counter 3 4) - before))
  [ "$slowest" -ge 350000 ] || break
done
expect "three presses that bounce are three" 3 "$pressed"

echo "# the worker process is killed"
before=$(counter 3 0)
kill -KILL "$(worker)"
pulse 5 "$width" "$button"
check "another one serves" wait_until counter 3 0
pulse 5 "$width" "$button"
expect "its counters go on, with what happened meanwhile" $((before + 10)) "$(counter 3 0)"
expect "the one that can be preset too" $((4000005 + 10)) "$(counter 4 0)"
expect "nothing was lost by that" 0 "$(lost)"

echo "# a reader that is stopped"
before=$(counter 3 2)
start heard python3 heard_changes.py 1
check "a client waits for changes" wait_until says heard listening
id=$(worker)
watch_control storm
kill -STOP "$(pid node)" # the supervisor, which would end a worker process that is silent for so long
kill -STOP "$id"
pulse 700 "$width" "$wave" "$control"
kill -CONT "$id"
kill -CONT "$(pid node)" # at once: a worker whose supervisor is silent for 5 s ends it
within 10 saw storm 700 >/dev/null || true
echo "# bare gpiomon beside it saw $(rising_seen storm) of 700"
stop storm INT || true
counted=$(($(counter 3 2) - before))
lost=$(lost)
echo "# of 1400 edges $counted were counted, $lost reported as lost"
check "what the kernel could not keep is missing" test "$counted" -lt 1400
check "is reported as lost" test "$lost" -gt 0
check "and told in the log, once" says node 'gpiochip.* lost'
refuse "not twice" says node 'gpiochip.* lost' 2
check "the client that waits ends" stop heard INT
told=$(sed -nE 's/^told ([0-9]+), lost .*/\1/p' "$(log heard)")
unheard=$(sed -nE 's/^told [0-9]+, lost ([0-9]+)$/\1/p' "$(log heard)")
echo "# it was told $told edges, and that $unheard were lost"
check "it was not told all" test "$told" -lt 1400
check "and knows" test "$unheard" -gt 0
# libgpiod 2 numbers edges, so it is known how many are missing. The simulator merges some on a machine that is very busy.
if ldd "$bin/coupler-node" | grep -q 'libgpiod\.so\.3' && [ "$(rising_seen storm)" -eq 700 ]; then
  expect "counted and lost are all that were made" 1400 $((counted + lost))
  expect "so are told and lost" 1400 $((told + unheard))
fi
check "it ends well on SIGTERM" stop node TERM
cat "$(log node)"
