#!/usr/bin/env bash
# ./meca build: the release preset.
. scripts/common.sh
need build
build release
say "built: build/release/bin/meca-bridge, build/release/bin/meca-ctl"
