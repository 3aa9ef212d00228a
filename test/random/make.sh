#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# make.sh COUPLER RANDOM_MAPS FOLDER SEED COUNT EACH: random maps, what `coupler generate` makes of them, and the ends
# that use it, EACH maps in one file.
set -euo pipefail
coupler=$1 random_maps=$2 folder=$3 seed=$4 count=$5 each=$6
rm -rf "$folder"
mkdir -p "$folder"
"$random_maps" maps "$folder" "$seed" "$count"
for ((i = 0; i < count; i++)); do
  "$coupler" generate "$folder/random_$i.yaml" --name "random_$i" --out "$folder" --quiet
done
"$random_maps" ends "$folder" "$count" "$each"
