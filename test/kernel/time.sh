#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Edges of a simulated chip come in their topics with right stamps, and an output follows an input after 2 s: a few of
# what test/bench/time/edges measures.
#   test/kernel/run --mem 1G test/kernel/time.sh BUILD_DIR
exec "$(dirname "$0")/../bench/time/in_guest.sh" "$1" 10 1 2000000000
