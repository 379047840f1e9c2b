# SPDX-License-Identifier: Apache-2.0
"""licences.py on texts and wheels made here: `./dev test --python` runs this."""

import hashlib
import zipfile
from pathlib import Path

import pytest
from licences import FILE_NAME, Contents, LicenceError, Part, licences_of, refused_licences, with_file

HEAD = "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\nUpstream-Name: x\n"


def copyright_text(**licences: str) -> str:
    names = {"everything": "*", "packaging": "debian/*"}
    parts = [
        f"Files: {names.get(files, files)}\nCopyright: y\nLicense: {name}\n text"
        for files, name in licences.items()
    ]
    return "\n\n".join([HEAD, *parts, "License: GPL-3\n stands alone"])


def test_the_licence_of_the_whole_work_counts() -> None:
    text = copyright_text(everything="Expat", packaging="GPL-2+", tools="GPL-3+")
    assert licences_of(text) == ["Expat"]
    assert refused_licences(text) == []


def test_without_one_for_the_whole_those_of_all_files_count() -> None:
    text = copyright_text(a="Zlib", b="BSD-3-clause", packaging="GPL-2+")
    assert licences_of(text) == ["BSD-3-clause", "Zlib"]
    assert refused_licences(text + "\n\nFiles: c\nCopyright: y\nLicense: GPL-2+\n") == ["GPL-2+"]


def test_files_on_several_lines() -> None:
    text = HEAD + "\nFiles:\n a.c\n b.c\nCopyright: y\nLicense: LGPL-2.1+\n"
    assert refused_licences(text) == ["LGPL-2.1+"]


@pytest.mark.parametrize("name", ["GPL-2+", "LGPL-2.1+", "AGPL-3", "GPL-2 or LGPL-3"])
def test_nothing_but_the_gpl_is_refused(name: str) -> None:
    assert refused_licences(copyright_text(everything=name)) == [name]


@pytest.mark.parametrize("name", ["BSD-3-clause or GPL-2", "GPL-2+ OR Apache-2.0", "public-domain", "MPL-2"])
def test_a_choice_beside_the_gpl_is_taken(name: str) -> None:
    assert refused_licences(copyright_text(everything=name)) == []


def test_a_text_that_no_machine_reads_names_nothing() -> None:
    assert licences_of("This program is free.\n\nDo what you like.") == []


def test_a_part_under_the_gpl_ends_it() -> None:
    contents = Contents()
    contents.part(Part("suite", "1", copyright_text(everything="GPL-2+"))).libraries.add(
        "libsuite-01234567.so.1"
    )
    with pytest.raises(LicenceError, match=r"suite: libsuite-01234567\.so\.1: under GPL-2\+"):
        contents.text()


def test_a_library_of_no_package_ends_it() -> None:
    with pytest.raises(LicenceError, match="no Debian package has libnobodys.so.1"):
        Contents().add_libraries(["libnobodys-01234567.so.1"])


def test_the_text_names_each_part_and_has_its_notice() -> None:
    contents = Contents()
    part = contents.part(Part("thing", "1.2", copyright_text(everything="Expat")))
    part.libraries.add("libthing-01234567.so.1")
    part.headers = 3
    text = contents.text()
    assert "- thing 1.2: libthing-01234567.so.1, headers (3 files). Licence: Expat\n" in text
    assert "Upstream-Name: x" in text


def make_wheel(path: Path, order: list[str]) -> Path:
    contents = {
        "x/__init__.py": "",
        "x-1.dist-info/METADATA": "Metadata-Version: 2.4\nName: x\nLicense-File: LICENSE\n\nText\n",
        "x-1.dist-info/RECORD": "stale,,\n",
    }
    with zipfile.ZipFile(path, "w") as wheel:
        for name in order:
            wheel.writestr(name, contents[name])
    return path


def test_the_wheel_has_the_file_and_a_true_record(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    names = ["x/__init__.py", "x-1.dist-info/METADATA", "x-1.dist-info/RECORD"]
    one = make_wheel(tmp_path / "one.whl", names)
    other = make_wheel(tmp_path / "other.whl", names[::-1])
    with_file(one, "notices\n", tmp_path / "one_out.whl")
    with_file(other, "notices\n", tmp_path / "other_out.whl")
    assert (tmp_path / "one_out.whl").read_bytes() == (tmp_path / "other_out.whl").read_bytes()

    with zipfile.ZipFile(tmp_path / "one_out.whl") as wheel:
        assert wheel.read(f"x-1.dist-info/licenses/{FILE_NAME}") == b"notices\n"
        metadata = wheel.read("x-1.dist-info/METADATA").decode()
        assert metadata.startswith(
            f"Metadata-Version: 2.4\nName: x\nLicense-File: LICENSE\nLicense-File: {FILE_NAME}\n"
        )
        rows = [line.split(",") for line in wheel.read("x-1.dist-info/RECORD").decode().splitlines()]
        assert sorted(name for name, _, _ in rows) == sorted(wheel.namelist())
        for name, digest, size in rows[:-1]:
            assert size == str(len(wheel.read(name)))
            assert digest.startswith("sha256=") and len(digest) == len("sha256=") + 43
        assert hashlib.sha256(wheel.read("x/__init__.py")).digest().hex().startswith("e3b0c442")
