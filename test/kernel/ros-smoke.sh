#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves that a ROS graph runs in the test kernel, from a ROS master to a message that arrives:
#   test/kernel/run --mem 1G test/kernel/ros-smoke.sh
# Needs scripts/install-packages ros.
set -euo pipefail
export PYTHONUNBUFFERED=1  # what rostopic prints is looked for in a file while it runs
# shellcheck source=checks.sh
. "$(dirname "$0")/checks.sh"

start core "$(dirname "$0")/../support/ros-master" 11311
check "a ROS master answers" wait_until says core http://
start publisher rostopic pub --rate 10 /greeting std_msgs/String "data: 'hello'"
start echo rostopic echo /greeting
check "messages arrive" wait_until says echo 'data: "hello"' 3
check "the publisher ends on SIGINT" stop publisher INT
check "the ROS master ends on SIGINT" stop core INT
