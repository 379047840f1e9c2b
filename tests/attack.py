#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Throws hostile files at the program, and kills it at any time, as often as it is told.

Files: an input of the fuzz corpus or an example map, with bytes changed, cut, doubled or put together with another
one's, is given to a command that reads such files. It has to end by itself within a minute, with an exit code of its
own (0 to 3), and an error is one line.

Kills: a merge that replaces the outputs of another one is killed after a random time. Whoever opens the outputs by
name finds one whole set, and the next merge leaves nothing but its own.
"""

import argparse
import collections
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

PROJECT = pathlib.Path(__file__).resolve().parent.parent
# What somewhere in a file makes trouble.
ODD = (b"\0", b"\n", b"9" * 20, b"-1", b"nan", b"1e999", b"[" * 50, b"{", b"\xff\xfe", b"../")
MAP = "image: {image}\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"


def hostile(seeds, rng):
    """The bytes of a seed, changed in one to four ways."""
    data = bytearray(rng.choice(seeds))
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(data) + 1)
        kind = rng.randrange(6)
        if kind == 0:
            data = data[:at]
        elif kind == 1 and data:
            data[at % len(data)] = rng.choice((0, 1, 0x7F, 0x80, 0xFF, rng.randrange(256)))
        elif kind == 2:
            data[at:at] = rng.choice(ODD)
        elif kind == 3:
            other = rng.choice(seeds)
            data = data[:at] + other[rng.randrange(len(other) + 1) :]
        elif kind == 4:
            data[at:at] = data[at : at + rng.randrange(1, 200)] * rng.randint(1, 20)
        else:
            del data[at : at + rng.randrange(1, 30)]
    return bytes(data)


def corpus(*targets):
    """The seeds of these fuzz targets; none is empty, so that something can be changed."""
    files = [file for target in targets for file in sorted((PROJECT / "fuzz/corpus" / target).iterdir())]
    return [data for data in (file.read_bytes() for file in files) if data]


def throw_files(program, count, rng, folder):
    yamls, tables, records = corpus("map_yaml"), corpus("truth", "initial_poses"), corpus("transforms")
    images = {"pgm": corpus("pnm"), "png": corpus("png"), "bmp": corpus("bmp"), "jpg": corpus("jpeg")}
    data = PROJECT / "tests/bag/data"
    bags = corpus("mcap") + [file.read_bytes() for file in sorted(data.rglob("*")) if file.is_file()]
    sound = folder / "sound.yaml"
    shutil.copyfile(PROJECT / "examples/three_robots/robot_1.yaml", sound)
    for image in (PROJECT / "examples/three_robots").glob("robot_1.p*"):
        shutil.copyfile(image, folder / image.name)
    counts, failures = collections.Counter(), []
    for i in range(count):
        kind = rng.choice(("yaml", "image", "image", "table", "record", "bag"))
        if kind == "yaml":
            (folder / "x.yaml").write_bytes(hostile(yamls, rng))
            command = ["info", folder / "x.yaml"]
        elif kind == "image":
            ending = rng.choice(sorted(images))
            (folder / f"x.{ending}").write_bytes(hostile(images[ending], rng))
            (folder / "x.yaml").write_text(MAP.format(image=f"x.{ending}"))
            command = (
                ["info", folder / "x.yaml"]
                if i % 4
                else ["match", sound, folder / "x.yaml", "--search", "quick"]
            )
        elif kind == "table":
            (folder / "x.tsv").write_bytes(hostile(tables, rng))
            readers = (
                ["evaluate"],
                ["evaluate", "--negatives"],
                ["merge", sound, "-o", folder / "o", "--init"],
            )
            command = [*rng.choice(readers), folder / "x.tsv"]
        elif kind == "bag":
            (folder / "x.bag").write_bytes(hostile(bags, rng))
            command = ["info", folder / "x.bag"]
        else:
            (folder / "saved").mkdir(exist_ok=True)
            (folder / "saved/transforms.json").write_bytes(hostile(records, rng))
            command = ["report", folder / "saved"]
        try:
            done = subprocess.run(
                [program, *command], capture_output=True, timeout=60, stdin=subprocess.DEVNULL
            )
            code = done.returncode
            bad = code not in (0, 1, 2, 3) or (code == 1 and done.stderr.count(b"\n") != 1)
        except subprocess.TimeoutExpired:
            code, bad = "hang", True
        counts[code] += 1
        if bad:
            kept = pathlib.Path(tempfile.mkdtemp(prefix="gridmerge-attack-"))
            shutil.copytree(folder, kept, dirs_exist_ok=True)
            failures.append(f"{code}: {' '.join(map(str, command))} (its files: {kept})")
        shutil.rmtree(folder / "o", ignore_errors=True)
    told = ", ".join(f"exit code {code}: {n}" for code, n in sorted(counts.items(), key=str))
    print(f"{count} hostile files: {told}")
    return failures


def contents(folder):
    files = (file for file in folder.iterdir() if file.is_file() and not file.name.startswith("."))
    return {file.name: file.read_bytes() for file in files}


def kill_merges(program, count, rng, folder):
    maps = [PROJECT / f"examples/three_robots/robot_{i}.yaml" for i in (1, 2)]
    poses = folder / "poses.tsv"
    # Both fixed, so that the run is short and most of it is writing.
    poses.write_text("map\tx\ty\ttheta\n" + "".join(f"{path}\t{x}\t0\t0\n" for x, path in enumerate(maps)))

    def command(target, resolution):
        fixed = [word for path in maps for word in ("--fix", path)]
        return [
            program,
            "merge",
            *maps,
            "--init",
            poses,
            *fixed,
            "-o",
            target,
            "--output-resolution",
            resolution,
            "--threads",
            "1",
            "--quiet",
        ]

    sets = []
    for resolution in ("0.2", "0.4"):
        start = time.monotonic()
        subprocess.run(command(folder / resolution, resolution), check=True, stdout=subprocess.DEVNULL)
        longest = time.monotonic() - start
        sets.append(contents(folder / resolution))
    failures, counts = [], collections.Counter()
    target = folder / "set"
    shutil.copytree(folder / "0.2", target)
    for i in range(count):
        run = subprocess.Popen(
            command(target, ("0.2", "0.4")[i % 2]), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        time.sleep(rng.uniform(0.0, 1.2 * longest))
        run.kill()
        run.wait()
        found = contents(target)
        counts["was killed" if run.returncode < 0 else "had ended"] += 1
        if found not in sets:
            failures.append(f"kill {i}: a mixed set: {sorted(found)}")
        if i % 50 == 49 or i == count - 1:
            subprocess.run(command(target, "0.4"), check=True, stdout=subprocess.DEVNULL)
            left = sorted(file.name for file in target.iterdir())
            if contents(target) != sets[1] or left != sorted(sets[1]):
                failures.append(f"kill {i}: the next merge leaves {left}")
    print(f"{count} kills: " + ", ".join(f"{what}: {n}" for what, n in sorted(counts.items())))
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument(
        "--program",
        type=pathlib.Path,
        default=PROJECT / "build/release/bin/gridmerge",
        help="default: the release build's",
    )
    parser.add_argument(
        "--files", type=int, default=10000, help="how many hostile files (default: %(default)s)"
    )
    parser.add_argument("--kills", type=int, default=1000, help="how many kills (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of all that is random (default: %(default)s)")
    arguments = parser.parse_args()
    failures = []
    for attack, count in ((throw_files, arguments.files), (kill_merges, arguments.kills)):
        with tempfile.TemporaryDirectory() as folder:
            if count > 0:
                failures += attack(
                    arguments.program.resolve(), count, random.Random(arguments.seed), pathlib.Path(folder)
                )
    for failure in failures:
        print(failure, file=sys.stderr)
    print(f"failures: {len(failures)}")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
