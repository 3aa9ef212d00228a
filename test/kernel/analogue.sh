#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Registers with channels of the kernel behind them: its example of an IIO device, and a PWM chip. What a client reads is
# compared with the kernel's own files.
#   test/kernel/run test/kernel/analogue.sh BUILD_DIR
set -euo pipefail
bin=$(realpath "${1:?the build folder}")/bin
cd "$(dirname "$0")"
# shellcheck source=plant.sh
. ./plant.sh

device=/sys/bus/iio/devices/iio:device0
dac=$device/out_voltage0_raw
pwm=/sys/class/pwm/pwmchip0/pwm0

plug_adc() { mkdir /sys/kernel/config/iio/devices/dummy/adc; }
unplug_adc() { rmdir /sys/kernel/config/iio/devices/dummy/adc; }
# mbpoll shows a register above 32767 as "65490 (-46)".
input_register() { answered client -t 3 -r "$1" -c 1 127.0.0.1 | sed -nE 's/^\[[0-9]+\]:[[:space:]]*([0-9]+)( \((-[0-9]+)\))?.*/\1 \3/p' | awk '{ print $NF }'; }
input_float() { answered client -t 3:float -B -r "$1" -c 1 127.0.0.1 | sed -nE 's/^\[[0-9]+\]:[[:space:]]*([0-9.e+-]+).*/\1/p'; }
set_registers() { answered client -t 4:hex -r "$1" 127.0.0.1 "${@:2}" >/dev/null; }
set_real() { answered client -t 4:float -B -r "$1" 127.0.0.1 -- "$2" >/dev/null; }
refused_with() {
  local said
  said=$(answered client -t 4:hex -r "$2" 127.0.0.1 "${@:3}") && return 1
  grep -qi "$1" <<<"$said"
}
# What the kernel says of a channel, in the register's unit.
physical() { awk -v raw="$(cat "$device/$1_raw")" -v offset="$2" -v scale="$3" -v unit="$4" 'BEGIN { printf "%.0f", (raw + offset) * scale / 1000 / unit }'; }
shown() { echo "$(cat $pwm/duty_cycle) of $(cat $pwm/period), $(cat $pwm/enable)"; }
shown_is() { [ "$(shown)" = "$1" ]; }
dac_is() { [ "$(cat $dac)" = "$1" ]; }
steps_are() { [ "$(input_register 4)" = "$1" ]; }
input_is_gone() { ! answered client -t 3 -r 0 -c 1 127.0.0.1 >/dev/null; }

# Reads two of the PWM's files as fast as it can and tells each change. "armed" comes first.
watch_pwm() {
  exec python3 -u -c '
import sys
files = [open(name) for name in sys.argv[1:]]
def values():
    for file in files:
        file.seek(0)
    return [file.read().strip() for file in files]
before = values()
print("armed")
while True:
    now = values()
    if now != before:
        print("changed", before, now)
    before = now
' $pwm/period $pwm/enable
}

echo "# a map whose channels are not there"
status=0
"$bin/coupler-node" analogue.yaml >"$check_folder/absent.log" 2>&1 || status=$?
cat "$check_folder/absent.log"
expect "ends the start with 3" 3 "$status"
check "and says what is missing" grep -q "point 'volts': there is no IIO device 'adc'" "$check_folder/absent.log"
expect "the PWM does not run" 0 "$(cat $pwm/enable)"
plant_chip
sed 's/^mapping:/&\n  coils:\n    lamp: {address: 0, line: {chip: plant, offset: 0}, initial: on}/' analogue.yaml >"$check_folder/lamp.yaml"
refuse "a map with a line ends the start too" "$bin/coupler-node" "$check_folder/lamp.yaml" 2>"$check_folder/lamp.log"
check "for the same reason" grep -q "point 'volts'" "$check_folder/lamp.log"
check "and the line was not driven" grep -qw input < <(gpioinfo | awk '/line +0:/')

plug_adc
echo 77 >$dac
sed 's/voltage0/voltage9/; s/chip: fan/chip: fun/' analogue.yaml >"$check_folder/wrong.yaml"
refuse "a channel that the device does not have ends the start" "$bin/coupler-node" "$check_folder/wrong.yaml" 2>"$check_folder/wrong.log"
cat "$check_folder/wrong.log"
check "with those that it has" grep -q "'voltage9'; it has .*voltage0, .*voltage1-voltage2" "$check_folder/wrong.log"
check "and the PWM chips that there are" grep -q "this machine has pwmchip0 (fan) with 1 channel" "$check_folder/wrong.log"
expect "outputs were not touched" "77" "$(cat $dac)"

echo "# inputs"
plant_node analogue.yaml
expect "the DAC has its initial value" 0 "$(cat $dac)"
expect "the PWM too" "0 of 40000, 1" "$(shown)"
scale=$(cat $device/in_voltage0_scale) offset=$(cat $device/in_voltage0_offset)
wanted=$(physical in_voltage0 "$offset" "$scale" 1e-9)
got=$(input_float 0)
echo "# kernel: $wanted nV; register: $got V"
check "a REAL has the channel's volts" awk -v got="$got" -v wanted="$wanted" 'BEGIN { exit !(got * 1e9 > wanted * 0.999 && got * 1e9 < wanted * 1.001) }'
scale=$(cat $device/in_voltage-voltage_scale)
expect "a scaled INT too, with the scale that channels share" "$(physical in_voltage1-voltage2 0 "$scale" 1e-9)" "$(input_register 2)"
expect "below zero as well" "$(physical in_voltage3-voltage4 0 "$scale" 1e-9)" "$(input_register 3)"
expect "a processed channel is read as it is" "$(cat $device/in_steps_input)" "$(input_register 4)"
echo 1 >$device/in_steps_en
echo 123 >$device/in_steps_input
check "and followed" wait_until steps_are 123

echo "# outputs"
check "a voltage is written" set_real 0 1.25
expect "the DAC has it, in mV" 1250 "$(cat $dac)"
check "a duty cycle is written" set_registers 2 250
expect "the PWM has it" "10000 of 40000, 1" "$(shown)"
check "both are written at once" set_registers 0 0x3F00 0 1000 8
expect "and driven" "500 40000 of 40000, 1" "$(cat $dac) $(shown)"
check "100.1 % is refused with exception 03" refused_with 'illegal data value' 0 0x3F80 0 1001
check "a voltage that is not a number too" refused_with 'illegal data value' 0 0x7FC0 0
check "half a voltage with exception 02" refused_with 'illegal data address' 1 0
expect "and nothing of it is driven" "500 40000 of 40000, 1" "$(cat $dac) $(shown)"
check "nor stored" [ "$(answered client -t 4:hex -r 0 -c 4 127.0.0.1 | grep -oE '0x[0-9A-F]+' | tr '\n' ' ')" = "0x3F00 0x0000 0x03E8 0x0008 " ]

echo "# the worker process dies"
start watch watch_pwm
check "period and enable of the PWM are watched" wait_until says watch armed
before=$(worker)
kill -KILL "$before"
check "the outputs are in their safe state" wait_until shown_is "12000 of 40000, 1"
check "all of them" wait_until dac_is 0
check "another worker process is started" wait_until new_worker "$before"
check "its registers show it" wait_until refused_with 'illegal data value' 2 1001
expect "in the point's scale" 300 "$(register 2)"
check "inputs are sampled again" wait_until steps_are 123
check "the PWM works" set_registers 2 500

echo "# the service is started anew"
check "it ends well" stop node TERM
expect "in its safe state" "12000 of 40000, 1" "$(shown)"
cp analogue.yaml "$check_folder/live.yaml"
plant_node "$check_folder/live.yaml"
check "and takes the PWM over, at its initial value" wait_until shown_is "0 of 40000, 1"

echo "# the map is read again"
read_again() { kill -HUP "$(pid node)" && wait_until says node "$1" "${2:-1}"; }
check "outputs are written" wait_until set_registers 0 0x3E80 0 250
sed -i 's/initial: 5/initial: 6/; s/units: V/units: volt/' "$check_folder/live.yaml"
check "another map is taken" read_again 'read the map again'
expect "outputs that it has, too, stay" "250 10000 of 40000, 1" "$(cat $dac) $(shown)"
check "inputs are sampled" wait_until steps_are 123
cp "$check_folder/live.yaml" "$check_folder/good.yaml"
sed -i 's/device: adc, channel: steps/device: adc, channel: stops/' "$check_folder/live.yaml"
check "one with a channel that is not there is refused" read_again 'the new map is refused'
expect "and the old one goes on" "250 10000 of 40000, 1" "$(cat $dac) $(shown)"
sed '/fan:/d' "$check_folder/good.yaml" >"$check_folder/live.yaml"
check "one without the PWM is taken" read_again 'read the map again' 2
expect "the PWM goes to its safe state, others stay" "250 12000 of 40000, 1" "$(cat $dac) $(shown)"
cp "$check_folder/good.yaml" "$check_folder/live.yaml"
check "it comes back" read_again 'read the map again' 3
expect "at its initial value" "0 of 40000, 1" "$(shown)"
stop watch KILL || true
refuse "period and enable never moved" says watch changed

echo "# unplugged"
check "a voltage is written" set_real 0 0.25
unplug_adc
check "an input that is gone is an exception 04" wait_until input_is_gone
refuse "so is the output" set_real 0 1
check "others are served" [ "$(input_register 5)" = 7 ]
check "the PWM as well" set_registers 2 250
cp "$(log node)" "$check_folder/before"
for _ in 1 2 3; do input_float 0 >/dev/null 2>&1 || true; done
check "what happened was said once" cmp "$(log node)" "$check_folder/before"
check "for each channel that was asked for" [ "$(grep -c 'iio:device0 (adc) .* failed: No such device' "$(log node)")" = 2 ]
echo "# plugged in again"
plug_adc
check "the input works" wait_until input_register 4
check "the output has its value again" wait_until dac_is 250
check "and takes another" wait_until set_real 0 0.5
expect "which it shows" 500 "$(cat $dac)"
expect "the PWM was left alone" "10000 of 40000, 1" "$(shown)"
before=$(worker)
sleep 3
expect "nothing is found again that nobody asks for" "$before" "$(worker)"
unplug_adc
stop node TERM || true
cat "$(log node)"
check "what cannot be driven at the end is said" says node 'not every output could be driven to its safe state'

echo "# simulated"
plant_node analogue.yaml --sim
check "an input keeps its initial value" [ "$(input_register 4)" = 0 ]
check "a PWM takes 100 %" set_registers 2 1000
refuse "and no more" set_registers 2 1001
stop node TERM
