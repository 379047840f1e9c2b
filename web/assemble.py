#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Puts the report page together, style and script inside, and writes it as C++ source.

The page comes in three pieces: up to the value of connect-src, from there to the data, and what follows the data. The
program that serves or saves the page fills the gaps.
"""

import argparse
import base64
import hashlib
import pathlib
import re
import sys

CONNECT = "<CONNECT>"
PIECES = ("kPageUpToConnect", "kPageUpToData", "kPageAfterData")


class PageError(Exception):
    pass


def inline(path, closing_tag):
    """The file's text, as it may stand in an element that is closed by `closing_tag`."""
    text = path.read_text(encoding="utf-8").strip("\n")
    # What a browser would end the element at, or hash otherwise than it is written: it reads a CR as LF,
    # a NUL as U+FFFD.
    for bad, what in (
        (closing_tag, closing_tag),
        ("<!--", "<!--"),
        ("\r", "a carriage return"),
        ("\0", "a NUL"),
    ):
        if bad in text.lower():
            raise PageError(f"{path}: holds {what}, which an inline element may not")
    return text


def source_hash(text):
    return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"


def policy(script, style):
    return (
        f"default-src 'none'; script-src {source_hash(script)}; style-src {source_hash(style)}; "
        f"img-src data: blob:; connect-src {CONNECT}; base-uri 'none'; form-action 'none'"
    )


def assemble(template, script, style):
    """The page with a gap, the data, and the policy's connect-src left open."""
    contents = {
        "STYLE": f"<style>{style}</style>",
        "SCRIPT": f"<script>{script}</script>",
        "CSP": f'<meta http-equiv="Content-Security-Policy" content="{policy(script, style)}">',
    }
    for name in (*contents, "DATA"):
        if template.count(f"<!--{name}-->") != 1:
            raise PageError(f"the template has to hold <!--{name}--> once")
    before_policy = template.partition("<!--CSP-->")[0]
    if re.search(r"<!--(STYLE|SCRIPT|DATA)-->|<(script|style|link)\b", before_policy, re.IGNORECASE):
        raise PageError("<!--CSP--> has to come before all that it is about")
    return re.sub(r"<!--(STYLE|SCRIPT|CSP)-->", lambda marker: contents[marker[1]], template)


def cut(page):
    """Up to connect-src's value, up to the data, the rest. The policy comes first, and no script holds a marker."""
    up_to_connect, _, rest = page.partition(CONNECT)
    up_to_data, _, after = rest.partition("<!--DATA-->")
    return up_to_connect, up_to_data, after


def as_source(pieces):
    """C++ that defines each piece. As numbers: no compiler limits their count as it does a literal's length."""
    lines = [
        "// Made by web/assemble.py; not to be changed by hand.",
        '#include "report/page_template.hpp"',
        "",
        "namespace gridmerge::internal {",
        "",
        "namespace {",
        "",
    ]
    for name, text in zip(PIECES, pieces):  # noqa: B905 - builds may run this with a Python older than 3.10
        data = text.encode()
        lines.append(f"constexpr unsigned char {name}Bytes[] = {{")
        lines += ["  " + ",".join(map(str, data[i : i + 40])) + "," for i in range(0, len(data), 40)]
        lines += ["};", ""]
    lines += ["}  // namespace", ""]
    for name in PIECES:
        lines.append(
            f"const std::string_view {name}(reinterpret_cast<const char*>({name}Bytes), sizeof({name}Bytes));"
        )
    return "\n".join([*lines, "", "}  // namespace gridmerge::internal", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--template", type=pathlib.Path, required=True)
    parser.add_argument("--style", type=pathlib.Path, required=True)
    parser.add_argument("--script", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True, help="the C++ source")
    arguments = parser.parse_args()
    try:
        page = assemble(
            arguments.template.read_text(encoding="utf-8"),
            inline(arguments.script, "</script"),
            inline(arguments.style, "</style"),
        )
        arguments.output.write_text(as_source(cut(page)), encoding="utf-8")
    except (PageError, OSError, UnicodeDecodeError) as error:
        sys.exit(f"assemble.py: {error}")


if __name__ == "__main__":
    main()
