#!/usr/bin/env bash
# ./meca image [build arguments]: the container image localhost/meca500-dds-bridge, with whichever engine is there.
. scripts/common.sh
name=${MECA_IMAGE:-localhost/meca500-dds-bridge}
debian_base=docker.io/library/debian:bookworm-slim

if command -v docker >/dev/null && docker info >/dev/null 2>&1; then
  say "building $name with docker"
  exec docker build -f docker/Dockerfile -t "$name" "$@" .
fi
if command -v podman >/dev/null; then
  say "building $name with podman"
  exec podman build --format docker -f docker/Dockerfile -t "$name" "$@" .
fi

# No engine: buildah needs no daemon, and with chroot isolation no privileges beyond root's.
need buildah
export BUILDAH_ISOLATION=chroot
if ! buildah inspect --type image "$debian_base" >/dev/null 2>&1 && ! buildah pull -q "$debian_base" >/dev/null 2>&1; then
  base=localhost/debian-bookworm-slim
  if ! buildah inspect --type image "$base" >/dev/null 2>&1; then
    [ "$(id -u)" = 0 ] || die "no registry in reach, and making a Debian base with debootstrap needs root: sudo ./meca image"
    need debootstrap
    say "no registry in reach: making $base with debootstrap (once)"
    root=$cache/debian12
    rm -rf "$root" && mkdir -p "$root"
    debootstrap --variant=minbase bookworm "$root" "${MECA_MIRROR:-http://deb.debian.org/debian}" >"$root.log" 2>&1 ||
      die "debootstrap failed, see $root.log"
    rm -rf "$root"/var/cache/apt/archives/*.deb "$root"/var/lib/apt/lists/*
    container=$(buildah from scratch)
    buildah add -q "$container" "$root" / >/dev/null
    buildah commit -q --rm "$container" "$base" >/dev/null
  fi
  debian_base=$base
fi
say "building $name with buildah (chroot isolation) on $debian_base"
# The format that knows HEALTHCHECK.
exec buildah bud --layers --format docker --build-arg "BASE=$debian_base" -f docker/Dockerfile -t "$name" "$@" .
