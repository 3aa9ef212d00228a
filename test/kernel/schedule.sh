#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What becomes of an output that is scheduled on a line of the kernel, or has a duration that has begun, and of the request
# that waits for news of it, when the chip is unplugged, the map is read again, the process that serves hangs or is killed, or
# the node ends and starts again.
#   test/kernel/run test/kernel/schedule.sh BUILD_DIR
set -euo pipefail
bin=$(realpath "${1:?the build folder}")/bin
cd "$(dirname "$0")"
# shellcheck source=plant.sh
. ./plant.sh
plant_chip
sim_pull plant 0 down
plant_node plant.yaml

# schedule NAME SECONDS [MS]: coil 0, so far ahead, for so long
schedule() {
  local name=$1
  shift
  start "$name" python3 schedule_client.py "$@"
  check "it is accepted" wait_until says "$name" scheduled
}
# begin NAME: a duration of a minute, which has begun
begin() {
  schedule "$1" 1 60000
  check "it is driven" wait_until level_is 0 1
}
read_again() {
  local before
  before=$(grep -c 'read the map again' "$(log node)" || true)
  kill -HUP "$(pid node)"
  wait_until says node 'read the map again: serving plant' $((before + 1))
}

echo "# it is driven, and who waits is told"
schedule calm 5
check "it is told" wait_until says calm 'driven, reason 0'
check "so is the change" says calm 'coil 0 is 1'
check "the line is high" level_is 0 1
check "it is written off again" set_coil 0 0
stop calm KILL || true

echo "# the chip is unplugged before its time"
schedule unplugged 10  # the node looks for its chips once a second
sim_unplug plant
check "who waits is told that it is cancelled" wait_until says unplugged 'cancelled, reason 5'
start late python3 schedule_client.py 5
check "another one is refused" wait_until says late 'exception 04'
sim_plug plant
sim_pull plant 0 down
check "plugged in again, inputs are read" wait_until input_is 0 0
check "the line is as it was" level_is 0 0
expect "so is the coil" 0 "$(coil 0)"
stop unplugged KILL || true

echo "# the map is read again"
schedule read_again 8
begun=$SECONDS
check "it is taken" read_again
check "who waits is told that it is cancelled" wait_until says read_again 'cancelled, reason 5'
sleep_until $((begun + 9))
check "nothing was driven at its time" level_is 0 0
stop read_again KILL || true
schedule lasting 1 8000
check "another one is driven, for 8 s" wait_until level_is 0 1
check "the map is taken meanwhile" read_again
check "the duration ends all the same" wait_until level_is 0 0
stop lasting KILL || true

echo "# the chip is unplugged while a duration runs"
begin gone
sim_unplug plant
check "the node sees it" wait_until says node 'line 0(, .*)? failed: No such device' 2 # alone, or in one request with others
sim_plug plant
sim_pull plant 0 down
check "plugged in again, the line is high, against its pull" wait_until level_is 0 1
check "it is written off" wait_until set_coil 0 0 # by the next process: this one has lost its line
check "and low" level_is 0 0
stop gone KILL || true

for signal in STOP KILL; do
  echo "# SIG$signal to the process that serves, while a duration runs"
  begin "$signal-in-it"
  before=$(worker)
  kill -s "$signal" "$before"
  check "another one is started" wait_until new_worker "$before"
  check "the line is as before the duration" wait_until level_is 0 0
  check "who waited is told by the end of the connection" wait_until says "$signal-in-it" 'the connection ended'

  echo "# SIG$signal to the process that serves"
  schedule "$signal" 5
  begun=$SECONDS before=$(worker)
  kill -s "$signal" "$before"
  check "another one is started" wait_until new_worker "$before"
  check "who waited is told by the end of the connection" wait_until says "$signal" 'the connection ended'
  sleep_until $((begun + 6))
  check "nothing was driven at its time" level_is 0 0
  expect "nor says the node so" 0 "$(coil 0)"
  refuse "nor was it told" says "$signal" 'driven'
done

echo "# the node ends, and starts again"
schedule ended 5
begun=$SECONDS
check "it ends" stop node
check "who waited was told why" wait_until says ended 'cancelled, reason 5'
plant_node plant.yaml
sleep_until $((begun + 6))
check "nothing was driven at its time" level_is 0 0
