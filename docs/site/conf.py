# SPDX-License-Identifier: Apache-2.0
"""Sphinx, for the site that `./dev docs` makes. docs/site/make.py prepares what this reads."""

import dataclasses
import inspect
import pkgutil
import re
from pathlib import Path

import furo
import gridmerge
import sphinx.ext.autodoc
import sphinx.util.inspect
from sphinx.ext.napoleon import GoogleDocstring
from sphinx.pycode import ModuleAnalyzer
from sphinx.util import logging

ROOT = Path(__file__).resolve().parents[2]

# Debian's furo looks for this on the web server, and shows its dark colours only to who asks for them by its switch.
NORMALIZE = Path("/usr/share/javascript/normalize.css/normalize.css")


def dark_colours() -> dict[str, str]:
    sheet = Path(furo.__file__).parent / "assets" / "styles" / "variables" / "_colors.scss"
    dark = sheet.read_text().split("@mixin colors-dark")[1]
    return dict(re.findall(r"^ *--([\w-]+): ([^;]+);", dark, re.MULTILINE))


project = "gridmerge"
found = re.search(r"project\(gridmerge VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
assert found, "CMakeLists.txt names no version"
version = release = found[1]
html_title = f"gridmerge {version}"

extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc"]
exclude_patterns = ["docs/site"]
# Links of README and the like name headings as on GitHub.
myst_heading_anchors = 4

html_theme = "furo"
html_static_path = ["static", str(NORMALIZE)]
html_css_files = [(NORMALIZE.name, {"priority": 100}), "site.css"]
html_theme_options = {"dark_css_variables": dark_colours()}
html_copy_source = False
html_show_copyright = False
toc_object_entries_show_parents = "hide"
pygments_style = "friendly"
pygments_dark_style = "monokai"

breathe_projects = {"gridmerge": str(ROOT / "build" / "docs" / "doxygen" / "xml")}
breathe_default_project = "gridmerge"
breathe_default_members = ("members",)

# A docstring's `name` is code.
default_role = "code"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "undoc-members": True}

# Names of other libraries, whose pages are not here.
nitpick_ignore_regex = [
    ("cpp:.*", r"std(::.*)?|gridmerge|internal(::.*)?"),
    (
        "py:.*",
        r"(np|os|collections\.abc|gridmerge\._grid)\..*|NDArray|ArrayLike|Axes|Figure|Executor|Callable|Iterable|Iterator|Mapping|Sequence|M",
    ),
]

# Of the dataclasses the ones that users make. All others are results.
MADE_BY_USERS = {gridmerge.InitialPose, gridmerge.Transform}


def read_comments() -> None:
    """The package says of its names that they are its own, not its modules': so are the comments below them."""
    package = ModuleAnalyzer.for_module("gridmerge")
    package.analyze()
    for module in pkgutil.iter_modules(gridmerge.__path__):
        if module.name == "_core":
            continue
        part = ModuleAnalyzer.for_module(f"gridmerge.{module.name}")
        part.analyze()
        for comments in ("attr_docs", "annotations", "overloads"):
            getattr(package, comments).update(getattr(part, comments))
        before = len(package.tagorder)
        package.tagorder.update({name: before + place for name, place in part.tagorder.items()})


def signature_as_written(subject, bound_method=False, type_aliases=None):
    """With types as the source has them: `MapLike`, not the union that it stands for."""
    signature = inspect.signature(subject)
    parameters = list(signature.parameters.values())
    if bound_method and not inspect.ismethod(subject):
        del parameters[0]
    return signature.replace(parameters=parameters)


def hide_constructor(app, what, name, obj, options, signature, result):
    if what == "class" and dataclasses.is_dataclass(obj) and obj not in MADE_BY_USERS:
        return "", None
    return None


def read_docstring(app, what, name, obj, options, lines):
    if what in ("class", "function", "method"):
        lines[:] = GoogleDocstring(lines, what=what, name=name, obj=obj).lines()


def find_alias(app, env, node, content):
    """A type may be a name for another one: `MapLike` is no class."""
    if node.get("refdomain") != "py" or node.get("reftype") != "class":
        return None
    python = env.get_domain("py")
    return python.resolve_xref(env, node["refdoc"], app.builder, "obj", node["reftarget"], node, content)


def name_everything(app, env):
    """Each public name of the package has its place in the reference."""
    here = {name for name in env.get_domain("py").objects}
    for name in gridmerge.__all__:
        if f"gridmerge.{name}" not in here:
            logging.getLogger(__name__).warning("reference/python.md lacks gridmerge.%s", name)


def setup(app):
    read_comments()
    sphinx.util.inspect.signature = signature_as_written
    sphinx.ext.autodoc.get_type_hints = lambda obj, *scopes: getattr(obj, "__annotations__", {})
    app.connect("autodoc-process-signature", hide_constructor)
    app.connect("autodoc-process-docstring", read_docstring)
    app.connect("missing-reference", find_alias)
    app.connect("env-check-consistency", name_everything)
