"""What a new wearer may expect: each person held out in turn, proportions, IK and network made of all the others.

`npm run train -- --mocap DIR --leave-one-out` calls this and renews the table of docs/training.md.
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import fitted_kinematics, train_learned
from .accuracy_tables import renew, table
from .fit_ik import FitIkConfig
from .prepared_corpus import PreparedCorpus
from .train_learned import TrainLearnedConfig
from .train_paper import predict

PAGE = Path(__file__).parents[2] / "docs/training.md"

# Of each training, fewer than for the network that is shipped: there are as many trainings as people.
STEPS = 600

COLUMNS = ("IK", "ours", "ours / IK", "elbows, ours / IK", "minutes")


def main(
    corpus: PreparedCorpus, recipe: TrainLearnedConfig, ik: FitIkConfig, report: Callable[[str], None] = lambda _: None
) -> list[list[str]]:
    """Rows of the table, a person each, and their mean, all counted alike; cm over six joints after torso and arm fitting."""
    recipe = replace(recipe, steps=min(recipe.steps, STEPS))
    rows, errors = [], []
    for name in sorted(corpus.people):
        report(name)
        others = tuple(sorted(set(corpus.people) - {name}))
        with fitted_kinematics.used(fitted_kinematics.fit(corpus, others, ik)):
            person = train_learned.held_out(corpus, (name,), recipe.window_seconds)
            network = train_learned.train(corpus, others, recipe)
            of_ik, ours = train_learned.ik_errors_cm(person), train_learned.fitted_errors_cm(predict(network, person.inputs), person)
        rows.append([name, *_cells(of_ik, ours), f"{len(ours) / corpus.rate_hz / 60:.1f}"])
        errors.append((of_ik.mean(axis=0), ours.mean(axis=0)))
    means = (np.mean([each[method] for each in errors], axis=0, keepdims=True) for method in (0, 1))
    return [*rows, ["all alike", *_cells(*means), ""]]


def _cells(of_ik: NDArray[np.float64], ours: NDArray[np.float64]) -> list[str]:
    """Of errors [F, 6]."""
    elbows = ours[:, :2].mean() / of_ik[:, :2].mean()
    return [f"{of_ik.mean():.2f}", f"{ours.mean():.2f}", f"{ours.mean() / of_ik.mean():.2f}", f"{elbows:.2f}"]


def write(rows: list[list[str]], page: Path = PAGE) -> None:
    """Renews the page's table."""
    page.write_text(renew(page.read_text(), {"leave-one-out": table(["cm", *COLUMNS], rows)}))
