# SPDX-License-Identifier: Apache-2.0
"""Each public name has a docstring; those of attributes stand in the source alone, behind them."""

import ast
import pathlib
from collections.abc import Iterator

import gridmerge

PACKAGE = pathlib.Path(gridmerge.__file__).parent


def is_text(statement: ast.stmt | None) -> bool:
    return (
        isinstance(statement, ast.Expr)
        and isinstance(statement.value, ast.Constant)
        and isinstance(statement.value.value, str)
    )


def undocumented(body: list[ast.stmt], of: str, names: set[str] | None) -> Iterator[str]:
    """Of the statements of a module, those of these `names`; of a class, all that are public."""
    for i, node in enumerate(body):
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            if any(isinstance(one, ast.Name) and one.id == "overload" for one in node.decorator_list):
                continue
            name, has_text = node.name, ast.get_docstring(node) is not None
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            name, has_text = node.target.id, is_text(body[i + 1] if i + 1 < len(body) else None)
        else:
            continue
        if name.startswith("_") or (names is not None and name not in names):
            continue
        if not has_text:
            yield of + name
        if isinstance(node, ast.ClassDef):
            yield from undocumented(node.body, f"{of}{name}.", None)


def exported_by_module() -> dict[str, set[str]]:
    """What the package takes from each of its modules."""
    exported: dict[str, set[str]] = {}
    for node in ast.parse((PACKAGE / "__init__.py").read_text()).body:
        if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module != "_core":
            exported[str(node.module)] = {alias.name for alias in node.names} & set(gridmerge.__all__)
    return exported


def test_every_public_name_has_a_docstring() -> None:
    exported = exported_by_module()
    # FileError is the extension module's.
    assert sum(len(names) for names in exported.values()) == len(gridmerge.__all__) - 1
    missing = [
        f"{module}: {name}"
        for module, names in exported.items()
        for name in undocumented(ast.parse((PACKAGE / f"{module}.py").read_text()).body, "", names)
    ]
    assert missing == []
