#!/usr/bin/env bash
# check_readme.sh: types the README's commands as a newcomer would. The blocks marked `sh` are run from top to bottom:
# ./meca run holds the first terminal (until the next one, or the end), the rest is the second one. ./meca test is CI's own.
. scripts/common.sh
mkdir -p build
mapfile -t commands < <(awk '/^```sh$/ {on = 1; next} /^```/ {on = 0} on' README.md)
[ ${#commands[@]} -ge 6 ] || die "README.md: only ${#commands[@]} commands found; is the block marked sh?"
run='' words='' skipping=''
trap '[ -z "$run" ] || kill -TERM "$run" 2>/dev/null || true' EXIT

may_make_networks() { unshare --net true 2>/dev/null || unshare --user --map-root-user --net true 2>/dev/null; }

# What is in the first terminal is asked to stop, and leaves in order.
stop_run() {
  [ -n "$run" ] || return 0
  kill -TERM "$run"
  local status=0
  wait "$run" || status=$?
  run=
  [ "$status" = 0 ] || die "README: $words left with exit code $status: $(tail -n 5 build/readme-run.log)"
}

for command in "${commands[@]}"; do
  case $command in
    './meca test') continue ;;
    './meca run' | './meca run '*)
      stop_run
      skipping=''
      if [ "$command" = './meca run ethercat' ] && ! may_make_networks; then
        say "README: SKIPPED from '$command' to the next run: no network of its own is permitted here"
        skipping=1
        continue
      fi
      build release meca-bridge meca-ctl meca-sim >/dev/null # not part of the patience below
      words=$command
      echo "\$ $words"
      $words >build/readme-run.log 2>&1 &
      run=$!
      # Nothing is typed into the second terminal before the first one says so.
      for _ in $(seq 100); do
        ./meca ctl health >/dev/null 2>&1 && break
        kill -0 "$run" 2>/dev/null || break
        sleep 0.2
      done
      kill -0 "$run" 2>/dev/null || die "README: $words ended: $(tail -n 5 build/readme-run.log)"
      ;;
    *)
      [ -z "$skipping" ] || continue
      echo "\$ $command"
      timeout 60 bash -euc "$command" || die "README: '$command' failed with exit code $?"
      ;;
  esac
done

stop_run
[ -n "$words" ] || die "README.md: no command starts the bridge"
say "README: ${#commands[@]} commands work"
