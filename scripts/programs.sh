# What './meca run' and './meca ctl' share; sourced after common.sh.
# shellcheck shell=bash

run_file=build/run.pid

# Where bridge, meca-sim and meca-ctl find each other's control sockets, in whichever namespace each is: the directory that
# they take by themselves carries the user id, and that is root's in a user namespace.
share_sockets() {
  [ -d "${XDG_RUNTIME_DIR:-}" ] && return
  export XDG_RUNTIME_DIR=/tmp/meca500-run-$(id -u)
  mkdir -p -m 700 "$XDG_RUNTIME_DIR"
}

# one_at_a_time WORD...: refuses when a './meca run' of this tree goes on: their robots have the same names. The lock
# is held through exec, and ends with its process, however that ends.
one_at_a_time() {
  mkdir -p build
  exec 9>>"$run_file"
  if ! flock --nonblock 9; then
    local pid words
    read -r pid words <"$run_file" || true
    die "'./meca run${words:+ $words}' runs already in this tree, as process $pid; Ctrl-C there or 'kill $pid' ends it"
  fi
  echo "$$ $*" >"$run_file"
}

# The process that runs './meca run ethercat' in this tree, or nothing.
ethercat_run() {
  local pid='' words=''
  read -r pid words 2>/dev/null <"$run_file" || true
  if [ "$words" = ethercat ] && grep -qs run_ethercat.sh "/proc/$pid/cmdline"; then echo "$pid"; fi
}

asked_to_stop='' bridge='' sim=''

# leave PID: asks it to stop and waits for it, through any number of Ctrl-C; its exit code.
leave() {
  local status
  kill -TERM "$1" 2>/dev/null || true
  while true; do
    status=0
    wait "$1" || status=$?
    kill -0 "$1" 2>/dev/null || return "$status"
  done
}

# tell_end NAME STATUS OTHER
tell_end() {
  local how="exit code $2"
  [ "$2" -le 128 ] || how="SIG$(kill -l $(($2 - 128)))"
  say "$1 has ended ($how); $3 is stopped as well"
}

# run_pair CONFIG [meca-sim arguments]: both, until Ctrl-C or SIGTERM, or until one ends of its own accord, which is said.
run_pair() {
  local config=$1 first='' status=0 pid ended
  shift
  # The bridge is told in the trap, so that no moment is too early to be asked.
  trap 'asked_to_stop=1; [ -z "$bridge" ] || kill -TERM "$bridge" 2>/dev/null || true' INT TERM HUP
  # Away from the terminal's Ctrl-C: the bridge says good-bye to robots that are still there.
  setsid build/release/bin/meca-sim "$@" &
  sim=$!
  [ -n "$asked_to_stop" ] || {
    build/release/bin/meca-bridge --config "$config" &
    bridge=$!
  }
  [ -z "$bridge" ] || wait -n -p first "$bridge" "$sim" || status=$?
  if [ -n "$asked_to_stop" ]; then
    status=0
  elif [ "${first:-}" = "$bridge" ]; then
    tell_end meca-bridge "$status" meca-sim
  else
    tell_end meca-sim "$status" meca-bridge
  fi
  for pid in $bridge $sim; do
    ended=0
    leave "$pid" || ended=$?
    [ "$status" != 0 ] || status=$ended
  done
  return "$status"
}
