#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# generate.sh COUPLER OUT MAP…: everything that COUPLER makes of the maps.
set -euo pipefail
coupler=$1 out=$2
rm -rf "$out"
for map in "${@:3}"; do
  name=$(basename "${map//-/_}" .yaml)
  for kind in "" --docs --python --vectors; do
    # shellcheck disable=SC2086
    "$coupler" generate "$map" $kind --name "$name" --out "$out" --quiet
  done
done
