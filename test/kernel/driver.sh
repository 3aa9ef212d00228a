#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The whole chain on a chip of the kernel: line, coupler-node, coupler_driver, topic, and back; an output at a time, also
# across a fault; and what the driver records of all, played to a driver without that chip.
#   test/kernel/run --mem 1G test/kernel/driver.sh BUILD_DIR
set -euo pipefail
export PYTHONUNBUFFERED=1  # what rostopic prints is looked for in a file while it runs
build=$(realpath "${1:?the build folder}")
bin=$build/bin
cd "$(dirname "$0")"
# shellcheck source=plant.sh
. ./plant.sh
plant_chip
plant_node plant.yaml
readonly not_begun='the device read a new map, lost or found a chip, or ended'

plant_master "$build"
recording=$check_folder/plant.jsonl
# A busy machine's node is late, not lost.
start driver "$bin/coupler_driver" _address:=127.0.0.1 _port:=1502 _timeout:="${patience}s" _record:="$recording"
check "the driver connects, with the node's own map" wait_until says driver 'connected'

echo "# pulling a line shows on its topic"
start button rostopic echo /plant/button
check "the topic tells that the line is low" wait_until says button 'data: False'
sim_pull plant 2 up
check "pulled up, it tells so" wait_until says button 'data: True'

echo "# publishing drives a line"
sim_pull plant 0 down
# Without --once, which ends 3 s later: whoever connects late gets it, too.
start on rostopic pub /plant/lamp/write std_msgs/Bool 'data: true'
check "the line is high, against its pull" wait_until level_is 0 1
check "who published it ends" stop on INT
sim_pull plant 0 up
start off rostopic pub /plant/lamp/write std_msgs/Bool 'data: false'
check "the line is low, against its pull" wait_until level_is 0 0
check "who published that ends" stop off INT

echo "# somebody sets the clock: stamps follow it, and it is told"
is_stamped_from() { [ "$(tail -n 1 "$(log stamped)" | cut -d, -f3 | cut -c -10)" -ge "$1" ]; }
start stamped rostopic echo -p /plant/closed/stamped
check "a stamp is now" wait_until is_stamped_from "$(date +%s)"
later=$(($(date +%s) + 3600))
check "the clock is set an hour ahead" date -s "@$later"
check "the driver tells it" wait_until says driver "clock was set 3[56].* s ahead"
check "stamps are an hour later" wait_until is_stamped_from "$later"

echo "# an output at a time: driven, or told why not"
sim_pull plant 0 down
schedule() {
  start "$1" python3 schedule_in_ros.py "$2"
  check "it is accepted" wait_until says "$1" 'accepted: the device does it'
  due=$((SECONDS + $(sed -nE 's/.*, in ([0-9]+) s$/\1/p' "$(log "$1")")))
}
not_driven() {
  sleep_until $((due + 1))
  check "nothing was driven at its time" level_is 0 0
}
schedule calm 3
check "it is told" wait_until says calm 'lamp done: $'
check "the line is high" level_is 0 1
check "it is written off" set_coil 0 0
schedule read_again 10
check "the map is read again" kill -HUP "$(pid node)"
check "it is told that it is cancelled" wait_until says read_again "lamp cancelled: $not_begun"
not_driven
for signal in KILL STOP; do
  schedule "$signal" 10
  check "SIG$signal to the process that serves" kill -s "$signal" "$(worker)"
  check "it is told that nobody knows" wait_until says "$signal" 'lamp unknown: the connection ended before'
  not_driven
done
schedule unplugged 30 # the node looks for its chips once a second

echo "# unplugging the chip is told, and crashes nobody"
sim_unplug plant
check "it is told that it is cancelled" wait_until says unplugged "lamp cancelled: $not_begun"
check "the driver tells of exception 04" wait_until says driver 'device failure'
check "the node names the line" wait_until says node 'BUTTON'
check "the driver runs" running driver
check "the node runs" running node
check "the driver ends well on SIGINT" stop driver INT
status=0; stop node INT || status=$?
expect "the node ends on SIGINT, with 3: its chip is gone" 3 "$status"

echo "# what was recorded on the chip is played where there is none"
is_heard() { rosnode info /another | grep -A1 'topic: /plant/button$' | grep -q 'to: /rostopic'; }
low=$(grep -c 'data: False' "$(log button)") high=$(grep -c 'data: True' "$(log button)")
start another "$bin/coupler_driver" __name:=another _map:=plant.yaml _address:=127.0.0.1 _port:=1503
check "rostopic hears another driver" wait_until is_heard
play() { start replay "$bin/coupler-node" --sim --replay "$recording" --speed 5 --listen 127.0.0.1 --port 1503; }
play
check "the topic tells that the line was low" wait_until says button 'data: False' $((low + 1))
check "then that it was high" wait_until says button 'data: True' $((high + 1))
check "the node ends with the recording" wait_until ended "$(pid replay)"
# Its last second, which has the exception, may pass while this kernel stands still.
for _ in 1 2 3 4 5; do
  ! within 5 says another 'device failure' || break
  play
  wait_until ended "$(pid replay)" || true
done
check "the driver tells of exception 04 once more" says another 'device failure'
check "the driver ends well on SIGINT" stop another INT
