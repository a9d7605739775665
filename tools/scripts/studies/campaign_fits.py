"""Fits of the ground to measured campaigns, kept in a folder (for rest_study.py and size_study.py)."""
import json
import os

from files import write_text
from program import talus

SURFACE = "bilinear"  # on which the tables of docs/effects.md were measured


def name_of(campaign):
    """The name of a campaign's folder."""
    return os.path.basename(os.path.normpath(campaign))


def fitted(o, campaign, name, start, seed, *options):
    """The folder of `talus calibrate` that starts with the parameters in a text; none in an empty one. A fit that is there is
    not made again."""
    out = os.path.join(o.work, f"{name_of(campaign)}-{name}-{seed}-{o.trials}-{o.starts}")
    if not os.path.exists(os.path.join(out, "fitted.toml")):
        first = ["--parameters", write_text(out + ".toml", start)] if start else []
        talus(o, "calibrate", os.path.join(campaign, "campaign.toml"), "-o", out, *first, "--surface", SURFACE, *options,
              "--seed", seed, "--trials", o.trials, "--starts", o.starts, "--threads", o.threads, "-q")
    return out


def errors_of(o, campaign, fit):
    """Errors of a fit on the fitting rows and on the held-out rows, with 400 trials a block of its own random numbers."""
    scored = json.loads(talus(o, "score", os.path.join(campaign, "campaign.toml"), "--parameters", os.path.join(fit, "fitted.toml"),
                              "--surface", SURFACE, "--trials", 400, "--seed", 1000, "--threads", o.threads, "--json", "-q"))
    return scored["fit"]["score"], scored["holdout"]["score"]


def add_fit_options(parser):
    parser.add_argument("--trials", type=int, default=32, help="of each block, in a fit")
    parser.add_argument("--starts", type=int, default=1, help="of the search, in a fit")
