"""What docs/paper.md says: tables of what was measured, and none of what was not."""

from pathlib import Path

import pytest
from threepoint_training import accuracy_tables, paper_page

JOINTS = ("j4", "j5", "j6", "j7", "j8", "j9")


def side(scale):
    return {
        "mseCm2": {joint: 6.0 * scale for joint in JOINTS},
        "mseStandardised": {joint: 0.02 * scale for joint in JOINTS},
        "rightShoulderMaeCm": 1.5 * scale,
        "mpjpeCm": 3.0 * scale,
    }


def reading(scale):
    sides = {"train": side(scale), "test": side(1.1 * scale)}
    return {"people": ["002"], "frames": 80_000, "iterations": 948, "megabytes": 6.3, **sides}


def method(scale):
    times = {"frames": 6736, "minimum": 0.1, "maximum": 9.0, "average": 0.2}
    return {"mseCm2": 60.0 * scale, "mpjpeCm": {"mean": 8.0 * scale}, "times": [times, times | {"frames": 8661}]}


PATH = {
    "people": ["060", "061"],
    "frames": 15_397,
    "methods": {"ik": method(1.0), "paper": method(1.2), "paper-published": method(1.5)},
}
SCALES = {name: 1.5 + number / 10 for number, name in enumerate(paper_page.LABELS)}
READINGS = {name: reading(scale) for name, scale in (SCALES | {"page": 1.0, "literal": 0.7, "wide": 3.0}).items()}


def rows(text):
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line[0] == "|"]


def sections(readings=READINGS):
    return paper_page.sections(readings, {"test": side(2.0)}, {"test": side(9.0)}, PATH)


def test_every_table_has_as_many_cells_in_each_row_as_in_its_head():
    for name, content in sections().items():
        assert len({len(row) for row in rows(content)} or {0}) == 1 or name == "corpus", name


def test_readings_are_sorted_by_their_distance_from_the_papers_errors():
    head, _, paper, *measured = rows(sections()["table-4"])
    assert paper[0] == "**the paper**"
    assert len(measured) == len(paper_page.LABELS)
    assert [measured[place][0] for place in (0, 1, -1)] == [paper_page.LABELS[n] for n in ("literal", "page", "wide")]
    assert measured[0][head.index("MPJPE [cm], train/test")] == "2.10/2.31"


def test_a_table_of_which_a_stage_was_not_run_stays():
    only_page = {"page": reading(1.0)}
    assert sections(only_page)["table-4"] is None
    assert sections({})["table-1"] is None
    assert paper_page.sections(only_page, None, None, PATH)["table-1"] is None


def test_the_baseline_has_the_papers_figures_and_ours():
    row = rows(sections()["tables-2-3"])[2]
    assert row == ["IK", "0.8066", "12.00", "0.1587", "3.00", "60.0", "8.00"]


def test_the_mean_of_the_papers_last_column_is_not_the_one_it_prints():
    assert sum(test for _, test in paper_page._MSE.values()) / 6 == pytest.approx(0.222, abs=5e-4)
    assert rows(sections()["table-1"])[-1][1] == "0.0277/0.0448"


def test_the_page_has_a_place_for_every_table():
    page = (Path(paper_page.REPOSITORY) / "docs/paper.md").read_text()
    once = accuracy_tables.renew(page, sections())
    assert accuracy_tables.renew(once, sections()) == once
