#!/usr/bin/python3
"""Does a test catch each of many deliberate faults in the engine, the tallies, the products and the fit?

  tools/scripts/checks/mutants.py [--only WORD] [--build build/mutants] [--jobs 2]
  tools/scripts/checks/mutants.py --check      whether every line of the table is still in its file

The sources are copied to build/mutants/tree and built there once (minutes). Then, for each fault of `MUTANTS`, one line is
changed, core_tests are built and run: first the tests named in the table, then, if none fails, all. Printed: the fault, and the
first test that fails, or SURVIVED; at the end how many survived. Exit code 1 if any did. Half an hour of two cores.
Results: docs/validation.md, "Faults on purpose".
"""
import argparse
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]

# file, text, what it becomes, tests that should see it
MUTANTS = [
    # the engine
    ("include/talus/physics/impact.hpp", "0.5 + 0.5 * draw.longitudinal", "0.5 - 0.5 * draw.longitudinal", "*Impact*:*Rough*:*Asper*"),
    ("include/talus/physics/impact.hpp", "(0.5 * draw.transverse)", "draw.transverse", "*Impact*:*Rough*:*Asper*"),
    ("src/physics/impact.cpp", "draw.longitudinal < kLowestBracket && part", "draw.longitudinal < 0.0 && part", "*Impact*:*Rough*:*Asper*"),
    ("include/talus/physics/impact.hpp", "cos_theta * level - sin_theta * normal.z()", "cos_theta * level + sin_theta * normal.z()", "*Impact*:*Rough*"),
    ("include/talus/physics/impact.hpp", "tilts & (velocity.dot(n2) < 0.0)", "tilts", "*Impact*:*Rough*"),
    ("include/talus/physics/impact.hpp", "ground.Et50 / (deformation_energy + ground.Et50)", "ground.En50 / (deformation_energy + ground.En50)", "*Impact*:*Restit*"),
    ("include/talus/physics/impact.hpp", "2.0 / 7.0 * slip", "2.0 / 5.0 * slip", "*Impact*:*Friction*"),
    ("include/talus/physics/impact.hpp", "(1.0 + k.normal) * v_n", "k.normal * v_n", "*Impact*:*Friction*"),
    ("include/talus/physics/impact.hpp", "2.5 / arm * n.cross(friction)", "2.5 / arm * friction.cross(n)", "*Impact*:*Energy*"),
    ("src/physics/impact.cpp", "draws_[event - first_]", "draws_[(event - first_) / 2]", "*Impact*:*Asper*:*Vector*"),
    ("src/physics/trace.cpp", "motion_.velocity.dot(normal_) < kSlideSpeed", "motion_.velocity.dot(normal_) < 10.0 * kSlideSpeed", "*Trace*:*Slide*:*Vector*"),
    ("src/physics/trace.cpp", "if (!fast && normal_.head<2>().norm() <= ground.tan_phi * normal_.z()) return End::Stopped;", "if (!fast) return End::Stopped;", "*Trace*:*End*:*Stop*"),
    ("src/physics/trace.cpp", "path_.impacts += 1;", "path_.impacts += 2;", "*Trace*:*Path*"),
    ("src/physics/slide.cpp", "const double friction = tan_phi * kGravity / std::sqrt(w2);", "const double friction = tan_phi * kGravity;", "*Slid*:*Slope*"),
    ("src/physics/slide.cpp", "if (squared > most) velocity *= std::sqrt(most / squared);", "", "*Slid*:*Energy*"),
    ("src/physics/slide.cpp", "kGravity + 2.0 * twist * v.x() * v.y()", "kGravity - 2.0 * twist * v.x() * v.y()", "*Slid*"),
    ("src/physics/crossing.hpp", "choose(rate > 0.0, 1.0 - share, share)", "choose(rate > 0.0, share, 1.0 - share)", "*Fl*"),
    ("include/talus/terrain/surface.hpp", "choose(along, 0.5 * (south.corner + north.corner)", "choose(along, south.corner", "*Surface*:*Crease*"),
    ("src/simulate/plan/plan.cpp", "const auto place = random.words(0), size = random.words(1);", "const auto place = random.words(0), size = random.words(0);", "*Release*:*Plan*:*Size*"),
    ("src/simulate/plan/plan.cpp", "(uniform(place[1]) - 0.5) * grid.cell_y", "uniform(place[1]) * grid.cell_y", "*Release*:*Plan*"),
    ("src/simulate/plan/plan.cpp", "const Random random(scenario.seed, source, block, Purpose::Release);", "const Random random(scenario.seed, source, block / 2, Purpose::Release);", "*Release*:*Plan*:*Stream*"),
    # the tallies
    ("src/simulate/tally/cell_record.cpp", "maximum[q] = std::max(maximum[q], summary.largest);", "maximum[q] = summary.largest;", "*Tally*:*Cell*"),
    ("src/simulate/tally/cell_record.cpp", "  add_checked(exits, other.exits);\n", "", "*Tally*:*Cell*:*Merge*"),
    ("include/talus/simulate/tally/checked_sum.hpp", "value * units + 0.5", "value * units", "*Tally*:*Cell*:*Mean*"),
    ("src/simulate/tally/tally.cpp", "values[i] > limit ? 1U : 0U", "values[i] >= limit ? 1U : 0U", "*Tally*:*Exceed*:*Thresh*"),
    ("include/talus/simulate/plan/region.hpp", "row % kRegionSide * kRegionSide + column % kRegionSide", "column % kRegionSide * kRegionSide + row % kRegionSide", "*Tally*:*Region*:*Visit*"),
    ("src/simulate/tally/histogram.cpp", "std::ceil(share * count)", "std::floor(share * count)", "*Histogram*:*Percentile*"),
    ("src/simulate/tally/histogram.cpp", "if (width_ == 1 && count > 0xFFU) widen(2);", "if (width_ == 1 && count > 0x1FFU) widen(2);", "*Histogram*"),
    ("src/simulate/tally/histogram.cpp", "add_checked(count, more);", "count = more;", "*Histogram*:*Merge*"),
    ("src/simulate/tally/visits.cpp", "/ mass - rotation)", "/ mass)", "*Rotation*"),
    ("src/simulate/tally/tally.cpp", "hazard.add(hazard_->rules, counted(Quantity::Energy, values)", "hazard.add(hazard_->rules, values.of(Quantity::Energy)", "*Rotation*"),
    ("src/simulate/tally/tally.cpp", "if (count_rotation_) largest[Quantity::Energy] = total;", "", "*Rotation*"),
    ("src/products/object_finder.cpp", "next_spin->span <= i", "next_spin->span < i", "*ObjectFinder*"),
    ("src/simulate/tally/hazard_tally.cpp", "energy > thresholds[level - 1]", "energy >= thresholds[level - 1]", "*Hazard*"),
    ("src/simulate/tally/hazard_tally.cpp", "sum * sum - level.squares", "sum * sum", "*Hazard*:*Overlap*"),
    ("src/simulate/tally/hazard_tally.cpp", "add_checked(bin.square, other.bins_[i].square);", "bin.square = other.bins_[i].square;", "*Hazard*"),
    ("src/simulate/tally/barrier_counts.cpp", "passage.how == Meeting::Over ? part.over", "passage.how == Meeting::Over ? part.caught", "*Barrier*"),
    ("src/simulate/totals.cpp", "totals.impacts += part.impacts;", "", "*Totals*:*Simul*"),
    # products and hazard
    ("src/products/comparison.cpp", "or_zero(b) - or_zero(a)", "or_zero(a) - or_zero(b)", "*Compar*"),
    ("src/products/comparison.cpp", "run[1] > other[2];", "run[1] > other[1];", "*Compar*"),
    ("src/products/comparison.cpp", "raster.lower_is_worse ? std::fmin(worst[i], run[i])", "false ? std::fmin(worst[i], run[i])", "*Compar*"),
    ("src/products/interval.cpp", "0.5 * (1.0 - confidence)", "(1.0 - confidence)", "*Interval*:*Bound*"),
    ("src/products/interval.cpp", "sources * (trials - 1)", "sources * trials", "*Interval*:*Reach*"),
    ("src/products/percentile_bounds.cpp", "at_most(low, count, share) <= kTail", "at_most(low + 1.0, count, share) <= kTail", "*Percentile*"),
    ("src/products/hazard.cpp", "{1.0 / frequency.value, 1.0 / frequency.high, 1.0 / frequency.low}", "{1.0 / frequency.value, 1.0 / frequency.low, 1.0 / frequency.high}", "*Hazard*:*Return*"),
    ("src/products/hazard_matrix.cpp", "frequencies[i] * matrix.years[column] >= kOnce", "frequencies[i] * matrix.years[column] > kOnce + 0.1", "*Hazard*:*Matrix*:*Class*"),
    ("src/products/hazard_matrix.cpp", "highest = std::max(highest, matrix.classes[i][column])", "highest = matrix.classes[i][column]", "*Hazard*:*Matrix*:*Class*"),
    ("src/products/barrier_design.cpp", "0.5 * d.mass * d.speed * d.speed", "d.mass * d.speed * d.speed", "*Barrier*:*Design*"),
    ("src/products/return_values.cpp", "if (!blocks.insert(crossing->block).second) continue;", "", "*OnceIn*"),
    ("src/simulate/tally/cell_record.cpp", "if (full) break;", "", "*Tally*:*Cell*:*Histogram*"),
    ("src/products/barrier_design.cpp", "c.energy() > design.mel", "c.energy() > design.sel", "*Barrier*:*Design*"),
    ("src/products/weibull.cpp", "first - 1.0 / shape - mean", "first - 0.9 / shape - mean", "*Weibull*"),
    ("src/products/weibull.cpp", "std::exp(-std::pow(x / scale, shape))", "1.0 - std::exp(-std::pow(x / scale, shape))", "*Weibull*"),
    ("src/products/raster_table.cpp", "values[1] = length.low / area;\n    values[2] = length.high / area;", "values[2] = length.low / area;\n    values[1] = length.high / area;", "*Raster*:*Map*:*Passage*"),
    ("src/products/held_at_release.cpp", "2.0 * row.diameter", "0.2 * row.diameter", "*Held*"),
    ("src/simulate/scenario/frequency.cpp", "cell * largest_factor / s.trajectories", "cell * largest_factor", "*Frequen*:*Weight*:*Hazard*"),
    ("src/simulate/scenario/frequency.cpp", "std::pow(low, -rules.exponent) - std::pow(high, -rules.exponent)", "std::pow(low, -rules.exponent)", "*Frequen*:*Law*"),
    # the fit
    ("src/fit/score/fair_scores.cpp", "pairs / (n * (n - 1.0))", "pairs / (n * n)", "*Fair*:*Score*"),
    ("src/fit/score/fair_scores.cpp", "share * (1.0 - share) / std::max(1.0, trials - 1.0)", "share * (1.0 - share) / trials", "*Fair*:*Brier*:*Score*"),
    ("src/fit/score/score.cpp", "if (block.holdout || !block.stop) continue;", "if (!block.stop) continue;", "*Score*"),
    ("src/fit/score/score.cpp", "std::sqrt(variance_of(x) + variance_of(y))", "std::sqrt(variance_of(x))", "*Score*"),
    ("src/fit/diagnose/permutation.cpp", "static_cast<double>(list.size()) + 1.0", "static_cast<double>(list.size())", "*Permut*:*Arrange*:*Propert*"),
]


def copy_sources(tree):
    files = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\n")
    for name in filter(None, files):
        there = tree / name
        there.parent.mkdir(parents=True, exist_ok=True)
        if not there.exists() or there.read_bytes() != (ROOT / name).read_bytes():
            shutil.copyfile(ROOT / name, there)


def failing_test(program, tests):
    """The first test that fails or is killed; nothing where all pass."""
    try:
        done = subprocess.run([program, f"--gtest_filter={tests}", "--gtest_fail_fast", "--gtest_brief=1"], capture_output=True,
                              text=True, timeout=1200, errors="replace")
    except subprocess.TimeoutExpired:
        return "no end after 20 minutes"
    if done.returncode == 0:
        return None
    named = re.search(r"\[  FAILED  \] (\S+)", done.stdout)
    return named.group(1) if named else f"the program ends with {done.returncode}"


def caught(tree, program, build, mutant):
    name, text, becomes, tests = mutant
    file = tree / name
    source = file.read_text()
    if source.count(text) == 0:
        return "NOT FOUND: the table is out of date"
    file.write_text(source.replace(text, becomes, 1))
    try:
        built = subprocess.run(build, capture_output=True, text=True)
        if built.returncode != 0:
            return "does not compile"
        return failing_test(program, tests) or failing_test(program, "*") or "SURVIVED"
    finally:
        file.write_text(source)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="part of a file's name or of the text")
    parser.add_argument("--build", type=Path, default=ROOT / "build/mutants")
    parser.add_argument("--jobs", default="2")
    parser.add_argument("--check", action="store_true")
    o = parser.parse_args()
    if o.check:
        gone = [f"{name}: {text}" for name, text, _, _ in MUTANTS if text not in (ROOT / name).read_text()]
        sys.exit("not in its file: " + "; ".join(gone) if gone else 0)
    tree, binary = o.build / "tree", o.build / "build"
    copy_sources(tree)
    subprocess.run(["cmake", "-S", tree, "-B", binary, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DTALUS_BENCH=OFF"], check=True,
                   stdout=subprocess.DEVNULL)
    build = ["ninja", "-C", str(binary), "-j", o.jobs, "core_tests"]
    subprocess.run(build, check=True, stdout=subprocess.DEVNULL)
    program = binary / "tests/core_tests"
    mutants = [m for m in MUTANTS if o.only in m[0] or o.only in m[1]]
    survivors = 0
    for mutant in mutants:
        began = time.time()
        by = caught(tree, program, build, mutant)
        survivors += by.startswith(("SURVIVED", "NOT FOUND", "does not compile"))
        print(f"{mutant[0]}: {' '.join(mutant[1].split())}  ->  {' '.join(mutant[2].split()) or '(removed)'}\n    {by}, "
              f"{time.time() - began:.0f} s", flush=True)
    print(f"{len(mutants)} faults, {survivors} survived")
    sys.exit(survivors > 0)


if __name__ == "__main__":
    main()
