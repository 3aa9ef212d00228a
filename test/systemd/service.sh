#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The package's life on a running system: installed, refused without a map, started, attacked by signals, stopped, purged.
#   test/kernel/run --systemd --root DEBIAN test/systemd/service.sh PACKAGE
set -euo pipefail
package=$(realpath "${1:?the .deb}")
cd "$(dirname "$0")"
# shellcheck source=../kernel/plant.sh
. ../kernel/plant.sh
readonly unit=coupler-node.service

client() { mbpoll -m tcp -a 1 -0 -1 -q -o 10 -p 502 "$@"; }
# Prints what a command says only if it fails.
quietly() { local output; output=$("$@" 2>&1) || { echo "$output"; return 1; }; }
property() { systemctl show --value -p "$1" "$unit"; }
is() { [ "$(property "$1")" = "$2" ]; }
in_journal() { grep -qE -- "$1" <<<"$(journalctl -u "$unit" -o cat --no-pager "${@:2}")"; }
supervisor() { property MainPID; }
worker() { pgrep -P "$(supervisor)" -x coupler-node-io; }
of_process() { sed -nE "s/^$2:[[:space:]]*(.*)/\1/p" "/proc/$1/status"; }
serves() { answered client -t 1 -r 0 -c 1 127.0.0.1 >/dev/null; }
times_made_safe() { journalctl -u "$unit" -o cat --no-pager | grep -cE '^(Terminated|the supervisor, .* ends with it): outputs are in their safe state' || true; }
made_safe() { [ "$(times_made_safe)" = "$1" ]; }
is_another() { [ "$(property MainPID)" != "$1" ] && is ActiveState active && serves; }
mode_of_chip() { stat -c '%U:%G %a' "/dev/$(sim_chip plant)"; }
mode_is() { [ "$(mode_of_chip)" = "$1" ]; }

expect "systemd is process 1" systemd "$(cat /proc/1/comm)"
expect "and the system is up" running "$(systemctl is-system-running --wait)"
plant_chip
mkdir /sys/kernel/config/iio/devices/dummy/adc
expect "a chip is root's" "root:root 600" "$(mode_of_chip)"

echo "# installed"
check "dpkg installs the package" quietly dpkg -i "$package"
check "the chip that was there is given to group gpio" wait_until mode_is "root:gpio 660"
sim_unplug plant
sim_plug plant
check "and so is one that comes later" wait_until mode_is "root:gpio 660"
# That of Raspberry Pi OS, for gpiochip4: one event of the chip makes the link, the next one takes it away.
mkdir -p /run/udev/rules.d
echo 'SUBSYSTEM=="gpio", KERNEL=="gpiochip*", PROGRAM="/usr/bin/test ! -c /dev/gpiochip99", SYMLINK+="gpiochip99"' \
  >/run/udev/rules.d/60-link.rules
udevadm settle
udevadm control --reload
udevadm trigger "/dev/$(sim_chip plant)"
udevadm settle
check "a rule links to the chip" test -c /dev/gpiochip99
check "dpkg installs the package once more" quietly dpkg -i "$package"
udevadm settle
check "the link stays" test -c /dev/gpiochip99
expect "the service is not enabled" disabled "$(systemctl is-enabled "$unit" || true)"
systemctl start "$unit"
expect "without a map it does not start" "inactive no" "$(property ActiveState) $(property ConditionResult)"

echo "# a map that is wrong"
echo 'name: [' >/etc/coupler/node.yaml
refuse "it does not start" quietly systemctl start "$unit"
expect "and is not tried again" "failed 0" "$(property ActiveState) $(property NRestarts)"
check "the journal says where the map is wrong" wait_until in_journal 'node\.yaml:[0-9]+:[0-9]+: error: '

echo "# started"
cp node.yaml /etc/coupler/node.yaml
check "it starts, and systemd is told when it serves" quietly systemctl enable --now "$unit"
expect "the service is active" "active running" "$(property ActiveState) $(property SubState)"
check "it says what it serves" [ "$(property StatusText | grep -c 'serving plant .* on .*:502')" -eq 1 ]
for process in "$(supervisor)" "$(worker)"; do
  name=$(cat "/proc/$process/comm")
  expect "$name is the user coupler" coupler "$(stat -c %U "/proc/$process")"
  check "$name is in group gpio" grep -qw "$(getent group gpio | cut -d: -f3)" <<<"$(of_process "$process" Groups)"
  expect "$name may bind port 502 and nothing else that root may" 0000000000000400 "$(of_process "$process" CapEff)"
  expect "$name can gain nothing" "0000000000000400 1" "$(of_process "$process" CapBnd) $(of_process "$process" NoNewPrivs)"
  resident=$(of_process "$process" VmRSS)
  check "$name has at most 6 MiB resident: $resident" test "${resident% kB}" -le 6144
  expect "$name has a filter of system calls" 2 "$(of_process "$process" Seccomp)"
done
check "it answers on port 502" wait_until serves
sim_pull plant 2 up
check "an input of the chip is read" wait_until input_is 0 1
sim_pull plant 0 up
sim_pull plant 1 down
check "an output is written" set_coil 0 0
check "and another" set_coil 1 1
expect "the chip has them" "0 1" "$(sim_value plant 0) $(sim_value plant 1)"
fan=/sys/class/pwm/pwmchip0/pwm0/duty_cycle
dac=/sys/bus/iio/devices/iio:device0/out_voltage0_raw
check "a PWM channel is written" answered client -t 4 -r 2 127.0.0.1 -- 500
expect "the chip has it, in ns" 20000 "$(cat "$fan")"
check "a DAC channel is written" answered client -t 4:float -B -r 0 127.0.0.1 -- 1.25
expect "the device has it, in mV" 1250 "$(cat "$dac")"
check "an IIO channel is read" answered client -t 3 -r 1 -c 1 127.0.0.1

echo "# reloaded"
before=$(supervisor)
sed 's/^  coils:/&\n    spare: 5/' node.yaml >/etc/coupler/node.yaml
check "systemd passes it on" systemctl reload "$unit"
check "a point that is new is served at once" set_coil 5 1
check "the journal tells" wait_until in_journal '^read the map again: serving plant \(8 points'
echo 'name: [' >/etc/coupler/node.yaml
refuse "a reload with a wrong map fails" systemctl reload "$unit"
check "the map is refused" wait_until in_journal '^the new map is refused; the old one stays in force'
expect "the service is as active as before" "active running" "$(property ActiveState) $(property SubState)"
check "and serves the map that it had" set_coil 5 0
expect "outputs are as they were" "0 1" "$(sim_value plant 0) $(sim_value plant 1)"
expect "by the same supervisor" "$before" "$(supervisor)"
cp node.yaml /etc/coupler/node.yaml

echo "# upgraded to a version that refuses the map, without udev"
echo 'name: [' >/etc/coupler/node.yaml
mv /usr/bin/udevadm /usr/bin/udevadm.away
check "dpkg installs the package all the same" quietly dpkg -i "$package"
mv /usr/bin/udevadm.away /usr/bin/udevadm
expect "it is configured" "install ok installed" "$(dpkg-query -W -f '${Status}' coupler-node)"
expect "the service has failed" failed "$(property ActiveState)"
cp node.yaml /etc/coupler/node.yaml
check "with a good map it starts again" quietly systemctl start "$unit"
check "and serves" wait_until serves

echo "# the sandbox, from inside"
install sandbox.sh /usr/local/bin/probe-sandbox # this tree may be in /tmp, which the service does not see
mknod -m 666 /dev/kernel-log c 1 11
sed -E '/^(Condition|Watchdog|Restart|StartLimit)/d; s/^Type=.*/Type=oneshot/; s#^ExecStart=.*#ExecStart=/usr/local/bin/probe-sandbox '"/dev/$(sim_chip plant)"'#' \
  "/usr/lib/systemd/system/$unit" >/run/systemd/system/sandbox.service
systemctl daemon-reload
check "it keeps what it promises" systemctl start sandbox.service
journalctl -u sandbox.service -o cat --no-pager | grep -E '^(not )?ok' || true

echo "# ahead of other programs"
drop_in=/run/systemd/system/$unit.d
mkdir "$drop_in"
cp /usr/share/doc/coupler-node/examples/realtime.conf "$drop_in"
systemctl daemon-reload
check "with realtime.conf it starts" quietly systemctl restart "$unit"
check "and serves" wait_until serves
is_locked() { [ "$(of_process "$1" VmLck)" != "0 kB" ]; }
policy_of() { chrt -p "$1" | sed -n 's/.*policy: //p; s/.*priority: //p' | paste -sd ' '; }
expect "the supervisor has real-time priority" "SCHED_FIFO|SCHED_RESET_ON_FORK 11" "$(policy_of "$(supervisor)")"
expect "so has the worker process" "SCHED_FIFO|SCHED_RESET_ON_FORK 10" "$(policy_of "$(worker)")"
check "the supervisor's memory is locked" is_locked "$(supervisor)"
check "so is the worker process's" is_locked "$(worker)"
rm -r "$drop_in"
systemctl daemon-reload
check "without it, it starts again" quietly systemctl restart "$unit"
check "and serves" wait_until serves

echo "# with TLS"
# certify NAME EXTENSION…: NAME.pem and NAME.key
certify() {
  local name=$1
  shift
  openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -keyout "$name.key" -out "$name.csr" -subj "/CN=$name"
  openssl x509 -req -in "$name.csr" -CA ca.pem -CAkey ca.key -CAcreateserial -days 700 -out "$name.pem" \
    -extfile <(printf '%s\n' basicConstraints=CA:FALSE "$@")
}
make_certificates() {
  openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -keyout ca.key -out ca.pem -days 3650 \
    -subj /CN=plant -addext keyUsage=critical,keyCertSign,cRLSign
  certify node extendedKeyUsage=serverAuth subjectAltName=IP:127.0.0.1
  certify cell1 extendedKeyUsage=clientAuth 1.3.6.1.4.1.50316.802.1=ASN1:UTF8String:operator
}
# Reads coil 0 by TLS: all of the reply but the coil.
reply_by_tls() {
  coproc timeout 60 openssl s_client -quiet -verify_quiet -verify_return_error -connect 127.0.0.1:802 \
    -cert cell1.pem -key cell1.key -CAfile ca.pem
  local replies s_client=$COPROC_PID
  exec {replies}<&"${COPROC[0]}" # a pipeline's processes do not have those of a coprocess
  printf '\0\1\0\0\0\6\1\1\0\0\0\1' >&"${COPROC[1]}"
  head -c 9 <&"$replies" | od -An -tx1 | tr -d ' '
  exec {replies}<&-
  kill "$s_client"
}
serves_tls() { [ "$(cd /etc/coupler && reply_by_tls 2>/dev/null)" = 000100000004010101 ]; }
# with_key PATH: the map, with TLS.
with_key() {
  sed "s#^mapping:#security: {certificate: node.pem, key: $1, ca: ca.pem, plain: operator, roles: {operator: {read: all, write: all}}}\n&#" \
    node.yaml >/etc/coupler/node.yaml
}
check "OpenSSL makes certificates" quietly eval 'cd /etc/coupler && make_certificates'
with_key node.key
refuse "a reload with a key of root's fails" systemctl reload "$unit"
check "the journal says which file, and why" wait_until in_journal "'security': the key .*node\.key cannot be read: Permission denied"
check "clients without TLS are served as before" serves
chgrp coupler /etc/coupler/node.key
chmod 640 /etc/coupler/node.key
check "with one that the service's group may read it succeeds" systemctl reload "$unit"
check "a client with a certificate is answered on port 802" wait_until serves_tls
tls=$(pgrep -P "$(supervisor)" -x coupler-tls)
expect "the process that does TLS is the user coupler" coupler "$(stat -c %U "/proc/$tls")"
expect "it may not even bind port 502" 0000000000000000 "$(of_process "$tls" CapEff)"
expect "it has a filter of system calls and can gain nothing" "2 1" "$(of_process "$tls" Seccomp) $(of_process "$tls" NoNewPrivs)"
check "clients without TLS are served, too" serves
chown root:root /etc/coupler/node.key
chmod 600 /etc/coupler/node.key
with_key "/run/credentials/$unit/node.key"
mkdir "$drop_in"
sed -n 's/^#LoadCredential=/[Service]\n&/p' "/usr/lib/systemd/system/$unit" | sed 's/^#//' >"$drop_in/key.conf"
systemctl daemon-reload
check "with LoadCredential a key of root's will do" quietly systemctl restart "$unit"
check "a client with a certificate is answered" wait_until serves_tls
rm -r "$drop_in"
cp node.yaml /etc/coupler/node.yaml
systemctl daemon-reload
check "without, it starts again" quietly systemctl restart "$unit"
check "and serves" wait_until serves

echo "# the worker process dies"
before=$(supervisor)
kill -KILL "$(worker)"
check "the supervisor starts another" wait_until serves
expect "systemd has nothing to do" "$before 0" "$(supervisor) $(property NRestarts)"
expect "outputs are safe" "1 0" "$(sim_value plant 0) $(sim_value plant 1)"

echo "# the supervisor dies"
check "an output is written" set_coil 0 0
said=$(times_made_safe)
# The worker process hears of it from the kernel and is faster than systemd, if it can run.
cgroup=/sys/fs/cgroup$(property ControlGroup)
mkdir -p "/run/systemd/system/$unit.d"
printf '[Service]\nTimeoutStopSec=180s\n' >"/run/systemd/system/$unit.d/patient.conf" # this machine may stand still
systemctl daemon-reload
echo 1 >"$cgroup/cgroup.freeze"
check "the worker process cannot run" wait_until grep -qx 'frozen 1' "$cgroup/cgroup.events"
kill -KILL "$before"
check "systemd waits for it" wait_until is SubState stop-sigterm
echo 0 >"$cgroup/cgroup.freeze" || true
rm "/run/systemd/system/$unit.d/patient.conf"
systemctl daemon-reload
check "systemd starts both again" wait_until is_another "$before"
check "the worker process has driven the safe state before" wait_until made_safe $((said + 1))
expect "once" 1 "$(property NRestarts)"

echo "# the supervisor is stopped: nobody watches the worker process any more"
before=$(supervisor)
kill -STOP "$before"
check "the worker process serves meanwhile" serves
check "the worker process notices, and systemd starts both again" within 120 is_another "$before"
check "the journal tells why" wait_until in_journal '^the supervisor, process [0-9]+, was silent for 5 s and is killed'

echo "# stopped"
check "an output is written" set_coil 0 0
sim_pull plant 0 down
said=$(times_made_safe)
check "systemctl stop succeeds" systemctl stop "$unit"
expect "with success" "inactive success 0" "$(property ActiveState) $(property Result) $(property ExecMainStatus)"
check "it says that outputs are in their safe state, once" wait_until made_safe $((said + 1))
refuse "no process is left" pgrep coupler-node
refuse "no line in the journal repeats name or priority" in_journal '^(<[0-9]>|coupler-node: )'
check "what is wrong is in the journal as an error" in_journal 'error: ' -p err
echo "# the journal of the service:"
journalctl -u "$unit" -o short-monotonic --no-pager | sed 's/^/#   /'

echo "# purged"
systemctl start "$unit"
check "dpkg purges the package while it runs" quietly dpkg --purge coupler-node
refuse "no process is left" pgrep coupler-node
refuse "systemd does not know the unit" quietly systemctl cat "$unit"
refuse "nothing of it is enabled" test -e "/etc/systemd/system/multi-user.target.wants/$unit"
check "the map that somebody wrote stays" test -e /etc/coupler/node.yaml
expect "the system is as well as before" running "$(systemctl reset-failed; systemctl is-system-running)"
