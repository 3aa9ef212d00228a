#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Random trajectories through the driver, actionlib and coupler-node, as a second program sees them on the chip's wires. How
# late the edges are stands beside a program that only waits for a timer.
#   test/kernel/run --mem 1G test/kernel/trajectory.sh BUILD_DIR [COUNT]     COUNT: trajectories (default 20)
set -euo pipefail
export PYTHONUNBUFFERED=1
build=$(realpath "${1:?the build folder}")
bin=$build/bin
cd "$(dirname "$0")"
# shellcheck source=plant.sh
. ./plant.sh
export COUPLER_BUILD_DIR=$build PYTHONDONTWRITEBYTECODE=1
plant_chip
map=$check_folder/plant.yaml
{ cat plant.yaml; echo 'axes: {lamp: {point: lamp}, inverted: {point: inverted}}'; } >"$map"
plant_node "$map"
plant_master "$build"
start driver "$bin/coupler_driver" _map:="$map" _timeout:="${patience}s" # a busy machine's node is late
check "the driver connects" wait_until says driver 'connected'

# timer: how late a bare timer is, in ms
timer() {
  "$build/test/bin/coupler_bench_timer" 300 20000000 | sort -n |
    awk '{ late[NR] = $1 / 1e6 } END { printf "  a bare timer: median %.3f, p99 %.3f, max %.3f\n", late[int(NR / 2)], late[int(NR * 0.99)], late[NR] }'
}
timer
check "each edge comes once, in order, never early" \
  python3 trajectories_in_ros.py "${2:-20}" "$(sim_wire plant 0)" "$(sim_wire plant 1)"
timer
