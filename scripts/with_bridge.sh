#!/usr/bin/env bash
# with_bridge.sh BRIDGE CONFIG PROGRAM [ARGS]: runs a program against a bridge of its own. Succeeds when the program does
# and the bridge, asked to stop with SIGTERM, leaves with exit code 0.
set -euo pipefail
bridge=$1 config=$2
shift 2
log=$(mktemp)
"$bridge" --config "$config" >"$log" 2>&1 &
pid=$!
trap 'kill -KILL "$pid" 2>/dev/null || true; rm -f "$log"' EXIT

status=0
"$@" || status=$?
# A bridge that died early is the better explanation for whatever the program says.
kill -TERM "$pid" 2>/dev/null || echo "the bridge was gone before it was asked to stop" >&2
bridge_status=0
wait "$pid" || bridge_status=$?
if [ "$status" != 0 ] || [ "$bridge_status" != 0 ]; then
  echo "program: exit code $status; bridge: exit code $bridge_status; what the bridge said:" >&2
  cat "$log" >&2
  exit 1
fi
