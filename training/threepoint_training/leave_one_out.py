"""Leave-one-out: errors on each person (or group of people) held out in turn, with proportions, IK and network trained on everyone else.

`npm run train -- --mocap DIR --leave-one-out` calls this and renews two tables of docs/training.md.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import fitted_kinematics, splits, train_learned
from .accuracy_tables import renew, table
from .fit_ik import FitIkConfig
from .model import CorrectionNetwork
from .prepared_corpus import PreparedCorpus
from .train_learned import Condition, HeldOut, TrainLearnedConfig
from .train_paper import predict
from .training_page import PAGE

COLUMNS = ("IK", "ours", "ours / IK", "elbows, ours / IK", "minutes")
# Frames of each person that IK is fitted on, at most: it is fitted anew for each person held out, and with more frames that takes hours.
IK_FRAMES = 400
HAND_COLUMNS = ("IK", "ours", "ours / IK", "elbows: IK", "ours", "ours / IK")
# What marks errors of people who were held out in turn, among those that a contract states.
IN_TURN = "in turn"
MEASURED, NOT_MEASURED = "measured by the other clips, error 5° (as above)", "nothing measured"
# What is known of the hands, by the guided calibration and by what the page notices: rows of a table.
HANDS = {
    MEASURED: Condition(),
    "and the forearm typed, error 1 cm": Condition(forearm_typed=True),
    NOT_MEASURED: Condition(hands_measured=False),
    "nothing measured, the forearm typed": Condition(hands_measured=False, forearm_typed=True),
    "measured with wrists bent by 20°": Condition(bent_wrists=np.radians(20.0)),
    "by 30°": Condition(bent_wrists=np.radians(30.0)),
    "measured, nothing noticed": Condition(hands_noticed=False),
    "nothing measured, nothing noticed": Condition(hands_measured=False, hands_noticed=False),
    "wrists bent by 20°, nothing noticed": Condition(bent_wrists=np.radians(20.0), hands_noticed=False),
    "by 30°, nothing noticed": Condition(bent_wrists=np.radians(30.0), hands_noticed=False),
}
# Every how many-th frame counts for that table.
HAND_STRIDE = 3


@dataclass(frozen=True)
class HeldOutPerson:
    """A person held out: errors [F, 6] in cm of IK and ours."""

    of_ik: NDArray[np.float64]
    ours: NDArray[np.float64]
    # By rows of HANDS: mean errors [2, 6] in cm of IK and ours.
    hands: dict[str, NDArray[np.float64]] = field(default_factory=dict)


@dataclass(frozen=True)
class Tables:
    """Rows by person and by what is known of the hands; and the errors that the page's contract states."""

    people: list[list[str]]
    hands: list[list[str]]
    # By the name that the contract gives them: mean errors [P, 6] in cm of each person by joint.
    errors: dict[str, NDArray[np.float64]]


def main(
    corpus: PreparedCorpus,
    recipe: TrainLearnedConfig,
    ik: FitIkConfig,
    report: Callable[[str], None] = lambda _: None,
    groups: int | None = None,
) -> Tables:
    """Rows of the tables: errors in cm over the six joints after torso and arm fitting. groups: hold people out in this many groups; None: one by one.

    Evaluation-only subjects (never trained on) have rows of their own, with proportions, IK and network trained on everyone else.
    """
    ik = replace(ik, frames_per_person=min(ik.frames_per_person, IK_FRAMES))
    trainable = splits.trainable(tuple(corpus.people))
    turns = [*splits.groups_in_turn(trainable, groups), *([measured] if (measured := splits.evaluation_only(tuple(corpus.people))) else [])]
    found: dict[str, HeldOutPerson] = {}
    for group in turns:
        report(", ".join(group))
        found |= hold_out(corpus, group, tuple(name for name in trainable if name not in group), recipe, ik)
    return tables(corpus, found)


def hold_out(
    corpus: PreparedCorpus, people: tuple[str, ...], others: tuple[str, ...], recipe: TrainLearnedConfig, ik: FitIkConfig
) -> dict[str, HeldOutPerson]:
    """Errors on each of these people, with proportions, IK and network trained on `others`."""
    with fitted_kinematics.used(fitted_kinematics.fit(corpus, others, ik)):
        network = train_learned.train(corpus, others, recipe)
        return {name: judge(corpus, name, network, recipe.window_seconds) for name in people}


def judge(corpus: PreparedCorpus, name: str, network: CorrectionNetwork, window_seconds: tuple[float, ...]) -> HeldOutPerson:
    """Errors on one person, with the kinematics in use and this network."""
    person = train_learned.held_out(corpus, (name,), window_seconds)
    ours = train_learned.fitted_errors_cm(predict(network, person.inputs), person)
    by_hands = {}
    for told, condition in HANDS.items():
        seen = train_learned.held_out(corpus, (name,), window_seconds, condition=condition)
        by_hands[told] = _mean_errors(seen.subset(np.arange(0, len(seen.inputs), HAND_STRIDE)), network)
    return HeldOutPerson(train_learned.ik_errors_cm(person), ours, by_hands)


def _mean_errors(person: HeldOut, network: CorrectionNetwork) -> NDArray[np.float64]:
    """Mean errors [2, 6] in cm of IK and of ours."""
    ours = train_learned.fitted_errors_cm(predict(network, person.inputs), person)
    return np.stack([train_learned.ik_errors_cm(person).mean(axis=0), ours.mean(axis=0)])


def tables(corpus: PreparedCorpus, found: dict[str, HeldOutPerson]) -> Tables:
    """Rows of the tables: trainable subjects and their mean, each person weighing the same, then evaluation-only subjects and theirs."""
    rows: list[list[str]] = []
    trainable = splits.trainable(tuple(found))
    for names, mean in ((trainable, "all alike"), (splits.evaluation_only(tuple(found)), "another laboratory, all alike")):
        if names:
            rows += [[name, *_cells(found[name].of_ik, found[name].ours), f"{corpus.minutes_of({name}):.1f}"] for name in names]
            means = (np.stack([getattr(found[name], method).mean(axis=0) for name in names]) for method in ("of_ik", "ours"))
            rows.append([mean, *_cells(*means), ""])
    judged, elsewhere = ([found[name] for name in names] for names in (trainable, splits.evaluation_only(tuple(found))))
    by_hands = [*_hand_rows(judged), *([f"another laboratory: {name}", *cells] for name, *cells in _hand_rows(elsewhere))]
    return Tables(rows, by_hands, _errors(judged))


def _errors(people: list[HeldOutPerson]) -> dict[str, NDArray[np.float64]]:
    """Mean errors [P, 6] in cm of IK and of ours, with hands measured and not, by the names that contracts give them."""
    who = f"{len(people)} people {IN_TURN}"
    return {
        f"{method}, {who}, {told}": np.stack([person.hands[condition][place] for person in people])
        for told, condition in (("hands measured", MEASURED), ("hands not measured", NOT_MEASURED))
        for place, method in enumerate(("IK", "learned"))
        if all(condition in person.hands for person in people)
    }


def _hand_rows(people: list[HeldOutPerson]) -> list[list[str]]:
    """A row for each of HANDS, each person weighing the same; without people none."""
    rows = []
    for told in people[0].hands if people else ():
        of_ik, ours = np.mean([person.hands[told] for person in people], axis=0)
        cells = [f"{value:.2f}" for joints in (slice(None), slice(0, 2)) for value in (of_ik[joints].mean(), ours[joints].mean())]
        ratios = [f"{ours[joints].mean() / of_ik[joints].mean():.3f}" for joints in (slice(None), slice(0, 2))]
        rows.append([told, *cells[:2], ratios[0], *cells[2:], ratios[1]])
    return rows


def _cells(of_ik: NDArray[np.float64], ours: NDArray[np.float64]) -> list[str]:
    """Cells for errors [F, 6] in cm: means of IK and ours, their ratio, and the elbows' ratio."""
    elbows = ours[:, :2].mean() / of_ik[:, :2].mean()
    return [f"{of_ik.mean():.2f}", f"{ours.mean():.2f}", f"{ours.mean() / of_ik.mean():.2f}", f"{elbows:.2f}"]


def write(rows: Tables, page: Path = PAGE) -> None:
    """Renews the page's tables."""
    columns = {"leave-one-out": COLUMNS, "hands": HAND_COLUMNS}
    cells = {"leave-one-out": rows.people, "hands": rows.hands}
    page.write_text(renew(page.read_text(), {name: table(["cm", *columns[name]], cells[name]) for name in columns}))
