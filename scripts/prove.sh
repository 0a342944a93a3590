#!/usr/bin/env bash
# ./meca prove [WORD] [options]: the long proofs of what is promised about control, each by one word; without a word, all.
# ./meca test runs the same tests in a shorter form. Figures are printed; the exit code says whether the promise held
# (0), was broken (1), or could not be judged because the machine was too busy (3). Options go to meca-bench: deaths
# --deaths N (500), fight --seconds N (120), throughput --seconds N (10).
. scripts/common.sh
which=${1:-all}
[ $# -gt 0 ] && shift

# in_test PROGRAM FILTER: unit tests in simulated time, at full length.
in_test() {
  build release "$1"
  "build/release/bin/$1" --gtest_filter="$2"
}
# measured NAME [options]: a scenario of meca-bench: real processes over DDS.
measured() {
  local name=$1
  shift
  mkdir -p build/bench
  build release meca-bridge meca-bench
  build/release/bin/meca-bench "$name" --json "build/bench/$name.json" "$@"
}

prove() {
  case $1 in
    million)
      export MECA_COMMANDS=${MECA_COMMANDS:-1000000}
      in_test test_control 'Million*'
      in_test test_buses '*OverABus.executed*'
      ;;
    faults)
      export MECA_FAULT_SEQUENCES=${MECA_FAULT_SEQUENCES:-10000}
      in_test test_control '*FaultAndRecovery*'
      in_test test_buses '*OverABus.faults*'
      ;;
    stops) in_test test_stops '*' ;;
    deaths | fight | throughput) measured "$@" ;;
    *) die "prove: '$1' is not million, faults, deaths, fight, throughput or stops" ;;
  esac
}

need build
if [ "$which" = all ]; then
  for which in million faults stops deaths fight throughput; do prove "$which"; done
else
  prove "$which" "$@"
fi
