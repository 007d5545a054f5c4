"""What docs/accuracy.md says: verdicts by the figures, tables that keep their place."""

import json
from pathlib import Path

import pytest
from threepoint_training import accuracy_page, accuracy_tables

JOINTS = tuple(accuracy_tables.JOINTS)


def report(scale):
    spread = {"mean": 5.0 * scale, "median": 4.0 * scale, "p95": 12.0 * scale}
    return {
        "mpjpeCm": spread,
        "joints": {joint: spread for joint in JOINTS},
        "mseCm2": 20.0 * scale**2,
        "maeCm": 3.0 * scale,
        "jointMseCm2": {joint: 20.0 * scale**2 for joint in JOINTS},
        "jointMaeCm": {joint: 3.0 * scale for joint in JOINTS},
        "swivelDeg": 25.0,
        "jerkRatio": 1.05,
        "boneVariationMm": 0.0,
        "handErrorMm": 0.0,
        "handErrorMaxMm": 0.0,
    }


def robustness(clean):
    errors = {"allCm": 1.2 * clean, "allSeenCm": clean, "elbowCm": 2 * clean, "elbowSeenCm": clean}
    step = {"stepCm": 8.0, "joint": "leftHand", "excessCm": 4.0, "excessJoint": "leftHand", "over5Cm": 0}

    def lost(milliseconds):
        return {
            "milliseconds": milliseconds,
            "losses": 7,
            "during": errors,
            "after": errors,
            "atLoss": step,
            "atReturn": step,
        }

    return {
        "mpjpeCm": clean,
        "jerkRatio": 1.05,
        "losses": [lost(ms) for ms in (100, 500, 2000)],
        "handTracking": lost(300),
        "offsets": [
            {"tracker": tracker, "axis": axis, "offsetCm": cm, "mpjpeCm": clean + abs(cm) / 10}
            for tracker in ("headset", "grips")
            for axis in "xyz"
            for cm in (-3, -1, 1, 3)
        ],
        "heights": [{"percent": p, "mpjpeCm": clean + 0.25} for p in (-5, -2, 2, 5)],
        "spans": [{"percent": p, "mpjpeCm": clean - 0.04} for p in (-5, 5)],
    }


def evaluation():
    methods = {"ik": report(1.0), "paper": report(1.2), "learned": report(0.8)}
    return {
        "corpus": {"clips": 3, "people": 2, "frames": 3600, "seconds": 60.0},
        "estimators": methods,
        "seen": methods,
        "unseen": methods,
        "people": {"001": {"seen": True} | methods, "005": {"seen": False} | methods},
        "fp32": {"learned": report(0.8), "paper": report(1.2)},
        "robustness": {
            "people": ["005"],
            "clips": 2,
            "frames": 2400,
            "estimators": {name: robustness(clean) for name, clean in (("ik", 5.0), ("paper", 6.0), ("learned", 4.0))},
        },
    }


def held_out_people(names, learned):
    """Returns an evaluation in which every person is held out."""
    methods = {"ik": report(1.0), "paper": report(1.2), "learned": report(learned)}
    return {"estimators": methods, "people": {name: {"seen": False} | methods for name in names}}


LABORATORIES = tuple(
    tuple(held_out_people(names, learned) for learned in both)
    for names, both in ((("135", "005"), (0.9, 0.8)), (("901", "902"), (0.7, 0.6)))
)

CONTRACT = {"bytes": 42544}


def verdict(text, start):
    (row,) = [line for line in text.splitlines() if line.startswith(f"| {start}")]
    return [cell.strip() for cell in row.strip("|").split("|")][1:]


def test_every_table_has_as_many_cells_in_each_row_as_in_its_head():
    for name, content in accuracy_page.sections(evaluation(), CONTRACT, LABORATORIES).items():
        rows = [line for line in content.splitlines() if line.startswith("|")]
        assert len({row.count("|") for row in rows}) <= 1, name


def test_aims_are_met_or_missed_by_the_figures():
    text = accuracy_tables.aims(evaluation(), CONTRACT)
    assert verdict(text, "MPJPE relative to IK, 005") == ["≤ 0.86", "0.800", "met"]
    assert verdict(text, "the person with the largest MPJPE relative to IK") == ["≤ 1.0", "0.800", "met"]
    assert verdict(text, "eye height") == ["≤ +0.2 cm", "+0.25 cm", "missed"]
    assert verdict(text, "tracker mounted")[1] == "+0.30 cm"
    assert verdict(text, "a hand lost for 2 s: its elbow") == ["≤ 1.8 ×", "2.00 ×", "missed"]
    assert verdict(text, "size") == ["≤ 300 kB", "43 kB", "met"]


def test_laboratories_stand_beside_each_other_with_hands_as_recorded_and_measured():
    home, elsewhere = LABORATORIES
    # The elbows differ from the mean of all joints, so that the test distinguishes their columns.
    home[0]["estimators"]["learned"]["joints"] |= {"leftElbow": {"mean": 3.0}, "rightElbow": {"mean": 2.0}}
    text = accuracy_tables.laboratories(home, elsewhere)
    assert text.splitlines()[0] == "| cm | IK | learned | learned / IK | elbows | jerk: IK | learned |"
    assert verdict(text, "005, 135, hands not calibrated") == ["5.00", "4.50", "0.90", "0.50", "1.05", "1.05"]
    assert verdict(text, "005, 135, hands calibrated")[:4] == ["5.00", "4.00", "0.80", "0.80"]
    assert verdict(text, "another laboratory (901, 902), hands not calibrated")[:3] == ["5.00", "3.50", "0.70"]
    assert verdict(text, "another laboratory, hands calibrated")[:3] == ["5.00", "3.00", "0.60"]


def test_laboratories_that_were_not_measured_leave_their_table_as_it_was(tmp_path, capsys):
    files = [tmp_path / f"{name}.json" for name in ("home", "home-measured", "elsewhere", "elsewhere-measured")]
    config = accuracy_page.AccuracyPageConfig(tmp_path, tmp_path, tmp_path, tuple(files[:2]), tuple(files[2:]))
    page = "<!-- laboratories -->\nas before\n<!-- /laboratories -->\n"

    def renewed():
        section = accuracy_page.sections(evaluation(), CONTRACT, accuracy_page.laboratories(config))["laboratories"]
        return accuracy_tables.renew(page, {"laboratories": section})

    for file, measured in zip(files, [each for both in LABORATORIES for each in both], strict=True):
        assert renewed() == page
        assert f"{file}" in capsys.readouterr().out
        file.write_text(json.dumps(measured))
    assert "| another laboratory, hands calibrated | 5.00 |" in renewed()
    assert capsys.readouterr().out == ""


def test_eight_bits_are_compared_where_both_were_measured():
    without = evaluation()
    del without["fp32"]
    assert verdict(accuracy_tables.aims(evaluation(), CONTRACT), "int8 against fp32: MPJPE") == [
        "≤ +0.05 cm",
        "+0.000 cm",
        "met",
    ]
    assert "fp32" not in accuracy_tables.aims(without, CONTRACT)


def test_losses_end_with_those_of_hand_tracking():
    head, _, *rows = accuracy_tables.loss(evaluation()).splitlines()
    assert [row.split(" | ")[0] for row in rows] == [
        "| 100 ms, 7 losses",
        "| 500 ms, 7 losses",
        "| 2000 ms, 7 losses",
        "| as in hand tracking, 300 ms on average, 7 losses",
    ]
    assert head.split(" | ")[1:3] == ["all joints: IK", "all joints: learned"]
    assert verdict(rows[0], "100 ms") == ["6.00 (1.20 ×)", "4.80 (1.20 ×)", "10.00 (2.00 ×)", "8.00 (2.00 ×)", "4.0", "4.0"]


def test_a_fault_has_the_figure_of_its_worst_direction():
    measured = evaluation()
    measured["robustness"]["estimators"]["learned"]["offsets"][3]["mpjpeCm"] = 4.9
    text = accuracy_tables.faults(measured)
    assert verdict(text, "headset ±1 cm") == ["+0.10", "+0.10"]
    assert verdict(text, "headset ±3 cm") == ["+0.30", "+0.90"]
    assert verdict(text, "arm span ±5 %") == ["−0.04", "−0.04"]


def test_only_people_held_out_have_a_row():
    (row,) = accuracy_tables.people(evaluation()).splitlines()[2:]
    assert row.startswith("| 005 |")


def test_a_page_renewed_twice_is_the_page_renewed_once():
    page = (Path(accuracy_page.REPOSITORY) / "docs/accuracy.md").read_text()
    once = accuracy_tables.renew(page, accuracy_page.sections(evaluation(), CONTRACT, LABORATORIES))
    assert accuracy_tables.renew(once, accuracy_page.sections(evaluation(), CONTRACT, LABORATORIES)) == once


def test_a_page_without_the_place_of_a_table_is_refused():
    with pytest.raises(ValueError, match="no place for loss"):
        accuracy_tables.renew("<!-- aims -->\n<!-- /aims -->", {"loss": "text"})
