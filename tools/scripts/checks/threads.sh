#!/usr/bin/env bash
# Looks for races: builds with clang's thread sanitizer and runs what is parallel with four threads: the engine on the fuzz corpus,
# a run with all its files, parts and their merge, hazard, a score. libarcher tells the sanitizer what OpenMP does (it knows no
# OpenMP by itself). First a program with a race, which must be found, and the same without one. Ends with an error at the first
# race. Not in CI: four minutes of building for code that rarely changes.
set -euo pipefail
cd "$(dirname "$0")/../../.."
archer=$(ls /usr/lib/llvm-*/lib/libarcher.so | tail -1)
export OMP_TOOL_LIBRARIES="$archer" TSAN_OPTIONS="ignore_noninstrumented_modules=1 halt_on_error=1" OMP_NUM_THREADS=4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for way in "" "reduction(+ : sum)"; do
  printf 'int main() {\n  int sum = 0;\n#pragma omp parallel for %s\n  for (int i = 0; i < 10000; ++i) sum += i;\n  return sum == 0;\n}\n' \
    "$way" > "$work/race.cpp"
  clang++ -O1 -g1 -fsanitize=thread -fopenmp=libomp "$work/race.cpp" -o "$work/race"
  found=no
  "$work/race" > "$work/race.txt" 2>&1 || { grep -q "data race" "$work/race.txt" && found=yes; }
  expected=$([ -z "$way" ] && echo yes || echo no)
  [ "$found" = "$expected" ] || { echo "threads.sh: the sanitizer does not tell a race from none here (${way:-race})" >&2; exit 1; }
done
cmake --preset tsan > /dev/null
cmake --build --preset tsan --target talus fuzz_engine
talus=build/tsan/talus
build/tsan/tests/fuzz_engine tests/fuzz/corpus/engine
$talus run data/valley/scenario.toml -o "$work/whole" --trajectories 3 --threads 4 -q
for part in 1 2; do $talus run data/valley/scenario.toml -o "$work/part-$part" --part "$part/2" --trajectories 3 --threads 4 -q; done
$talus merge "$work/merged" "$work/part-1" "$work/part-2" --threads 4 -q
cmp "$work/whole/impact_probability.tif" "$work/merged/impact_probability.tif"
$talus hazard "$work/whole" -q
printf '[ground]\ndefault = "upper-talus-3d"\n' > "$work/model.toml"
$talus score data/elm/campaign.toml --parameters "$work/model.toml" --trials 20 --threads 4 -q > "$work/score.txt"
echo "no race"
