"""The command line of `npm run tool -- train`."""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from . import pipeline
from .motion_files import MocapError
from .splits import FOLDS
from .training_config import Task, TrainConfig, quick

# Options that ask for something else instead of training the networks, and what that is.
_TASKS: dict[str, tuple[Task, str]] = {
    "--select": ("selection", "the recipe judged by the selection metric, and compared with earlier ones"),
    "--online-calibration": (
        "online calibration",
        "the estimation of calibration errors from minutes of motion, on people held out in four groups, for docs/accuracy.md",
    ),
    "--board": (
        "board",
        "the networks of docs/board.md, on all trainable people but those held out there; a run that was ended goes on",
    ),
    "--lockbox": (
        "lockbox",
        "the learned network in --out on the lockbox people, logged in training/lockbox-log.json; for a release only",
    ),
}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="npm run tool -- train --", description="Trains the networks of the page from motion capture."
    )
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--mocap", type=Path, help="folder with .asf/.amc or .bvh files")
    source.add_argument("--generated", action="store_true", help="generated motion instead, to try the pipeline")
    parser.add_argument("--skeleton", type=Path, help="a skeleton map (docs/accuracy.md)")
    parser.add_argument("--out", type=Path, default=TrainConfig.out)
    parser.add_argument("--fp32", type=Path, help="also writes the networks with 32-bit weights there, to compare with")
    parser.add_argument("--seed", type=int, default=TrainConfig.seed)
    parser.add_argument(
        "--threads",
        type=int,
        default=TrainConfig.threads,
        help="more are faster with large cores; weights differ in the last digits",
    )
    parser.add_argument(
        "--folds",
        default=",".join(TrainConfig.folds),
        help="who is held out in turn; the first one's networks are written (default: A,B)",
    )
    parser.add_argument(
        "--cross-validation",
        type=Path,
        default=TrainConfig.cross_validation,
        help="networks and errors of the folds go there",
    )
    parser.add_argument(
        "--stage",
        choices=TrainConfig.stages,
        help="this one alone; all-subjects takes the errors of an earlier cross-validation",
    )
    parser.add_argument(
        "--networks",
        default=",".join(TrainConfig.networks),
        help="train and replace only these (default: paper,learned)",
    )
    parser.add_argument(
        "--refit-kinematics",
        action="store_true",
        help="first fit the page's body proportions and IK parameters on all trainable people",
    )
    for option, (_, what) in _TASKS.items():
        parser.add_argument(
            option, dest="tasks", action="append_const", const=option, help=f"instead of all that: {what}"
        )
    parser.add_argument(
        "--groups", type=int, help="with --select: so many groups in turn instead of one subject at a time"
    )
    parser.add_argument(
        "--steps",
        type=int,
        help=f"of our network's training (default: {TrainConfig.learned.steps}); with --board: at most so many of the "
        f"field's networks (default: {TrainConfig.board.steps})",
    )
    parser.add_argument(
        "--quick", action="store_true", help="a twentieth of the training, but for --steps: does it run?"
    )
    return parser


def config_of(arguments: Sequence[str]) -> TrainConfig:
    """The run that a command line asks for; one that contradicts itself ends the program with a sentence."""
    parser = _parser()
    given = parser.parse_args(arguments)
    tasks = list(dict.fromkeys(given.tasks or []))
    if len(tasks) > 1:
        parser.error(f"{' and '.join(tasks)} are runs of their own: give one of them")
    config = TrainConfig(
        mocap=given.mocap,
        out=given.out,
        cross_validation=given.cross_validation,
        stages=(given.stage,) if given.stage else TrainConfig.stages,
        fp32_out=given.fp32,
        skeleton_map=given.skeleton,
        folds=tuple(given.folds.split(",")),
        networks=tuple(given.networks.split(",")),
        task=_TASKS[tasks[0]][0] if tasks else TrainConfig.task,
        groups=given.groups,
        refit_kinematics=given.refit_kinematics,
        seed=given.seed,
        threads=given.threads,
    )
    if unknown := set(config.folds) - set(FOLDS):
        parser.error(f"no fold {', '.join(sorted(unknown))}; there are {', '.join(FOLDS)}")
    if config.groups is not None and config.task != "selection":
        parser.error(f"--groups {config.groups} is of --select: give that too")
    if config.groups is not None and config.groups < 2:
        parser.error(f"--groups {config.groups}: two groups at least, or there is no one to train on")
    if given.steps is not None and given.steps < 1:
        parser.error(f"--steps {given.steps}: at least one")
    if config.task == "lockbox" and (given.quick or given.steps is not None):
        parser.error("--lockbox trains nothing: it takes neither --steps nor --quick")
    if unknown := set(config.networks) - set(TrainConfig.networks):
        parser.error(f"no network {', '.join(sorted(unknown))}; there are {', '.join(TrainConfig.networks)}")
    config = quick(config) if given.quick else config
    steps = {"learned": config.learned.steps, "board": config.board.steps}
    if given.steps is not None:
        steps["board" if config.task == "board" else "learned"] = given.steps
    return replace(
        config,
        paper=replace(config.paper, seed=config.seed),
        learned=replace(config.learned, seed=config.seed, steps=steps["learned"]),
        board=replace(config.board, seed=config.seed, steps=steps["board"]),
    )


if __name__ == "__main__":
    try:
        pipeline.main(config_of(sys.argv[1:]))
    except MocapError as error:
        sys.exit(str(error))
