"""Facts about the table of legs: people alike, with long clips and short ones; another laboratory in rows of its own.
"""

from pathlib import Path

import pytest
from threepoint_training import legs_page


def person(seen: bool, minutes: float, foot: float) -> dict[str, object]:
    figures = {
        "pelvisCm": 8.0, "kneeCm": 12.0, "footCm": foot, "skateCmS": 30.0, "trueSkateCmS": 4.0, "slideCmS": 1.0, "floatCm": 0.5, "sinkCm": 0.1,
        "standing": 0.7, "agreed": 0.8,
    }  # fmt: skip
    return {"seen": seen, "minutes": minutes, **{driver: dict(figures) for driver in legs_page.DRIVERS}}


LEGS = {"people": {"002": person(True, 9.0, 10.0), "901": person(False, 2.0, 40.0), "005": person(False, 1.0, 20.0)}}


def rows(table: str) -> list[list[str]]:
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()]


def test_people_count_alike_and_another_laboratory_by_itself() -> None:
    head, _, *lines = rows(legs_page.drivers(LEGS))
    foot = head.index("foot [cm]")
    assert [(line[0], line[foot]) for line in lines] == [
        ("the true pelvis", "15.0"), ("IK", "15.0"), ("learned", "15.0"),
        ("the true pelvis, another laboratory", "40.0"), ("IK, another laboratory", "40.0"), ("learned, another laboratory", "40.0"),
    ]  # fmt: skip
    assert lines[0][head.index("contact agreed")] == "80 %"


def test_a_page_without_marks_is_refused(tmp_path: Path) -> None:
    (tmp_path / "legs.json").write_text('{"people": {}}')
    page = tmp_path / "page.md"
    page.write_text("# Legs\n")
    with pytest.raises(ValueError, match="no place for legs"):
        legs_page.main(tmp_path / "legs.json", page)
