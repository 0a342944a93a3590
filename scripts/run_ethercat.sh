#!/usr/bin/env bash
# ./meca run ethercat: the bridge and three simulated robots in one EtherCAT segment, as two programs with real frames
# between them at 1 kHz, in a network of their own. Arguments go to meca-sim. 'ctl.sh' reaches into that network.
. scripts/common.sh
. scripts/programs.sh

# How to get a network of its own: what is in there touches nobody else's interfaces, and nothing is left of it.
find_way_in() {
  if unshare --net true 2>/dev/null; then
    way_in=(unshare --net)
  elif unshare --user --map-root-user --net true 2>/dev/null; then
    way_in=(unshare --user --map-root-user --net)
  elif [ "$(id -u)" != 0 ] && command -v sudo >/dev/null; then
    say "an own network needs root here: sudo"
    way_in=(sudo --preserve-env=XDG_RUNTIME_DIR unshare --net)
  else
    die "a network of its own is not permitted here. In a container: --cap-add SYS_ADMIN --cap-add NET_ADMIN \
--cap-add NET_RAW --security-opt apparmor=unconfined. Elsewhere: root, or user namespaces (sysctl \
kernel.unprivileged_userns_clone=1, kernel.apparmor_restrict_unprivileged_userns=0). With interfaces of your own you need \
none of this: config/ethercat_demo.yaml says how"
  fi
}

if [ "${1:-}" != --inside ]; then
  one_at_a_time ethercat
  exec 9>&- # sudo would: whoever is inside asks again
  need build ethercat
  build release meca-bridge meca-ctl meca-sim
  find_way_in
  share_sockets
  exec "${way_in[@]}" "$0" --inside "$@"
fi
shift

one_at_a_time ethercat

lay_cable() {
  ip link set lo up && # DDS between bridge and meca-ctl
    ip link add meca0 type veth peer name meca1 &&
    ip link set meca0 addrgenmode none up && ip link set meca1 addrgenmode none up
}
lay_cable || die "no virtual cable could be laid (see above); it needs the kernel's veth devices"

cat <<TEXT

The bridge and three simulated robots run in this terminal until Ctrl-C: arm1, arm2 and arm3 in one EtherCAT segment,
master on meca0, robots on meca1, a frame every millisecond. Both are in a network of their own; './meca ctl' is meca-ctl
in there. In a second terminal:

  ./meca ctl status
  ./meca ctl --robot arm2 activate
  ./meca ctl --robot arm2 home
  ./meca ctl --robot arm2 move-joints 30 20 -10 15 40 0 --wait
  ./meca ctl --robot arm2 watch
  ./meca ctl --robot arm2 sim unplug                the cable before arm2: arm3 is behind it
  ./meca ctl --robot arm2 sim plug
  ./meca ctl sim help                               faults and buttons
  sudo nsenter --target $$ --net tshark -i meca0 -Y ecat

TEXT

run_pair config/ethercat_demo.yaml --protocol ethercat --interface meca1 --count 3 "$@" 9>&-
