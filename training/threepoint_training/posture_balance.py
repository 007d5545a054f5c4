"""How often each posture is drawn into a batch, so that what is common does not crowd out what is rare.

A corpus holds what its people were asked to do, mostly walking; a wearer does other things. A posture is how a trunk is held, or how an arm is:
each by itself, for a batch puts them together anew.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class BalanceConfig:
    """A frame of a person counts (frames of that person)^-people · (frames of that posture)^-trunks, its arms likewise by `arms`; and those of
    people who were asked for many things (`splits.VARIED`) `varied` times as much.

    Postures are alike that k-means puts into one of so many clusters.
    """

    people: float = 0.5
    varied: float = 2.0
    trunks: float = 0.0
    arms: float = 0.0
    trunk_clusters: int = 100
    arm_clusters: int = 200
    seed: int = 7


# k-means looks at so many postures, so often: centres move by little afterwards.
_SAMPLE, _ITERATIONS = 20_000, 8


def weights(people: NDArray[np.int64], postures: Array, clusters: int, exponents: tuple[float, float], seed: int) -> Array:
    """How much each frame [F] counts, by its person (a number) and posture [F, D]; exponents: of people and of postures."""
    of_people, of_postures = exponents
    weight = _frequency(people) ** -of_people
    if of_postures > 0:
        weight = weight * _frequency(cluster(postures, clusters, seed)) ** -of_postures
    return weight


def cluster(postures: Array, clusters: int, seed: int) -> NDArray[np.int64]:
    """The cluster [F] of each posture [F, D]: k-means (Lloyd), from postures drawn at random."""
    random = np.random.default_rng(seed)
    some = postures[random.choice(len(postures), min(_SAMPLE, len(postures)), replace=False)]
    centres = some[:clusters]
    for _ in range(_ITERATIONS):
        nearest = _nearest(some, centres)
        counts = np.bincount(nearest, minlength=len(centres))
        sums = np.stack([np.bincount(nearest, column, len(centres)) for column in some.T], axis=1)
        # A centre that no posture is nearest to stays where it is.
        centres = np.where(counts[:, None] > 0, sums / np.maximum(counts, 1)[:, None], centres)
    return _nearest(postures, centres)


def _nearest(postures: Array, centres: Array) -> NDArray[np.int64]:
    half_squares = (centres**2).sum(axis=1) / 2
    blocks = np.array_split(postures, len(postures) // 8192 + 1)
    return np.concatenate([np.argmin(half_squares - block @ centres.T, axis=1) for block in blocks])


def _frequency(labels: NDArray[np.int64]) -> Array:
    """How many frames [F] share each frame's label."""
    return np.bincount(labels)[labels].astype(np.float64)
