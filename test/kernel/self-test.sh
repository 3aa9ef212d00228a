#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves that the test kernel and gpio-sim.sh do what tests of the project's programs rely on:
#   test/kernel/run test/kernel/self-test.sh
# Uses only Debian's gpiod tools, of libgpiod 1 or 2.
set -euo pipefail
# shellcheck source=gpio-sim.sh
. "$(dirname "$0")/gpio-sim.sh"

# The tools of libgpiod 2 take the chip by an option, and read at once only with numeric output asked for.
if [[ $(gpioget --version) == *v1.* ]]; then
  get() { gpioget "$1" "$2"; }
  drive() { exec gpioset --mode=signal "$1" "$2"; }
else
  get() { gpioget --numeric --chip "$1" "$2"; }
  drive() { exec gpioset --chip "$1" "$2"; }
fi
sees() { "${@:2}" | grep -- "$1" >/dev/null; }
wire_is() { [ "$(sim_value "$1" "$2")" = "$3" ]; }

read -r _ _ turns </proc/self/schedstat
check "the kernel counts how long a process waits for the CPU" [ "$turns" -gt 0 ]

sim_create plain 8
check "gpiodetect lists the chip by its label" sees "$(sim_chip plain) \[plain\] (8 lines)" gpiodetect

for level in 1 0 1; do
  if [ "$level" = 1 ]; then sim_pull plain 3 up; else sim_pull plain 3 down; fi
  expect "an input reads $level when pulled so" "$level" "$(get "$(sim_chip plain)" 3)"
done

sim_pull plain 5 down
start output drive "$(sim_chip plain)" 5=1
check "a driven output is seen on the wire against its pull" wait_until wire_is plain 5 1
refuse "a line that is in use is refused to another" get "$(sim_chip plain)" 5
stop output KILL || true
check "a line that nobody drives any more falls back to its pull" wait_until wire_is plain 5 0

start edges monitor "$(sim_chip plain)" 0
check "gpiomon watches the line" wait_until is_watched "$(sim_chip plain)"
for _ in 1 2 3 4 5; do sim_pull plain 0 up; sleep 0.02; sim_pull plain 0 down; sleep 0.02; done
check "five pulses are ten edges" wait_until says edges '.' 10
check "five of them rise" says edges '(rising|RISING)' 5
check "five fall" says edges '(falling|FALLING)' 5
refuse "no more were reported" says edges '.' 11
sim_create other 2
check "a second chip stands beside the first" sees "\[other\] (2 lines)" gpiodetect
stop edges INT || true

sim_define named 4 "plant-1"
sim_name named 2 "pump"
sim_hog named 3 output-high "somebody"
sim_plug named
check "a line has its name" sees '"\?pump"\?' gpioinfo
check "a hogged line has its consumer" sees '"\?somebody"\?' gpioinfo
expect "a hogged line is driven" 1 "$(sim_value named 3)"

chip=$(sim_chip plain)
start held drive "$chip" 6=1
check "an output is held before the chip is unplugged" wait_until wire_is plain 6 1
check "a chip in use can be unplugged" timeout 60 bash -c "echo 0 >$sim_folder/plain/live"
status=0; timeout 60 "$BASH" -c "$(declare -f get); get $chip 3" || status=$?
refuse "reading an unplugged chip does not hang" test "$status" = 124
refuse "reading an unplugged chip is an error" test "$status" = 0
refuse "an unplugged chip has no name" sim_chip plain
refuse "an unplugged chip has no wire" sim_value plain 3
sim_plug plain
check "the chip comes back while its old lines are still held" sees "$(sim_chip plain) \[plain\]" gpiodetect
sim_pull plain 3 up
expect "the chip works again" 1 "$(get "$(sim_chip plain)" 3)"
stop held INT || true

sim_remove plain
sim_remove other
sim_remove named
expect "removed chips are gone" "" "$(gpiodetect)"
refuse "a chip that does not exist is refused" sim_pull plain 0 up
