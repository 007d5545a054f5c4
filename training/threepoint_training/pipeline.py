"""From mocap files to public/models, in one run: prepare, proportions and IK, the paper's network, ours, export, the
table.

A run is seeded: the same data and options write the same weights on the same machine.
"""

import functools
import itertools
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import torch
from rich.console import Console

from . import (
    cross_validate,
    fit_networks,
    fitted_kinematics,
    golden,
    lockbox,
    online_calibration,
    prepare,
    selection,
    train_board,
    train_learned,
    train_paper,
)
from .fit_networks import Destination, TrainingRun
from .generated_motion import generate_corpus
from .lockbox_log import LockboxAccess, git_commit
from .prepared_corpus import PreparedCorpus
from .shared_constants import REPOSITORY
from .splits import LOCKBOX, evaluation_only, trainable, training_people
from .training_config import Task, TrainConfig
from .training_report import LABELS, TrainingReport

TITLE = "MPJPE: IK and ours after torso and arm fitting, the paper's network raw [cm]"


Rows = dict[str, dict[str, float]]


def main(config: TrainConfig, console: Console | None = None) -> Rows:
    """Does the configured task, prints its table and returns it: MPJPE [cm] by row and column; nothing where the table
    has other figures.
    """
    torch.set_num_threads(config.threads)
    report = TrainingReport(console or Console())
    with report.progress:
        return _TASKS[config.task](TrainingRun(config, _corpus(config, report), report))


def _train(run: TrainingRun) -> Rows:
    """Trains the networks of each fold, then those of the page, and renews the golden vectors with the latter.

    The page's kinematics are refitted first, where the run does so: all of these networks add to its IK.
    """
    config = run.config
    if config.refit_kinematics:
        everyone = trainable(tuple(run.corpus.people))
        fitted_kinematics.write(fit_networks.kinematics(run, everyone, "all subjects"))
    folds = cross_validate.usable_folds(run)
    if "cross-validation" in config.stages and folds:
        cross_validate.main(run, folds)
    if "all-subjects" in config.stages:
        _train_on_all_subjects(run)
        if config.out.resolve() == (REPOSITORY / "public/models").resolve():
            golden.main(golden.GoldenConfig(config.out))
    run.report.table(TITLE, ("mean", *LABELS), run.report.rows)
    return run.report.rows


def _train_on_all_subjects(run: TrainingRun) -> None:
    """Trains and writes the page's networks, each on its subset of all trainable people (`splits.trained_on`).

    Their contracts carry the errors of cross-validation: on held-out people, of networks trained in the same way
    without them.
    """
    subjects = trainable(tuple(run.corpus.people))
    for name in run.config.networks:
        errors = cross_validate.earlier_errors(run, name)
        row = f"{name}, all subjects, trained on"
        if name == "paper":
            frames = fit_networks.paper_frames(run, subjects, "all subjects")
            network = fit_networks.paper(run, frames, "all subjects")
            run.report.found(row, train_paper.errors_cm(network, frames))
        else:
            network = fit_networks.learned(run, subjects, "all subjects")
            test = train_learned.held_out(run.corpus, subjects, run.config.learned.window_seconds)
            run.report.found(row, train_learned.errors_cm(network, test))
        provenance = fit_networks.provenance(run, name, subjects, errors | {row: run.report.rows[row]})
        fit_networks.write(run, name, network, provenance, Destination(run.config.out))


def _select(run: TrainingRun) -> Rows:
    """Judges the recipe by the selection metric, and compares it with the recipes judged earlier on the same people and
    seeds.
    """
    config = selection.SelectionConfig(run.config.groups)
    found = selection.main(run.corpus, run.config.learned, config, run.report.console.print)
    for frames in selection.FRAMES:
        figures = [selection.figures(seed[frames]) for seed in found]
        means = {name: sum(each[name] for each in figures) / len(figures) for name in figures[0]}
        run.report.console.print(
            f"error relative to IK, {frames} frames: {', '.join(f'{name} {value:.3f}' for name, value in means.items())}"
        )
    file = run.config.selections / f"{git_commit()}-{run.config.learned.steps}.json"
    for earlier in sorted(set(run.config.selections.glob("*.json")) - {file}):
        other = selection.load(earlier)
        if [set(seed["active"]) for seed in other] != [set(seed["active"]) for seed in found]:
            continue
        for name, difference in selection.compare(
            [seed["active"] for seed in found], [seed["active"] for seed in other]
        ).items():
            verdict = " (a tie)" if difference.is_tie else ""
            run.report.console.print(
                f"minus {earlier.stem}, active frames, {name}: {difference.mean:+.4f} ± {difference.standard_error:.4f}{verdict}"
            )
    selection.save(found, file)
    return {}


def _online_calibration(run: TrainingRun) -> Rows:
    """Evaluates the estimation of calibration errors from minutes of motion; renews its table in docs/accuracy.md."""
    online_calibration.write(
        online_calibration.main(run.corpus, run.config.learned, run.config.ik, report=run.report.console.print)
    )
    return {}


def _make_board(run: TrainingRun) -> Rows:
    """Trains the networks of the board that are not finished: ours and the paper's without the people held out there,
    then those of the field.
    """
    config, print_line = run.config, functools.partial(run.report.console.print, markup=False)
    folder = train_board.folder_of(run.corpus, config.board)
    training = training_people("board", tuple(run.corpus.people))
    for name in config.networks:
        if (folder / f"{name}.json").exists():
            print_line(f"{name}: finished before")
            continue
        if name == "paper":
            network = fit_networks.paper(run, fit_networks.paper_frames(run, training, "board"), "board")
        else:
            network = fit_networks.learned(run, training, "board")
        fit_networks.write(
            run, name, network, fit_networks.provenance(run, name, training, {}), Destination(folder)
        )
    train_board.main(run.corpus, config.board, print_line)
    return {}


def _open_lockbox(run: TrainingRun) -> Rows:
    """Evaluates the learned network in `out` on the lockbox people and logs it."""
    row = lockbox.main(run.corpus, lockbox.LockboxConfig(run.config.out, run.config.lockbox_log))
    run.report.console.print_json(data=row)
    return {}


_TASKS: dict[Task, Callable[[TrainingRun], Rows]] = {
    "train": _train,
    "selection": _select,
    "online calibration": _online_calibration,
    "board": _make_board,
    "lockbox": _open_lockbox,
}


def _corpus(config: TrainConfig, report: TrainingReport) -> PreparedCorpus:
    """The motion to train with; the run says where it is from, what was put right or left out, and how much of it there
    is.
    """
    corpus = (
        generate_corpus(people=6, clips=4, frames=600, seed=config.seed)
        if config.mocap is None
        else _prepared(config, config.mocap, report)
    )
    for problem in corpus.problems:
        report.console.print(f"  {problem}", markup=False)
    people = tuple(corpus.people)
    amount = f"{len(corpus.clips)} clips of {len(people)} people, {corpus.minutes_of(people):.0f} minutes at {corpus.rate_hz} Hz"
    never_trained_on = f"; evaluation-only: {', '.join(evaluation_only(people))}" if evaluation_only(people) else ""
    report.console.print(f"{config.mocap or 'generated motion'}: {amount}{never_trained_on}", markup=False)
    return corpus


def _prepared(config: TrainConfig, mocap: Path, report: TrainingReport) -> PreparedCorpus:
    numbers = itertools.count(1)
    with report.task("prepare", None) as advance:
        prepared = prepare.PrepareConfig(mocap, config.skeleton_map, cache=config.cache)
        if config.task == "lockbox":
            access = LockboxAccess("npm run tool -- train --lockbox", config.lockbox_log)
            prepared = replace(prepared, people=LOCKBOX, lockbox=access)
        return prepare.main(prepared, lambda name: advance(next(numbers), f"prepare {name}"))
