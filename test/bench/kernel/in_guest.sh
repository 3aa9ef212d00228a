#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Inside the kernel that test/bench/kernel/run starts: a chip, both servers, then the comparison.
set -euo pipefail
build=$(realpath "$1")
bin=$build/bin
# shellcheck source=../../kernel/plant.sh
. "$(dirname "$0")/../../kernel/plant.sh"
sim_create plant 6
plant_node "$(dirname "$0")/map.yaml"
# Resident memory after some work, code and libraries included.
memory() { ps --no-headers -o comm=,rss= -p "$(pid "$1")" --ppid "$(pid "$1")" | awk -v what="$2" '{ printf "# %s: %s %d KiB resident\n", what, $1, $2 }'; }

start floor "$build/test/bin/coupler_bench_line_floor" 1503 "/dev/$(sim_chip plant)" 2 3
check "the floor serves" wait_until 5 says floor serving
check "every level was right" "$build/test/bin/coupler_bench_lines" "/dev/$(sim_chip plant)" "$(dirname "$(sim_wire plant 0)")" "$2"
memory node coupler-node
check "it ends well" stop node
start generated "$build/test/bin/bench_wired_node"
check "the generated node serves" wait_until 5 says generated 'serving plant'
check "and answers" set_coil 0 1
memory generated "generated node"
