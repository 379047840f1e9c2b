# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from gridmerge_ros.ages import RobotAge, format_time, publisher_digits, read_ages, read_time


def diagnoses(*statuses: dict[str, str]) -> Any:
    return SimpleNamespace(
        status=[
            SimpleNamespace(values=[SimpleNamespace(key=key, value=value) for key, value in one.items()])
            for one in statuses
        ]
    )


@pytest.mark.parametrize("seconds", [0.0, 1764224401.25, 1764224401.000000238, 9999999999.5])
def test_times_come_back(seconds: float) -> None:
    text = format_time(seconds)
    assert read_time(text) == pytest.approx(seconds, abs=1e-6)
    # Told on, it does not change any more: nodes come to an end with telling.
    again = read_time(text)
    assert again is not None and read_time(format_time(again)) == again


@pytest.mark.parametrize(
    "text",
    [
        "",
        "1764224401",
        "1764224401.25",
        "-1.000000000",
        "1e9.000000000",
        "1764224401.2500000000",
        "nan",
        " 1.000000000",
        "1.000000000\n",
        "99999999999.000000000",
        ".000000000",
        "\u0661.000000000",
    ],
)
def test_other_texts_are_no_times(text: str) -> None:
    assert read_time(text) is None


def test_numbers_of_publishers() -> None:
    guid = tuple(range(240, 256))
    assert publisher_digits(guid) == "f0f1f2f3f4f5f6f7f8f9fafbfcfdfeff"
    assert publisher_digits((*guid, *[0] * 8)) == publisher_digits(guid)


def test_ages_of_a_message() -> None:
    told = {
        "topic": "/tb1/map",
        "frame": "tb1/map",
        "publisher": "0102",
        "heard first": "100.500000000",
        "maps": "3",
    }
    others = [{}, {"topic": "/tb2/map"}, {**told, "heard first": "yesterday"}, {"heard first": "7.000000000"}]
    assert read_ages(diagnoses(told, *others)) == [
        RobotAge("/tb1/map", "0102", "tb1/map", 100.5),
        RobotAge("", "", "", 7.0),
    ]
