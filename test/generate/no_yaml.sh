#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# no_yaml.sh NODE COUPLER: a generated node needs no YAML parser, neither shared nor linked in. COUPLER, which has one,
# proves that the search would find it.
set -eu
has_yaml() { ldd "$1" | grep yaml >/dev/null || nm -C "$1" | grep 'YAML::' >/dev/null; }

has_yaml "$2" || { echo "$2 has a YAML parser, but it was not found: this test sees nothing"; exit 1; }
if has_yaml "$1"; then
  echo "$1 has a YAML parser:"
  ldd "$1" | grep yaml || nm -C "$1" | grep -m 5 'YAML::'
  exit 1
fi
