"""Facts about how often postures are drawn."""

import numpy as np
from threepoint_training.body_parts import BalanceConfig, BodyParts, clusters_of
from threepoint_training.generated_motion import generate_corpus


def test_clusters_part_postures_that_lie_apart():
    random = np.random.default_rng(1)
    owner = np.repeat(np.arange(3), (600, 60, 20))
    postures = np.array([[0.0, 0.0], [5.0, 0.0], [0.0, 5.0]])[owner] + random.normal(scale=0.1, size=(680, 2))
    found = clusters_of(postures, 12)
    assert all(len(set(owner[found == label])) == 1 for label in set(found))


def test_a_rare_posture_is_drawn_more_often_than_its_share_of_the_frames():
    """A person squats in 10 of 400 frames: each of these counts for more, the more the larger the exponent."""
    corpus = generate_corpus(people=1, clips=1, frames=400, seed=4)
    squatting = np.arange(400) >= 390
    corpus.positions[squatting, :, 1] -= 0.8

    def share(exponent: float) -> float:
        parts = BodyParts(corpus, ("002",), BalanceConfig(people=0.0, postures=exponent, clusters=12))
        return float(squatting[parts.draw_trunks(np.random.default_rng(2), 8000)].mean())

    assert abs(share(0.0) - 0.025) < 0.008
    assert 0.035 < share(0.5) < share(1.0)
