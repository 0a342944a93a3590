#!/usr/bin/env bash
# runtime_packages.sh BINARY...: the Debian packages whose shared libraries these programs load, one a line.
set -euo pipefail

# dpkg knows a file under the path it was packed with, which on a merged /usr is not always the one that ldd prints.
owner_of() {
  local path
  for path in "$(readlink -f "$1")" "$1" "/usr$1" "$(readlink -f "$1" | sed 's|^/usr||')"; do
    dpkg-query -S "$path" 2>/dev/null && return
  done
  echo "no package owns $1" >&2
  return 1
}

ldd "$@" | awk '$2 == "=>" && $3 ~ /^\// {print $3}' | sort -u | while read -r library; do
  owner_of "$library"
done | sed 's/:.*//' | sort -u
