"""The configuration of one run of `npm run tool -- train`."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from . import fit_ik, lockbox_log, train_board, train_learned, train_paper
from .shared_constants import REPOSITORY

# What a run does: trains the networks, or instead makes the tables of one study, or evaluates the lockbox.
Task = Literal["train", "selection", "online calibration", "board", "lockbox"]


@dataclass(frozen=True)
class TrainConfig:
    """mocap None: generated motion, for trying the pipeline out. refit_kinematics also replaces the page's proportions
    and IK.

    First the folds, whose errors are what is claimed; then the networks of the page, trained on all subjects, which
    carry those errors.
    """

    mocap: Path | None
    out: Path = REPOSITORY / "public/models"
    # The networks of the first fold and the errors of all go there: what `npm run tool -- evaluate --models` measures
    # on people held out.
    cross_validation: Path = REPOSITORY / ".cache/cross-validation"
    stages: tuple[str, ...] = ("cross-validation", "all-subjects")
    # The networks of the first fold with 32-bit weights go there, for the evaluation to compare with; None: they are
    # not written.
    fp32_out: Path | None = None
    # Errors of the recipes that were judged, by commit and steps.
    selections: Path = REPOSITORY / ".cache/selection"
    # Every evaluation of the lockbox.
    lockbox_log: Path = lockbox_log.LOG
    cache: Path = REPOSITORY / ".cache/mocap"
    skeleton_map: Path | None = None
    folds: tuple[str, ...] = ("A", "B")
    networks: tuple[str, ...] = ("paper", "learned")
    task: Task = "train"
    # The task "selection" holds people out in this many groups in turn; None: one person at a time.
    groups: int | None = None
    refit_kinematics: bool = False
    seed: int = 2460
    # Small layers gain little from more threads, and with one their sums keep their order on any machine.
    threads: int = 1
    paper: train_paper.TrainPaperConfig = train_paper.TrainPaperConfig()
    learned: train_learned.TrainLearnedConfig = train_learned.TrainLearnedConfig()
    ik: fit_ik.FitIkConfig = fit_ik.FitIkConfig()
    board: train_board.BoardConfig = train_board.BoardConfig()


def quick(config: TrainConfig) -> TrainConfig:
    """Returns the config with about a twentieth of the work."""
    return replace(
        config,
        paper=replace(config.paper, epochs=1, batch=1024),
        learned=replace(config.learned, steps=80, batch=512),
        ik=replace(config.ik, iterations=2, frames_per_person=200),
        board=replace(config.board, steps=40, batch=8, watch_every=20, watched_windows=64),
    )
