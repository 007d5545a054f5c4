"""Facts about the motion that golden vectors and the smoke test are made of."""

import numpy as np
from threepoint_training.generated_motion import generate_clip, generate_corpus
from threepoint_training.prepared_corpus import JOINTS, Person, PreparedCorpus

PERSON = Person("test", 1.6, 1.55)
BONES = (
    ("hips", "spine"), ("chest", "neck"), ("neck", "head"),
    *(
        (f"{side}{a}", f"{side}{b}")
        for side in ("left", "right")
        for a, b in (("UpperArm", "LowerArm"), ("LowerArm", "Hand"))
    ),
)  # fmt: skip


def test_bones_keep_their_length():
    joints, _ = generate_clip(np.random.default_rng(1), 300, PERSON)
    for a, b in BONES:
        length = np.linalg.norm(joints[:, JOINTS.index(a)] - joints[:, JOINTS.index(b)], axis=-1)
        assert np.ptp(length) < 1e-9
        assert length[0] > 0.05


def test_the_same_seed_makes_the_same_people():
    first, second, other = (generate_corpus(2, 2, 60, seed) for seed in (3, 3, 4))
    np.testing.assert_array_equal(first.positions, second.positions)
    np.testing.assert_array_equal(first.rotations, second.rotations)
    assert np.abs(first.positions - other.positions).max() > 0.1


def test_a_generated_person_moves_smoothly_and_stays_above_the_floor():
    joints, rotations = generate_clip(np.random.default_rng(2), 600, PERSON)
    assert joints[..., 1].min() > 0.1
    assert joints[:, JOINTS.index("head"), 1].max() < 1.8
    speed = np.linalg.norm(np.diff(joints, axis=0), axis=-1) * 60
    assert 0.5 < speed.max() < 8
    np.testing.assert_allclose(np.linalg.norm(rotations, axis=-1), 1, atol=1e-9)


def test_a_corpus_survives_its_file(tmp_path):
    corpus = generate_corpus(2, 3, 50, 1)
    corpus.save(tmp_path / "corpus.npz")
    read = PreparedCorpus.load(tmp_path / "corpus.npz")
    np.testing.assert_array_equal(read.positions, corpus.positions)
    assert read.people == corpus.people
    assert read.clips == corpus.clips
    assert read.clips_of({"003"}) == [3, 4, 5]
    assert read.clip_slice(4) == slice(200, 250)
