"""Ablation: the recipe trained without each of its parts, evaluated on held-out people, as calibrated and under disturbances.

`npm run train -- --mocap DIR --ablate` calls this and renews the table of docs/training.md. 005 and 135 are neither trained nor tested on.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from . import splits, train_learned
from .accuracy_tables import renew, table
from .model import CorrectionNetwork
from .prepared_corpus import PreparedCorpus
from .simulate_trackers import TrackerConfig
from .train_learned import Condition, TrainLearnedConfig
from .train_paper import predict
from .training_page import PAGE

# Two groups of training people, held out in turn.
FOLDS = (("014", "127", "002"), ("003", "009", "016"))

CLEAN = Condition()
CONDITIONS: dict[str, Condition] = {
    "as calibrated": CLEAN,
    "trackers 3 cm off": Condition(offset=0.03),
    "eye height +5 %": Condition(eye_height=1.05),
    "a hand lost": Condition(lost_hand=True),
    "33 ms late": Condition(late=2),
    "seated": Condition(seated=0.28),
    "headset tilted 8°": Condition(tilt=np.radians(8.0)),
}


@dataclass(frozen=True)
class AblationConfig:
    """steps: of each training, fewer than for the page's network, for the variants are compared with each other alone."""

    steps: int = 600
    seed: int = 2460
    folds: tuple[tuple[str, ...], ...] = FOLDS


def variants(config: TrainLearnedConfig) -> dict[str, TrainLearnedConfig]:
    """The recipe, and the recipe without each of its parts, by the labels of the table's rows."""
    augment, trackers = config.augment, config.augment.trackers

    def without(**changes: object) -> TrainLearnedConfig:
        return replace(config, augment=replace(augment, **changes))

    def exact(**changes: float) -> TrainLearnedConfig:
        return without(trackers=replace(trackers, **changes))

    tilted = TrackerConfig(**{**trackers.__dict__, "headset_pitch": np.radians(8.0)})
    return {
        "the recipe": config,
        "without recombined bodies": without(recombined=0.0),
        "without arms of other lengths": without(arm_scale=0.0),
        "without tracker offsets": exact(headset_offset=0.0, wrist_offset=0.0, headset_pitch=0.0, hand_turn=0.0),
        "without noise": exact(position_noise=0.0, rotation_noise=0.0),
        "without errors of the calibration": without(eye_height_error=0.0, arm_span_error=0.0),
        "hands that stand as they were noticed": without(mistaken_hands=0.0),
        "without lost hands": without(lost_hand=0.0),
        "lost hands held for a moment only": without(lost_frames=12),
        "lost hands not seen again": without(returned=0.0),
        "without late trackers": without(late=0.0),
        "without seated people": without(seated=0.0),
        "headsets tilted by 8°, gaze not calibrated": without(trackers=tilted),
        "no shrinkage": replace(config, shrinkage=1.0, arm_shrinkage=1.0),
        "no per-subject random effects": replace(config, effects_learning_rate=0.0),
        "every joint alike in the loss": replace(config, elbow_share=1 / 3),
        "no regret in the loss": replace(config, regret_weight=0.0),
        "loss on raw joints alone": replace(config, fitted_loss_weight=0.0, auxiliary_loss_weight=1.0, regret_weight=0.0),
        "only the newest frame": without(window_frames=(0,)),
    }


def main(
    corpus: PreparedCorpus,
    recipe: TrainLearnedConfig,
    config: AblationConfig = AblationConfig(),
    report: Callable[[str], None] = lambda _: None,
    trained: Callable[[tuple[str, ...], CorrectionNetwork], None] = lambda *_: None,
) -> list[list[str]]:
    """Rows of the table: MPJPE [cm] of each variant under each condition, mean over the folds; first IK.

    report(text) is called before each training; trained(people held out, network) with each fold's network of the whole recipe.
    """
    reserved = set(splits.FOLDS["A"])
    folds = [fold for fold in config.folds if set(fold) <= set(corpus.people)]
    if not folds:
        raise ValueError(f"the ablation needs one of these groups of people: {' or '.join('+'.join(fold) for fold in config.folds)}")
    recipe = replace(recipe, steps=config.steps, seed=config.seed)
    errors: dict[str, dict[str, list[float]]] = {}
    for fold in folds:
        training = tuple(sorted(set(splits.trainable(tuple(corpus.people))) - set(fold) - reserved))
        tests: dict[tuple[str, tuple[float, ...]], train_learned.HeldOut] = {}
        for name, variant in variants(recipe).items():
            report(f"{name}, {', '.join(fold)} held out")
            network = train_learned.train(corpus, training, variant)
            if variant is recipe:
                trained(fold, network)
            for condition, given in CONDITIONS.items():
                key = (condition, variant.window_seconds)
                if key not in tests:
                    tests[key] = train_learned.held_out(corpus, fold, variant.window_seconds, condition=given)
                test = tests[key]
                own = train_learned.fitted_errors_cm(predict(network, test.inputs), test)
                errors.setdefault(name, {}).setdefault(condition, []).append(float(own.mean()))
                if name == "the recipe":
                    errors.setdefault("IK", {}).setdefault(condition, []).append(float(train_learned.ik_errors_cm(test).mean()))
    order = ["IK", *variants(recipe)]
    return [[name, *(f"{np.mean(errors[name][condition]):.2f}" for condition in CONDITIONS)] for name in order]


def write(rows: list[list[str]], page: Path = PAGE) -> None:
    """Renews the page's table."""
    page.write_text(renew(page.read_text(), {"ablation": table(["cm", *CONDITIONS], rows)}))
