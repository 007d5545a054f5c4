"""How rare each frame's posture is, so that walking, which most recordings show, does not crowd out everything else in
a batch.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# k-means runs on this many frames, this many times; the centres hardly move afterwards.
_SAMPLE, _ITERATIONS, _SEED = 20_000, 10, 7


def cluster(postures: Array, clusters: int) -> NDArray[np.int64]:
    """Returns the cluster [F] of each posture [F, D]: k-means (Lloyd) that starts from postures drawn at random."""
    random = np.random.default_rng(_SEED)
    sample = postures[random.choice(len(postures), min(_SAMPLE, len(postures)), replace=False)]
    centres = sample[:clusters]
    for _ in range(_ITERATIONS):
        nearest = _nearest(sample, centres)
        counts = np.bincount(nearest, minlength=len(centres))[:, None]
        sums = np.stack([np.bincount(nearest, column, len(centres)) for column in sample.T], axis=1)
        # A centre that is nearest to no posture keeps its place.
        centres = np.where(counts > 0, sums / np.maximum(counts, 1), centres)
    return _nearest(postures, centres)


def _nearest(postures: Array, centres: Array) -> NDArray[np.int64]:
    half_squares = (centres**2).sum(axis=1) / 2
    blocks = np.array_split(postures, len(postures) // 8192 + 1)
    return np.concatenate([np.argmin(half_squares - block @ centres.T, axis=1) for block in blocks])


def frequency(labels: NDArray[np.int64]) -> Array:
    """Returns how many frames [F] share each frame's label [F]."""
    return np.bincount(labels)[labels].astype(np.float64)
