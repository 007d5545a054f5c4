"""Facts about what minutes of wearing tell of a calibration that is wrong."""

import json
import shutil

import numpy as np
import pytest
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.motion import MocapError
from threepoint_training.noticed_wear import ROOT, Fault, NoticedWearConfig, Reader, main, signs
from threepoint_training.simulate_trackers import TrackerConfig, draw_wearer, simulate
from threepoint_training.skeleton import body_from_calibration

pytestmark = pytest.mark.training

CORPUS = generate_corpus(people=1, clips=1, frames=1200, seed=5)
PERSON = next(iter(CORPUS.people.values()))


def signs_of(fault):
    wearer = fault.worn(draw_wearer(TrackerConfig(), np.random.default_rng(1)))
    tracked = simulate(CORPUS.positions, CORPUS.rotations, wearer, TrackerConfig(), np.random.default_rng(2))
    body = body_from_calibration(np.array(PERSON.eye_height * (1 + fault.eye_height)), np.array(PERSON.arm_span))
    return signs(*tracked, body, NoticedWearConfig())


def test_a_headset_that_sits_higher_is_higher_and_further_from_hands_that_hang():
    right, higher = signs_of(Fault()), signs_of(Fault(up=0.03))
    assert higher[0] - right[0] == pytest.approx(0.03 / PERSON.eye_height, abs=0.005)
    assert higher[1] > right[1]


def test_a_body_taken_for_too_small_stands_too_high():
    assert signs_of(Fault(eye_height=-0.05))[0] == pytest.approx(signs_of(Fault())[0] / 0.95, abs=0.005)


def test_faults_that_signs_follow_from_are_read_and_what_was_not_seen_says_nothing():
    random = np.random.default_rng(3)
    faults = random.normal(size=(400, 3)) * [0.03, 0.03, 0.05]
    seen = 1 + faults @ random.normal(size=(3, 3))
    reader = Reader(seen, faults, ridge=1e-3)
    read = reader(seen[7])
    np.testing.assert_allclose([read.up, read.back, read.eye_height], faults[7], atol=1e-4)
    nothing = reader(np.full(3, np.nan))
    np.testing.assert_allclose([nothing.up, nothing.back, nothing.eye_height], faults.mean(axis=0), atol=1e-9)


def test_without_a_network_of_people_held_out_a_sentence_says_how_one_is_made(tmp_path):
    with pytest.raises(MocapError, match="learned.json: there is no network of people held out; npm run train"):
        main(CORPUS, NoticedWearConfig(models=tmp_path))


def test_a_network_that_has_seen_everybody_judges_nobody(tmp_path):
    contract = json.loads((ROOT / "public/models/learned.json").read_text())
    shutil.copy(ROOT / "public/models" / contract["file"], tmp_path)
    contract["trainedOn"]["people"] = list(CORPUS.people)
    (tmp_path / "learned.json").write_text(json.dumps(contract))
    with pytest.raises(MocapError, match="has seen everybody"):
        main(CORPUS, NoticedWearConfig(models=tmp_path, fewest_minutes=0.1))
