# SPDX-License-Identifier: Apache-2.0
"""Writes into a wheel the licences of what it contains besides gridmerge: packaging/wheel.sh runs this.

Nothing is listed by hand. The shared libraries are those that auditwheel put into the wheel. The headers are those
that the compiler read, by Ninja's record of them. Debian's packages say whose they are and under which licence. A part
whose licences are all of the GPL family ends this with an error.
"""

from __future__ import annotations

import argparse
import base64
import hashlib
import importlib.metadata
import os
import re
import subprocess
import sys
import time
import zipfile
from dataclasses import dataclass, field
from pathlib import Path

FILE_NAME = "THIRD_PARTY_LICENSES.txt"
# The C and C++ runtime and Python are not in the wheel: who installs it has them.
OF_THE_SYSTEM = re.compile(r"(libc6|linux-libc|libstdc\+\+-\d+|libgcc-\d+|libpython3(\.\d+)?)-dev")
PARAGRAPH = re.compile(r"\n\s*\n")


class LicenceError(Exception):
    """What the wheel contains cannot be named, or may not be passed on with it."""


@dataclass
class Part:
    """A work of somebody else, in the wheel as a library, as compiled headers, or both."""

    name: str
    version: str
    copyright: str
    libraries: set[str] = field(default_factory=set)
    headers: int = 0


def licences_of(text: str) -> list[str]:
    """The licences that a file debian/copyright names for the work as a whole, or else for each of its files.

    Packaging itself (`debian/*`) is not in a library. Empty if the text is not in Debian's machine-readable form.
    """
    by_files: dict[str, str] = {}
    for paragraph in PARAGRAPH.split(text):
        files = re.search(r"^Files:\s*(.*?)\s*^\S+:", paragraph + "\nEnd:", re.MULTILINE | re.DOTALL)
        name = re.search(r"^License:[ \t]*(.+)$", paragraph, re.MULTILINE)
        if files and name:
            by_files[files[1]] = name[1].strip()
    if "*" in by_files:
        return [by_files["*"]]
    return sorted({name for files, name in by_files.items() if not files.startswith("debian/")})


def refused_licences(text: str) -> list[str]:
    """Those of licences_of() that offer nothing but the GPL, the LGPL or the AGPL."""
    alternatives = {name: re.split(r"\s+or\s+", name, flags=re.IGNORECASE) for name in licences_of(text)}
    return [name for name, ways in alternatives.items() if all(re.search(r"\b[AL]?GPL", way) for way in ways)]


def run(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def packages_of(files: set[str]) -> dict[str, str]:
    """The Debian package of each file that one has."""
    if not files:
        return {}
    # Ends with 1 if a file is nobody's: those are found by what is missing in the answer.
    found = subprocess.run(["dpkg-query", "--search", *sorted(files)], capture_output=True, text=True).stdout
    answer = {}
    for line in found.splitlines():
        package, _, path = line.partition(": ")
        answer[path] = package.split(":")[0].split(",")[0]
    return answer


def debian_part(package: str) -> Part:
    """The work that a package is built from; its packages have one copyright file."""
    fields = run("dpkg-query", "--show", "--showformat=${source:Package}\t${source:Version}\n", package)
    name, version = fields.splitlines()[0].split("\t")
    text = Path("/usr/share/doc", package, "copyright").read_text(encoding="utf-8")
    return Part(f"{name} (Debian)", version, text)


def nanobind_part() -> Part:
    found = importlib.metadata.distribution("nanobind")
    texts = [file.read_text() for file in found.files or [] if re.search(r"LICEN[SC]E", file.name)]
    if not texts:
        raise LicenceError("the package nanobind brings no licence")
    return Part("nanobind", found.version, "\n".join(texts))


def headers_read(build: Path) -> set[Path]:
    """What the compiler read, as Ninja remembers it; paths may be relative to the build folder."""
    lines = run("ninja", "-C", str(build), "-t", "deps").splitlines()
    return {Path(os.path.normpath(build / line.strip())) for line in lines if line.startswith("    ")}


class Contents:
    """All parts of a wheel, by name."""

    def __init__(self) -> None:
        self.parts: dict[str, Part] = {}

    def part(self, made: Part) -> Part:
        return self.parts.setdefault(made.name, made)

    def add_libraries(self, names: list[str]) -> None:
        """Shared libraries as auditwheel has renamed them: libtbb-0b1c2d3e.so.12.8."""
        for name in names:
            original = re.sub(r"-[0-9a-f]{8}(?=\.so)", "", name)
            found = packages_of({f"*/{original}"})
            if not found:
                raise LicenceError(f"{name}: no Debian package has {original}")
            self.part(debian_part(next(iter(found.values())))).libraries.add(name)

    def add_headers(self, headers: set[Path], own: Path, ceres: Path, ceres_version: str) -> None:
        """Headers under `own` are gridmerge's, those under `ceres` of the Ceres that is linked into it."""
        nanobind = Path(str(importlib.metadata.distribution("nanobind").locate_file("nanobind")))
        of_debian = set()
        for header in headers:
            if header.is_relative_to(nanobind):
                self.part(nanobind_part()).headers += 1
            elif header.is_relative_to(ceres):
                text = (ceres / "copyright").read_text(encoding="utf-8")
                self.part(Part("ceres-solver (linked in)", ceres_version, text)).headers += 1
            elif not header.is_relative_to(own):
                of_debian.add(str(header))
        packages = packages_of(of_debian | {str(Path(path).resolve()) for path in of_debian})
        counts: dict[str, int] = {}
        for path in of_debian:
            package = packages.get(path) or packages.get(str(Path(path).resolve()))
            if package is None:
                raise LicenceError(f"{path}: the compiler read it, and no package has it")
            counts[package] = counts.get(package, 0) + 1
        for package, count in sorted(counts.items()):
            if not OF_THE_SYSTEM.fullmatch(package):
                self.part(debian_part(package)).headers += count

    def text(self) -> str:
        """The file's text; LicenceError if a part may not be passed on."""
        parts = sorted(self.parts.values(), key=lambda part: part.name)
        for part in parts:
            if refused := refused_licences(part.copyright):
                what = ", ".join(sorted(part.libraries)) or f"headers ({part.headers} files)"
                raise LicenceError(
                    f"{part.name}: {what}: under {'; '.join(refused)}, which the wheel may not contain"
                )
        lines = [
            "What this wheel contains besides gridmerge, whose licence is in LICENSE.",
            "",
            "Shared libraries are as Debian built them; headers of the others are compiled into gridmerge.",
            "A notice is of a whole work, of which the wheel may contain less. Where it offers several licences",
            "and one is the GPL, the wheel is passed on under another. `apt-get source NAME=VERSION` brings the",
            "sources of a part of Debian.",
            "",
        ]
        for part in parts:
            headers = [f"headers ({part.headers} files)"] if part.headers else []
            contained = [*sorted(part.libraries), *headers]
            licences = "; ".join(licences_of(part.copyright)) or "see its notice"
            lines.append(f"- {part.name} {part.version}: {', '.join(contained)}. Licence: {licences}")
        for part in parts:
            lines += ["", "=" * 100, f"{part.name} {part.version}", "=" * 100, "", part.copyright.strip()]
        everything = "\n".join(part.copyright for part in parts)
        for name in sorted(set(re.findall(r"/usr/share/common-licenses/([\w.-]*\w)", everything))):
            path = Path("/usr/share/common-licenses", name)
            if "GPL" not in name and path.exists():
                lines += ["", "=" * 100, str(path), "=" * 100, "", path.read_text(encoding="utf-8").strip()]
        return "\n".join(lines) + "\n"


def digest(data: bytes) -> str:
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def with_file(wheel: Path, text: str, output: Path) -> None:
    """Copies the wheel, with `text` among its licences, in an order and with dates that are always the same."""
    with zipfile.ZipFile(wheel) as source:
        modes = {one.filename: one.external_attr for one in source.infolist() if not one.is_dir()}
        contents = {name: source.read(name) for name in modes}
    info = next(name for name in contents if name.endswith(".dist-info/METADATA")).removesuffix("METADATA")
    metadata = contents[f"{info}METADATA"].decode()
    listed = re.sub(
        r"^(License-File: .*\n)", rf"\1License-File: {FILE_NAME}\n", metadata, count=1, flags=re.MULTILINE
    )
    if listed == metadata:
        raise LicenceError(f"{wheel}: METADATA has no License-File after which another could stand")
    contents[f"{info}METADATA"] = listed.encode()
    contents[f"{info}licenses/{FILE_NAME}"] = text.encode()
    record = f"{info}RECORD"
    del contents[record]
    names = sorted(contents, key=lambda name: (name.startswith(info), name))
    rows = [f"{name},sha256={digest(contents[name])},{len(contents[name])}" for name in names]
    contents[record] = ("\n".join([*rows, f"{record},,"]) + "\n").encode()
    date = time.gmtime(int(os.environ["SOURCE_DATE_EPOCH"]))[:6]
    with zipfile.ZipFile(output, "w") as result:
        for name in [*names, record]:
            entry = zipfile.ZipInfo(name, date)
            entry.external_attr = modes.get(name, 0o100644 << 16)
            entry.compress_type = zipfile.ZIP_DEFLATED
            result.writestr(entry, contents[name])


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("wheel", type=Path, help="as auditwheel has repaired it")
    parser.add_argument(
        "--build", type=Path, required=True, help="the folder in which Ninja built its module"
    )
    parser.add_argument("--own", type=Path, required=True, help="gridmerge's sources, which hold that folder")
    parser.add_argument(
        "--ceres", type=Path, required=True, help="folder of the Ceres linked in, with its `copyright`"
    )
    parser.add_argument("--ceres-version", required=True)
    parser.add_argument("--output", type=Path, required=True, help="folder for the wheel with its licences")
    arguments = parser.parse_args()
    with zipfile.ZipFile(arguments.wheel) as wheel:
        libraries = [Path(name).name for name in wheel.namelist() if re.search(r"\.libs/[^/]+$", name)]
    contents = Contents()
    try:
        contents.add_libraries(libraries)
        contents.add_headers(
            headers_read(arguments.build.resolve()),
            arguments.own.resolve(),
            arguments.ceres.resolve(),
            arguments.ceres_version,
        )
        with_file(arguments.wheel, contents.text(), arguments.output / arguments.wheel.name)
    except LicenceError as error:
        print(f"licences.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
