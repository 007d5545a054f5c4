"""One network trained, judged or written: the steps that cross-validation and the networks of the page share."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import torch

from . import export, fitted_kinematics, train_learned, train_paper
from .prepared_corpus import PreparedCorpus
from .splits import counted, trainable, trained_on
from .training_config import TrainConfig
from .training_report import TrainingReport

VERSION = "1"


@dataclass(frozen=True)
class TrainingRun:
    """Configuration, corpus and report, which every step of a run needs."""

    config: TrainConfig
    corpus: PreparedCorpus
    report: TrainingReport


def kinematics(run: TrainingRun, people: tuple[str, ...], label: str) -> fitted_kinematics.Kinematics:
    """Body proportions and IK parameters fitted on these people."""
    with run.report.task(f"IK {label}", run.config.ik.iterations) as advance:
        return fitted_kinematics.fit(run.corpus, people, run.config.ik, lambda done: advance(done, None))


def paper(
    run: TrainingRun,
    frames: train_paper.PaperFrames,
    label: str,
    chosen: np.ndarray | None = None,
    watch: Callable[[float, train_paper.AnyPaperNetwork], None] = lambda *_: None,
) -> torch.nn.Module:
    """The paper's network trained on the chosen frames; None: on all."""
    config = run.config.paper
    chosen = np.arange(len(frames.inputs)) if chosen is None else chosen
    batches = max(1, 2 * len(chosen) // config.batch)
    with run.report.task(f"paper {label}", config.epochs * 100) as advance:

        def report(epoch: int, iteration: int, loss: float) -> None:
            advance(100 * epoch + 100 * iteration / batches, f"paper {label} {loss:.4f}")

        return train_paper.train(frames, chosen, config, report, watch)


def _people_of(run: TrainingRun, name: str, training: tuple[str, ...], label: str) -> tuple[str, ...]:
    """The subset of `training` this network trains on (splits.trained_on); prints their names."""
    people = trained_on(name, training)
    run.report.console.print(f"{name}, {label}: trained on {counted(people, tuple(run.corpus.people))}", markup=False)
    return people


def paper_frames(run: TrainingRun, training: tuple[str, ...], label: str) -> train_paper.PaperFrames:
    """All frames of the subset of `training` that the paper's network trains on."""
    return train_paper.frames_of(run.corpus, _people_of(run, "paper", training, label), run.config.seed)


def followed_paper(
    run: TrainingRun, training: tuple[str, ...], test: train_paper.PaperFrames, label: str
) -> tuple[torch.nn.Module, train_paper.LearningCurve]:
    """The paper's network trained on its subset of `training`, and its learning curve on those frames and on `test`."""
    frames = paper_frames(run, training, label)
    curve, watch = train_paper.follow_learning(frames, test)
    return paper(run, frames, label, watch=watch), curve


def learned(run: TrainingRun, training: tuple[str, ...], label: str) -> torch.nn.Module:
    """Our network trained on these people."""
    people = _people_of(run, "learned", training, label)
    with run.report.task(f"learned {label}", run.config.learned.steps) as advance:
        return train_learned.train(
            run.corpus, people, run.config.learned, lambda step, loss: advance(step + 1, f"learned {label} {loss:.3f}")
        )


def frame_random_split(seed: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The paper's protocol: frames to train on, and 20 % of all frames, drawn at random, to test on; their neighbours
    are trained on.
    """
    test = np.sort(np.random.default_rng(seed).choice(count, count // 5, replace=False))
    return np.setdiff1d(np.arange(count), test), test


def paper_frame_random_errors_cm(run: TrainingRun) -> np.ndarray:
    """Errors [F, 6] in cm of the paper's network on the test frames of the paper's protocol."""
    frames = paper_frames(run, trainable(tuple(run.corpus.people)), "frame-random")
    chosen, test = frame_random_split(run.config.seed, len(frames.inputs))
    network = paper(run, frames, "frame-random", chosen)
    return train_paper.errors_cm(network, frames, test)


def learned_frame_random_errors_cm(run: TrainingRun) -> np.ndarray:
    """Errors [F, 6] in cm of our network's raw joints on the test frames of the paper's protocol."""
    people = _people_of(run, "learned", trainable(tuple(run.corpus.people)), "frame-random")
    frames = train_learned.held_out(run.corpus, people, run.config.learned.window_seconds)
    chosen, test = frame_random_split(run.config.seed, len(frames.inputs))
    config = run.config.learned_frame_random
    with run.report.task("learned frame-random", config.steps) as advance:
        network = train_learned.train_frame_random(
            frames, chosen, config, lambda step, loss: advance(step + 1, f"learned frame-random {loss:.3f}")
        )
    tested = frames.subset(test)
    return train_learned.raw_errors_cm(train_paper.predict(network, tested.inputs), tested)


@dataclass(frozen=True)
class Destination:
    """The folder that a network is written to; fp32: the folder for a copy with 32-bit weights, None: no copy."""

    out: Path
    fp32: Path | None = None


def write(
    run: TrainingRun,
    name: str,
    network: torch.nn.Module,
    provenance: export.Provenance,
    destination: Destination,
) -> None:
    """Writes a network with its contract."""
    if name == "paper":
        window = (0.0,)
        examples = train_paper.frames_of(run.corpus, provenance.people[:1], run.config.seed).inputs[::97]
    else:
        window = run.config.learned.window_seconds
        examples = train_learned.held_out(run.corpus, provenance.people[:1], window).inputs[::97]
    export.main(
        export.ExportConfig(name, VERSION, destination.out, window, provenance, fp32_out=destination.fp32),
        network,
        examples,
    )


def provenance(
    run: TrainingRun,
    name: str,
    training: tuple[str, ...],
    errors: dict[str, dict[str, float]],
    curve: train_paper.LearningCurve | dict[str, list[float]] | None,
) -> export.Provenance:
    """What a contract states of a network of this run: corpus, seed, errors [cm] and the subset of `training` that it
    trained on.
    """
    source = (
        "generated motion" if run.config.mocap is None else "CMU Graphics Lab Motion Capture Database and like files"
    )
    return export.Provenance(
        corpus=source,
        corpus_hash=run.corpus.corpus_hash,
        people=trained_on(name, training),
        seed=run.config.seed,
        errors=errors,
        learning_curve=asdict(curve) if isinstance(curve, train_paper.LearningCurve) else curve,
    )
