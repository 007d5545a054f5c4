"""One network trained, judged or written: the steps that cross-validation and the networks of the page share."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch

from . import export, fitted_kinematics, train_learned, train_paper
from .prepared_corpus import PreparedCorpus
from .splits import counted, trained_on
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
) -> torch.nn.Module:
    """The paper's network trained on these frames."""
    config = run.config.paper
    batches = max(1, 2 * len(frames.inputs) // config.batch)
    with run.report.task(f"paper {label}", config.epochs * 100) as advance:

        def report(epoch: int, iteration: int, loss: float) -> None:
            advance(100 * epoch + 100 * iteration / batches, f"paper {label} {loss:.4f}")

        return train_paper.train(frames, np.arange(len(frames.inputs)), config, report)


def _people_of(run: TrainingRun, name: str, training: tuple[str, ...], label: str) -> tuple[str, ...]:
    """The subset of `training` this network trains on (splits.trained_on); prints their names."""
    people = trained_on(name, training)
    run.report.console.print(f"{name}, {label}: trained on {counted(people, tuple(run.corpus.people))}", markup=False)
    return people


def paper_frames(run: TrainingRun, training: tuple[str, ...], label: str) -> train_paper.PaperFrames:
    """All frames of the subset of `training` that the paper's network trains on."""
    return train_paper.frames_of(run.corpus, _people_of(run, "paper", training, label), run.config.seed)


def learned(run: TrainingRun, training: tuple[str, ...], label: str) -> torch.nn.Module:
    """Our network trained on these people."""
    people = _people_of(run, "learned", training, label)
    with run.report.task(f"learned {label}", run.config.learned.steps) as advance:
        return train_learned.train(
            run.corpus, people, run.config.learned, lambda step, loss: advance(step + 1, f"learned {label} {loss:.3f}")
        )


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
    )
