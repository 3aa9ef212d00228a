# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# The chip of plant.yaml and a Modbus client, for the tests that run the project's programs. To be sourced:
#   plant_chip                 makes the chip "plant" with 8 lines; line 2 is BUTTON, line 6 belongs to "hog-a"
#   plant_node MAP [ARGS…]     starts the node with a map and waits until it serves
#   plant_master BUILD_DIR     starts a ROS master, and makes the build's messages and programs known to this shell
#   worker [NAME]              prints the id of the process that answers for the node (or NAME, as it was started)
#   new_worker ID              there is one, and it is not that one
#   input N, coil N            prints 0 or 1, as mbpoll reads it
#   set_coil N 0|1             writes it
#   watch_wires LINE…          tells each change of these wires; to be started, then wait for it to say "armed"
# A request that is answered with an exception fails and prints mbpoll's text.

# shellcheck source=gpio-sim.sh
. "$(dirname "${BASH_SOURCE[0]}")/gpio-sim.sh"

plant_chip() {
  sim_define plant 8
  sim_name plant 2 BUTTON
  sim_hog plant 6 output-low hog-a
  sim_plug plant
}

plant_master() {
  set +u
  # shellcheck disable=SC1091
  . "$1/devel/setup.bash"
  set -u
  # roscore gives its master 10 s to start, which this kernel may need on a busy machine.
  start core "$(dirname "${BASH_SOURCE[0]}")/../support/ros-master" 11311
  check "a ROS master answers" wait_until says core http://
}

plant_node() {
  start node "$bin/coupler-node" "$@"
  check "the node serves" wait_until says node 'serving plant'
}

worker() { pgrep -P "$(pid "${1:-node}")" -x coupler-node-io; }
new_worker() { local now; now=$(worker) && [ "$now" != "$1" ] && [[ "$(cat "/proc/$now/stat")" != *" Z "* ]]; }

client() { mbpoll -m tcp -a 1 -0 -1 -q -o 10 -p 1502 "$@"; }

# mbpoll reports a failed request on stderr and exits with 0 all the same.
answered() {
  local output
  output=$("$@" 2>&1)
  if grep -q 'failed' <<<"$output"; then
    echo "$output"
    return 1
  fi
  echo "$output"
}

read_one() { answered client -t "$1" -r "$2" -c 1 127.0.0.1 | sed -nE 's/^\[[0-9]+\]:[[:space:]]*(-?[0-9]+).*/\1/p'; }
input() { read_one 1 "$1"; }
coil() { read_one 0 "$1"; }
register() { read_one 4 "$1"; }
set_coil() { answered client -t 0 -r "$1" 127.0.0.1 -- "$2" >/dev/null; }
input_is() { [ "$(input "$1")" = "$2" ]; }
level_is() { [ "$(sim_value plant "$1")" = "$2" ]; }

# Reads the wires of lines as fast as it can and tells each change. "armed" comes first. To be started.
watch_wires() {
  local line files=()
  for line in "$@"; do files+=("$(sim_wire plant "$line")/value"); done
  exec python3 -u -c '
import sys
files = [open(name, "rb", buffering=0) for name in sys.argv[1:]]
def levels():
    for file in files:
        file.seek(0)
    return [file.read(1) for file in files]
before = levels()
print("armed")
while True:
    now = levels()
    if now != before:
        print("changed", before, now)
    before = now
' "${files[@]}"
}
