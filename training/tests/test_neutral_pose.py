"""Facts about what a neutral pose is taken to tell."""

import numpy as np
import pytest
from threepoint_training import neutral_pose, train_learned
from threepoint_training.features import ARM_LENGTH, HANDS
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.neutral_pose import NeutralPoseConfig

pytestmark = pytest.mark.training

CORPUS = generate_corpus(people=2, clips=1, frames=60, seed=5)


def one_person() -> train_learned.HeldOut:
    return train_learned.held_out(CORPUS, tuple(CORPUS.people)[:1], (0.0,))


def test_the_bias_is_what_both_sides_share():
    person = one_person()
    shift = np.zeros((6, 3), np.float32)
    shift[0], shift[1] = (-0.03, 0.02, 0.01), (0.03, 0.02, 0.01)
    shift[5] = (0.0, 0.0, 0.05)
    person.targets[:] = shift.reshape(18)
    np.testing.assert_allclose(neutral_pose.bias(person), shift, atol=1e-6)
    # Leaning to one side is no habit as long as it is not known to which.
    person.targets[:, 15] += 0.04
    np.testing.assert_allclose(neutral_pose.bias(person), shift, atol=1e-6)


def test_hands_that_hang_further_back_are_measured_so():
    person = one_person()
    frames = np.ones(len(person.inputs), bool)
    before = neutral_pose.measure(person, frames)
    for hand in HANDS:
        person.inputs[:, hand.start + 2] += 0.1
    after = neutral_pose.measure(person, frames)
    np.testing.assert_allclose(after - before, [0, 0, 0.1 * person.inputs[0, ARM_LENGTH]], atol=1e-6)


def test_a_person_like_the_others_is_predicted_like_them():
    random = np.random.default_rng(1)
    measures = random.normal(size=(40, 3))
    biases = (measures @ np.array([0.0, 0.0, 0.02]))[:, None, None] * np.ones((6, 3))
    weak = NeutralPoseConfig(ridge=1e-6)
    np.testing.assert_allclose(neutral_pose.predict(measures, biases, measures[3], weak), biases[3] - biases.mean(axis=0), atol=1e-6)
    assert np.abs(neutral_pose.predict(measures, biases, measures.mean(axis=0), weak)).max() < 1e-9


def test_few_people_are_believed_less_and_strangers_not_without_bound():
    measures, biases = np.array([[0.0, 0, 0], [0, 0, 1], [0, 0, 2]]), np.arange(3.0)[:, None, None] * np.ones((6, 3))
    firm, weak = (np.abs(neutral_pose.predict(measures, biases, measures[2], NeutralPoseConfig(ridge=r))).max() for r in (8.0, 0.1))
    assert firm < weak
    config = NeutralPoseConfig()
    near, far = (neutral_pose.predict(measures, biases, np.array([0, 0, z]), config) for z in (10.0, 1000.0))
    np.testing.assert_allclose(near, far)


def test_too_few_people_in_a_neutral_pose_is_an_error():
    with pytest.raises(ValueError, match="neutral poses of three people"):
        neutral_pose.main(CORPUS, train_learned.TrainLearnedConfig(), {})
