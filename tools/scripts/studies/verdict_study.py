#!/usr/bin/python3
"""Does the verdict of `talus diagnose` hang on luck? One campaign in ten ways.

  tools/scripts/studies/verdict_study.py CAMPAIGN.toml [--talus build/release/talus] [--work verdicts] [-- OPTIONS of diagnose]

Five seeds; the rows of every table in two other orders; without half of the held-out blocks; with held-out blocks added
(copies under other names, before the rest); one thread. A diagnosis that is there already is not run again.
Prints the verdict and figures of each, and in how many the verdict, the names and the figures are those of the first: a
figure agrees if it lies in the first one's 95 % interval. Where the same seed and fitting rows are used, it must be equal.
Ten times as long as one diagnosis (minutes). Results: docs/diagnosis-results.md, "Ten ways".
"""
import csv
import os
import random
import shutil
import sys
import tomllib

from files import read_json, read_table
from program import parser_of, talus

TABLES = ("blocks", "stops", "passages", "samples")


class Tables:
    """The tables of a campaign by block, which can be written again as another campaign."""

    def __init__(self, campaign):
        self.folder = os.path.dirname(os.path.abspath(campaign))
        with open(campaign, "rb") as file:
            self.names = {t: n for t, n in tomllib.load(file).items() if t in TABLES}
        self.toml = os.path.basename(campaign)
        self.rows = {table: read_table(f"{self.folder}/{name}") for table, name in self.names.items()}
        self.held_out = [b["id"] for b in self.rows["blocks"] if b.get("holdout") == "1"]

    def write(self, folder, rows):
        shutil.copytree(self.folder, folder, dirs_exist_ok=True, copy_function=shutil.copyfile)
        for table, name in self.names.items():
            with open(f"{folder}/{name}", "w", encoding="utf-8", newline="") as file:
                writer = csv.DictWriter(file, self.rows[table][0].keys())
                writer.writeheader()
                writer.writerows(rows[table])
        return f"{folder}/{self.toml}"

    def shuffled(self, seed):
        mixed = random.Random(seed)
        return {table: mixed.sample(rows, len(rows)) for table, rows in self.rows.items()}

    def without_half(self):
        gone = set(self.held_out[::2])
        return {table: [r for r in rows if r["id"] not in gone] for table, rows in self.rows.items()}

    def with_more(self):
        """Copies of held-out blocks under names that sort before the others."""
        copied = set(self.held_out[::3])
        return {table: [r | {"id": "0-copy-" + r["id"]} for r in rows if r["id"] in copied] + rows
                for table, rows in self.rows.items()}


def variants(tables):
    """Name, tables and options of each diagnosis."""
    for seed in range(1, 6):
        yield f"seed {seed}", tables.rows, ["--seed", str(seed)]
    yield "shuffled once", tables.shuffled(1), []
    yield "shuffled again", tables.shuffled(2), []
    if tables.held_out:
        yield "half of the held-out blocks", tables.without_half(), []
        yield "more held-out blocks", tables.with_more(), []
    yield "one thread", tables.rows, ["--threads", "1"]


def diagnosed(o, campaign, out, options):
    if not os.path.exists(f"{out}/diagnosis.json"):
        talus(o, "diagnose", campaign, "-o", out, "-q", *options)
    return read_json(f"{out}/diagnosis.json")


def report(name, found):
    fit, unseen = found["error"]["fit"], found["error"]["holdout"]
    p = min(f["p_corrected"] for f in found["families"] if f["p_corrected"] is not None)
    print(f"{name:28} {found['verdict']:32} {'+'.join(found['effects']):28} {p:8.4f} {fit['before']:.4f} {fit['after']:.4f}  "
          f"{unseen['before']:.4f} {unseen['after']:.4f} {100 * unseen['reduction']:5.1f} "
          f"({100 * unseen['ci95'][0]:.1f} to {100 * unseen['ci95'][1]:.1f}) %")


def main():
    parser = parser_of(__doc__, work="verdicts")
    parser.add_argument("campaign")
    end = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    given, more = parser.parse_args(sys.argv[1:end]), sys.argv[end + 1:]
    tables = Tables(given.campaign)
    print(f"{'':28} {'verdict':32} {'effects':28} {'least p':>8} fit: before, after; unseen: before, after, lower by (95 %)")
    all_found = []
    for name, rows, options in variants(tables):
        folder = f"{given.work}/{name.replace(' ', '_')}"
        campaign = tables.write(f"{folder}/campaign", rows)
        found = diagnosed(given, campaign, f"{folder}/out", [*more, *options])
        report(name, found)
        all_found.append(found)
    first = all_found[0]
    low, high = first["error"]["holdout"]["ci95"]
    alike = {
        "verdict": [f["verdict"] == first["verdict"] for f in all_found],
        "effects": [f["effects"] == first["effects"] for f in all_found],
        "reduction within the first one's interval": [low <= f["error"]["holdout"]["reduction"] <= high for f in all_found],
        "equal figures of the fit (seed 1)": [f["error"]["fit"] == first["error"]["fit"] for f in [first, *all_found[5:]]],
    }
    for what, same in alike.items():
        print(f"{what}: {sum(same)} of {len(same)}")


if __name__ == "__main__":
    main()
