#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The attack list against a node that holds lines of a kernel chip: two processes, a watchdog, a list of clients. Only
# answers, memory and the outputs' levels count: in this kernel attackers, bystander and node share one processor.
#   test/kernel/run --mem 1G test/kernel/attack.sh BUILD_DIR
set -euo pipefail
build=$(realpath "${1:?the build folder}")
cd "$(dirname "$0")"
# shellcheck source=gpio-sim.sh
. ./gpio-sim.sh
sim_create plant 16
expect "the map's chip is there" gpiochip0 "$(sim_chip plant)"
sim_pull plant 0 up # away from its safe state
check "no attack succeeds" ../attack/run --untimed "$build" kept
