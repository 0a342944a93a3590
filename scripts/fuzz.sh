#!/usr/bin/env bash
# ./meca fuzz [seconds] [target]: every libFuzzer target for so long (default 30 s), starting from its corpus.
# New inputs go to build/fuzz/found/, a crash to build/fuzz/crash/; put what is worth keeping into tests/fuzz/corpus.
. scripts/common.sh
seconds=${1:-30}
only=${2:-}
[[ $seconds =~ ^[0-9]+$ ]] || die "fuzz: '$seconds' is not a number of seconds"
need build clang

mapfile -t targets < <(find tests/fuzz -maxdepth 1 -name '*_fuzz.cpp' -printf '%f\n' | sed 's/_fuzz\.cpp$//' | sort)
[ -z "$only" ] || targets=("$only")
[ ${#targets[@]} -gt 0 ] || die "fuzz: there is no tests/fuzz/*_fuzz.cpp"
build fuzz "${targets[@]/#/fuzz_}"

for target in "${targets[@]}"; do
  mkdir -p "build/fuzz/found/$target" build/fuzz/crash
  corpus=tests/fuzz/corpus/$target
  [ -d "$corpus" ] || die "fuzz: $target has no corpus; put a few inputs into $corpus"
  if ! "build/fuzz/bin/fuzz_$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/crash/$target-" "build/fuzz/found/$target" "$corpus" >"build/fuzz/$target.log" 2>&1; then
    tail -n 60 "build/fuzz/$target.log"
    die "fuzz: $target found something; the input is in build/fuzz/crash/, the whole log in build/fuzz/$target.log"
  fi
  say "fuzz: $target: $(sed -n 's/^stat::number_of_executed_units: *//p' "build/fuzz/$target.log") inputs in $seconds s, nothing found"
done
