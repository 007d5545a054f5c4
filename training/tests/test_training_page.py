"""Facts about the table of results."""

from threepoint_training import training_page
from threepoint_training.training_report import LABELS


def errors(value):
    return {"mean": value} | dict.fromkeys(LABELS, value)


def test_results_stand_by_protocol_and_leave_out_who_was_trained_on():
    learned = {
        "IK, fold A (1, 2)": errors(7.0),
        "learned, fold A (1, 2)": errors(6.0),
        "learned, all subjects, trained on": errors(4.0),
    }
    paper = {
        "IK, fold A (1, 2)": errors(7.5),
        "paper, fold A (1, 2)": errors(10.0),
        "paper, frame-random 80/20": errors(3.0),
    }
    _, _, *rows = training_page.results([{"errors": learned}, {"errors": paper}]).splitlines()
    assert [row.split(" | ")[:2] for row in rows] == [
        ["| fold A (1, 2): IK", "7.00"],
        ["| fold A (1, 2): the paper's network", "10.00"],
        ["| fold A (1, 2): ours", "6.00"],
        ["| frame-random 80/20: the paper's network", "3.00"],
    ]
