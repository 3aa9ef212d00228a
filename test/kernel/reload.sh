#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# SIGHUP: the node reads its map again while a client writes and reads, and no line moves that did not change. Kept
# outputs are pulled away from their levels and watched at their wires all the time.
#   test/kernel/run test/kernel/reload.sh BUILD_DIR
set -euo pipefail
bin=$(realpath "${1:?the build folder}")/bin
cd "$(dirname "$0")"
# shellcheck source=plant.sh
. ./plant.sh
plant_chip
map="$check_folder/map.yaml"
cp reload.yaml "$map"

# How often the node said so before.
times() { grep -cE -- "$1" "$(log node)" || true; }
# Gives the node the map on stdin; the rest is check's: what it says then, and how often it said so before.
reload_with() {
  local said=$1 before
  cat >"$map"
  before=$(times "$said")
  kill -HUP "$(pid node)"
  wait_until says node "$said" $((before + 1))
}
taken='read the map again: serving plant'
refused='the new map is refused; the old one stays in force'

# Writes a coil and reads it back without a pause, on one connection as long as it lasts. Tells each lost one, and each answer
# that is wrong; says "going" when the first round is done, and the number of rounds at the end.
traffic() {
  exec python3 -u -c '
import signal, socket
going = True
def stop(*_):
    global going
    going = False
signal.signal(signal.SIGTERM, stop)
rounds = lost = 0
node = None
def ask(pdu):
    node.sendall(bytes([rounds >> 8 & 255, rounds & 255, 0, 0, 0, 1 + len(pdu), 1]) + pdu)
    answer = node.recv(260)
    if not answer:
        raise ConnectionError("closed")
    return answer[:2] == bytes([rounds >> 8 & 255, rounds & 255]) and answer[7:]
def check(pdu, wanted):
    answer = ask(pdu)
    if answer != wanted:
        print("wrong", pdu, answer)
while going:
    try:
        node = node or socket.create_connection(("127.0.0.1", 1502), timeout=60)
        check(b"\5\0\0\xff\0", b"\5\0\0\xff\0")
        check(b"\1\0\0\0\2", b"\1\1\3")
        check(b"\3\0\0\0\1", b"\3\2\4\xd2")
    except OSError as error:
        lost += 1
        print("lost", error)
        node = node and node.close()
    if rounds == 0:
        print("going")
    rounds += 1
print("rounds", rounds, "lost", lost)
'
}

plant_node "$map"
check "a register is written" answered client -t 4 -r 0 127.0.0.1 -- 1234
for coil in 0 1; do check "coil $coil is written" set_coil "$coil" 1; done
sim_pull plant 0 down
sim_pull plant 1 up
sim_pull plant 3 up
sim_pull plant 4 down
expect "the first kept line is driven, against its pull" 1 "$(sim_value plant 0)"
expect "the second, active-low, too" 0 "$(sim_value plant 1)"
for _ in 1 2 3; do sim_pull plant 2 up; sleep 0.02; sim_pull plant 2 down; sleep 0.02; done
expect "three presses are counted" 3 "$(read_one 3 0)"
start wires watch_wires 0 1
check "the kept lines are watched" wait_until says wires armed
start traffic traffic
check "a client writes and reads" wait_until says traffic going

echo "# maps that are refused"
before=$(worker)
status=0; said=$(echo 'name: [' >"$map"; "$bin/coupler-node" --reload "$(pid node)" 2>&1) || status=$?
expect "who asks for one that is no map hears why" "1 yes" "$status $(grep -qF "the '[' is never closed" <<<"$said" && echo yes)"
check "one that is no map" reload_with "$refused" <<<'name: ['
check "its place is told" says node 'map.yaml:[0-9]+:[0-9]+: error'
check "a line that belongs to somebody else" reload_with "$refused" < <(sed 's/offset: 3}/offset: 6}/' reload.yaml)
check "its holder is told" says node 'hog-a'
check "a line that is not there" reload_with "$refused" < <(sed 's/line: BUTTON/line: BOTTON/' reload.yaml)
check "an address that this machine has not" reload_with "$refused" < <(cat reload.yaml; echo 'listen: 192.0.2.1')
check "another polarity of an output beside one that stays" reload_with "$refused" \
  < <(sed 's/offset: 0}/offset: 0}, active_low: true/' reload.yaml)
check "with the remedy" says node "point 'kept'.* restart the node"
check "a point in the identity area" reload_with "$refused" < <(sed 's/presses: {address: 0/presses: {address: 0xFF00/' reload.yaml)
expect "the worker process is the same after all of them" "$before" "$(worker)"
expect "nothing moved" 0 "$(sim_value plant 3)"

echo "# a map that looks the same to clients: one output has another line"
check "it is taken" reload_with "$taken" < <(sed 's/offset: 3}/offset: 5}, initial: on/' reload.yaml)
sim_pull plant 5 down
expect "the new line has its initial level, against its pull" 1 "$(sim_value plant 5)"
expect "and its coil shows it" 1 "$(coil 2)"
expect "the old line is in its safe state, against its pull" 1 "$(sim_pull plant 3 down; sim_value plant 3)"
expect "counters go on" 3 "$(read_one 3 0)"
sim_pull plant 2 up; sleep 0.02; sim_pull plant 2 down; sleep 0.02
expect "and count" 4 "$(read_one 3 0)"
refuse "the client did not notice" says traffic lost

echo "# a map with other points"
sed 's/leaves: .*/arrives: {address: 7, line: {chip: plant, offset: 7}, active_low: true, initial: on}/; s/line: BUTTON/line: BUTTON, active_low: true/; s/offset: 3}/offset: 5}/' \
  reload.yaml >"$check_folder/other.yaml"
check "it is taken" reload_with "$taken" <"$check_folder/other.yaml"
check "clients are told to look again" says node 'clients have to connect again'
expect "the output that is not in it is in its safe state, against its pull" 1 "$(sim_value plant 4)"
sim_pull plant 7 up
check "the new one is driven, against its pull" level_is 7 0
refuse "what is gone is not served" coil 3
expect "the input has its new polarity" 1 "$(input 0)"
check "the client found out" wait_until says traffic lost

echo "# again and again"
before=$(times "$taken")
for _ in {1..10}; do
  check "there" reload_with "$taken" <reload.yaml
  check "and back" reload_with "$taken" <"$check_folder/other.yaml"
done
expect "twenty times" $((before + 20)) "$(times "$taken")"

echo "# a map through standard input"
start piped bash -c "exec '$bin/coupler-node' - --sim --port 1504 <reload.yaml"
check "it is served" wait_until says piped 'serving plant'
kill -HUP "$(pid piped)"
check "it cannot be read again" wait_until says piped 'it cannot be read again'
refuse "and is not refused" says piped 'is refused'
check "the node ends well" stop piped TERM

echo "# who asks hears the answer"
check "a map that is taken is status 0" "$bin/coupler-node" --reload "$(pid node)"
echo 'name: [' >"$map"
status=0; "$bin/coupler-node" --reload "$(pid node)" || status=$?
expect "one that is refused is status 1" 1 "$status"
status=0; "$bin/coupler-node" --reload $$ || status=$?
expect "another program is left alone" 3 "$status"

echo "# the end"
check "the traffic ends" stop traffic TERM
refuse "no answer was wrong" says traffic wrong
grep rounds "$(log traffic)"
stop wires KILL || true
refuse "no kept line moved, all the time" says wires changed
check "the node ends well" stop node TERM
cat "$(log node)"

echo "# the watchdog has expired, and one output is new, another one moves"
watched() {
  printf '%s\n' 'name: plant' 'port: 1502' 'watchdog: {timeout: 300ms, recovery: manual}' 'mapping:' '  coils:'
  printf '    %s: {address: %s, line: {chip: plant, offset: %s}, initial: on}\n' "$@"
}
expired() { [ "$(read_one 3 $((0xFF0B)))" = 3 ]; }
watched moves 0 0 >"$map"
plant_node "$map"
check "an output is written" set_coil 0 1
check "the watchdog expires" wait_until expired
check "the map is taken" reload_with "$taken" < <(watched moves 0 1 new 1 3)
for line in 1 3; do
  sim_pull plant "$line" up
  check "line $line is in its safe state, against its pull" level_is "$line" 0
done
check "the node ends well" stop node TERM

echo "# the first line of a map comes by a reload"
sed '/watchdog/d; s/, line: {[^}]*}//' <(watched lamp 0 0) >"$map"
plant_node "$map"
exec 8<>/dev/tcp/127.0.0.1/1502
check "the map is taken" reload_with "$taken" < <(watched lamp 0 0 | sed '/watchdog/d')
printf '\0\1\0\0\0\6\1\5\0\0\0\0' >&8
expect "a client that was there is answered" '00 01 00 00 00 06 01 05 00 00 00 00' "$(timeout 60 head -c 12 <&8 | od -An -tx1 | xargs)"
check "and drives" level_is 0 0
exec 8<&-

echo "# a map that never comes, while the process that drives dies"
check "the output is written" set_coil 0 1
sim_pull plant 0 up
mv "$map" "$map.kept"; mkfifo "$map"
before=$(worker)
kill -HUP "$(pid node)"
check "a pipe is refused" wait_until says node 'map.yaml: error: it is not a regular file'
rm "$map"; mv "$map.kept" "$map"
head -c 4000000 >"$map.long" < <(yes '  a_point_of_a_long_map: {address: 0, type: INT, description: nothing but text}')
mv "$map.long" "$map"
kill -HUP "$(pid node)"
check "a long one is being read" wait_until pgrep -x coupler-map
reader=$(pgrep -x coupler-map)
kill -STOP "$reader"  # it must not read all of it before the rest has happened
kill -KILL "$before"
check "the output is safe meanwhile, against its pull" wait_until level_is 0 0
check "another worker process is started" wait_until new_worker "$before"
check "the map is still being read" pgrep -x coupler-map
check "the node ends well at SIGTERM, at once" stop node TERM
check "and so does the process that reads" wait_until ended "$reader"
