#!/usr/bin/env bash
# Runs the tests of core, files and runs of a build with sanitizers, and replays the corpus of the fuzz targets:
# sanitized_tests.sh build/asan. Two processes at a time: one for each test, as ctest has it, takes as long again to begin.
set -euo pipefail
cd "$(dirname "$0")/../../.."
build="$1"
# Long where nothing is optimised, and run by tools/test.sh in the release build: tests of laws by many blocks.
long="*ScoreTest*:*Calibrate*:*FreePaths*:*EffectFits*:*JointFits*:*Nested*:*ResidualTable*:*SceneSymmetry*:*PlaneTable*:*PlaneSigns*"
long+=":*PlaneScaling*:*LogScore*:*DepositScore*:*DepositCheck*:*WithZerosToo*:*Dispersion*:*Evaluate*:*EnergyComponent*:*CoverageOf*"
long+=":*PropertyTest*:*TheFreePathAmong*:*DayTest*:*FurtherScreens*:AirDrag.LandsAfterAThrow*:Touch.AgreesWithSmallSteps"
long+=":ImpactEnergy.N*:ImpactEnergy.WithA*:VisitBatch.VisitsNoOther*:*RoughFlight.Lands*2500_by*:*RoughFlight.Lands*50_by_50*:*RoughFlight.Lands*200_by_300*"
long+=":BoundsOfReached.Cover*:LogHistogram.HoldsTheBound*:ScreenFinder.APathVertex*:ChiBar.OfTwo*:Regression.OfNormal*"
long+=":PercentileBounds.Cover*:AnnualFrequency.BoundsOfStrataCover*:ForestStems.TheRateIsThatOfEachCell"
long+=":Random.NeighboursAreIndependent:Random.TheBattery*:CrossingsPerYear.BoundsOfPieces*:Intervals.*Cover*:VisitBatch.FlightsOver*"
long+=":RestInRoughness.KnowsNoDirection:RestInRoughness.MoreBlocks*:TreeList.TheIndexFinds*:TreeList.APlantedStrip*:Energy.NeverGrows*"
long+=":*BarrierRun.NothingBehind*:*BarrierRun.ZeroHeight*:Pieces.ABlockOfWhich*:SettledModel.IsTheTrue*:SettledModel.LeavesAn*"
export LSAN_OPTIONS="suppressions=$PWD/tests/leaks_of_libomp.txt:print_suppressions=0"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

# A half of the tests of a program; prints what it says if one fails.
run() {
  local program="$1" half="$2" log="$work/$1-$2"
  if ! GTEST_TOTAL_SHARDS=2 GTEST_SHARD_INDEX="$half" timeout 1800 "$build/tests/$program" --gtest_brief=1 --gtest_filter="-$long" > "$log" 2>&1; then
    cat "$log"
    return 1
  fi
  tail -n 1 "$log"
}

for program in core_tests io_tests run_tests; do
  run $program 0 & first=$!
  run $program 1 & second=$!
  failed=0
  wait $first || failed=1
  wait $second || failed=1
  [ $failed = 0 ]
done
ctest --test-dir "$build" --output-on-failure -j 2 -R "^(fuzz\\.|layers|lanes_)"
