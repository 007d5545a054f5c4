"""Seeded normal numbers that the page draws alike (createNormalRandom in src/threepoint/core/math/random.ts)."""

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

_WORD = np.uint64(0xFFFFFFFF)


class NormalSource(Protocol):
    """A generator of standard normal numbers: NumPy's, or the page's."""

    def normal(self, *, size: int | tuple[int, ...] = ()) -> Any:
        """An array of this shape."""


class NormalNumbers:
    """Uniform numbers of SplitMix32, whose state is one 32-bit number, two for each normal number of Box and Muller."""

    def __init__(self, seed: int) -> None:
        self._state = np.uint64(seed & 0xFFFFFFFF)

    def normal(self, *, size: int | tuple[int, ...] = ()) -> NDArray[np.float64]:
        """An array of this shape; its numbers are drawn in the order in which they lie in memory."""
        uniform = self._uniform(2 * int(np.prod(size))).reshape(*np.atleast_1d(np.array(size, int)), 2)
        return np.sqrt(-2 * np.log(1 - uniform[..., 0])) * np.cos(2 * np.pi * uniform[..., 1])

    def _uniform(self, count: int) -> NDArray[np.float64]:
        """The next numbers [count] in [0, 1)."""
        mixed = (self._state + np.arange(1, count + 1, dtype=np.uint64) * np.uint64(0x9E3779B9)) & _WORD
        self._state = mixed[-1]
        for shift, factor in ((16, 0x21F0AAAD), (15, 0x735A2D97)):
            mixed = ((mixed ^ (mixed >> np.uint64(shift))) * np.uint64(factor)) & _WORD
        return (mixed ^ (mixed >> np.uint64(15))) / 2**32
