#!/usr/bin/env bash
# ./meca bench [image|latency|cpu|wakeup|stopped-reader|ethernet-ip|ethernet-ip-period|ethernet-ip-latency|
# ethernet-ip-robots] [meca-bench options]: measures, each thing beside its bare counterpart in the same run. Figures also
# go to build/bench/*.json. EtherNet/IP is measured on loopback addresses: the bridge's 127.0.2.1, robots at 127.0.1.1 and
# up.
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

ethernet_ip() {
  for name in period latency robots; do measure "ethernet-ip-$name" "$@"; done
}

case $which in
  all)
    image
    for name in latency cpu wakeup; do measure "$name" "$@"; done
    measure stopped-reader --seconds 60 "$@"
    ethernet_ip "$@"
    ;;
  image) image "$@" ;;
  latency | cpu | wakeup | stopped-reader | ethernet-ip-period | ethernet-ip-latency | ethernet-ip-robots)
    measure "$which" "$@"
    ;;
  ethernet-ip) ethernet_ip "$@" ;;
  *) die "bench: '$which' is not image, latency, cpu, wakeup, stopped-reader or ethernet-ip[-period|-latency|-robots]" ;;
esac
