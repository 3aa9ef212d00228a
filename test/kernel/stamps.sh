#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Changes of inputs have the time stamps of the kernel: lines of a simulated chip are pulled at known times, and what
# the node's lines tell is compared, through a debounce period too.
#   test/kernel/run test/kernel/stamps.sh BUILD_DIR
set -euo pipefail
program=$(realpath "${1:?the build folder}")/test/bin/edge_stamps
cd "$(dirname "$0")"
# shellcheck source=gpio-sim.sh
. ./gpio-sim.sh
sim_create plant 4
check "each change has the time of its edge" "$program" \
  "$(sim_wire plant 0)" "$(sim_wire plant 1)" "$(sim_wire plant 2)" "$(sim_wire plant 3)"
