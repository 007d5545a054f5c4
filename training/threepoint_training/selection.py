"""The figures by which recipes of the learned network are chosen: errors of people held out in turn, in active frames,
hands not measured.

`npm run tool -- train --mocap DIR --select` calls this for the recipe of the code as it is, and compares it with those of
earlier calls.
"""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import splits, train_learned
from .arrays import Array
from .features import HANDS, HEAD_AXES, HEADSET_HEIGHT
from .prepared_corpus import PreparedCorpus
from .train_learned import HeldOut, TrainLearnedConfig
from .train_paper import predict

# Columns of ESTIMATED_JOINTS that a figure averages.
JOINTS = {"all joints": slice(None), "elbows": slice(0, 2)}
FRAMES = ("all", "active")


@dataclass(frozen=True)
class PersonErrors:
    """Mean errors by joint [6] of IK and of the learned network, for one person over some frames [cm]."""

    frames: int
    of_ik: Array
    ours: Array

    @property
    def ratio(self) -> float:
        """Our error relative to that of IK, all joints."""
        return float(self.ours.mean() / self.of_ik.mean())


# By name, one recipe's people, each held out.
People = Mapping[str, PersonErrors]


def active(inputs: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Which frames [F] are active: a wrist higher than 0.75 arm lengths below the headset, the head under 0.9 of the
    eye height, or tilted by over 30°. Standing and walking with hanging arms is none of these.
    """
    hand_heights = inputs[:, [hand.start + 1 for hand in HANDS]]
    return (
        (hand_heights.max(axis=1) > -0.75)
        | (inputs[:, HEADSET_HEIGHT] < 0.9)
        | (inputs[:, HEAD_AXES.start + 4] < np.cos(np.radians(30.0)))
    )


def errors_by_person(corrections: NDArray[np.float32], people: HeldOut) -> dict[str, dict[str, PersonErrors]]:
    """Errors of a network with these corrections [F, 18] after torso and arm fitting, by FRAMES and by name; a person
    without active frames is missing from those.
    """
    ours, of_ik = train_learned.fitted_errors_cm(corrections, people), train_learned.ik_errors_cm(people)
    chosen = {"all": np.ones(len(ours), bool), "active": active(people.inputs)}
    return {
        frames: {
            str(name): PersonErrors(int(own.sum()), of_ik[own].mean(axis=0), ours[own].mean(axis=0))
            for name in np.unique(people.people)
            if (own := among & (people.people == name)).any()
        }
        for frames, among in chosen.items()
    }


@dataclass(frozen=True)
class SelectionConfig:
    """People are held out in `groups` groups in turn (None: each alone), each with networks of `seeds` seeds."""

    groups: int | None = None
    seeds: int = 3


def main(
    corpus: PreparedCorpus,
    recipe: TrainLearnedConfig,
    config: SelectionConfig = SelectionConfig(),
    report: Callable[[str], None] = lambda _: None,
) -> list[dict[str, People]]:
    """By seed and by FRAMES: errors on each trainable person, of a network trained on everyone outside the person's
    group; IK keeps its constants.
    """
    everyone = splits.trainable(tuple(corpus.people))
    found: list[dict[str, dict[str, PersonErrors]]] = [{frames: {} for frames in FRAMES} for _ in range(config.seeds)]
    for group in splits.groups_in_turn(everyone, config.groups):
        held_out = train_learned.held_out(corpus, group, recipe.window_seconds, hands_measured=False)
        others = tuple(name for name in everyone if name not in group)
        for number, of_seed in enumerate(found):
            report(f"held out: {', '.join(group)}; seed {recipe.seed + number}")
            network = train_learned.train(corpus, others, replace(recipe, seed=recipe.seed + number))
            for frames, people in errors_by_person(predict(network, held_out.inputs), held_out).items():
                of_seed[frames] |= people
    return [dict(of_seed) for of_seed in found]


def save(found: list[dict[str, People]], file: Path) -> None:
    """Writes what `main` found."""
    seeds = [
        {
            frames: {name: [each.frames, each.of_ik.tolist(), each.ours.tolist()] for name, each in people.items()}
            for frames, people in seed.items()
        }
        for seed in found
    ]
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(seeds))


def load(file: Path) -> list[dict[str, People]]:
    """Reads what `save` wrote."""
    return [
        {
            frames: {
                name: PersonErrors(count, np.array(of_ik), np.array(ours))
                for name, (count, of_ik, ours) in people.items()
            }
            for frames, people in seed.items()
        }
        for seed in json.loads(file.read_text())
    ]


def worse_half(*recipes: People) -> tuple[str, ...]:
    """The half of the people whose errors relative to IK are the largest, on average over these recipes."""
    ratio = {name: float(np.mean([recipe[name].ratio for recipe in recipes])) for name in recipes[0]}
    return tuple(sorted(sorted(ratio, key=lambda name: -ratio[name])[: (len(ratio) + 1) // 2]))


def figures(people: People) -> dict[str, float]:
    """Errors relative to IK, each person weighing the same: of all people and of the worse half, of all joints and of
    elbows.
    """
    found = {}
    for group, names in (("all people", tuple(people)), ("worse half", worse_half(people))):
        for joints, columns in JOINTS.items():
            ours, of_ik = (
                np.mean([getattr(people[name], key)[columns].mean() for name in names]) for key in ("ours", "of_ik")
            )
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

    Differences are paired by person and seed; their variance is that between people plus that between seeds, for both
    are samples.
    """
    seeds = len(a)
    # Each person's mean over seeds, for who is in the worse half.
    everyone = tuple(a[0])
    half = worse_half(*a, *b)
    found = {}
    for group, names in (("all people", everyone), ("worse half", half)):
        for joints, columns in JOINTS.items():
            paired = np.array(
                [
                    [one[name].ours[columns].mean() - other[name].ours[columns].mean() for name in names]
                    for one, other in zip(a, b, strict=True)
                ]
            )
            scale = np.mean([one[name].of_ik[columns].mean() for one in a for name in names])
            variance = paired.mean(axis=0).var(ddof=1) / len(names) + (
                paired.mean(axis=1).var(ddof=1) / seeds if seeds > 1 else 0.0
            )
            found[f"{group}, {joints}"] = Difference(float(paired.mean() / scale), float(np.sqrt(variance) / scale))
    return found
