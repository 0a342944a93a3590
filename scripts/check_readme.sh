#!/usr/bin/env bash
# check_readme.sh: types the README's commands as a newcomer would. The blocks marked `sh` are run from top to bottom:
# ./meca run holds the first terminal (it ends with this script), the rest is the second one. ./meca test is CI's own.
. scripts/common.sh
mkdir -p build
mapfile -t commands < <(awk '/^```sh$/ {on = 1; next} /^```/ {on = 0} on' README.md)
[ ${#commands[@]} -ge 6 ] || die "README.md: only ${#commands[@]} commands found; is the block marked sh?"
bridge=
trap '[ -z "$bridge" ] || kill -TERM "$bridge" 2>/dev/null || true' EXIT

for command in "${commands[@]}"; do
  case $command in
    './meca test') continue ;;
    './meca run')
      build release meca-bridge meca-ctl >/dev/null # not part of the patience below
      ./meca run >build/readme-run.log 2>&1 &
      bridge=$!
      # Nothing is typed into the second terminal before the first one says so.
      for _ in $(seq 100); do
        build/release/bin/meca-ctl health >/dev/null 2>&1 && break
        kill -0 "$bridge" 2>/dev/null || break
        sleep 0.2
      done
      kill -0 "$bridge" 2>/dev/null || die "README: ./meca run ended: $(tail -n 5 build/readme-run.log)"
      ;;
    *)
      echo "\$ $command"
      timeout 60 bash -euc "$command" || die "README: '$command' failed with exit code $?"
      ;;
  esac
done

kill -TERM "$bridge"
status=0
wait "$bridge" || status=$?
bridge=
[ "$status" = 0 ] || die "README: ./meca run left with exit code $status: $(tail -n 5 build/readme-run.log)"
say "README: ${#commands[@]} commands work"
