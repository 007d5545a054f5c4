"""What every parser of motion capture returns: a skeleton's joints over time, in the file's own units and axes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


class MocapError(ValueError):
    """A sentence that says what is wrong and in which file and line."""


@dataclass(frozen=True)
class Motion:
    """
    positions [frames, joints, 3] and global rotations [frames, joints, 4] (xyzw; identity is the rest pose). notes:
    what was put right, a sentence each.
    """

    names: tuple[str, ...]
    rest_positions: NDArray[np.float64]
    positions: NDArray[np.float64]
    rotations: NDArray[np.float64]
    frame_rate: float | None
    notes: tuple[str, ...] = ()

    def index(self, name: str) -> int:
        """The index of a joint; an unknown name raises KeyError."""
        try:
            return self.names.index(name)
        except ValueError:
            raise KeyError(name) from None
