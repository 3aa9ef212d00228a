#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves that a ROS graph runs in the test kernel, from a roscore to a message that arrives:
#   test/kernel/run --mem 1G test/kernel/ros-smoke.sh
# Needs scripts/install-packages ros.
set -euo pipefail
export PYTHONUNBUFFERED=1  # what rostopic prints is looked for in a file while it runs
# shellcheck source=checks.sh
. "$(dirname "$0")/checks.sh"

start core roscore
check "a roscore answers" wait_until rosnode list
start publisher rostopic pub --rate 10 /greeting std_msgs/String "data: 'hello'"
start echo rostopic echo /greeting
check "messages arrive" wait_until says echo 'data: "hello"' 3
check "the publisher ends on SIGINT" stop publisher INT
check "the roscore ends on SIGINT" stop core INT
