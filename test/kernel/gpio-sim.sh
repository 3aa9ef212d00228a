# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# Simulated GPIO chips for scripts that test/kernel/run starts. To be sourced; brings checks.sh along:
#   . "$(dirname "$0")/gpio-sim.sh"
#
#   sim_create NAME NUM_LINES [LABEL]   makes a chip (LABEL is NAME if not given) and plugs it in
# or, for a chip with line names or lines that belong to somebody else:
#   sim_define NAME NUM_LINES [LABEL]
#   sim_name NAME LINE LINE_NAME
#   sim_hog NAME LINE input|output-high|output-low [CONSUMER]
#   sim_plug NAME
# then
#   sim_chip NAME                       prints the chip's name (gpiochip0); it may change when it is plugged in again
#   sim_pull NAME LINE up|down          what an input reads, and what a line falls back to that nobody drives
#   sim_value NAME LINE                 prints the level of the wire, 0 or 1 (physical: active-low is not applied)
#   sim_unplug NAME, sim_plug NAME      pulls the chip out, also while it is in use, and plugs it in again; pulls are lost
#   sim_remove NAME                     unplugs and forgets it
#   monitor CHIP LINE                   gpiomon, of libgpiod 1 or 2; to be started, then wait for is_watched CHIP
# A function that cannot do it prints why on stderr and gives 1.
#
# To know when testing: a line that nobody drives falls back to its pull, so to see that something drives it, pull it
# the other way. The simulator merges edges that come within about 5 ms.

# shellcheck source=checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"

sim_folder=/sys/kernel/config/gpio-sim
if [ ! -d "$sim_folder" ]; then
  echo "gpio-sim.sh: this kernel has no gpio-sim; start the script by test/kernel/run" >&2
  exit 1
fi

sim_fail() { echo "gpio-sim.sh: $*" >&2; return 1; }

sim_write() {
  local value=$1 file=$2
  { echo "$value" >"$file"; } 2>/dev/null || sim_fail "the kernel refuses '$value' in $file"
}

sim_known() { [ -d "$sim_folder/$1" ] || sim_fail "there is no chip '$1'; make it with sim_create or sim_define"; }

sim_plugged() { sim_known "$1" && [ "$(cat "$sim_folder/$1/live")" = 1 ]; }

sim_define() {
  local name=$1 lines=$2 label=${3:-$1} bank=$sim_folder/$1/bank0
  [ ! -d "$sim_folder/$name" ] || { sim_fail "there is a chip '$name' already"; return; }
  mkdir -p "$bank" && sim_write "$lines" "$bank/num_lines" && sim_write "$label" "$bank/label"
}

# Makes and prints the folder of a line's settings.
sim_line() {
  local name=$1 line=$2 folder=$sim_folder/$1/bank0/line$2
  sim_known "$name" || return
  ! sim_plugged "$name" || { sim_fail "chip '$name' is plugged in: names and hogs come before sim_plug"; return; }
  [ "$line" -lt "$(cat "$sim_folder/$name/bank0/num_lines")" ] || { sim_fail "chip '$name' has no line $line"; return; }
  mkdir -p "$folder" && echo "$folder"
}

sim_name() {
  local name=$1 line=$2 line_name=$3 folder
  folder=$(sim_line "$name" "$line") && sim_write "$line_name" "$folder/name"
}

sim_hog() {
  local name=$1 line=$2 direction=$3 consumer=${4:-hog} folder
  folder=$(sim_line "$name" "$line")/hog || return
  mkdir -p "$folder" && sim_write "$consumer" "$folder/name" && sim_write "$direction" "$folder/direction"
}

sim_plug() { sim_known "$1" && { sim_plugged "$1" || sim_write 1 "$sim_folder/$1/live"; }; }

sim_unplug() { sim_known "$1" && { ! sim_plugged "$1" || sim_write 0 "$sim_folder/$1/live"; }; }

sim_create() {
  sim_define "$@" && sim_plug "$1"
}

sim_remove() {
  local name=$1
  sim_unplug "$name" || return
  find "$sim_folder/$name" -depth -type d -exec rmdir {} +
}

sim_chip() {
  sim_known "$1" || return
  sim_plugged "$1" || { sim_fail "chip '$1' is unplugged"; return; }
  cat "$sim_folder/$1/bank0/chip_name"
}

# Prints the folder of a line's simulated wire, which only a plugged-in chip has.
sim_wire() {
  local name=$1 line=$2 chip wire
  chip=$(sim_chip "$name") || return
  wire=/sys/devices/platform/$(cat "$sim_folder/$name/dev_name")/$chip/sim_gpio$line
  [ -d "$wire" ] || { sim_fail "chip '$name' has no line $line"; return; }
  echo "$wire"
}

sim_pull() {
  local wire
  case $3 in up | down) ;; *) sim_fail "a pull is up or down, not '$3'"; return ;; esac
  wire=$(sim_wire "$1" "$2") || return
  sim_write "pull-$3" "$wire/pull"
}

sim_value() {
  local wire
  wire=$(sim_wire "$1" "$2") || return
  cat "$wire/value"
}

if [[ $(gpiomon --version 2>/dev/null) == *v1.* ]]; then
  monitor() { exec gpiomon --line-buffered "$1" "$2"; }
  is_watched() { gpioinfo "$1" | grep -q gpiomon; }
else
  monitor() { exec stdbuf -oL gpiomon --chip "$1" "$2"; }
  is_watched() { gpioinfo --chip "$1" | grep -q gpiomon; }
fi
