"""Measures what the paper's sections 3.4 and 4 report without participants, stage by stage: `npm run tool -- paper`.

A stage is a file of figures. A finished stage with the same options is not run again, whatever ended the run.
"""

import argparse
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from . import prepare, train_learned, train_paper
from .arrays import Array
from .chest_features import chest_axes
from .differentiable_kinematics import DifferentiableKinematics
from .features import FEATURES
from .model import PaperShape
from .motion_files import MocapError
from .prepared_corpus import PreparedCorpus
from .residual import OUTPUTS
from .shared_constants import REPOSITORY
from .skeleton import body_from_calibration
from .splits import FOLDS, VARIED, trainable, trained_on
from .stage_files import read_stage, write_stage
from .train_paper import PaperFrames, PaperInputs, TrainPaperConfig

Json = dict[str, Any]

# The paper's names of the six joints, in the order of every tensor.
JOINTS = ("j4", "j5", "j6", "j7", "j8", "j9")
RIGHT_SHOULDER = JOINTS.index("j7")
# Frames of either side that table 4 of the paper samples.
SAMPLE = 27_056
# Batches of an epoch that section 3.3 of the paper states.
ITERATIONS = 150
# Filtering similar poses leaves 60 of 200 frames a second (section 3.2).
SHARE_KEPT = 60 / 200
# Who is held out for the error on new people.
HELD_OUT = FOLDS["B"]


@dataclass(frozen=True)
class Reading:
    """One way to read the paper: its network and samples."""

    train: TrainPaperConfig = TrainPaperConfig()
    inputs: PaperInputs = PaperInputs()


def _reading(iterations: int | None = None, shape: PaperShape = PaperShape(), **inputs: Any) -> Reading:
    return Reading(TrainPaperConfig(iterations=iterations, shape=shape), PaperInputs(axes="room", **inputs))


# `page` is the network of the page, `room` the same with axes of the room; each other reading differs from `room` in
# one thing, `literal` in all that a page can do.
READINGS: dict[str, Reading] = {
    "page": Reading(),
    "room": _reading(),
    "iterations": _reading(iterations=ITERATIONS),
    "joints": _reading(points="joints"),
    "parent": _reading(hands="parent"),
    "filtered": _reading(share_kept=SHARE_KEPT),
    "wide": _reading(shape=PaperShape(width=2304)),
    "literal": _reading(ITERATIONS, PaperShape(width=2304), points="joints", share_kept=SHARE_KEPT),
    "six": _reading(shape=PaperShape(networks=6, width=256)),
    "eighteen": _reading(shape=PaperShape(networks=18, first_filters=16, width=192)),
}


@dataclass(frozen=True)
class ReproductionConfig:
    """out: the folder of the stages, in a folder for each corpus. stages: only these; empty: all."""

    out: Path = REPOSITORY / ".cache/paper"
    seed: int = 2460
    epochs: int = TrainPaperConfig.epochs
    stages: tuple[str, ...] = ()


def frame_random_split(seed: int, count: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The paper's protocol: frames to train on, and 20 % of all frames, drawn at random, to test on; their neighbours
    are trained on.
    """
    test = np.sort(np.random.default_rng(seed).choice(count, count // 5, replace=False))
    return np.setdiff1d(np.arange(count), test), test


def errors_by_side(differences: dict[str, Array], scale: Array | None) -> Json:
    """Figures of differences [F, 18] [m] in the reading's axes, by side: squared errors by joint per
    coordinate, in cm² and of standardised coordinates (scale [18] [m]), absolute errors of the right shoulder, and the
    mean distance over a sample of frames.
    """
    return {
        side: {
            "frames": len(difference),
            "mseCm2": _by_joint((100 * difference) ** 2),
            **({} if scale is None else {"mseStandardised": _by_joint((difference / scale) ** 2)}),
            "rightShoulderMaeCm": float(np.abs(_joint(difference, RIGHT_SHOULDER)).mean()) * 100,
            "mpjpeCm": _sampled_mpjpe_cm(difference),
        }
        for side, difference in differences.items()
    }


def _joint(values: Array, joint: int) -> Array:
    return values[:, 3 * joint : 3 * joint + 3]


def _by_joint(squares: Array) -> dict[str, float]:
    return {name: float(_joint(squares, joint).mean()) for joint, name in enumerate(JOINTS)}


def _sampled_mpjpe_cm(difference: Array) -> float:
    count = min(SAMPLE, len(difference))
    chosen = np.random.default_rng(0).choice(len(difference), count, replace=False)
    return float(np.linalg.norm(difference[chosen].reshape(-1, 3), axis=-1).mean()) * 100


class _LastEpoch:
    """What figures 4 and 5 of the paper show of the last epoch: the loss of each batch, of standardised targets, and
    the error of the right shoulder's height [cm] on some test frames.
    """

    def __init__(self, epochs: int, test: tuple[NDArray[np.float32], NDArray[np.float32]]) -> None:
        self.last, self.test = epochs - 1, test
        self.losses: list[float] = []
        self.heights_cm: list[float] = []

    def report(self, epoch: int, _: int, loss: float) -> None:
        if epoch == self.last:
            self.losses.append(round(loss, 5))

    def watch(self, epochs: float, network: train_paper.AnyPaperNetwork) -> None:
        if epochs > self.last:
            inputs, targets = self.test
            height = 3 * RIGHT_SHOULDER + 1
            error = np.abs(train_paper.predict(network, inputs)[:, height] - targets[:, height])
            self.heights_cm.append(round(float(error.mean()) * 100, 4))


def _differences(network: torch.nn.Module, frames: PaperFrames, chosen: NDArray[np.int64]) -> Array:
    return (train_paper.predict(network, frames.inputs[chosen]) - frames.targets[chosen]).astype(np.float64)


def measure_reading(corpus: PreparedCorpus, people: tuple[str, ...], reading: Reading, seed: int) -> Json:
    """Trains one reading under the paper's protocol, a fifth of the frames drawn at random to test on, and measures
    it.
    """
    frames = train_paper.frames_of(corpus, people, seed, reading.inputs)
    chosen, test = frame_random_split(seed, len(frames.inputs))
    last = _LastEpoch(reading.train.epochs, (frames.inputs[test[::8]], frames.targets[test[::8]]))
    train = replace(reading.train, watches_per_epoch=50)
    network = train_paper.train(frames, chosen, train, last.report, last.watch)
    parameters = sum(parameter.numel() for parameter in network.parameters())
    differences = {"train": _differences(network, frames, chosen), "test": _differences(network, frames, test)}
    return {
        "people": people,
        "frames": len(frames.inputs),
        "iterations": len(last.losses),
        "parameters": parameters,
        "megabytes": parameters * 4 / 1e6,
        **errors_by_side(differences, network.output_scale.numpy().astype(np.float64)),
        "lastEpoch": {"loss": last.losses, "rightShoulderHeightCm": last.heights_cm},
    }


def measure_held_out(corpus: PreparedCorpus, people: tuple[str, ...], reading: Reading, seed: int) -> Json:
    """Trains the page's reading without some people, and measures it on them."""
    held_out = tuple(person for person in people if person in HELD_OUT)
    training = tuple(person for person in people if person not in HELD_OUT)
    if not held_out or not training:
        raise MocapError(f"it needs {', '.join(HELD_OUT)} and others besides them")
    sides = {"train": training, "test": held_out}
    frames = {side: train_paper.frames_of(corpus, who, seed, reading.inputs) for side, who in sides.items()}
    network = train_paper.train(frames["train"], np.arange(len(frames["train"].inputs)), reading.train)
    differences = {side: _differences(network, each, np.arange(len(each.inputs))) for side, each in frames.items()}
    scale = network.output_scale.numpy().astype(np.float64)
    return {"people": held_out, **errors_by_side(differences, scale)}


def measure_ik(corpus: PreparedCorpus, people: tuple[str, ...], seed: int) -> Json:
    """Measures our own IK, after torso and arm fitting and without calibrated hands, on the test frames of the page's
    reading.
    """
    difference = np.concatenate(list(_ik_differences(corpus, people, seed)))
    _, test = frame_random_split(seed, len(difference))
    return {"people": people, **errors_by_side({"test": difference[test]}, None)}


def _ik_differences(corpus: PreparedCorpus, people: tuple[str, ...], seed: int) -> Iterator[Array]:
    """IK's joints minus the true ones [F, 18] of each clip, heading frame [m]."""
    kinematics = DifferentiableKinematics()
    for name, clip, tracked in train_paper.tracked_clips(corpus, people, seed):
        person = corpus.people[name]
        body = body_from_calibration(np.array(person.eye_height), np.array(person.arm_span))
        clip_frames = train_learned.clip_frames(corpus, clip, tracked, body, (0.0,))
        inputs = clip_frames.inputs
        nothing = torch.zeros(len(inputs), OUTPUTS // 3, 3)
        fitted = kinematics(nothing, torch.from_numpy(inputs)).numpy().reshape(-1, 6, 3)
        from_truth = (fitted - clip_frames.targets.reshape(-1, 6, 3)) * clip_frames.eye_height[:, None, None]
        yield (from_truth @ chest_axes(inputs[:, :FEATURES])).reshape(-1, OUTPUTS)


# The options on which the figures of a stage depend, and its measurement.
_Stage = tuple[Json, Callable[[], Json]]


def _stages(corpus: PreparedCorpus, people: tuple[str, ...], config: ReproductionConfig) -> dict[str, _Stage]:
    """Every stage by its name, in the order in which they run."""

    def at(reading: Reading) -> Reading:
        return replace(reading, train=replace(reading.train, epochs=config.epochs, seed=config.seed))

    beside = {"seed": config.seed, "people": people}
    page = at(READINGS["page"])
    stages: dict[str, _Stage] = {
        "ik": (beside, lambda: measure_ik(corpus, people, config.seed)),
        "held-out": (
            beside | {"reading": asdict(page)},
            lambda: measure_held_out(corpus, people, page, config.seed),
        ),
    }
    for name, reading in READINGS.items():
        chosen = at(reading)
        stages[name] = (
            beside | {"reading": asdict(chosen)},
            lambda chosen=chosen: measure_reading(corpus, people, chosen, config.seed),
        )
    return stages


def main(corpus: PreparedCorpus, config: ReproductionConfig, report: Callable[[str], None] = print) -> Path:
    """Runs the stages that are not finished; returns the folder of their files. A stage that the motion does not allow
    is left out with a sentence.
    """
    people = trained_on("paper", trainable(tuple(corpus.people)))
    if not people:
        raise MocapError("no one of this motion may be trained on")
    if missing := sorted(set(trainable(VARIED)) - set(corpus.people)):
        report(f"The page's network was also trained on people that are missing here: {', '.join(missing)}.")
    folder = config.out / corpus.corpus_hash[:16]
    stages = _stages(corpus, people, config)
    if unknown := set(config.stages) - set(stages):
        raise MocapError(f"no stage {', '.join(sorted(unknown))}; there are {', '.join(stages)}")
    for name in config.stages or stages:
        options, measure = stages[name]
        if read_stage(folder / f"{name}.json", options, report) is not None:
            report(f"{name}: finished before")
            continue
        try:
            figures = measure()
        except MocapError as error:
            report(f"{name} is left out: {error}")
            continue
        write_stage(folder / f"{name}.json", options, figures)
        report(f"{name}: MPJPE {figures['test']['mpjpeCm']:.2f} cm on the test frames")
    return folder


def _arguments() -> tuple[prepare.PrepareConfig, ReproductionConfig, int]:
    parser = argparse.ArgumentParser(prog="npm run tool -- paper --", description="The paper's tables, measured.")
    parser.add_argument("--mocap", type=Path, required=True)
    parser.add_argument("--skeleton", type=Path)
    parser.add_argument("--stages", help=f"only these of ik, held-out, {', '.join(READINGS)}, separated by commas")
    parser.add_argument("--epochs", type=int, default=ReproductionConfig.epochs, help="fewer: does it run?")
    parser.add_argument("--threads", type=int, default=1)
    given = parser.parse_args()
    stages = tuple(given.stages.split(",")) if given.stages else ()
    prepared = prepare.PrepareConfig(given.mocap, given.skeleton, cache=REPOSITORY / ".cache/mocap")
    return prepared, ReproductionConfig(epochs=given.epochs, stages=stages), given.threads


if __name__ == "__main__":
    prepared, config, threads = _arguments()
    torch.set_num_threads(threads)
    try:
        corpus = prepare.main(prepared)
        for problem in corpus.problems:
            print(f"  {problem}")
        print(main(corpus, config))
    except MocapError as error:
        sys.exit(f"paper: {error}")
