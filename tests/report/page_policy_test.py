#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The page that gridmerge writes allows just the script and the style that are in it; and web/assemble.py refuses what
it cannot put into a page. usage: page_policy_test.py GRIDMERGE, in the project's folder"""

import base64
import hashlib
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, "web")
import assemble

GRIDMERGE = sys.argv.pop(1)
TEMPLATE = "<head><!--CSP--><!--STYLE--></head><body><!--DATA--><!--SCRIPT--></body>"


def sha256(text):
    return "'sha256-" + base64.b64encode(hashlib.sha256(text).digest()).decode() + "'"


class Policy(unittest.TestCase):
    def test_allows_what_is_in_the_page(self):
        with tempfile.TemporaryDirectory() as folder:
            maps = [f"examples/three_robots/robot_{i}.yaml" for i in (1, 2)]
            subprocess.run(
                [GRIDMERGE, "merge", *maps, "-o", folder, "--quiet"], check=True, stdout=subprocess.PIPE
            )
            page = pathlib.Path(folder, "report.html").read_bytes()
        policies = re.findall(rb'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', page)
        self.assertEqual(len(policies), 1)
        rules = dict(rule.strip().split(" ", 1) for rule in policies[0].decode().split(";"))
        scripts = re.findall(rb"<script>(.*?)</script>", page, re.DOTALL)
        styles = re.findall(rb"<style>(.*?)</style>", page, re.DOTALL)
        self.assertEqual((len(scripts), len(styles)), (1, 1))
        self.assertEqual(page.count(b"<script"), 2, "the script and the data")
        self.assertEqual(
            rules,
            {
                "default-src": "'none'",
                "script-src": sha256(scripts[0]),
                "style-src": sha256(styles[0]),
                "img-src": "data: blob:",
                "connect-src": "'none'",
                "base-uri": "'none'",
                "form-action": "'none'",
            },
        )


class Assembling(unittest.TestCase):
    def inline(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "main.js")
            path.write_bytes(text)
            return assemble.inline(path, "</script")

    def test_refuses_what_would_end_the_element_or_not_be_hashed_as_it_is(self):
        for text in (b"a='</script>'", b"a='</SCRIPT '", b"a='<!--'", b"a\0", b"a='\xff'"):
            with self.assertRaises((assemble.PageError, UnicodeDecodeError), msg=text):
                self.inline(text)

    def test_the_gaps_are_where_they_belong(self):
        page = assemble.assemble(TEMPLATE, "go('<CONNECT>')", "a{}")
        up_to_connect, up_to_data, after = assemble.cut(page)
        self.assertTrue(up_to_connect.endswith("connect-src "))
        self.assertTrue(up_to_data.endswith("<body>"))
        self.assertEqual(after, "<script>go('<CONNECT>')</script></body>")

    def test_refuses_a_template_that_lacks_a_marker_or_has_it_too_late(self):
        late = TEMPLATE.replace("<!--CSP-->", "").replace("</head>", "<!--CSP--></head>")
        for template in (TEMPLATE.replace("<!--DATA-->", ""), TEMPLATE + "<!--DATA-->", late):
            with self.assertRaises(assemble.PageError, msg=template):
                assemble.assemble(template, "", "")

    def test_the_source_holds_every_byte(self):
        pieces = ('<p title="\\">\n', "ü" * 50, "?")
        source = assemble.as_source(pieces)
        held = [
            bytes(map(int, filter(None, re.sub(r"\s", "", body).split(","))))
            for body in re.findall(r"Bytes\[\] = \{(.*?)\};", source, re.DOTALL)
        ]
        self.assertEqual(held, [piece.encode() for piece in pieces])


unittest.main()
