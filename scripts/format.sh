#!/usr/bin/env bash
# ./meca format [--check]: clang-format as .clang-format says, on every C and C++ file that git knows.
. scripts/common.sh
need format
mode=(-i)
[ "${1:-}" = --check ] && mode=(--dry-run -Werror)
git ls-files -z '*.cpp' '*.hpp' '*.c' '*.h' | xargs -0 clang-format "${mode[@]}"
