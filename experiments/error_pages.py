#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws what the verdict gets wrong on cases with ground truth, as one page to judge by eye: OUTPUT/index.html.

usage: experiments/error_pages.py --gridmerge BINARY [--data DIR] [--output DIR] [--keep] [--missed] [--most N]

Of every pairs.tsv (and negatives.tsv beside it) in DATA or in its folders it shows
    wrong answers that were accepted,
    unrelated pairs that were accepted,
    right answers that were refused, and
    with --missed, pairs whose best hypothesis is wrong, and which were refused.
The two maps lie at the estimated pose, and for wrong answers at the true one too. Below or beside that is what they
have in common, enlarged. Runs `gridmerge evaluate` into OUTPUT, and `gridmerge match` for the cases shown. --keep takes
the results of the last run. The pictures show the data, whose licence may not be this project's, so they stay in
OUTPUT, a build folder. Needs numpy and Pillow.
"""

import argparse
import csv
import dataclasses
import html
import json
import pathlib
import subprocess

import numpy as np
from overlay import (
    PALETTE,
    View,
    all_points,
    common_points,
    data_uri,
    main_direction,
    picture,
    scale_bar,
    view_of,
)

# isort: split
from grids import Grid, Pose, centres, overlap, read_grid, transformed  # once overlay has told where it is

SECTIONS = {
    "wrong": "Wrong, and accepted",
    "unrelated": "Unrelated, and accepted",
    "refused": "Right, and refused",
    "missed": "Best hypothesis wrong, and refused",
}
SHOWN_HYPOTHESES = 6


@dataclasses.dataclass(frozen=True)
class Case:
    section: str
    folder: pathlib.Path
    fixed: str
    moving: str
    result: dict  # of evaluate
    truth: dict[str, str]  # the row of pairs.tsv; empty for unrelated pairs


# Which cases


def read_rows(path: pathlib.Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def evaluate(arguments: argparse.Namespace, folder: pathlib.Path) -> list[dict]:
    """The results of all cases of a folder's tables."""
    name = "_".join(folder.relative_to(arguments.data).parts) or "cases"
    result = arguments.output / f"{name}.json"
    if not (arguments.keep and result.is_file()):
        command = [
            arguments.gridmerge,
            "evaluate",
            folder / "pairs.tsv",
            "--json",
            result,
            "--quiet",
            "--threads",
            str(arguments.threads),
        ]
        if (folder / "negatives.tsv").is_file():
            command += ["--negatives", folder / "negatives.tsv"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return json.loads(result.read_text())["cases"]


def section_of(result: dict) -> str | None:
    accepted, right = result["verdict"] == "accepted", result["correct"]
    if right is None:
        return "unrelated" if accepted else None
    if right:
        return None if accepted else "refused"
    return "wrong" if accepted else "missed"


def find_cases(arguments: argparse.Namespace) -> tuple[list[Case], int]:
    """Those to be shown, the most probable first, and how many there are in all."""
    cases, total = [], 0
    for path in sorted([*arguments.data.glob("pairs.tsv"), *arguments.data.glob("*/pairs.tsv")]):
        truths = {(row["fixed"], row["moving"]): row for row in read_rows(path)}
        for result in evaluate(arguments, path.parent):
            total += 1
            section = section_of(result)
            if section:
                truth = truths[result["fixed"], result["moving"]] if result["correct"] is not None else {}
                cases.append(Case(section, path.parent, result["fixed"], result["moving"], result, truth))
    return sorted(cases, key=lambda case: -case.result["probability"]), total


# One case


def pose_of(entries: dict) -> Pose:
    return tuple(float(entries[key]) for key in ("x", "y", "theta"))


def displacement(moving: Grid, a: Pose, b: Pose) -> float:
    """How far the moving map's known cells are apart at two poses [m], root mean square."""
    cells = centres(moving, moving.known)
    return float(np.mean(((transformed(a, cells) - transformed(b, cells)) ** 2).sum(axis=1))) ** 0.5


def match(arguments: argparse.Namespace, case: Case) -> dict:
    command = [
        arguments.gridmerge,
        "match",
        "--json",
        "--quiet",
        "--threads",
        str(arguments.threads),
        case.folder / case.fixed,
        case.folder / case.moving,
    ]
    return json.loads(subprocess.run(command, stdout=subprocess.PIPE, text=True).stdout)


def figure(caption: str, view: View, fixed: Grid, moving: Grid, pose: Pose) -> str:
    bar = scale_bar(view)
    return (
        f'<figure><div class="map"><img src="{data_uri(picture(view, fixed, moving, pose))}" alt="">'
        f'<span class="bar" style="width:{100 * bar / view.width:.2f}%">{bar:g} m</span></div>'
        f"<figcaption>{caption}</figcaption></figure>"
    )


def figures(case: Case, fixed: Grid, moving: Grid, estimate: Pose, truth: Pose | None) -> str:
    resolution = max(fixed.resolution, moving.resolution)
    everything = all_points(fixed, moving, estimate)
    angle = main_direction(centres(fixed, fixed.walls), everything)
    poses = [("estimated", estimate)]
    if truth is not None and not case.result["correct"]:
        poses.append(("true", truth))
    drawn = ""
    for name, pose in poses:
        view = view_of(all_points(fixed, moving, pose), angle, resolution)
        drawn += figure(f"at the {name} pose", view, fixed, moving, pose)
    for name, pose in poses:
        common = common_points(fixed, moving, pose)
        if len(common):
            view = view_of(common, angle, resolution)
            drawn += figure(f"the common part, at the {name} pose", view, fixed, moving, pose)
    return drawn


def hypotheses(found: list[dict], moving: Grid, truth: Pose | None, tolerance: float) -> str:
    rows = []
    for hypothesis in found[:SHOWN_HYPOTHESES]:
        error, mark = "", ""
        if truth is not None:
            off = displacement(moving, pose_of(hypothesis["transform"]), truth)
            error, mark = f"{off:.2f}", ' class="good"' if off <= tolerance else ""
        probability, score = hypothesis.get("probability"), hypothesis.get("score")
        bar = f'<span style="width:{100 * (probability or 0.0):.1f}%"></span>'
        cells = [shown(probability), "" if score is None else f"{score:.0f}", error]
        rows.append(
            f'<tr{mark}><td class="share">{bar}</td>'
            + "".join(f"<td>{cell}</td>" for cell in cells)
            + "</tr>"
        )
    left = len(found) - len(rows)
    more = f'<p class="soft">and {left} more</p>' if left > 0 else ""
    head = "<tr><th></th><th>probability</th><th>score</th><th>error [m]</th></tr>"
    return f"<table>{head}{''.join(rows)}</table>{more}"


def shown(value: float | None) -> str:
    """Four digits of a probability, and more where these say nothing."""
    if value is None:
        return ""
    if 0.0 < value < 0.001:
        return f"{value:.1e}"
    return f"{value:.6f}" if value > 0.9995 else f"{value:.4f}"


def facts(case: Case, found: dict, fixed: Grid, moving: Grid, truth: Pose | None) -> dict[str, str]:
    result = {"probability": shown(case.result["probability"])}
    reason = found.get("reason") or case.result.get("reason")
    if reason:
        result["reason"] = html.escape(str(reason)).replace("_", " ")
    if truth is not None:
        result["error"] = f"{case.result['error']:.2f} m, allowed {case.result['tolerance']:.1f} m"
        result["tier"] = html.escape(case.truth.get("tier") or "none")
        result["overlap, true"] = f"{100 * overlap(fixed, moving, truth):.0f} %"
    if "overlap" in found:
        result["overlap, estimated"] = f"{100 * found['overlap']:.0f} %"
    if "acceptance_index" in found:
        result["acceptance index"] = f"{found['acceptance_index']:.3f}"
    result["known"] = f"{fixed.known_area:.0f} and {moving.known_area:.0f} m²"
    return result


def article(arguments: argparse.Namespace, case: Case) -> str:
    fixed, moving = read_grid(case.folder / case.fixed), read_grid(case.folder / case.moving)
    found = match(arguments, case)
    truth = pose_of(case.truth) if case.truth else None
    terms = "".join(
        f"<dt>{name}</dt><dd>{value}</dd>" for name, value in facts(case, found, fixed, moving, truth).items()
    )
    tolerance = case.result["tolerance"] or 0.0
    drawn = figures(case, fixed, moving, pose_of(found["transform"]), truth)
    found_table = hypotheses(found.get("hypotheses", []), moving, truth, tolerance)
    return (
        f'<article><h3><span class="fixed">{html.escape(case.fixed)}</span> '
        f'<span class="moving">{html.escape(case.moving)}</span></h3>'
        f'<div class="case"><div class="facts"><dl>{terms}</dl>{found_table}</div>'
        f'<div class="maps">{drawn}</div></div></article>'
    )


# The page

STYLE = """
body { margin: 0 auto; max-width: 1700px; padding: 1rem 1.5rem 4rem; background: #fafaf8; color: #26262b;
  font: 15px/1.45 system-ui, sans-serif; }
h1 { font-size: 1.4rem; margin: 0 0 .3rem; } h2 { font-size: 1.15rem; margin: 2.2rem 0 .6rem; }
h3 { font-size: .95rem; margin: 0 0 .6rem; font-weight: 600; overflow-wrap: anywhere; }
h3 span { margin-right: 1.2em; } h3 .fixed { color: #1f63c4; } h3 .moving { color: #c04a08; }
nav a { margin-right: 1.2em; color: #005a9c; }
.soft, figcaption { color: #5d5d64; font-size: .85rem; } p { margin: .3rem 0; }
.legend i { display: inline-block; width: 1.1em; height: .8em; margin: 0 .35em 0 1.1em; border: 1px solid #0002; }
article { background: #fff; border: 1px solid #d6d6d1; border-radius: 6px; padding: .8rem 1rem; margin: 0 0 1rem; }
.case { display: grid; grid-template-columns: 300px 1fr; gap: 1.4rem; align-items: start; }
.maps { display: grid; grid-template-columns: 1fr 1fr; gap: .8rem 1.2rem; align-items: start; }
.large .maps { grid-template-columns: 1fr; }
dl { font-size: .9rem; display: grid; grid-template-columns: auto 1fr; gap: .1rem .8rem; margin: 0 0 .8rem; }
dt { color: #5d5d64; } dd { margin: 0; } table { border-collapse: collapse; font-size: .85rem; width: 100%; }
td, th { text-align: right; padding: .1rem .35rem; font-weight: 400; font-variant-numeric: tabular-nums; }
th { color: #5d5d64; } .share { width: 60px; padding-left: 0; }
.share span { display: block; height: .7em; background: #b9b9c0; }
.good td { color: #00694a; font-weight: 600; } .good .share span { background: #00805a; }
figure { margin: 0; } .map { position: relative; border: 1px solid #e6e6e2; cursor: zoom-in; }
.large .map { cursor: zoom-out; } img { display: block; width: 100%; }
.bar { position: absolute; left: 8px; bottom: 6px; border: 2px solid #26262b; border-top: 0; height: 6px;
  font-size: .75rem; line-height: 0; text-align: center; text-shadow: 0 0 3px #fff, 0 0 3px #fff, 0 0 3px #fff; }
@media (max-width: 1000px) { .case, .maps { grid-template-columns: 1fr; } }
"""
SCRIPT = """
for (const map of document.querySelectorAll('.map'))
  map.addEventListener('click', () => map.closest('.case').classList.toggle('large'));
"""
LEGEND = [
    (4, "wall of the fixed map"),
    (5, "wall of the moving map"),
    (6, "walls that meet, within 0.2 m"),
    (1, "known to the fixed map"),
    (2, "known to the moving map"),
    (3, "known to both"),
]


def page(sections: dict[str, list[str]], counts: dict[str, int], total: int, data: pathlib.Path) -> str:
    links = "".join(f'<a href="#{key}">{title}: {counts[key]}</a>' for key, title in SECTIONS.items())
    legend = "".join(f'<i style="background:{PALETTE[i]}"></i>{text}' for i, text in LEGEND)
    body = ""
    for key, articles in sections.items():
        left = counts[key] - len(articles)
        more = f'<p class="soft">{left} more are not shown.</p>' if left else ""
        body += f'<h2 id="{key}">{SECTIONS[key]}: {counts[key]}</h2>{"".join(articles)}{more}'
    return (
        '<!doctype html><html lang="en"><meta charset="utf-8"><title>Errors of the verdict</title>'
        f"<style>{STYLE}</style><h1>Errors of the verdict</h1><p>{total} cases of {html.escape(str(data))}. "
        "The most probable come first. A click on a map enlarges it; a hypothesis within the tolerance is green.</p>"
        f"<nav>{links}</nav>"
        f'<p class="legend">{legend}</p>{body}<script>{SCRIPT}</script></html>\n'
    )


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--gridmerge", type=pathlib.Path, required=True)
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared/data"))
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("build/errors"))
    parser.add_argument("--keep", action="store_true", help="take the last run's results of evaluate")
    parser.add_argument(
        "--missed", action="store_true", help="show refused pairs whose best hypothesis is wrong, too"
    )
    parser.add_argument("--most", type=int, default=150, help="cases of each kind")
    parser.add_argument("--threads", type=int, default=0)
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)

    cases, total = find_cases(arguments)
    counts = {key: sum(case.section == key for case in cases) for key in SECTIONS}
    sections = {}
    for key in SECTIONS if arguments.missed else list(SECTIONS)[:-1]:
        drawn = [case for case in cases if case.section == key][: arguments.most]
        sections[key] = [article(arguments, case) for case in drawn]
    path = arguments.output / "index.html"
    path.write_text(page(sections, counts, total, arguments.data))
    print(f"wrote {path}: " + ", ".join(f"{SECTIONS[key].lower()} {counts[key]}" for key in SECTIONS))


if __name__ == "__main__":
    main()
