#!/usr/bin/env bash
# ./meca bench [image|latency|cpu|wakeup|stopped-reader|ethernet-ip[-period|-latency|-robots]|
# ethercat[-period|-latency|-throughput|-robots]] [meca-bench options]: measures, each thing beside its bare counterpart in
# the same run. Figures also go to build/bench/*.json. EtherNet/IP is measured on loopback addresses: the bridge's
# 127.0.2.1, robots at 127.0.1.1 and up. EtherCAT is measured on a virtual cable in a network of its own, as root or in a
# user namespace; where that is not permitted, it says so.
. scripts/common.sh
which=${1:-all}
[ $# -gt 0 ] && shift
mkdir -p build/bench
need build ethercat

image() {
  build release image-bench
  build/release/bin/image-bench --benchmark_out=build/bench/image.json --benchmark_out_format=json "$@"
}
measure() {
  local name=$1
  shift
  build release meca-bridge meca-bench meca-sim
  build/release/bin/meca-bench "$name" --json "build/bench/$name.json" "$@"
}

ethernet_ip() {
  for name in period latency robots; do measure "ethernet-ip-$name" "$@"; done
}

# 3: this machine cannot tell; it has said why.
ethercat() {
  for name in period latency throughput robots; do measure "ethercat-$name" "$@" || [ $? = 3 ]; done
}

case $which in
  all)
    image
    for name in latency cpu wakeup; do measure "$name" "$@"; done
    measure stopped-reader --seconds 60 "$@"
    ethernet_ip "$@"
    ethercat "$@"
    ;;
  image) image "$@" ;;
  latency | cpu | wakeup | stopped-reader | ethernet-ip-period | ethernet-ip-latency | ethernet-ip-robots | \
    ethercat-period | ethercat-latency | ethercat-throughput | ethercat-robots)
    measure "$which" "$@"
    ;;
  ethernet-ip) ethernet_ip "$@" ;;
  ethercat) ethercat "$@" ;;
  *)
    die "bench: '$which' is not image, latency, cpu, wakeup, stopped-reader, ethernet-ip[-period|-latency|-robots] or \
ethercat[-period|-latency|-throughput|-robots]"
    ;;
esac
