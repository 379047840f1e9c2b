# SPDX-License-Identifier: Apache-2.0
"""Makes the documentation site in build/site: `./dev docs` builds the program and the wheel, and runs this.

The pages keep their places of the repository, so that links between them hold in both: build/docs/source is README.md,
docs and so on by symbolic links, and beside them the pages that are made here.
"""

import argparse
import itertools
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "build" / "docs"
SOURCE = WORK / "source"
SITE = ROOT / "build" / "site"
PAGES = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "docs", "examples/three_robots/README.md")


def write(page: str, text: str) -> None:
    path = SOURCE / page
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def link_pages() -> None:
    own = Path("docs/site")
    places = {page: page for page in PAGES}
    places |= {page.relative_to(own): page for page in sorted((ROOT / own).relative_to(ROOT).rglob("*.md"))}
    for place, page in places.items():
        link = SOURCE / place
        link.parent.mkdir(parents=True, exist_ok=True)
        link.symlink_to(ROOT / page)


def heading(text: str, line: str) -> str:
    return f"{text}\n{line * len(text)}\n\n"


def read_doxygen() -> None:
    (WORK / "doxygen").mkdir(parents=True)
    settings = f"@INCLUDE = docs/site/Doxyfile\nOUTPUT_DIRECTORY = {WORK / 'doxygen'}\n"
    subprocess.run(["doxygen", "-"], input=settings, text=True, check=True, cwd=ROOT)


def text_of(element: ElementTree.Element) -> str:
    return "".join(element.itertext())


def public_names() -> list[tuple[str, int, str]]:
    """The header, the line and the directive of each name in the namespace gridmerge."""
    xml = WORK / "doxygen" / "xml"
    names = []
    for path in [*xml.glob("struct*.xml"), *xml.glob("class*.xml")]:
        found = ElementTree.parse(path).getroot()[0]
        # What is nested in another one is shown there.
        if text_of(found.find("compoundname")).count("::") == 1:
            names.append((found, text_of(found.find("compoundname")) + "\n   :members:"))
    for found in ElementTree.parse(xml / "namespacegridmerge.xml").getroot().iter("memberdef"):
        name = text_of(found.find("qualifiedname"))
        # Of names outside of types Doxygen does not say that they lack one.
        if not (text_of(found.find("briefdescription")) + text_of(found.find("detaileddescription"))).strip():
            sys.exit(f"{found.find('location').get('file')}: {name} has no comment")
        if found.get("kind") == "function":
            name += "(" + ", ".join(text_of(one.find("type")) for one in found.findall("param")) + ")"
        names.append((found, name))
    places = [(found.find("location"), f".. doxygen{found.get('kind')}:: {name}") for found, name in names]
    return sorted((place.get("file"), int(place.get("line")), directive) for place, directive in places)


def write_cpp_pages() -> None:
    """A page for each room of include/gridmerge: its headers, and their names in their order."""
    read_doxygen()
    pages: dict[str, str] = {}
    for header, names in itertools.groupby(public_names(), key=lambda name: name[0]):
        room = Path(header).parent.name
        pages.setdefault(room, heading(f"gridmerge/{room}", "="))
        pages[room] += heading(header.removeprefix("gridmerge/"), "-")
        pages[room] += "\n\n".join(directive for _, _, directive in names) + "\n\n"
    for room, page in pages.items():
        write(f"reference/cpp/{room}.rst", page)


def help_of(program: Path, *command: str) -> str:
    return subprocess.run([program, *command, "--help"], text=True, check=True, stdout=subprocess.PIPE).stdout


def write_command_line_page(program: Path) -> None:
    """What --help says, of the program and of each command that it lists."""
    usage = help_of(program)
    listed = usage.split("Subcommands:\n")[1].split("\n\n")[0]
    text = (
        heading("Command line", "=") + "What ``gridmerge --help`` and the ``--help`` of each command say.\n\n"
    )
    for command in [[], *([line.split()[0]] for line in listed.splitlines() if line[2:3].strip())]:
        said = help_of(program, *command).rstrip()
        text += heading(" ".join(["gridmerge", *command]), "-") + ".. code-block:: text\n\n"
        text += "\n".join(f"   {line}".rstrip() for line in said.splitlines()) + "\n\n"
    write("reference/command_line.rst", text)


def mend_theme(static: Path) -> None:
    """Debian's furo has its script in parts, which no browser loads, and a style sheet at a path of the web server."""
    script = static / "scripts" / "furo.js"
    options = ["--bundle", "--log-level=warning", "--allow-overwrite", f"--outfile={script}"]
    subprocess.run(["esbuild", script, *options], check=True)
    sheet = static / "styles" / "furo.css"
    sheet.write_text(sheet.read_text().replace("@import url(/javascript/normalize.css/normalize.css);", ""))


def main() -> None:
    parser = argparse.ArgumentParser(description="Makes the documentation site in build/site.")
    parser.add_argument("--program", type=Path, required=True, help="gridmerge, for what its --help says")
    parser.add_argument("--wheel", type=Path, required=True, help="of the Python package, for its docstrings")
    parser.add_argument(
        "--backend", type=Path, required=True, help="nanobind_backend, which the wheel imports"
    )
    arguments = parser.parse_args()
    for folder in (WORK, SITE):
        shutil.rmtree(folder, ignore_errors=True)
    link_pages()
    write_command_line_page(arguments.program)
    write_cpp_pages()
    zipfile.ZipFile(arguments.wheel).extractall(WORK / "python")
    shutil.copytree(arguments.backend, WORK / "python" / arguments.backend.name)
    # Each warning is an error, a link to a place of the site that is not there among them.
    options = [
        "-q",
        "-W",
        "--keep-going",
        "-n",
        "-b",
        "html",
        "-d",
        WORK / "doctrees",
        "-c",
        ROOT / "docs" / "site",
    ]
    built = subprocess.run(
        [sys.executable, "-m", "sphinx", *options, SOURCE, SITE],
        env=os.environ | {"PYTHONPATH": str(WORK / "python")},
        check=False,
    )
    if built.returncode != 0:
        sys.exit(built.returncode)
    mend_theme(SITE / "_static")


if __name__ == "__main__":
    main()
