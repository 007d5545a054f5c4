"""Facts about the evaluation of the lockbox, on generated motion and with a log of its own."""

import json
from dataclasses import replace
from datetime import date

import numpy as np
import pytest
import torch
from rich.console import Console
from threepoint_training import export, lockbox, pipeline, selection, train_learned
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.lockbox import LockboxConfig
from threepoint_training.model import CorrectionNetwork
from threepoint_training.motion_files import MocapError
from threepoint_training.synthetic_skeletons import angles_of, write_asf_amc
from threepoint_training.training_config import TrainConfig

pytestmark = pytest.mark.training

# 002 to 009; 009 is in the lockbox.
CORPUS = generate_corpus(people=8, clips=1, frames=60, seed=8)
WINDOW = (0.0, 0.1)


@pytest.fixture(scope="module")
def models(tmp_path_factory):
    """The folder of a network with random weights, which knows 002 alone."""
    torch.manual_seed(1)
    known = train_learned.held_out(CORPUS, ("002",), WINDOW)
    network = CorrectionNetwork(len(WINDOW), 8, 0.0).eval()
    network.normalise(torch.from_numpy(known.inputs), torch.from_numpy(known.targets))
    folder = tmp_path_factory.mktemp("models")
    provenance = export.Provenance("generated motion", CORPUS.corpus_hash, ("002",), 1, {})
    export.main(export.ExportConfig("learned", "1", folder, WINDOW, provenance), network, known.inputs)
    return folder


def test_each_evaluation_appends_the_errors_of_lockbox_people_alone(models, tmp_path):
    log = tmp_path / "log.json"
    first = lockbox.main(CORPUS, LockboxConfig(models, log))
    lockbox.main(CORPUS, LockboxConfig(models, log))
    rows = json.loads(log.read_text())
    assert rows == [first, first]
    assert date.fromisoformat(first["date"]) and first["gitCommit"]
    assert first["weightsSha256"] == json.loads((models / "learned.json").read_text())["sha256"]
    assert list(first["cm"]) == ["009"]
    held_out = train_learned.held_out(CORPUS, ("009",), WINDOW, hands_measured=False)
    of_ik = train_learned.ik_errors_cm(held_out)
    errors = first["cm"]["009"]
    assert errors["IK"] == {
        "all joints": pytest.approx(of_ik.mean(), abs=0.006),
        "elbows": pytest.approx(of_ik[:, :2].mean(), abs=0.006),
    }
    assert errors["learned"] != errors["IK"]
    for joints in selection.JOINTS:
        ratio = errors["learned"][joints] / errors["IK"][joints]
        assert first["ratios"]["all"][f"all people, {joints}"] == pytest.approx(ratio, abs=0.003)
    assert set(first["ratios"]) == set(selection.FRAMES)


def test_a_network_that_knows_someone_of_the_lockbox_is_refused(models, tmp_path):
    contract = json.loads((models / "learned.json").read_text())
    contract["trainedOn"]["people"] = ["002", "135"]
    (tmp_path / "learned.json").write_text(json.dumps(contract))
    with pytest.raises(MocapError, match="trained on 135, who are in the lockbox"):
        lockbox.main(CORPUS, LockboxConfig(tmp_path, tmp_path / "log.json"))
    assert not (tmp_path / "log.json").exists()


def test_the_command_needs_recordings_of_the_lockbox(models, tmp_path):
    """Generated motion of the pipeline has 002 to 007."""
    config = replace(TrainConfig(mocap=None), task="lockbox", out=models, lockbox_log=tmp_path / "log.json")
    with pytest.raises(MocapError, match="No person of the lockbox"):
        pipeline.main(config, Console(quiet=True))
    assert not (tmp_path / "log.json").exists()


def test_the_command_evaluates_the_networks_in_out(models, tmp_path):
    person = tmp_path / "mocap/009"
    person.mkdir(parents=True)
    write_asf_amc(person, angles_of(3, 76))
    for file in list(person.iterdir()):
        file.rename(person / file.name.replace("p", "009", 1))
    log = tmp_path / "log.json"
    config = replace(
        TrainConfig(mocap=tmp_path / "mocap"), task="lockbox", out=models, lockbox_log=log, cache=tmp_path / "cache"
    )
    assert pipeline.main(config, Console(quiet=True)) == {}
    opened, row = json.loads(log.read_text())
    assert (opened["people"], opened["purpose"]) == (["009"], "npm run tool -- train --lockbox")
    assert list(row["cm"]) == ["009"]
    assert np.isfinite(list(row["ratios"]["all"].values())).all()
