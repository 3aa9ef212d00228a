#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A firmware whose hooks and lines are written in one request: both or neither, and safe whichever process dies.
#   test/kernel/run test/kernel/hooks.sh BUILD_DIR
set -euo pipefail
bin=$(realpath "${1:?the build folder}")/bin
cd "$(dirname "$0")"
# shellcheck source=plant.sh
. ./plant.sh
plant_chip

set_coils() { answered client -t 0 -r 0 127.0.0.1 -- "$@" >/dev/null; }
hooks_called() { grep -E '^(motor|speed|safe) ' "$(log gate)" | cut -d' ' -f1,2 | paste -sd' '; }

start gate "$bin/gate_firmware"
check "the firmware serves" wait_until says gate 'serving gate'
check "it begins in the process that serves" says gate "^began 0 in $(worker gate)$"
check "what its thread sets is read" wait_until input_is 0 1
sim_pull plant 2 up
check "a line is read beside it" wait_until input_is 1 1
check "and its hook is called, though no client waits for it" wait_until says gate "^button 1 in $(worker gate)$"

echo "# one request, a hook and a line"
sim_pull plant 0 down
refuse "a write that the hook refuses is refused" set_coils 1 1
expect "and its line not driven" 0 "$(sim_value plant 0)"
expect "nor is it kept" 0 "$(coil 0)"
check "the firmware is told a speed" answered client -t 4 -r 0 127.0.0.1 -- 5
check "then the hook accepts" set_coils 1 1
expect "the line is driven, against its pull" 1 "$(sim_value plant 0)"
expect "the hooks were called in that order" "motor 1 speed 5 motor 1" "$(hooks_called)"

echo "# a line drives another one"
sim_pull plant 2 down
check "the hook of the button is called" wait_until says gate "^button 0 in $(worker gate)$"
check "and has driven the brake" wait_until level_is 0 0
expect "clients read that" 0 "$(coil 1)"
check "the brake is put on again" set_coils 1 1

echo "# the process that serves dies"
check "the brake is released" set_coils 1 0
expect "its line is low" 0 "$(sim_value plant 0)"
before=$(worker gate)
kill -KILL "$before"
check "the firmware is made safe" wait_until says gate '^safe 0 in'
refuse "not in the supervisor, which runs no code of a firmware" says gate "^safe 0 in $(pid gate)$"
refuse "nor in the process that died" says gate "^safe 0 in $before$"
check "and drives the brake on, against its pull" wait_until level_is 0 1
check "another process begins" wait_until says gate '^began 0 in' 2
check "what its thread sets is read" wait_until input_is 0 1
expect "the brake has stayed" 1 "$(sim_value plant 0)"

echo "# the process that serves dies during a pulse"
# A pulse that was over before shows nothing, and there is another one.
for died in 2 3 4 5 6; do
  ended=$(grep -c '^horn 0 in' "$(log gate)" || true)
  before=$(worker gate)
  check "the horn sounds" set_coil 2 1
  kill -KILL "$before"
  check "another process begins" wait_until says gate '^began 0 in' $((died + 1))
  says gate "^horn 0 in $before$" || break
done
check "which ends the pulse" wait_until says gate "^horn 0 in $(worker gate)$"
expect "once, and no other process did" $((ended + 1)) "$(grep -c '^horn 0 in' "$(log gate)")"

echo "# a line that cannot be driven"
check "the firmware is told a speed" answered client -t 4 -r 0 127.0.0.1 -- 6
check "both are written" set_coils 1 1
sim_unplug plant
before=$(hooks_called)
refuse "a write to hook and line is refused" set_coils 0 1
expect "and the hook gets its value back" "$before motor 0 motor 1" "$(hooks_called)"
expect "clients read what it was" 1 "$(coil 0)"
check "the hook alone goes on" set_coil 0 0

check "without the chip another process begins" wait_until says gate '^began 0 in' $((died + 2))

echo "# it ends"
before=$(worker gate)
stop gate TERM || true
check "the firmware is made safe, once, by the process that served" says gate "^safe 0 in $before$" 1
expect "and by no other" $((died + 1)) "$(grep -c '^safe 0 in' "$(log gate)")"
