# SPDX-License-Identifier: Apache-2.0
"""The tables and the plots of what benchmark.py measures. A case is one of the result of `gridmerge evaluate --json`, a
row what is said of the cases of one value of a factor."""

import itertools
import math
import pathlib

# Limits of shared wall [m] between which pairs are counted together.
WALLS = (0, 2.5, 5, 10, 20, 40, 80, math.inf)
NO_FIGURE = "\N{EN DASH}"  # in a table, where there is no figure


def counts_of(cases: list[dict]) -> dict:
    pairs = [case for case in cases if case["correct"] is not None]
    accepted = [case for case in pairs if case["verdict"] == "accepted"]
    seconds = sorted(case["seconds"] for case in cases)
    return {
        "pairs": len(pairs),
        "best right": sum(case["correct"] for case in pairs),
        "accepted right": sum(case["correct"] for case in accepted),
        "accepted wrong": sum(not case["correct"] for case in accepted),
        "median s": f"{seconds[len(seconds) // 2]:.3f}" if seconds else NO_FIGURE,
    }


def interval(right: int, of: int) -> str:
    """The rates that could well have given so many of so many: Wilson's interval of 95 %."""
    if of == 0:
        return NO_FIGURE
    z, rate = 1.96, right / of
    middle, half = rate + z * z / (2 * of), z * math.sqrt(rate * (1 - rate) / of + z * z / (4 * of * of))
    return f"{max(0.0, (middle - half) / (1 + z * z / of)):.2f} to {min(1.0, (middle + half) / (1 + z * z / of)):.2f}"


def by_shared_wall(cases: list[dict]) -> list[dict]:
    rows = []
    for least, below in itertools.pairwise(WALLS):
        inside = [
            case for case in cases if case["shared_wall"] is not None and least <= case["shared_wall"] < below
        ]
        rows.append(
            with_intervals(
                {"shared wall [m]": f"{least:g} to {below:g}" if below < math.inf else f"from {least:g}"}
                | counts_of(inside)
            )
        )
    return rows


def with_intervals(row: dict) -> dict:
    """With the intervals of the rates of right and accepted ones after their numbers."""
    return row | {
        key: f"{row[key]} ({interval(row[key], row['pairs'])})" for key in ("best right", "accepted right")
    }


def summarize(value, cases: list[dict], memory: float) -> dict:
    negatives = [case for case in cases if case["correct"] is None]
    return (
        {"value": value}
        | counts_of(cases)
        | {
            "unrelated accepted": f"{sum(case['verdict'] == 'accepted' for case in negatives)} of {len(negatives)}",
            "peak MB": f"{memory:.0f}",
        }
    )


def table(rows: list[dict], first: str | None = None) -> str:
    columns = list(rows[0])
    names = [first if first and column == "value" else column for column in columns]
    lines = ["| " + " | ".join(names) + " |", "|" + " --- |" * len(columns)]
    lines += ["| " + " | ".join(str(row[column]) for column in columns) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def share(row: dict, key: str) -> float:
    return row[key] / row["pairs"] if row["pairs"] else 0.0


def pyplot():
    """Imported late: a child's peak memory counts from that of the process that started it."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot

    return matplotlib.pyplot


def plot_family(rows: list[dict], label: str, path: pathlib.Path) -> None:
    plt = pyplot()
    figure, axes = plt.subplots(figsize=(5, 3))
    numbers = [row["value"] for row in rows]
    for key, colour, marker in (
        ("best right", "#0072b2", "o"),
        ("accepted right", "#009e73", "s"),
        ("accepted wrong", "#d55e00", "x"),
    ):
        axes.plot(range(len(rows)), [share(row, key) for row in rows], color=colour, marker=marker, label=key)
    axes.set_xticks(
        range(len(rows)), [str(number) for number in numbers], rotation=30 if label.startswith("kind") else 0
    )
    axes.set_xlabel(label)
    axes.set_ylabel("share of the pairs")
    axes.set_ylim(-0.02, 1.02)
    axes.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=120)
    plt.close(figure)


def plot_cost(rows: list[dict], label: str, path: pathlib.Path) -> None:
    """Time and memory of a match; memory is the process's, two maps and all."""
    plt = pyplot()
    figure, axes = plt.subplots(figsize=(5, 3))
    values = [str(row["value"]) for row in rows]
    axes.plot(
        values,
        [math.nan if row["median s"] == NO_FIGURE else float(row["median s"]) for row in rows],
        color="#0072b2",
        marker="o",
    )
    axes.set_xlabel(label)
    axes.set_ylabel("median seconds per match", color="#0072b2")
    axes.set_ylim(bottom=0)
    memory = axes.twinx()
    memory.plot(values, [float(row["peak MB"]) for row in rows], color="#d55e00", marker="s")
    memory.set_ylabel("peak memory [MB]", color="#d55e00")
    memory.set_ylim(bottom=0)
    figure.tight_layout()
    figure.savefig(path, dpi=120)
    plt.close(figure)


def plot_probability(cases: list[dict], path: pathlib.Path) -> float:
    """ROC and reliability; the expected calibration error."""
    judged = sorted(((case["probability"], bool(case["correct"])) for case in cases), reverse=True)
    right = sum(r for _, r in judged) or 1
    wrong = len(judged) - right or 1
    plt = pyplot()
    figure, (roc, reliability) = plt.subplots(1, 2, figsize=(8, 3.4))
    xs, ys, seen = [0.0], [0.0], [0, 0]
    for _, is_right in judged:
        seen[is_right] += 1
        xs.append(seen[0] / wrong)
        ys.append(seen[1] / right)
    roc.plot(xs, ys, color="#0072b2")
    roc.set_xlabel("wrong or unrelated, accepted")
    roc.set_ylabel("right, accepted")
    error = 0.0
    means, shares = [], []
    for low in range(10):
        inside = [(p, r) for p, r in judged if low / 10 <= p < (low + 1) / 10 or (low == 9 and p >= 1.0)]
        if inside:
            means.append(sum(p for p, _ in inside) / len(inside))
            shares.append(sum(r for _, r in inside) / len(inside))
            error += abs(means[-1] - shares[-1]) * len(inside) / len(judged)
    reliability.plot([0, 1], [0, 1], color="#999999", linewidth=0.8)
    reliability.plot(means, shares, color="#0072b2", marker="o")
    reliability.set_xlabel("probability given")
    reliability.set_ylabel("share right")
    figure.tight_layout()
    figure.savefig(path, dpi=120)
    plt.close(figure)
    return error
