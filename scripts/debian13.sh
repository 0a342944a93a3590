#!/usr/bin/env bash
# shellcheck disable=SC2016 # inner shells expand
# ./meca test --debian13: the same source, built and tested in a Debian 13 root, for its Fast DDS 3.
# The root lives in the cache directory and is kept, so that the second time only builds what changed.
. scripts/common.sh
[ "$(id -u)" = 0 ] || die "a Debian 13 root is entered with chroot, and that needs root: sudo ./meca test --debian13"
need debootstrap
root=$cache/debian13
mirror=${MECA_MIRROR:-http://deb.debian.org/debian}

if [ ! -e "$root/.complete" ]; then
  say "making a Debian 13 root in $root (once, about 400 MB and two minutes)"
  rm -rf "$root"
  mkdir -p "$root"
  debootstrap --variant=minbase trixie "$root" "$mirror" >"$root.log" 2>&1 ||
    die "debootstrap failed, see $root.log (another mirror: MECA_MIRROR=http://...)"
  touch "$root/.complete"
fi
# How this machine reaches the package mirror is true for the root as well.
cp -L /etc/resolv.conf /etc/hosts "$root/etc/"
apt-config dump | grep -i '^Acquire::http.*::Proxy' >"$root/etc/apt/apt.conf.d/90proxy" || true

# A copy of the source: its own build directory, and nothing in the root can touch this tree. Unchanged files keep the time
# of their copy and changed ones are new, so that the build there never mistakes one for the other, whenever it was edited.
say "testing on Debian 13 in $root/src"
mkdir -p "$root/src/build"
rm -rf "$root/src.new"
mkdir "$root/src.new"
tar --create --exclude=./build --exclude=./.git . | tar --extract --touch --directory "$root/src.new"
(cd "$root/src.new" && find . -type f -exec sh -c 'cmp -s "$1" "../src/$1" && touch -r "../src/$1" "$1"' _ {} \;)
mv "$root/src/build" "$root/src.new/build"
rm -rf "$root/src"
mv "$root/src.new" "$root/src"

# In namespaces of its own: mounts and stray processes are gone when it ends.
exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 MECA_JOBS="$jobs" \
  unshare --mount --pid --fork --kill-child bash -euc '
    root=$1; shift
    mount -t proc proc "$root/proc"
    mkdir -p "$root/dev/pts"; mount -t devpts devpts "$root/dev/pts"
    mkdir -p "$root/dev/shm"; mount -t tmpfs tmpfs "$root/dev/shm"
    exec chroot "$root" bash -c "cd /src && exec ./meca test \"\$@\"" meca "$@"' meca "$root" "$@"
