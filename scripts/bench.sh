#!/usr/bin/env bash
# ./meca bench [image|latency|cpu|wakeup|stopped-reader] [meca-bench options]: measures, each thing beside its bare
# counterpart in the same run. Figures also go to build/bench/*.json.
. scripts/common.sh
which=${1:-all}
[ $# -gt 0 ] && shift
mkdir -p build/bench
need build

image() {
  build release image-bench
  build/release/bin/image-bench --benchmark_out=build/bench/image.json --benchmark_out_format=json "$@"
}
measure() {
  local name=$1
  shift
  build release meca-bridge meca-bench
  build/release/bin/meca-bench "$name" --json "build/bench/$name.json" "$@"
}

case $which in
  all)
    image
    for name in latency cpu wakeup; do measure "$name" "$@"; done
    measure stopped-reader --seconds 60 "$@"
    ;;
  image) image "$@" ;;
  latency | cpu | wakeup | stopped-reader) measure "$which" "$@" ;;
  *) die "bench: '$which' is not image, latency, cpu, wakeup or stopped-reader" ;;
esac
