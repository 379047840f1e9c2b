# SPDX-License-Identifier: Apache-2.0
"""What a wheel promises by its name and its metadata."""

import importlib.metadata
from pathlib import Path

import gridmerge
from gridmerge import _core


def test_one_module_serves_every_python() -> None:
    assert Path(_core.__file__).name == "_core.abi3.so"


def test_what_pip_brings_with_it() -> None:
    required = importlib.metadata.requires("gridmerge") or []
    names = {
        text.split(";")[0].split("<")[0].split(">")[0].strip() for text in required if "extra ==" not in text
    }
    assert names == {"numpy", "nanobind-backend"}


def test_it_has_its_licence_and_version() -> None:
    metadata = importlib.metadata.metadata("gridmerge")
    assert metadata["License-Expression"] == "Apache-2.0"
    assert metadata["Version"] == gridmerge.__version__
    files = importlib.metadata.files("gridmerge") or []
    assert any(file.match("*.dist-info/licenses/LICENSE") for file in files)
