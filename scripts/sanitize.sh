#!/usr/bin/env bash
# ./meca sanitize [asan|tsan] [ctest arguments]: asan = ASan+UBSan (alignment on) over all tests;
# tsan = clang's ThreadSanitizer over the tests where threads meet.
. scripts/common.sh
which=${1:-both}
[ $# -gt 0 ] && shift
case $which in asan | tsan | both) ;; *) die "sanitize: '$which' is not asan or tsan" ;; esac

asan() {
  need build ethercat
  build asan
  # Without the proofs by many processes at once, and without eight robots in real time in one simulator: what is slowed
  # down so much comes to no end in their time.
  # Fast DDS keeps singletons until exit, so leaks are only those that LeakSanitizer can prove; its default is right.
  # Debian's Fast DDS 2.9 frees its history pools by the size of their base class (RTPSReader::~RTPSReader): not ours to
  # mend, and without the option every reader ends the process.
  # Fewer random faults: what they run through is the same, and ten times slower here.
  MECA_FAULT_SEQUENCES=${MECA_FAULT_SEQUENCES:-60} ASAN_OPTIONS=new_delete_type_mismatch=0 UBSAN_OPTIONS=print_stacktrace=1 \
    ctest --test-dir build/asan --output-on-failure --no-tests=error -j "$jobs" --timeout 300 -LE prove -E EightInOneSegment "$@"
}

tsan() {
  need build ethercat clang
  # Only what has threads: the machines without I/O have none, and instrumenting them proves nothing.
  build tsan meca-bridge meca-ctl meca-sim test_bridge test_net test_e2e test_program test_meca_sim_program cyclone_every_topic cyclone_move cyclone_kinematics_test
  TSAN_OPTIONS="suppressions=$PWD/tests/tsan.supp halt_on_error=1 second_deadlock_stack=1" \
    ctest --test-dir build/tsan --output-on-failure --no-tests=error -j "$jobs" --timeout 300 \
    -R '^(bridge|net|e2e|interop|program|sim_program)\.' "$@"
}

case $which in
  asan) asan "$@" ;;
  tsan) tsan "$@" ;;
  both) asan "$@" && tsan "$@" ;;
esac
