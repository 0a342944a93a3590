#!/usr/bin/env bash
# ./meca build [target...]: the release preset; without targets everything.
. scripts/common.sh
need build
build release "$@"
[ $# -gt 0 ] || say "built: build/release/bin/meca-bridge, build/release/bin/meca-ctl"
