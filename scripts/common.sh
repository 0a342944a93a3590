# What the wishes share; sourced from the top of the repository.
# shellcheck shell=bash
set -euo pipefail

say() { echo "meca: $*"; }
die() {
  echo "meca: $*" >&2
  exit 1
}

jobs=${MECA_JOBS:-$(nproc)}
# shellcheck disable=SC2034 # used by the scripts that source this
cache=${MECA_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/meca500}

as_root() {
  if [ "$(id -u)" = 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    die "this needs root and there is no sudo here; as root: $*"
  fi
}

debian_version() { (. /etc/os-release 2>/dev/null && echo "${VERSION_ID:-0}"); }

# The packages that one purpose needs, by the names of this Debian.
packages_for() {
  case $1 in
    build)
      echo g++ cmake ninja-build libfastcdr-dev fastddsgen libyaml-cpp-dev libspdlog-dev libcli11-dev \
        nlohmann-json3-dev libgtest-dev libgmock-dev libbenchmark-dev cyclonedds-dev cyclonedds-tools
      # Fast DDS 2 was called fastrtps.
      case $(debian_version) in 12*) echo libfastrtps-dev ;; *) echo libfastdds-dev ;; esac
      ;;
    ethercat) echo iproute2 ;; # virtual cables, for tests and bench as well
    tshark) echo tshark ;; # for .ci/run alone
    clang) echo clang libclang-rt-dev ;;
    format) echo clang-format ;;
    debootstrap) echo debootstrap ;;
    buildah) echo buildah ;;
  esac
}

is_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

# need PURPOSE...: installs what is missing; silent and quick when nothing is.
need() {
  [ -n "${MECA_NO_INSTALL:-}" ] && return
  local purpose package missing=()
  if ! command -v dpkg-query >/dev/null; then
    say "this is not Debian: install by hand what corresponds to: $(for purpose; do packages_for "$purpose"; done | xargs)"
    return
  fi
  for purpose; do
    for package in $(packages_for "$purpose"); do
      is_installed "$package" || missing+=("$package")
    done
  done
  [ ${#missing[@]} = 0 ] && return
  say "installing from Debian's packages: ${missing[*]}"
  as_root apt-get update -qq || say "apt-get update failed; trying with the package lists that are here"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends "${missing[@]}" >/dev/null ||
    die "apt-get could not install them (see above); install them by hand, then set MECA_NO_INSTALL=1"
}

# build PRESET [TARGET...]: configures when needed and builds; without targets everything.
build() {
  local preset=$1
  local log=build/configure-$preset.log
  shift
  mkdir -p build
  [ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" >"$log" 2>&1 || {
    cat "$log" >&2
    die "configuring the preset '$preset' failed (see above)"
  }
  cmake --build "build/$preset" --parallel "$jobs" ${1:+--target "$@"}
}
