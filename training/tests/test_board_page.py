"""What docs/board.md says: a row for each method, and a sentence instead of tables of what was not trained."""

import json
from dataclasses import replace

import pytest

pytestmark = pytest.mark.training


def measured(scale):
    return {
        "people": ["002", "005"],
        "clips": 12,
        "frames": 3456,
        "mpjpeCm": {"mean": 7.0 * scale},
        "rawMpjpeCm": 7.5 * scale,
        "joints": {"leftElbow": {"mean": 8.0 * scale}, "rightElbow": {"mean": 10.0 * scale}},
        "jerkRatio": 0.9,
        "loss": {"during": {"allCm": 9.0 * scale, "elbowCm": 18.0 * scale}},
    }


SCALES = {"ccd": 1.5, "ik": 1.0, "paper": 1.2, "learned": 0.8, "transformer": 0.9, "memory": 1.1}


@pytest.fixture
def page(tmp_path):
    """A page with places for the tables, and files of what was measured and trained."""
    from threepoint_training.board_page import LABELS
    from threepoint_training.stage_files import write_stage

    times = {name: {"p10Ms": 0.2, "p50Ms": 0.25} for name in LABELS}
    (tmp_path / "times-now.json").write_text(json.dumps(times))
    for name, scale in SCALES.items():
        groups = {"heldOut": measured(scale), "elsewhere": measured(2 * scale) | {"loss": None}}
        (tmp_path / f"{name}-now.json").write_text(json.dumps(groups))
    figures = {"steps": 900, "windows": 57_600, "seconds": 600, "validationCm": 8.25, "bestStep": 800}
    write_stage(tmp_path / "transformer.json", {}, figures | {"stoppedFalling": False})
    marks = (f"<!-- {name} -->\n\n<!-- /{name} -->\n" for name in ("corpus", "methods", "trainings"))
    (tmp_path / "board.md").write_text("".join(marks))
    return tmp_path / "board.md"


def write(page, *networks):
    from threepoint_training import board_page
    from threepoint_training.train_board import BoardConfig

    config = replace(BoardConfig(), networks=networks)
    board_page.main(page.parent, config, "now", page)
    lines = (line for line in page.read_text().splitlines() if line.startswith("| "))
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_every_method_has_a_row_with_what_was_measured(page):
    head, _, *rows = write(page, "transformer")
    board = {row[0]: dict(zip(head, row, strict=True)) for row in rows if len(row) == len(head)}
    of_ours = ["hands only", "CCD-IK (three.js)", "our IK", "`paper`", "`learned`"]
    assert list(board) == [*of_ours, "Transformer", "MLP with memory"]
    assert board["Transformer"] == {
        "": "Transformer",
        "all joints [cm]": "6.30",
        "network alone": "6.75",
        "elbows": "8.10",
        "jerk": "0.90",
        "lost hand: all": "8.10",
        "its elbow": "16.20",
        "another laboratory": "12.60",
        "parameters": "4,118,082",
        "multiply-adds [M]": "113.6",
        "ms a frame: p10 / p50": "0.20 / 0.25",
    }
    assert board["hands only"]["all joints [cm]"] == board["our IK"]["parameters"] == "–"


def test_a_training_that_reached_its_budget_is_said_to_have_fallen_still(page):
    assert write(page, "transformer")[-1] == ["Transformer", "900", "57,600", "10", "8.25 at 800", "yes"]


def test_half_a_run_is_refused_in_a_sentence_and_the_page_stays(page):
    from threepoint_training.motion_files import MocapError

    before = page.read_text()
    with pytest.raises(MocapError, match="has no finished training of memory"):
        write(page, "transformer", "memory")
    (page.parent / "ik-now.json").unlink()
    with pytest.raises(MocapError, match="has no finished measurement of ik"):
        write(page, "transformer")
    assert page.read_text() == before
