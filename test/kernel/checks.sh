# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# Checks, waiting and background programs for scripts that test/kernel/run starts. To be sourced (gpio-sim.sh does).
#   check TEXT CMD…           ok if CMD succeeds            refuse TEXT CMD…   ok if CMD fails
#   expect TEXT WANTED GOT    ok if both are the same text
#   wait_until CMD…           tries CMD every 20 ms; fails after three minutes, and shows the last try's output
#   sleep_until SECOND        until $SECONDS is that, or not at all
#   within SECONDS CMD…       the same, where failing is no failure of the test
#   start NAME CMD…           runs CMD in the background; its output goes to the file $(log NAME)
#   pid NAME, log NAME        the process id, the file of its output
#   running NAME              whether it still runs
#   stop NAME [SIGNAL]        sends SIGNAL (default TERM), waits for the end, and gives its exit status
#                             (128 + signal number if it died of a signal; 255 if it had to be killed after three minutes)
#   says NAME PATTERN [COUNT] whether at least COUNT lines (default 1) of its output match (grep -E)
# Each check prints `ok - TEXT` or `not ok - TEXT`. When the script ends, a summary follows; its exit status is then 1
# if a check failed or none was made, or the script's own if that is not 0. The output of every started program is shown
# when something failed. Example:
#   start watch gpiomon "$(sim_chip plant)" 0
#   sim_pull plant 0 up
#   check "gpiomon sees the edge" wait_until says watch RISING
#   check "gpiomon ends well" stop watch INT
#   status=0; stop other || status=$?; expect "the other one dies of the signal" 143 "$status"

check_folder=$(mktemp -d)
: >"$check_folder/results"
trap check_summary EXIT

# Results are kept in a file, so that a check in a subshell or a pipeline counts too.
check_result() {
  echo "$1" >>"$check_folder/results"
  echo "$1"
}

check() {
  local text=$1
  shift
  if "$@"; then check_result "ok - $text"; else check_result "not ok - $text (failed: $*)"; fi
}

refuse() {
  local text=$1
  shift
  if "$@"; then check_result "not ok - $text (succeeded: $*)"; else check_result "ok - $text"; fi
}

expect() {
  local text=$1 wanted=$2 got=$3
  if [ "$wanted" = "$got" ]; then check_result "ok - $text"; else check_result "not ok - $text: wanted '$wanted', got '$got'"; fi
}

microseconds() { echo "${EPOCHREALTIME/[.,]/}"; }

readonly patience=180 # seconds: only tells what hangs from what works, also where four programs share two busy processors

sleep_until() { sleep $(($1 > SECONDS ? $1 - SECONDS : 0)); }

wait_until() { within "$patience" "$@"; }

within() {
  local seconds=$1 end
  shift
  end=$(($(microseconds) + $(awk -v s="$seconds" 'BEGIN { printf "%d", s * 1000000 }')))
  until "$@" >"$check_folder/attempt" 2>&1; do
    if [ "$(microseconds)" -ge "$end" ]; then
      sed 's/^/# /' "$check_folder/attempt"
      return 1
    fi
    sleep 0.02
  done
}

log() { echo "$check_folder/$1.log"; }
pid() { cat "$check_folder/$1.pid"; }
running() { ! ended "$(pid "$1")"; }

# A program that has ended stays as a zombie until it is waited for.
ended() { ! kill -0 "$1" 2>/dev/null || grep -q '^State:.*Z' "/proc/$1/status" 2>/dev/null; }

start() {
  local name=$1
  shift
  : >"$(log "$name")" # now, since what an earlier one said is not said by this one
  # A shell without job control lets its background programs ignore SIGINT; with it, they are as in a terminal.
  set -m
  "$@" >"$(log "$name")" 2>&1 </dev/null &
  echo $! >"$check_folder/$name.pid"
  set +m
}

stop() {
  local name=$1 signal=${2:-TERM} process
  process=$(pid "$name")
  kill -s "$signal" "$process" 2>/dev/null || true
  if ! wait_until ended "$process"; then
    echo "# $name did not end within $patience s after SIG$signal; killed"
    kill -KILL "$process"
    wait "$process" || true
    return 255
  fi
  wait "$process"
} 2>/dev/null # the shell would tell of each program that dies of a signal

says() {
  local name=$1 pattern=$2 count=${3:-1}
  [ "$(grep -cE -- "$pattern" "$(log "$name")")" -ge "$count" ]
}

# shellcheck disable=SC2317 # called by the trap
check_summary() {
  local status=$? passed failed file
  passed=$(grep -c '^ok' "$check_folder/results") || true
  failed=$(grep -c '^not ok' "$check_folder/results") || true
  [ "$status" -eq 0 ] || echo "# the script ended early, with status $status"
  [ $((passed + failed)) -gt 0 ] || echo "# no check was made"
  if [ "$status" -ne 0 ] || [ "$failed" -gt 0 ]; then
    for file in "$check_folder"/*.log; do
      [ -s "$file" ] || continue
      echo "# output of $(basename "$file" .log):"
      sed 's/^/#   /' "$file"
    done
  fi
  echo "# $passed passed, $failed failed"
  [ "$status" -ne 0 ] || { [ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]; } || status=1
  exit "$status"
}
