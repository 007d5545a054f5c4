"""Facts about motion of lockbox people: nothing reads it without a row in the log."""

import json
import re
import subprocess
import sys
from datetime import date
from pathlib import Path

import pytest
from test_prepare import STANDING, person_bvh
from threepoint_training import lockbox_log, prepare, recordings
from threepoint_training.lockbox_log import LockboxAccess
from threepoint_training.motion_files import MocapError
from threepoint_training.splits import LOCKBOX

PERSON = LOCKBOX[0]


@pytest.fixture
def mocap(tmp_path: Path) -> Path:
    """A folder with motion of a lockbox person and of another one."""
    folder = tmp_path / "mocap"
    for person in (PERSON, "005"):
        (folder / person).mkdir(parents=True)
        (folder / person / f"{person}_01.bvh").write_text(person_bvh(STANDING))
    return folder


def test_people_of_the_lockbox_are_left_out_unless_they_are_named(mocap: Path) -> None:
    corpus = prepare.main(prepare.PrepareConfig(mocap))
    assert list(corpus.people) == ["005"]
    assert corpus.problems == (f"{PERSON}: in the lockbox; left out",)


def test_a_folder_of_lockbox_people_alone_says_what_to_do(mocap: Path) -> None:
    with pytest.raises(MocapError, match=f"all of this motion is of lockbox people \\({PERSON}\\); name them"):
        prepare.main(prepare.PrepareConfig(mocap / PERSON))


def test_nobody_reads_a_named_person_of_the_lockbox_without_a_log(mocap: Path) -> None:
    with pytest.raises(MocapError, match=f"{PERSON}: in the lockbox; only an evaluation that is logged"):
        prepare.main(prepare.PrepareConfig(mocap, people=(PERSON, "005")))


def test_each_reading_adds_a_row_also_from_the_cache(mocap: Path, tmp_path: Path) -> None:
    log = tmp_path / "log.json"
    log.write_text('[{"date": "2020-01-01"}]')
    config = prepare.PrepareConfig(
        mocap, people=(PERSON, "005"), cache=tmp_path / "cache", lockbox=LockboxAccess("a release", log)
    )
    for _ in range(2):
        assert list(prepare.main(config).people) == [PERSON, "005"]
    earlier, first, second = json.loads(log.read_text())
    assert earlier == {"date": "2020-01-01"}
    assert first == second
    assert (first["people"], first["purpose"]) == ([PERSON], "a release")
    assert date.fromisoformat(first["date"]) and first["gitCommit"]


def test_recordings_for_evaluate_goldens_and_report_leave_the_lockbox_out(mocap: Path, tmp_path: Path) -> None:
    before = lockbox_log.LOG.read_bytes()
    command = [sys.executable, "-m", "threepoint_training.recordings", "--mocap", str(mocap), "--out", str(tmp_path)]
    subprocess.run(command, cwd=Path(recordings.__file__).parents[1], check=True)
    assert [clip["person"] for clip in json.loads((tmp_path / "index.json").read_text())["clips"]] == ["005"]
    assert lockbox_log.LOG.read_bytes() == before


def test_motion_is_read_by_prepare_alone() -> None:
    """Another user of a reader would bypass the log; `golden_mocap` writes skeletons of its own."""
    package = Path(prepare.__file__).parent
    readers = re.compile(r"import .*\b(read_motion)\b")
    users = {file.stem for file in package.glob("*.py") if readers.search(file.read_text())}
    assert users == {"prepare"}
