#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What a process of the service may do: service.sh runs it in place of the node.
#   sandbox.sh CHIP      CHIP: /dev/gpiochip0
# shellcheck disable=SC2317 # may and may_not call what is here
chip=$1
failures=0

may() { if "${@:2}" 2>/dev/null; then echo "ok - it may $1"; else echo "not ok - it may not $1"; failures=1; fi; }
may_not() { if "${@:2}" 2>/dev/null; then echo "not ok - it may $1"; failures=1; else echo "ok - it may not $1"; fi; }
open_for_both() { (: <>"$1"); }
open_to_read() { (: <"$1"); }
write_to() { (: >"$1"); }
write_number() { echo "$1" >"$2"; }
process_1_is_seen() { [ -e /proc/1/comm ]; }
proc_sys_is_seen() { [ -e /proc/sys ]; }

may "use the chip" open_for_both "$chip"
may "change a PWM channel" write_number 8000 /sys/class/pwm/pwmchip0/pwm0/duty_cycle
may "drive a DAC" write_number 500 /sys/bus/iio/devices/iio:device0/out_voltage0_raw
may_not "change what a driver does" write_number 3 /sys/bus/iio/devices/iio:device0/in_voltage0_offset
may "read its map" open_to_read /etc/coupler/node.yaml
may_not "read another device, although its mode allows it" open_to_read /dev/kernel-log
may_not "write to /etc" write_to /etc/coupler/other
may_not "write to /var" write_to /var/tmp/../lib/other
may_not "see other users' processes" process_1_is_seen
may_not "see the kernel's settings" proc_sys_is_seen
may_not "look into /home" ls /home
may_not "make a namespace" unshare --user true
may_not "change the clock" date --set=now
exit "$failures"
