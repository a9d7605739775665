#!/usr/bin/python3
"""Prints what `talus diagnose CAMPAIGNS/NAME/campaign.toml -o OUT/NAME` has found: the tables of docs/diagnosis-results.md. Seconds.

  tools/scripts/figures/diagnosis_table.py CAMPAIGNS OUT NAME...

CAMPAIGNS is the folder of the campaigns, such as ../shared/data/campaigns. For each campaign it prints the effect that was found, beside
the one in its truth.toml if it has one, and the seconds by the clock. Then follows every candidate of the first round: its error on the
held-out rows, the share by which this error is lower (95 % interval over blocks), and the p-value of its score test.
"""
import json
import os
import sys
import tomllib


def read(out, name):
    with open(f"{out}/{name}/diagnosis.json", encoding="utf-8") as file:
        return json.load(file)


def text(value, form="{:.3f}"):
    return "-" if value is None else form.format(value)


def percent(interval):
    return " to ".join(text(None if value is None else 100 * value, "{:.0f}") for value in interval)


def truth_of(campaigns, name):
    path = f"{campaigns}/{name}/truth.toml"
    if not os.path.exists(path):
        return {}
    with open(path, "rb") as file:
        return tomllib.load(file)


def found(d):
    words = []
    for r in d["rounds"]:
        alike = r.get("indistinguishable_from", [])
        words.append(f"{r['effect']} {r.get('where', '')}".strip() + (f" (alike: {', '.join(alike)})" if alike else ""))
    return "; then ".join(words)


def campaigns_table(campaigns, results):
    print("| campaign | found | p | hidden | held-out before, after | reduction, 95 % | with the truth | s |")
    print("| --- " * 8 + "|")
    for name, d in results.items():
        e, truth = d["error"]["holdout"], truth_of(campaigns, name)
        hidden = truth.get("effect", "")
        best = truth.get("holdout_error_with_the_truth")
        above = f"{best:.3f} ({100 * (e['after'] / best - 1):+.1f} %)" if best and e["after"] else ""
        print(f"| {name} | {found(d)} | {d['rounds'][0]['p_value']:.4f} | {hidden} | {text(e['before'])}, {text(e['after'])} | "
              f"{text(e['reduction'] and 100 * e['reduction'], '{:.0f}')} % ({percent(e['ci95'])}) | {above} | {d['seconds']:.0f} |")


def candidates_table(name, d):
    print(f"\n{name}: {text(d['error']['holdout']['before'])} before\n\n| candidate | held-out error (reduction, 95 %) | p |\n| --- | --- | --- |")
    for c in d["candidates"]:
        print(f"| {c['effect']}, {c['where']} | {text(c['holdout'])} ({percent(c['holdout_reduction_ci95'])} %) | {c['p_value']:.2g} |")


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    campaigns, out, names = sys.argv[1], sys.argv[2], sys.argv[3:]
    results = {name: read(out, name) for name in names}
    campaigns_table(campaigns, results)
    for name, d in results.items():
        candidates_table(name, d)


if __name__ == "__main__":
    main()
