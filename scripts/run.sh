#!/usr/bin/env bash
# ./meca run: the bridge on the built-in robot, and what to type next. Arguments go to meca-bridge.
. scripts/common.sh
need build
build release meca-bridge meca-ctl
[ $# -gt 0 ] || set -- --config config/builtin.yaml
cat <<'TEXT'

The bridge runs in this terminal until Ctrl-C. In a second one:

  build/release/bin/meca-ctl status
  build/release/bin/meca-ctl activate
  build/release/bin/meca-ctl home
  build/release/bin/meca-ctl move-joints 30 20 -10 15 40 0 --wait
  build/release/bin/meca-ctl watch
  build/release/bin/meca-ctl sim press p-stop2      its buttons; 'meca-ctl sim' lists them

TEXT
exec build/release/bin/meca-bridge "$@"
