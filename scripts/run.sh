#!/usr/bin/env bash
# ./meca run: the bridge on the built-in robot, and what to type next. Arguments go to meca-bridge.
# ./meca run ethernet_ip: the bridge and meca-sim as two programs that speak EtherNet/IP. Arguments go to meca-sim.
# ./meca run ethercat: the same over EtherCAT with three robots (run_ethercat.sh).
. scripts/common.sh
. scripts/programs.sh
if [ "${1:-}" = ethercat ]; then
  shift
  exec scripts/run_ethercat.sh "$@"
fi
case ${1:-} in
  '' | ethernet_ip | -*) ;;
  *) die "run: '$1' is neither ethernet_ip nor ethercat, nor an option of meca-bridge; a file of your own: --config $1" ;;
esac
need build

what_to_type() {
  cat <<TEXT

$1 in this terminal until Ctrl-C. In a second one:

  build/release/bin/meca-ctl status
  build/release/bin/meca-ctl activate
  build/release/bin/meca-ctl home
  build/release/bin/meca-ctl move-joints 30 20 -10 15 40 0 --wait
  build/release/bin/meca-ctl watch
$2

TEXT
}

if [ "${1:-}" != ethernet_ip ]; then
  build release meca-bridge meca-ctl
  if [ $# = 0 ]; then
    one_at_a_time
    set -- --config config/builtin.yaml
  fi
  what_to_type "The bridge runs" \
    "  build/release/bin/meca-ctl sim press p-stop2      its buttons; 'meca-ctl sim' lists them"
  exec build/release/bin/meca-bridge "$@"
fi

shift
build release meca-bridge meca-ctl meca-sim
one_at_a_time ethernet_ip
what_to_type "The bridge (127.0.0.1) and a simulated robot (127.0.0.2) run, with EtherNet/IP between them," \
  "  build/release/bin/meca-ctl sim unplug             faults and buttons; 'meca-ctl sim' lists them
  build/release/bin/meca-ctl sim plug
  sudo tshark -i lo -f 'tcp port 44818 or udp port 2222'"

run_pair config/ethernet_ip_demo.yaml --bind 127.0.0.2 "$@" 9>&-
