#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# coupler-node on a chip of the kernel, with mbpoll as the client.
#   test/kernel/run test/kernel/node.sh BUILD_DIR
set -euo pipefail
bin=$(realpath "${1:?the build folder}")/bin
cd "$(dirname "$0")"
# shellcheck source=plant.sh
. ./plant.sh
plant_chip

echo "# lines follow, both ways; a link to the chip, as Raspberry Pi OS has one, is no second chip"
ln -s "$(sim_chip plant)" /dev/gpiochip99
sed 's#chip: plant, offset: 0#chip: /dev/gpiochip99, offset: 0#' plant.yaml >"$check_folder/linked.yaml"
plant_node "$check_folder/linked.yaml"
for level in up down up; do
  sim_pull plant 2 "$level"
  check "pulling a line $level shows in its input" wait_until input_is 0 "$([ "$level" = up ] && echo 1 || echo 0)"
done
sim_pull plant 3 down
check "an active-low input is on while its line is low" wait_until input_is 1 1
sim_pull plant 3 up
check "and off while it is high" wait_until input_is 1 0

sim_pull plant 0 down
check "a coil is written" set_coil 0 1
expect "its line is driven, against its pull" 1 "$(sim_value plant 0)"
expect "it reads back" 1 "$(coil 0)"
sim_pull plant 0 up
check "a coil is cleared" set_coil 0 0
expect "its line is driven low, against its pull" 0 "$(sim_value plant 0)"
sim_pull plant 1 down
expect "an active-low output that is off is high, against its pull" 1 "$(sim_value plant 1)"
check "an active-low coil is written" set_coil 1 1
sim_pull plant 1 up
expect "its line is low, against its pull" 0 "$(sim_value plant 1)"

echo "# debounce"
wire=$(sim_wire plant 4)/pull
# A level that lasted since this program was kept waiting is another one, and there is another round.
for _ in {1..20}; do
  slowest=0
  for _ in 1 2 3 4 5; do
    begun=$(microseconds)
    for level in up down; do echo "pull-$level" >"$wire"; sleep 0.03; done
    took=$(($(microseconds) - begun))
    slowest=$((took > slowest ? took : slowest))
  done
  seen=$(input 2)
  [ "$slowest" -ge 900000 ] || break
  wait_until input_is 2 0
done
expect "a level that does not last is not seen" 0 "$seen"
sim_pull plant 4 up
check "one that lasts is" wait_until input_is 2 1

echo "# who holds a line is named"
sed 's/chip: plant, offset: 0/chip: plant, offset: 6/' plant.yaml >"$check_folder/busy.yaml"
status=0
"$bin/coupler-node" "$check_folder/busy.yaml" --port 1503 >"$check_folder/busy.log" 2>&1 || status=$?
cat "$check_folder/busy.log"
expect "a busy line ends the start with 3" 3 "$status"
check "the message names the chip" grep -q 'plant\|gpiochip' "$check_folder/busy.log"
check "the line" grep -qE 'line 6' "$check_folder/busy.log"
check "and its holder" grep -q 'hog-a' "$check_folder/busy.log"
sed 's/BUTTON/BOTTON/' plant.yaml >"$check_folder/missing.yaml"
refuse "a line that no chip has ends the start" "$bin/coupler-node" "$check_folder/missing.yaml" --port 1503

echo "# unplugged"
sim_unplug plant
refuse "reading an input fails" input 0
said=$(answered client -t 1 -r 0 -c 1 127.0.0.1 2>&1) || true
check "with exception 04, which mbpoll calls a server failure" grep -qi 'device or server failure' <<<"$said"
refuse "writing a coil fails" set_coil 0 1
expect "registers are served as before" 7 "$(register 0)"
expect "coils without a line too" 0 "$(coil 2)"
check "the node runs" running node
# libgpiod 1 wants a request for each polarity of outputs; the inputs, which are watched for edges, report together.
if [[ $(gpiomon --version) == *v1.* ]]; then requests=3; else requests=2; fi
check "and tells what happened, of each request to the kernel" wait_until says node 'failed: No such device' $requests
cp "$(log node)" "$check_folder/before"
for _ in 1 2 3; do input 0 >/dev/null 2>&1 || true; done
check "once, not at each request" cmp "$(log node)" "$check_folder/before"
status=0; stop node TERM || status=$?
expect "it ends on SIGTERM, with 3: its outputs are not safe" 3 "$status"
cat "$(log node)"
