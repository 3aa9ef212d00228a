#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Outputs are safe whatever happens to the process that drives them, read at the wires of a kernel chip. Each wire is
# pulled away from the level that it has to have: only a line that is driven shows it.
#   test/kernel/run test/kernel/supervisor.sh BUILD_DIR
set -euo pipefail
bin=$(realpath "${1:?the build folder}")/bin
cd "$(dirname "$0")"
# shellcheck source=plant.sh
. ./plant.sh

# Coils 0 … 5 are off, on, hold; 3 … 5 the same, active-low. They are written to the opposite of their safe state, and
# what is to be held to `on`.
written=(1 0 1 1 0 1)
safe=(0 1 1 0 1 1)

wire_of() { if [ "$1" -ge 3 ]; then echo $((1 - $2)); else echo "$2"; fi; }
wires_are() {
  local line
  for line in 0 1 2 3 4 5; do
    level_is "$line" "$(wire_of "$line" "$(eval "echo \${$1[$line]}")")" || { echo "line $line is wrong"; return 1; }
  done
}
pull_away_from() {
  local line
  for line in 0 1 2 3 4 5; do
    if [ "$(wire_of "$line" "$(eval "echo \${$1[$line]}")")" = 1 ]; then
      sim_pull plant "$line" down
    else
      sim_pull plant "$line" up
    fi
  done
}
coils_are() { [ "$(answered client -t 0 -r 0 -c 6 127.0.0.1 | sed -nE 's/^\[[0-9]+\]:[[:space:]]*([01]).*/\1/p' | tr '\n' ' ')" = "$1 " ]; }
write_outputs() { answered client -t 0 -r 0 127.0.0.1 -- "${written[@]}" >/dev/null; }

sim_define plant 8
sim_plug plant
plant_node supervisor.yaml
check "there is a worker process" wait_until worker
check "its name tells it from its supervisor" grep -qx coupler-node-io "/proc/$(worker)/comm"

for signal in KILL STOP SEGV TERM; do
  echo "# SIG$signal to the worker process"
  before=$(worker)
  check "the outputs are written" wait_until write_outputs
  check "and driven" wires_are written
  pull_away_from safe
  start wires watch_wires 2 5
  check "the held lines are watched" wait_until says wires armed
  kill -s "$signal" "$before"
  check "every output is in its safe state, against its pull" wait_until wires_are safe
  check "another worker process is started" wait_until new_worker "$before"
  check "outputs are as they were left" wires_are safe
  check "it serves, and its image shows them" wait_until coils_are "${safe[*]}"
  check "inputs work" wait_until input_is 0 0
  stop wires KILL || true
  refuse "no held line moved meanwhile" says wires changed
done

echo "# outputs that a write does not name keep their levels through all of this"
check "one coil is written" set_coil 0 1
pull_away_from safe
sim_pull plant 0 down
expect "its line is driven" 1 "$(sim_value plant 0)"
check "the others are as before" level_is 2 1
check "and the active-low one too" level_is 5 0

echo "# a supervisor that was stopped itself does not take its child's silence for death"
before=$(worker)
kill -s STOP "$(pid node)"
sleep 2
kill -s CONT "$(pid node)"
sleep 1
expect "the worker process is the same" "$before" "$(worker)"

echo "# a signal to the supervisor"
check "it ends well" stop node TERM
check "and says so" says node 'Terminated: outputs are in their safe state' 2
refuse "no process is left" pgrep 'coupler-node'
cat "$(log node)"

echo "# the supervisor is killed"
plant_node supervisor.yaml
check "outputs are written" wait_until write_outputs
id=$(worker)
status=0; stop node KILL || status=$?
expect "it dies" 137 "$status"
check "its worker process drives the safe state and ends" wait_until ended "$id"
check "and says so" says node 'the supervisor, process [0-9]+, was killed, and the node ends with it: outputs are in their safe state'

echo "# the supervisor is stopped: its worker process, after which nobody would look, ends safely"
plant_node supervisor.yaml
check "outputs are written" wait_until write_outputs
id=$(worker)
kill -s STOP "$(pid node)"
check "its worker process ends" wait_until ended "$id"
check "and tells why" says node 'the supervisor, process [0-9]+, was silent for 5 s and is killed; outputs are in their safe state'
status=0; stop node CONT || status=$?
expect "the supervisor was killed, stopped as it was" 137 "$status"

echo "# the worker process is stopped, and before that is noticed the supervisor is killed"
plant_node supervisor.yaml
check "outputs are written" wait_until write_outputs
id=$(worker)
kill -s STOP "$id"
status=0; stop node KILL || status=$?
expect "the supervisor dies" 137 "$status"
check "the worker process, which the kernel makes go on, drives the safe state and ends" wait_until ended "$id"
check "and says so" says node 'the supervisor, process [0-9]+, was killed, and the node ends with it: outputs are in their safe state'

echo "# nobody reads the log"
mkfifo "$check_folder/unread"
exec 9<>"$check_folder/unread"
start node sh -c 'exec "$@" 2>&9' sh "$bin/coupler-node" supervisor.yaml
check "the node serves" wait_until write_outputs
dd if=/dev/zero of="$check_folder/unread" bs=4096 count=200 oflag=nonblock 2>"$check_folder/dd" || true
check "its pipe is full" grep -q 'temporarily unavailable' "$check_folder/dd"
before=$(worker)
kill -s KILL "$before"
check "every output is in its safe state" wait_until wires_are safe
check "another worker process is started" wait_until new_worker "$before"
check "the supervisor ends at SIGTERM" stop node TERM
