#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A chip is unplugged while it is served, and comes back under another number: Linux 6.1 does not give the old one again
# when lines were held at that moment.
#   test/kernel/run test/kernel/unplug.sh BUILD_DIR
set -euo pipefail
bin=$(realpath "${1:?the build folder}")/bin
cd "$(dirname "$0")"
# shellcheck source=plant.sh
. ./plant.sh
plant_chip

exception_04() { grep -qi 'device or server failure' < <(answered "$@" 2>&1 || true); }
press() { sim_pull plant 2 up; sleep 0.02; sim_pull plant 2 down; sleep 0.02; }
lost='(failed: No such device)'
back='works again'
holds_no_line() {
  local id
  id=$(worker) && [ -d "/proc/$id/fd" ] || return
  [ -z "$(find "/proc/$(pid node)/fd" "/proc/$id/fd" -lname '*gpio*')" ]
}
# Requests to the kernel for the map: libgpiod 1 wants one for each polarity of outputs.
if [[ $(gpiomon --version) == *v1.* ]]; then requests=3; else requests=2; fi
times() { grep -cE -- "$1" "$(log node)" || true; }

plant_node reload.yaml
check "an output is written" set_coil 0 1
check "an active-low one too" set_coil 1 1
check "a register too" answered client -t 4 -r 0 127.0.0.1 -- 1234
press
expect "a press is counted" 1 "$(read_one 3 0)"

for round in 1 2; do
  echo "# unplugged, round $round"
  chip=$(sim_chip plant)
  before=$(times "$lost")
  sim_unplug plant
  check "the node notices, though nobody asks" wait_until says node "$lost" $((before + requests))
  check "reading an input is answered with exception 04" exception_04 client -t 1 -r 0 -c 1 127.0.0.1
  check "writing an output too" exception_04 client -t 0 -r 0 127.0.0.1 -- 0
  expect "what is not wired is served as ever" 1234 "$(register 0)"
  expect "an output shows what it was driven to" 1 "$(coil 0)"
  expect "each loss is told once" $((before + requests)) "$(times "$lost")"
  check "nothing of the chip is held" wait_until holds_no_line
  [ "$round" = 1 ] || sim_create stranger 4

  before=$(times "$back")
  sim_plug plant
  sim_pull plant 0 down
  sim_pull plant 1 up
  check "outputs are driven as they were, against their pull" wait_until level_is 0 1
  check "of both polarities" wait_until level_is 1 0
  check "inputs are read" wait_until input_is 0 0
  sim_pull plant 2 up
  check "and follow" wait_until input_is 0 1
  sim_pull plant 2 down
  check "each return is told" wait_until says node "$back" $((before + requests))
  expect "once" $((before + requests)) "$(times "$back")"
  check "outputs can be written" set_coil 0 1
  counted=$(read_one 3 0)
  press
  expect "edges are counted" $((counted + 1)) "$(read_one 3 0)"
  refuse "the chip has another number" test "$chip" = "$(sim_chip plant)"
done

echo "# plugged in again, and the map is read again at once"
sim_unplug plant
check "the node notices" wait_until says node "$lost" $((3 * requests))
sim_plug plant
sim_pull plant 0 down
kill -s HUP "$(pid node)"
check "the map is read again" wait_until says node 'read the map again'
check "outputs are as they were, and not as they begin" wait_until level_is 0 1
expect "the node says so" 1 "$(coil 0)"
refuse "no line is held by the node itself" says node "held by 'coupler-node'"

echo "# somebody else takes a line before the node does"
before=$(times 'is busy')
sim_unplug plant
check "the node notices" wait_until says node "$lost" $((4 * requests))
sim_hog plant 0 output-low thief
sim_plug plant
check "who holds it is told" wait_until says node "held by 'thief'"
check "inputs work all the same" wait_until input_is 0 0
check "the output's request is answered with exception 04" exception_04 client -t 0 -r 0 127.0.0.1 -- 1
sleep 2
expect "told once, not at each try" $((before + 1)) "$(times 'is busy')"
refuse "no worker process died" says node 'the worker process'
status=0; stop node TERM || status=$?
expect "who stops the node is told that the thief's output is not safe" 3 "$status"
check "in words, too" says node 'not every output could be driven to its safe state when the node ended'
cat "$(log node)"
