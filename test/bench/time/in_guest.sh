#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Inside the kernel that test/bench/time/edges starts: a chip, a node, a driver and the bare chain, then the samples.
#   in_guest.sh BUILD_DIR ROUNDS REACTIONS NS
set -euo pipefail
build=$(realpath "$1")
bin=$build/bin
bench=$build/test/bin
here=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=../../kernel/plant.sh
. "$here/../../kernel/plant.sh"
sim_create plant 8
plant_node "$here/plant.yaml"
plant_master "$build"
start driver "$bin/coupler_driver" _map:="$here/plant.yaml" _timeout:="${patience}s" # a busy machine's node is late
check "the driver connects" wait_until says driver 'connected'
chip=/dev/$(sim_chip plant)
start publisher "$bench/coupler_bench_bare" publisher 1503
check "the bare chain publishes" wait_until says publisher publishing
start sender "$bench/coupler_bench_bare" sender "$chip" 2 1503
check "and hears of edges" wait_until says sender sending
start reaction "$bench/coupler_bench_bare" reaction "$chip" 3 7 "$4"
check "the bare timer waits" wait_until says reaction reacting
wires=$(dirname "$(sim_wire plant 0)")
check "edges are told, each with a stamp that is right" "$bench/coupler_bench_edges" wire "$chip" "$wires" "$2"
check "outputs follow" "$bench/coupler_bench_reaction" "$chip" "$wires" "$3" "$4"
grep timer "$(log reaction)"
