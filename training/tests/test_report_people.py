"""Tests of the selection of the people that the report measures."""

import json
import subprocess
import sys
from pathlib import Path

from threepoint_training import report_people
from threepoint_training.splits import LOCKBOX, VARIED, trainable


def folder_of(folder: Path, *people: str) -> Path:
    for person in people:
        (folder / person).mkdir()
        (folder / person / f"{person}_01.bvh").write_text("")
    return folder


def test_tables_are_of_the_varied_people_outside_the_lockbox_where_they_are_all_there(tmp_path: Path) -> None:
    there = report_people.main(folder_of(tmp_path, *VARIED, "132", "901", "903"))
    assert there == {"tables": list(trainable(VARIED)), "elsewhere": ["901", "903"], "paper": ["132"]}


def test_tables_are_of_everyone_outside_the_lockbox_where_one_of_them_is_missing(tmp_path: Path) -> None:
    there = report_people.main(folder_of(tmp_path, *LOCKBOX, "005", "anna"))
    assert there == {"tables": ["005", "anna"], "elsewhere": [], "paper": ["anna"]}


def test_the_paper_s_network_is_measured_on_people_it_knows_where_there_are_no_others(tmp_path: Path) -> None:
    assert report_people.main(folder_of(tmp_path, "005", "135", "901"))["paper"] == ["005"]


def test_the_program_answers_in_json_or_says_what_is_wrong(tmp_path: Path) -> None:
    def ask(mocap: Path) -> subprocess.CompletedProcess[str]:
        training = Path(report_people.__file__).parents[1]
        command = [sys.executable, "-m", "threepoint_training.report_people", "--mocap", str(mocap)]
        return subprocess.run(command, cwd=training, capture_output=True, text=True, check=False)

    assert json.loads(ask(folder_of(tmp_path, "005")).stdout)["tables"] == ["005"]
    refused = ask(tmp_path / "nowhere")
    assert (refused.returncode, refused.stderr) == (1, f"{tmp_path / 'nowhere'}: no such folder\n")
