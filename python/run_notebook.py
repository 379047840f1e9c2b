# SPDX-License-Identifier: Apache-2.0
"""Runs notebooks and fails if a cell does, or if one is kept with its outputs: `python run_notebook.py NOTEBOOK...`"""

import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient


def run(path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    if any(cell.get("outputs") or cell.get("execution_count") for cell in notebook.cells):
        raise SystemExit(f"{path}: holds outputs; clear them before it is committed")
    NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(path.parent)}}).execute()
    if not any(
        "image/png" in output.get("data", {}) for cell in notebook.cells for output in cell.get("outputs", ())
    ):
        raise SystemExit(f"{path}: drew no picture")


for argument in sys.argv[1:]:
    run(Path(argument))
    print(f"{argument}: every cell ran")
