#!/usr/bin/python3
"""How often is `talus diagnose` right? Makes campaigns with the engine itself and diagnoses them.

  tools/scripts/studies/diagnosis_study.py [--talus build/release/talus] [--effects all] [--magnitudes 1,2,0.5] [--blocks 60,120]
      [--each 1] [--screens 3] [--none 20] [--null plain,scatter,grouped,outside] [--base-fits 1] [--again] [--trials 24] [--test-trials 100] [--most-effects 3]
      [--threads N] [--jobs 1] [--work DIR] [--seed 1] [-o study.csv]

Each campaign has a slope of its own (length, steepness, a gully, bumps), three zones, blocks of many sizes and shapes, three
screens (--screens, all but one in the meadow) and four days. One effect of a known size acts (or none). One simulated trial per block, with errors of measurement,
serves as the measurement. A third of the blocks is held out. Prints the confusion matrix, the false alarms and the power by
magnitude, how many effects were not named though they act above the detection limit that the diagnosis gives for the place
where they act, and the error on the held-out rows of three models: the ground alone, the model that was
found, the model that made the data. Campaigns without an effect are of the kinds of --null in turn: `plain`; `scatter`, whose
stops, speeds, jumps and spins scatter 1.6 times as much in variance as trials of the model; `grouped`, six blocks a group,
which share an error of the release of 6 m and a ground of their own (each parameter 15 % up or down); `outside`, a ground far
from the start of the fit (theta_scale of talus and rock beyond 2.5 standard deviations of the prior). Printed for these: how
often each family is below 1, 5 and 10 %, and how far the fitted ground lies from the true one (towards the prior); with
--again also for a second diagnosis, which starts from the ground that the first one fitted. The same
engine makes and judges the data: this measures the statistics, not the physics. Campaigns that are finished, with the same
seed, options and program, are not run again. A campaign takes one to eight minutes of one core. Results:
docs/diagnosis-results.md, "The study".
"""
import csv
import hashlib
import itertools
import json
import os
import shutil
import tomllib
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from osgeo import gdal

from files import read_json, read_table, write_raster, write_text
from program import list_of, parser_of, talus

WEST, SOUTH, CELL, COLUMNS, ROWS = 2_600_000.0, 1_200_000.0, 2.0, 160, 260
GROUND = """
[ground.zones.{name}]
theta_scale = {theta:.4f}
psi_scale = {psi:.4f}
En50 = {En:.4f}
Et50 = {Et:.4f}
shape = [1.0, 1.4]
"""
# The size 1 of each effect: [table] and its keys, each times the magnitude where it is a pair (value, "x").
EFFECTS = {
    "vegetation-drag": {"coefficient": (150.0, "x"), "height": (8.0, ""), "zones": '["meadow"]'},
    "forest-stems": {"density": (300.0, "x"), "diameter": (0.35, ""), "zones": '["meadow"]'},
    "block-shape": {"lateral": (0.8, "x"), "loss": (0.12, "x")},
    "block-mass": {"roughness": (0.4, "x")},
    "wet-ground": {"softening": (0.8, "x"), "drag": (0.5, "x"), "days": "[2]"},
    "soft-ground": {"drag": (2.0, "x"), "zones": '["meadow"]'},
    "rolling-resistance": {"coefficient": (0.3, "x"), "zones": '["meadow"]'},
    "air-drag": {"coefficient": (1.0, "x")},
    "fragmentation": {"threshold": (60.0, "/"), "largest": (0.7, "")},
}

# Distances of the screens from the northern edge [m]: the first in the talus, the others in the meadow.
SCREENS = (140, 250, 320)

# Where they act, as the diagnosis calls it; the others everywhere.
PLACES = {name: "zone meadow" for name, keys in EFFECTS.items() if "zones" in keys} | {"wet-ground": "day 2"}
GROUND_KEYS = ("theta_scale", "psi_scale", "En50", "Et50")
FAMILIES = ("block property", "place", "day", "instrument", "dispersion")
NULLS = ("plain", "scatter", "grouped", "outside")
BLOCKS = "id,x,y,release_height_m,vx,vy,vz,mass_kg,density_kgm3,L1_m,L2_m,L3_m,day,holdout,group"


def terrain(g, folder):
    """A face that eases into a run-out, with a gully and bumps. Row 0 is in the north, where the blocks start."""
    y = (np.arange(ROWS) + 0.5)[:, None] * CELL
    x = (np.arange(COLUMNS) + 0.5)[None, :] * CELL - COLUMNS * CELL / 2
    steep = np.tan(np.radians(g.uniform(37, 42)))
    knee = 40 * np.log1p(np.exp((y - 260) / 40))
    fall = y * steep - knee * (steep - 0.10)
    gully = g.uniform(2, 6) * np.exp(-((x - g.uniform(-20, 20)) / 25) ** 2)
    bumps = sum(g.uniform(0.2, 0.5) * np.sin(x / g.uniform(9, 25) + y / g.uniform(9, 25) + g.uniform(0, 6)) for _ in range(6))
    corner = (WEST, SOUTH + ROWS * CELL)
    write_raster(f"{folder}/dem.tif", 400 - fall - gully + bumps, corner, CELL, options=["COMPRESS=DEFLATE"])
    zones = np.where(y < 60, 3, np.where(y < 240, 1, 2)) * np.ones((1, COLUMNS))
    write_raster(f"{folder}/zones.tif", zones, corner, CELL, kind=gdal.GDT_Byte, options=["COMPRESS=DEFLATE"])


def blocks(g, folder, count, grouped):
    with open(f"{folder}/blocks.csv", "w", encoding="utf-8") as out:
        out.write(BLOCKS + "\n")
        for i in range(count):
            mass = np.exp(g.uniform(np.log(80), np.log(2500)))
            a, b = sorted(g.uniform(0.45, 1.0, 2), reverse=True)
            length = (6 * mass / 2700 / np.pi / a / b) ** (1 / 3)
            out.write(f"b{i:03d},{WEST + COLUMNS * CELL / 2 + g.uniform(-30, 30):.2f},{SOUTH + ROWS * CELL - g.uniform(8, 40):.2f},"
                      f"{g.uniform(0.5, 2):.2f},0,-1,0,{mass:.1f},2700,{length:.3f},{a * length:.3f},{b * length:.3f},"
                      f"{1 + i % 4},{int((i // 6 if grouped else i) % 3 == 1)},{f'g{i // 6}' if grouped else ''}\n")


def campaign_text(name, measured):
    tables = 'stops = "stops.csv"\npassages = "passages.csv"\n' if measured else ""
    return (f'name = "{name}"\ncrs = "EPSG:2056"\nsurface = "bilinear"\ndem = "dem.tif"\nzones = "zones.tif"\nblocks = "blocks.csv"\n{tables}'
            'screens = "screens.csv"\n[zone_names]\n1 = "talus"\n2 = "meadow"\n3 = "rock"\n[measurement_error]\n'
            "position_m = 0.3\nspeed_fraction = 0.03\njump_height_m = 0.1\nangular_velocity_fraction = 0.05\n")


def model_text(g, effect, magnitude, outside=False, factors=np.ones((3, 4))):
    text = '[ground]\ndefault = "upper-talus-3d"\n'
    zones = (("talus", 0.07 if outside else 0.8, 13), ("meadow", 1.0, 8), ("rock", 0.07 if outside else 0.5, 20))
    for (name, theta, En), times in zip(zones, factors):
        text += GROUND.format(name=name, theta=theta * g.uniform(0.9, 1.2) * times[0], psi=g.uniform(0.5, 0.8) * times[1],
                              En=En * g.uniform(0.8, 1.2) * times[2], Et=45 * g.uniform(0.7, 1.3) * times[3])
    if effect != "none":
        text += f"\n[effects.{effect}]\n"
        for key, value in EFFECTS[effect].items():
            if isinstance(value, tuple):
                size = value[0] * magnitude if value[1] == "x" else value[0] / magnitude if value[1] == "/" else value[0]
                value = f"{size:.6g}"
            text += f"{key} = {value}\n"
    return text


def simulated(o, folder, name, seed):
    """Stops and passages of ten trials of each block by the model NAME.toml."""
    talus(o, "score", f"{folder}/plan.toml", "--parameters", f"{folder}/{name}.toml", "--trials", 10, "--seed", 1000 + seed,
          "--dump", f"{folder}/{name}", "-q")
    stops = [s for s in read_table(f"{folder}/{name}/stops.csv") if s["end"] in ("stopped", "trapped")]
    return stops, read_table(f"{folder}/{name}/passages.csv")


def scatter_more(g, table, keys):
    """Adds to each number the same scatter again times 0.6 ** 0.5: the pooled standard deviation within the blocks."""
    for key in keys:
        within = defaultdict(list)
        for row in table:
            within[row["block"], row.get("screen")].append(float(row[key]))
        variances = [np.var(values, ddof=1) for values in within.values() if len(values) > 1]
        spread = np.sqrt(0.6 * np.mean(variances)) if variances else 0.0
        for row in table:
            value = float(row[key]) + g.normal(0.0, spread)
            row[key] = f"{value if key in 'xy' else max(0.0, value):.4f}"


def in_groups(g, o, folder, seed, effect, magnitude):
    """Each group falls on a ground of its own and its releases are written down with an error of their own."""
    table = read_table(f"{folder}/blocks.csv")
    ground = g.bit_generator.state
    stops, passages = [], []
    for group in sorted({row["group"] for row in table}):
        g.bit_generator.state = ground  # the same ground but for the group's own factors
        own = np.random.default_rng([seed, int(group[1:])])
        write_text(f"{folder}/{group}.toml", model_text(g, effect, magnitude, factors=own.choice([0.85, 1 / 0.85], (3, 4))))
        of_group = {row["id"] for row in table if row["group"] == group}
        some_stops, some_passages = simulated(o, folder, group, seed)
        stops += [s for s in some_stops if s["block"] in of_group]
        passages += [p for p in some_passages if p["block"] in of_group]
        shift = own.normal(0.0, 6.0, 2)
        for row in table:
            if row["id"] in of_group:
                row["x"], row["y"] = f"{float(row['x']) + shift[0]:.2f}", f"{min(float(row['y']) + shift[1], SOUTH + ROWS * CELL - 2):.2f}"
    write_text(f"{folder}/blocks.csv", BLOCKS + "\n" + "".join(",".join(row.values()) + "\n" for row in table))
    return stops, passages


def screen_distances(count):
    return (SCREENS[0], *np.linspace(*SCREENS[1:], count - 1))


def make(o, folder, effect, magnitude, count, seed, null="plain"):
    """A campaign in `folder`: the measurements of one trial of the model in truth_model.toml."""
    os.makedirs(folder, exist_ok=True)
    g = np.random.default_rng(seed)
    terrain(g, folder)
    blocks(g, folder, count, null == "grouped")
    top = SOUTH + ROWS * CELL
    lines = [f'S{i + 1},"LINESTRING ({WEST + 4} {top - d}, {WEST + COLUMNS * CELL - 4} {top - d})"' for i, d in enumerate(screen_distances(o.screens))]
    write_text(f"{folder}/screens.csv", "id,wkt\n" + "\n".join(lines) + "\n")
    write_text(f"{folder}/plan.toml", campaign_text("plan", False))
    ground = g.bit_generator.state
    write_text(f"{folder}/truth_model.toml", model_text(g, effect, magnitude, null == "outside"))
    stops, passages = simulated(o, folder, "truth_model", seed)
    if null == "scatter":
        scatter_more(g, stops, "xy")
        scatter_more(g, passages, ("speed_ms", "jump_height_m", "angular_velocity_rads"))
    if null == "grouped":
        g.bit_generator.state = ground
        stops, passages = in_groups(g, o, folder, seed, effect, magnitude)
    mass = {b["id"]: float(b["mass_kg"]) for b in read_table(f"{folder}/blocks.csv")}
    write_text(f"{folder}/stops.csv", "id,x,y,mass_kg\n" + "".join(
        f"{s['block']},{s['x']},{s['y']},{float(s['mass_share']) * mass[s['block']]:.1f}\n" for s in stops if s["trial"] == "0"))
    write_text(f"{folder}/passages.csv", "id,screen,speed_ms,jump_height_m,angular_velocity_rads\n" + "".join(
        f"{p['block']},{p['screen']},{p['speed_ms']},{p['jump_height_m']},{p['angular_velocity_rads']}\n"
        for p in passages if p["trial"] == "0"))
    write_text(f"{folder}/campaign.toml", campaign_text(os.path.basename(folder), True))


def program(o):
    """The first digits of the checksum of the program."""
    with open(shutil.which(o.talus), "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()[:12]


def zones_of(path):
    with open(path, "rb") as file:
        return tomllib.load(file)["ground"]["zones"]


def pull(fitted, truth):
    """How far the fitted ground lies from the true one: the logarithm of fitted over true, by parameter, on average over the zones."""
    fitted, truth = zones_of(fitted), zones_of(truth)
    return {key: np.mean([np.log(fitted[zone][key] / truth[zone][key]) for zone in truth]) for key in GROUND_KEYS}


def diagnosis_folder(o, folder):
    return f"{folder}/diagnosis-{o.trials}-{o.test_trials}-{o.most_effects}-{o.base_fits}"


def families_of(found):
    return {f["name"]: f["p_value"] for f in found["families"]}


def diagnose_from(o, folder, out, start=()):
    if not os.path.exists(f"{out}/diagnosis.json"):
        talus(o, "diagnose", f"{folder}/campaign.toml", "-o", out, "--trials", o.trials, "--test-trials", o.test_trials,
              "--most-effects", o.most_effects, "--base-fits", o.base_fits, "-q", "--overwrite", *start,
              *(["--threads", o.threads] if o.threads else []))
    return read_json(f"{out}/diagnosis.json")


def diagnose(o, folder):
    out = diagnosis_folder(o, folder)
    found = diagnose_from(o, folder, out)
    if o.again:
        again = diagnose_from(o, folder, out + "-again", ("--parameters", f"{out}/fitted.toml"))
        found["again"] = families_of(again) | {"found": again["effect"]}
    truth = json.loads(talus(o, "score", f"{folder}/campaign.toml", "--parameters", f"{folder}/truth_model.toml", "--rows",
                             "holdout", "--trials", 200, "--json", "-q"))
    return found, truth["holdout"]


def above_limit(found, effect, magnitude):
    """Whether an effect that was not named acts more strongly than the diagnosis's own detection limit where it acts."""
    for limit in found["detection_limits"]:
        if limit["effect"] != effect:
            continue
        amount = next((p["amount"] for p in limit["places"] if p["where"] == PLACES.get(effect, "everywhere")), limit["amount"])
        key = limit["parameter"].split(".")[-1]
        size = EFFECTS[effect][key.removeprefix("1/")][0]
        return amount is not None and (magnitude / size if key.startswith("1/") else magnitude * size) >= amount
    return False


def one(o, effect, magnitude, count, k):
    """Makes and diagnoses one campaign, and prints what came out."""
    null = o.null[k % len(o.null)] if effect == "none" else "plain"
    made = effect if null == "plain" else f"none ({null})"
    folder = f"{o.work}/{o.program}-{o.seed}/{effect}-{null}-{magnitude:g}-{count}-{k}"
    folder += f"-{o.screens}-screens" if o.screens != len(SCREENS) else ""
    if not os.path.exists(f"{folder}/campaign.toml"):
        make(o, folder, effect, magnitude, count, o.seed + 7919 * k + sum(map(ord, effect)) + int(100 * magnitude) + count, null)
    found, truth = diagnose(o, folder)
    e, headline = found["error"]["holdout"], found["error"]["headline"]
    large = [g["score"] for g in truth["groups"] if g["rows"] >= headline["fewest_rows_of_a_group"]]
    truth = truth["score"]
    families, again = families_of(found), found.get("again", {})
    row = dict(effect=made, magnitude=magnitude, blocks=count, found=found["effect"], alike=" ".join(found["indistinguishable_from"]),
               p=found["rounds"][0]["p_value"], before=e["before"], after=e["after"], truth=truth,
               large_before=headline["before"], large_after=headline["after"], large_truth=sum(large) / len(large), seconds=found["times"]["cpu"],
               above_limit=above_limit(found, effect, magnitude), **{name: families.get(name) for name in FAMILIES},
               **({f"again {name}": again.get(name) for name in ("found", *FAMILIES)} if again else {}),
               **pull(f"{diagnosis_folder(o, folder)}/fitted.toml", f"{folder}/truth_model.toml"))
    print(f"{made} x{magnitude:g}, {count} blocks, {k}: {row['found']} ({row['alike']}) p {row['p']:.4f}, held-out {row['before']:.3f} -> "
          f"{row['after']:.3f}, truth {truth:.3f}; groups of ten rows and more {row['large_before']:.3f} -> {row['large_after']:.3f}, truth "
          f"{row['large_truth']:.3f}; {row['seconds']:.0f} s", flush=True)
    return row


def study(o):
    plan = []
    for n in o.blocks:  # so that half of a study has some of everything
        none = [("none", 1.0, n, k) for k in range(o.none)]
        some = [(e, m, n, k) for k in range(o.each) for m in o.magnitudes for e in o.effects]
        plan += [p for pair in itertools.zip_longest(some, none) for p in pair if p]
    with ThreadPoolExecutor(o.jobs) as jobs:
        return list(jobs.map(lambda campaign: one(o, *campaign), plan))


def report(table):
    names = sorted({r["effect"] for r in table})
    counts = defaultdict(int)
    for r in table:
        counts[r["effect"], r["found"]] += 1
    found = sorted({r["found"] for r in table})
    print("\n| made with | " + " | ".join(found) + " |\n| --- |" + " --- |" * len(found))
    for name in names:
        print(f"| {name} | " + " | ".join(str(counts[name, f] or "") for f in found) + " |")
    none = [r for r in table if r["effect"].startswith("none")]
    kinds = sorted({r["effect"] for r in none})
    for kind in kinds + ["all without an effect"] * (len(kinds) > 1):
        of = [r for r in none if kind not in kinds or r["effect"] == kind]
        alarms = sum(r["found"] not in ("none", "unexplained") for r in of)
        print(f"\n{kind}: false alarms: {alarms} of {len(of)}, unexplained: {sum(r['found'] == 'unexplained' for r in of)}, "
              f"smallest corrected p at most 0.05: {sum(r['p'] <= 0.05 for r in of)}")
        if "again found" in of[0]:
            print(f"  again from that ground: false alarms: {sum(r['again found'] not in ('none', 'unexplained') for r in of)}")
        for name in [name for name in of[0] if name.removeprefix("again ") in FAMILIES]:
            p = np.array([r[name] for r in of if r[name] is not None])
            if len(p):
                print(f"  {name}: p below 0.01, 0.05, 0.10 in {', '.join(f'{100 * np.mean(p <= a):.0f} %' for a in (0.01, 0.05, 0.1))} of {len(p)}")
        print("  ground fitted / true: " + ", ".join(f"{key} {np.exp(np.mean([r[key] for r in of])):.2f}" for key in GROUND_KEYS))
        beside = np.array([r["before"] / r["truth"] - 1 for r in of])
        print(f"  held-out error beside the true model's: above it in {np.sum(beside > 0)} of {len(of)}, {100 * np.mean(beside):+.1f} % on average")
    effects = [r for r in table if not r["effect"].startswith("none")]
    for size in sorted({r["magnitude"] for r in effects}):
        of = [r for r in effects if r["magnitude"] == size]
        named = sum(r["found"] == r["effect"] for r in of)
        listed = sum(r["effect"] in [r["found"]] + r["alike"].split() for r in of)
        seen = sum(r["found"] != "none" for r in of)
        print(f"magnitude {size:g}: {len(of)} campaigns, residual seen {seen}, right effect named {named}, named or listed as alike {listed}")
    above = sum(r["found"] != r["effect"] and r["above_limit"] for r in effects)
    if effects:
        print(f"not named though above the detection limit: {above} of {len(effects)}")
        wrong = sum(r["found"] not in ("none", "unexplained", r["effect"]) and r["effect"] not in r["alike"].split() for r in effects)
        named = [r for r in effects if r["found"] == r["effect"]]
        print(f"another effect named: {wrong} of {len(effects)}; error after within 5 % of the true model's in "
              f"{sum(r['after'] <= 1.05 * r['truth'] for r in named)} of {len(named)} named, in groups of ten rows and more in "
              f"{sum(r['large_after'] <= 1.05 * r['large_truth'] for r in named)}")


def main():
    parser = parser_of(__doc__, work="build/study", jobs=1)
    parser.add_argument("--effects", type=list_of(str), default="all", help="that act, one at a time")
    parser.add_argument("--magnitudes", type=list_of(float), default="1,2,0.5", help="of the effects, times those of EFFECTS")
    parser.add_argument("--blocks", type=list_of(int), default="60,120", help="of a campaign")
    parser.add_argument("--each", type=int, default=1, help="campaigns of each effect, magnitude and number of blocks")
    parser.add_argument("--screens", type=int, default=len(SCREENS), help="of a campaign")
    parser.add_argument("--none", type=int, default=20)
    parser.add_argument("--null", type=list_of(str), default=",".join(NULLS), help="kinds of campaigns without an effect")
    parser.add_argument("--base-fits", type=int, default=1)
    parser.add_argument("--again", action="store_true", help="diagnose again, from the ground that was fitted")
    parser.add_argument("--trials", type=int, default=24)
    parser.add_argument("--test-trials", type=int, default=100)
    parser.add_argument("--most-effects", type=int, default=3)
    parser.add_argument("--threads", type=int, help="of each diagnosis; all processors where it is not given")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-o", "--out")
    o = parser.parse_args()
    o.effects = list(EFFECTS) if o.effects == ["all"] else o.effects
    o.program = program(o)
    table = study(o)
    report(table)
    if o.out:
        with open(o.out, "w", encoding="utf-8") as out:
            writer = csv.DictWriter(out, table[0].keys())
            writer.writeheader()
            writer.writerows(table)


main()
