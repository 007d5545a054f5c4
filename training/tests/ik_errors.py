"""How far inverse kinematics is from the truth."""

import numpy as np
from threepoint_training import solve_ik


def errors_cm(frames, parameters):
    """Distances [F, 6] of the estimated joints of a `fit_ik.Sample` in centimetres."""
    return (
        np.linalg.norm(
            solve_ik.solve(frames.positions, frames.rotations, frames.body, parameters) - frames.truth, axis=-1
        )
        * 100
    )
