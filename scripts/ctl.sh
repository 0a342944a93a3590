#!/usr/bin/env bash
# ./meca ctl WORDS: meca-ctl; while './meca run ethercat' runs, inside of its network.
. scripts/common.sh
. scripts/programs.sh
ctl=build/release/bin/meca-ctl
[ -x "$ctl" ] || die "there is no $ctl yet; './meca build' makes it"

pid=$(ethercat_run)
[ -n "$pid" ] || exec "$ctl" "$@"

share_sockets
enter=(nsenter --target "$pid" --net)
if [ -r "/proc/$pid/ns/net" ] && [ -r "/proc/$pid/ns/user" ]; then
  [ "$(readlink "/proc/$pid/ns/user")" = "$(readlink /proc/self/ns/user)" ] || enter+=(--user --preserve-credentials)
else
  enter=(sudo --preserve-env=XDG_RUNTIME_DIR "${enter[@]}")
fi
exec "${enter[@]}" "$ctl" "$@"
