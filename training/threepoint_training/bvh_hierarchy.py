"""The skeleton of a BVH file."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass
class BvhHierarchy:
    """Joints in the file's order, parents before children (−1: none); offsets in the file's units, channels by joint.
    """

    names: list[str] = field(default_factory=list)
    parents: list[int] = field(default_factory=list)
    offsets: list[NDArray[np.float64]] = field(default_factory=list)
    channels: list[tuple[str, ...]] = field(default_factory=list)

    def open(self, name: str, parent: int) -> int:
        """The number of a joint that begins here."""
        self.names.append(name)
        self.parents.append(parent)
        self.offsets.append(np.zeros(3))
        self.channels.append(())
        return len(self.names) - 1

    def offset(self, name: str) -> NDArray[np.float64]:
        """A joint's offset from its parent; an unknown name raises ValueError."""
        return self.offsets[self.names.index(name)]

    def place(self, name: str, offset: NDArray[np.float64]) -> None:
        """Moves a joint, and what hangs from it, to this offset from its parent."""
        self.offsets[self.names.index(name)] = offset

    def rest_positions(self) -> NDArray[np.float64]:
        """Returns the joint positions relative to the root with all angles zero [joints, 3]."""
        rest = np.zeros((len(self.names), 3))
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                rest[joint] = rest[parent] + self.offsets[joint]
        return rest
