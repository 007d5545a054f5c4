"""The figures by which recipes of the learned network are chosen: errors of people held out in turn, in active frames, hands not measured."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import postures, train_learned
from .model import CorrectionNetwork
from .train_learned import Condition, HeldOut
from .train_paper import predict

Array = NDArray[np.float64]

# The condition under which recipes are compared: how a user meets the page, who has calibrated no hand.
CONDITION = Condition(hands_measured=False)
# Columns of ESTIMATED_JOINTS that a figure averages.
JOINTS = {"all joints": slice(None), "elbows": slice(0, 2)}
FRAMES = ("all", "active")


@dataclass(frozen=True)
class PersonErrors:
    """Mean errors of one person in cm by joint [6], of IK and of ours, over some frames."""

    frames: int
    of_ik: Array
    ours: Array

    @property
    def ratio(self) -> float:
        """Our error relative to that of IK, all joints."""
        return float(self.ours.mean() / self.of_ik.mean())


# By name, one recipe's people, each held out.
People = Mapping[str, PersonErrors]


def errors_by_person(network: CorrectionNetwork, people: HeldOut) -> dict[str, dict[str, PersonErrors]]:
    """Errors of held-out people after torso and arm fitting, by FRAMES and by name; a person without active frames is missing from those."""
    ours, of_ik = train_learned.fitted_errors_cm(predict(network, people.inputs), people), train_learned.ik_errors_cm(people)
    chosen = {"all": np.ones(len(ours), bool), "active": postures.active(people.inputs)}
    return {
        frames: {
            str(name): PersonErrors(int(own.sum()), of_ik[own].mean(axis=0), ours[own].mean(axis=0))
            for name in np.unique(people.people)
            if (own := among & (people.people == name)).any()
        }
        for frames, among in chosen.items()
    }


def worse_half(*recipes: People) -> tuple[str, ...]:
    """The half of the people whose errors relative to IK are the largest, on average over these recipes."""
    ratio = {name: float(np.mean([recipe[name].ratio for recipe in recipes])) for name in recipes[0]}
    return tuple(sorted(sorted(ratio, key=lambda name: -ratio[name])[: (len(ratio) + 1) // 2]))


def figures(people: People) -> dict[str, float]:
    """Errors relative to IK, each person weighing the same: of all people and of the worse half, of all joints and of elbows."""
    found = {}
    for group, names in (("all people", tuple(people)), ("worse half", worse_half(people))):
        for joints, columns in JOINTS.items():
            ours, of_ik = (np.mean([getattr(people[name], key)[columns].mean() for name in names]) for key in ("ours", "of_ik"))
            found[f"{group}, {joints}"] = float(ours / of_ik)
    return found


@dataclass(frozen=True)
class Difference:
    """The error of one recipe minus that of another, relative to IK's error, and its standard error."""

    mean: float
    standard_error: float

    @property
    def is_tie(self) -> bool:
        """Whether the difference is below two standard errors."""
        return abs(self.mean) < 2 * self.standard_error


def compare(a: list[People], b: list[People]) -> dict[str, Difference]:
    """Differences a − b of two recipes over the same seeds and people, by the names that `figures` gives them.

    Differences are paired by person and seed; their variance is that between people plus that between seeds, for both are samples.
    """
    seeds = len(a)
    # Each person's mean over seeds, for who is in the worse half.
    everyone = tuple(a[0])
    half = worse_half(*a, *b)
    found = {}
    for group, names in (("all people", everyone), ("worse half", half)):
        for joints, columns in JOINTS.items():
            paired = np.array(
                [[one[name].ours[columns].mean() - other[name].ours[columns].mean() for name in names] for one, other in zip(a, b, strict=True)]
            )
            scale = np.mean([one[name].of_ik[columns].mean() for one in a for name in names])
            variance = paired.mean(axis=0).var(ddof=1) / len(names) + (paired.mean(axis=1).var(ddof=1) / seeds if seeds > 1 else 0.0)
            found[f"{group}, {joints}"] = Difference(float(paired.mean() / scale), float(np.sqrt(variance) / scale))
    return found
