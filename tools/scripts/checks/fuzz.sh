#!/usr/bin/env bash
# Fuzzes the readers and the engine (docs/fuzzing.md): builds the targets with clang's fuzzer and sanitizers, and runs each.
#
#   tools/scripts/checks/fuzz.sh [SECONDS each, 600] [TARGET...]
#
# New cases go to build/fuzz/corpus/TARGET; a case that fails to build/fuzz/crash-*, and the exit code is not 0. A mended
# fault's case belongs into tests/fuzz/corpus/TARGET, which `ctest -R fuzz` replays.
set -euo pipefail
cd "$(dirname "$0")/../../.."
seconds="${1:-600}"
shift || true
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(scenario campaign profile tables run_folder engine)
cmake --preset fuzz > /dev/null
cmake --build --preset fuzz

# Names of keys, fields and drivers, which bytes by chance do not hit.
grep -ohE '"[A-Za-z][A-Za-z0-9_ .-]{1,30}"' -r src/io src/run src/simulate | sort -u > build/fuzz/words.dict
[ -w /dev/shm ] && export TMPDIR=/dev/shm  # the targets write their case into a folder: no disk is needed
export OMP_NUM_THREADS=2 OMP_WAIT_POLICY=passive
# Leaks are for `ctest --preset asan`; with these options a case takes a third of the time (docs/fuzzing.md).
export ASAN_OPTIONS=detect_leaks=0:malloc_context_size=2:quarantine_size_mb=16
for target in "${targets[@]}"; do
  mkdir -p "build/fuzz/corpus/$target"
  dictionary=()
  [ "$target" = engine ] || dictionary=(-dict=build/fuzz/words.dict)
  echo "== $target, $seconds s"
  TIMEFORMAT="$target: %U s of the processor, %S s of the system, %R s by the clock"
  time "build/fuzz/tests/fuzz_$target" -max_total_time="$seconds" -max_len=20000 -timeout=10 -rss_limit_mb=4096 \
    -detect_leaks=0 -print_final_stats=1 -artifact_prefix="build/fuzz/crash-$target-" "${dictionary[@]}" \
    "build/fuzz/corpus/$target" "tests/fuzz/corpus/$target" 2>&1 | { grep -vE "^#|INFO|NEW_FUNC" || true; }
done
