#!/usr/bin/env bash
# ./meca test [--debian13] [ctest arguments]: every test, in the release preset.
. scripts/common.sh
if [ "${1:-}" = --debian13 ]; then
  shift
  exec scripts/debian13.sh "$@"
fi
need build ethercat
build release
# --output-on-failure shows why; ctest's own closing lines name what failed and what was skipped.
exec ctest --test-dir build/release --output-on-failure --no-tests=error -j "$jobs" --timeout 300 "$@"
