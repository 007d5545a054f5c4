"""Facts about the learned network that hold with any weights."""

import numpy as np
import pytest
import torch
from threepoint_training.chest_features import CHEST_FEATURES, chest_features
from threepoint_training.features import FEATURES, HANDS, HEAD_AXES, IK_JOINTS, SEEN
from threepoint_training.generated_motion import generate_corpus
from threepoint_training.model import ByteDropout, CorrectionNetwork
from threepoint_training.train_learned import held_out

pytestmark = pytest.mark.training

WINDOW = (0.0, 0.1, 0.25)
CORPUS = generate_corpus(people=2, clips=1, frames=200, seed=4)
PEOPLE = held_out(CORPUS, tuple(CORPUS.people), WINDOW)
SWAPPED = [1, 0, 3, 2, 4, 5]
MIRROR = np.array([-1.0, 1.0, 1.0], np.float32)


@pytest.fixture
def network() -> CorrectionNetwork:
    """Returns an untrained network: random weights with the mean and scale of the data."""
    torch.manual_seed(1)
    network = CorrectionNetwork(len(WINDOW), width=32, dropout=0.0)
    network.normalise(torch.from_numpy(PEOPLE.inputs), torch.from_numpy(PEOPLE.targets))
    return network.eval()


def corrections(network: CorrectionNetwork, inputs: np.ndarray) -> np.ndarray:
    with torch.no_grad():
        return network(torch.from_numpy(inputs)).numpy().reshape(-1, 6, 3)


def with_chest_features(windows: np.ndarray) -> np.ndarray:
    return np.concatenate([windows, chest_features(windows[:, :FEATURES])], axis=1).astype(np.float32)


def mirrored(inputs: np.ndarray) -> np.ndarray:
    """Features of the body a mirror shows, made from what features mean and not from what the network knows of them."""
    taps = inputs[:, :-CHEST_FEATURES].reshape(len(inputs), -1, FEATURES)
    result = taps.copy()

    def turned(columns: np.ndarray) -> np.ndarray:
        x, y = columns[..., :3], columns[..., 3:]
        matrix = np.stack([x, y, np.cross(x, y)], axis=-1)
        flip = np.diag(MIRROR)
        image = flip @ matrix @ flip
        return np.concatenate([image[..., :, 0], image[..., :, 1]], axis=-1)

    result[..., HEAD_AXES] = turned(taps[..., HEAD_AXES])
    for own, other in (HANDS, HANDS[::-1]):
        position, axes = np.split(taps[..., other], [3], axis=-1)
        result[..., own] = np.concatenate([position * MIRROR, turned(axes)], axis=-1)
    result[..., SEEN] = taps[..., SEEN][..., ::-1]
    ik = taps[..., IK_JOINTS].reshape(*taps.shape[:2], 6, 3)
    result[..., IK_JOINTS] = (ik[..., SWAPPED, :] * MIRROR).reshape(*taps.shape[:2], 18)
    return with_chest_features(result.reshape(len(inputs), -1))


def test_a_mirror_image_is_corrected_to_the_mirror_image(network):
    seen = corrections(network, PEOPLE.inputs)
    image = corrections(network, mirrored(PEOPLE.inputs))
    np.testing.assert_allclose(image, seen[:, SWAPPED] * MIRROR, atol=1e-5)
    assert np.abs(seen - seen[:, SWAPPED] * MIRROR).max() > 0.005


def test_an_elbow_knows_nothing_of_the_other_hand(network):
    """The trunk may: that is why the elbow is looked at from its shoulder, with a trunk that keeps quiet."""
    with torch.no_grad():
        for layer in (network.trunk_output_mean, network.trunk_output_scale):
            layer.zero_()
    windows = PEOPLE.inputs[:, :-CHEST_FEATURES].copy()
    before = corrections(network, PEOPLE.inputs)
    windows[:, HANDS[1]] = np.roll(windows[:, HANDS[1]], 50, axis=0)
    after = corrections(network, with_chest_features(windows))
    np.testing.assert_allclose(after[:, 0], before[:, 0], atol=1e-6)
    assert np.abs(after[:, 1] - before[:, 1]).max() > 1e-3


def test_nothing_at_all_gives_numbers_all_the_same(network):
    assert np.isfinite(corrections(network, np.zeros((1, network.inputs), np.float32))).all()


def test_dropout_leaves_out_its_share_keeps_the_mean_and_follows_the_seed():
    def dropped(seed: int) -> torch.Tensor:
        torch.manual_seed(seed)
        return ByteDropout(0.2)(torch.ones(400, 500))

    once = dropped(1)
    assert (once == 0).float().mean().item() == pytest.approx(0.2, abs=0.005)
    assert once.mean().item() == pytest.approx(1.0, abs=0.01)
    assert torch.equal(once, dropped(1))
    assert not torch.equal(once, dropped(2))
    assert torch.equal(ByteDropout(0.2).eval()(once), once)
