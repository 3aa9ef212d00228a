#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Clients with TLS and without keep their connections while a chip is unplugged and comes back, and the map is read again.
#   test/kernel/run test/kernel/secure.sh BUILD_DIR
set -euo pipefail
bin=$(realpath "${1:?the build folder}")/bin
cd "$(dirname "$0")"
sessions=$PWD/sessions.py
# shellcheck source=plant.sh
. ./plant.sh
plant_chip

cp reload.yaml "$check_folder/plant.yaml"
cat >>"$check_folder/plant.yaml" <<'END'
security:
  certificate: node/node.pem
  key: node/node.key
  ca: node/authority.pem
  port: 1802
  roles: {everything: {read: all, write: all}}
  plain: everything
END
cd "$check_folder"
check "certificates are made" "$bin/coupler" certificates . --node node:127.0.0.1 --client client:everything
plant_node plant.yaml
sim_pull plant 2 down
start sessions /usr/bin/python3 "$sessions" 1502 1802 client 0
check "the client with TLS reads the input" wait_until says sessions '^tls 0'
check "so does the one without" wait_until says sessions '^plain 0'
sim_pull plant 2 up
check "both see it change" wait_until says sessions '^tls 1'
check "the one without, too" wait_until says sessions '^plain 1'

sim_unplug plant
for client in tls plain; do check "$client: without the chip it is exception 04" wait_until says sessions "^$client exception 4"; done
sim_plug plant
sim_pull plant 2 down
for client in tls plain; do check "$client: with the chip it is read again" wait_until says sessions "^$client 0" 2; done

sed -i 's/everything: {read: all, write: all}/everything: {read: all}/' plant.yaml
kill -HUP "$(pid node)"
check "the map is read again" wait_until says node 'read the map again'
sim_pull plant 2 up
for client in tls plain; do check "$client: the same connection goes on" wait_until says sessions "^$client 1" 2; done
refuse "no connection was closed" says sessions closed
refuse "no worker process died" says node 'the worker process'
stop sessions KILL || true
check "the node ends well" stop node
