"""The array that most functions take and return; its shape stands in brackets, as [F, 3] for F frames."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
