#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What becomes of an output that is scheduled on a line of the kernel, and of the request that waits for news of it, when
# the chip is unplugged, the process that serves hangs or is killed, or the node ends and starts again.
#   test/kernel/run test/kernel/schedule.sh BUILD_DIR
set -euo pipefail
bin=$(realpath "${1:?the build folder}")/bin
cd "$(dirname "$0")"
# shellcheck source=plant.sh
. ./plant.sh
plant_chip
sim_pull plant 0 down
plant_node plant.yaml

# schedule NAME SECONDS: coil 0, so far ahead
schedule() {
  start "$1" python3 schedule_client.py "$2"
  check "it is accepted" wait_until says "$1" scheduled
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

for signal in STOP KILL; do
  echo "# SIG$signal to the process that serves"
  schedule "$signal" 5
  begun=$SECONDS before=$(worker)
  kill -s "$signal" "$before"
  check "another one is started" wait_until new_worker "$before"
  check "who waited is told by the end of the connection" wait_until says "$signal" 'the connection ended'
  sleep $((begun + 6 - SECONDS > 0 ? begun + 6 - SECONDS : 0))
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
sleep $((begun + 6 - SECONDS > 0 ? begun + 6 - SECONDS : 0))
check "nothing was driven at its time" level_is 0 0
