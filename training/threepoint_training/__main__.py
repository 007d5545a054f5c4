"""From mocap files to public/models, in one run: prepare, body and IK, the paper's network, ours, export, the table.

`npm run train -- --mocap DIR` calls this. A run is seeded: the same data and options write the same weights on the same machine.
"""

import argparse
import json
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from . import ablation, export, fit_ik, golden, ik, kinematics, leave_one_out, neutral_pose, people, prepare, skeleton, train_learned, train_paper
from .features import paper_input
from .generated_motion import generate_corpus
from .model import PaperNetwork, CorrectionNetwork
from .motion import MocapError
from .prepared_corpus import PreparedCorpus

REPOSITORY = Path(__file__).parents[2]
LABELS = ("left elbow", "right elbow", "left shoulder", "right shoulder", "spine", "pelvis")
VERSION = "1"


@dataclass(frozen=True)
class TrainConfig:
    """mocap None: generated motion, for trying the pipeline out. refit_kinematics also replaces the page's proportions and IK.

    First the folds, whose errors are what is claimed; then the networks of the page, trained on everybody, who carry those errors.
    """

    mocap: Path | None
    out: Path = REPOSITORY / "public/models"
    # The networks of the first fold and the errors of all go there: what `npm run evaluate -- --models` measures on people held out.
    cross_validation: Path = REPOSITORY / ".cache/cross-validation"
    stages: tuple[str, ...] = ("cross-validation", "everybody")
    # The networks of the first fold with 32-bit weights go there, for the evaluation to compare with; None: they are not written.
    fp32_out: Path | None = None
    cache: Path = REPOSITORY / ".cache/mocap"
    skeleton_map: Path | None = None
    folds: tuple[str, ...] = ("A", "B")
    networks: tuple[str, ...] = ("paper", "learned")
    frame_random: bool = True
    ablate: bool = False
    leave_one_out: bool = False
    refit_kinematics: bool = False
    seed: int = 2460
    # Small layers gain little from more threads, and with one their sums keep their order on any machine.
    threads: int = 1
    paper: train_paper.TrainPaperConfig = train_paper.TrainPaperConfig()
    learned: train_learned.TrainLearnedConfig = train_learned.TrainLearnedConfig()
    learned_frame_random: train_learned.TrainFrameRandomConfig = train_learned.TrainFrameRandomConfig()
    ik: fit_ik.FitIkConfig = fit_ik.FitIkConfig()
    # The page's damping of the correction; chosen by `npm run evaluate`: jerk against error.
    correction_half_life: float = 0.04


def compact_json(content: Any) -> str:
    """JSON with a line per innermost list, as the parameter files in src/core are written."""
    def on_one_line(match: re.Match[str]) -> str:
        return f"[{' '.join(match[1].split())}]"

    return re.sub(r"\[\s+([^\[\]{}]*?)\s+\]", on_one_line, json.dumps(content, indent=2)) + "\n"


def by_joint(errors: np.ndarray) -> dict[str, float]:
    """Mean over frames of [F, 6] by joint, and `mean`."""
    return {"mean": float(errors.mean())} | dict(zip(LABELS, errors.mean(axis=0).tolist(), strict=True))


def main(config: TrainConfig, console: Console | None = None) -> dict[str, dict[str, float]]:
    """Trains, writes models and contracts, prints the table and returns it: MPJPE [cm] by row and joint."""
    console = console or Console()
    torch.set_num_threads(config.threads)
    rows: dict[str, dict[str, float]] = {}

    def found(row: str, errors: np.ndarray) -> None:
        rows[row] = by_joint(errors)
        # A run takes most of an hour: what is known is told at once, in a log too.
        console.print(f"{row}: {rows[row]['mean']:.2f} cm")

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console, transient=not console.is_terminal) as progress:
        corpus = _corpus(config, progress, console)
        if config.ablate:
            return _ablate(config, corpus, progress, console)
        if config.leave_one_out:
            _leave_one_out(config, corpus, progress, console)
            return {}
        everybody = tuple(corpus.people)
        for fold in config.folds:
            if not set(people.FOLDS[fold]) & set(everybody) or not people.training_people(fold, everybody):
                console.print(f"Fold {fold} left out: it needs {', '.join(people.FOLDS[fold])} and others besides them")
        folds = [fold for fold in config.folds if set(people.FOLDS[fold]) & set(everybody) and people.training_people(fold, everybody)]
        if "cross-validation" in config.stages and folds:
            _cross_validate(config, corpus, folds, found, rows, progress)
        if "everybody" in config.stages:
            _train_on_everybody(config, corpus, found, rows, progress)
    if "everybody" in config.stages and config.out.resolve() == (REPOSITORY / "public/models").resolve():
        golden.main(config.out)
    _print_table("MPJPE: IK and ours where the skeleton puts joints, the paper's as its network says them [cm]", ("mean", *LABELS), rows, console)
    return rows


def _cross_validate(
    config: TrainConfig,
    corpus: PreparedCorpus,
    folds: list[str],
    found: Callable[[str, np.ndarray], None],
    rows: dict[str, dict[str, float]],
    progress: Progress,
) -> None:
    """Networks that have not seen the fold's people, and the paper's own protocol; the first fold's are written."""
    everybody = tuple(corpus.people)
    shipped = folds[0]
    networks: dict[str, torch.nn.Module] = {}
    curve: train_paper.LearningCurve | None = None
    for fold in folds:
        training = people.training_people(fold, everybody)
        unseen = tuple(person for person in people.FOLDS[fold] if person in everybody)
        with _kinematics(config, corpus, training, fold, shipped, progress):
            label = f"fold {fold}"
            test = train_learned.held_out(corpus, unseen, config.learned.window_seconds)
            found(f"IK, {label} ({', '.join(unseen)})", train_learned.ik_errors_cm(test))
            trained: dict[str, torch.nn.Module] = {}
            if "paper" in config.networks:
                frames = train_paper.frames_of(corpus, unseen, config.seed)
                trained["paper"], followed = _train_paper(config, corpus, training, frames, label, progress)
                curve = followed if fold == shipped else curve
                found(
                    f"paper, {label} ({', '.join(unseen)})",
                    train_paper.joint_errors_cm(train_paper.predict(trained["paper"], frames.inputs), frames.targets),
                )
            if "learned" in config.networks:
                trained["learned"] = _train_learned(config, corpus, training, label, progress)
                found(
                    f"learned, {label} ({', '.join(unseen)})",
                    train_learned.errors_cm(train_paper.predict(trained["learned"], test.inputs), test),
                )
        if fold == shipped:
            networks = trained
    if config.frame_random and "paper" in config.networks:
        found("paper, frame-random 80/20", _paper_frame_random(config, corpus, progress))
    if config.frame_random and "learned" in config.networks:
        found("learned, frame-random 80/20", _learned_frame_random(config, corpus, progress))
    for name, network in networks.items():
        errors = {row: values for row, values in rows.items() if row.startswith((name, "IK"))}
        if not config.frame_random:
            earlier, _ = _cross_validated(config, corpus, name)
            errors |= {row: values for row, values in earlier.items() if "frame-random" in row}
        provenance = _provenance(config, corpus, people.training_people(shipped, everybody), errors)
        learning = asdict(curve) if name == "paper" and curve else None
        _export(config, corpus, name, network, config.cross_validation, provenance, learning, config.fp32_out)


def _train_on_everybody(
    config: TrainConfig, corpus: PreparedCorpus, found: Callable[[str, np.ndarray], None], rows: dict[str, dict[str, float]], progress: Progress
) -> None:
    """The page's networks. Their contracts state the errors on people held out, of networks trained the same way without them."""
    everybody = tuple(sorted(corpus.people))
    for name in config.networks:
        errors, curve = _cross_validated(config, corpus, name)
        row = f"{name}, everybody, who was trained on"
        if name == "paper":
            frames = train_paper.frames_of(corpus, everybody, config.seed)
            network = _fit_paper(config, frames, np.arange(len(frames.inputs)), "paper everybody", progress)
            found(row, train_paper.joint_errors_cm(train_paper.predict(network, frames.inputs), frames.targets))
        else:
            network = _train_learned(config, corpus, everybody, "everybody", progress)
            test = train_learned.held_out(corpus, everybody, config.learned.window_seconds)
            found(row, train_learned.errors_cm(train_paper.predict(network, test.inputs), test))
        provenance = _provenance(config, corpus, everybody, errors | {row: rows[row]})
        _export(config, corpus, name, network, config.out, provenance, curve, None)


def _cross_validated(config: TrainConfig, corpus: PreparedCorpus, name: str) -> tuple[dict[str, dict[str, float]], dict[str, Any] | None]:
    """Errors and learning curve of the networks whose people were held out, from their contract; none, where nobody could be."""
    file = config.cross_validation / f"{name}.json"
    if not file.exists():
        return {}, None
    contract = json.loads(file.read_text())
    if contract["trainedOn"]["corpusHash"] != corpus.corpus_hash:
        raise MocapError(f"{file} was made from other motion: run both stages, or give another --cross-validation")
    curve = contract.get("learningCurve")
    return contract["errors"], {key: value for key, value in curve.items() if key != "unit"} if curve else None


def _ablate(config: TrainConfig, corpus: PreparedCorpus, progress: Progress, console: Console) -> dict[str, dict[str, float]]:
    task = progress.add_task("ablation", total=len(ablation.FOLDS) * len(ablation.variants(config.learned)))
    networks: dict[tuple[str, ...], CorrectionNetwork] = {}
    rows = ablation.run(
        corpus, config.learned, ablation.AblationConfig(seed=config.seed),
        lambda name: progress.update(task, advance=1, description=name), networks.__setitem__,
    )  # fmt: skip
    progress.remove_task(task)
    shown = _print_cells("MPJPE without each part of the recipe, people held out [cm]", ablation.CONDITIONS, rows, console)
    told = neutral_pose.run(corpus, config.learned, networks)
    _print_cells("MPJPE with what a neutral pose tells of its person [cm]", neutral_pose.COLUMNS, told, console)
    # Last: a page without a place for them costs no hour of training.
    ablation.write(rows)
    neutral_pose.write(told)
    return shown


def _leave_one_out(config: TrainConfig, corpus: PreparedCorpus, progress: Progress, console: Console) -> None:
    task = progress.add_task("leave one out", total=len(corpus.people))
    rows = leave_one_out.run(corpus, config.learned, config.ik, lambda name: progress.update(task, advance=1, description=f"without {name}"))
    progress.remove_task(task)
    for row in rows:
        console.print("  ".join(row))
    leave_one_out.write(rows)


def _print_cells(title: str, columns: Iterable[str], rows: list[list[str]], console: Console) -> dict[str, dict[str, float]]:
    head = list(columns)
    shown = {name: dict(zip(head, map(float, values), strict=True)) for name, *values in rows}
    _print_table(title, head, shown, console)
    return shown


def _corpus(config: TrainConfig, progress: Progress, console: Console) -> PreparedCorpus:
    if config.mocap is None:
        return generate_corpus(people=6, clips=4, frames=600, seed=config.seed)
    task = progress.add_task("prepare", total=None)
    corpus = prepare.main(
        prepare.PrepareConfig(config.mocap, config.skeleton_map, cache=config.cache),
        lambda name: progress.update(task, advance=1, description=f"prepare {name}"),
    )
    progress.remove_task(task)
    for problem in corpus.problems:
        console.print(f"  {problem}")
    minutes = len(corpus.positions) / corpus.rate_hz / 60
    console.print(f"{len(corpus.clips)} clips of {len(corpus.people)} people, {minutes:.0f} minutes at {corpus.rate_hz} Hz")
    return corpus


@contextmanager
def _kinematics(
    config: TrainConfig, corpus: PreparedCorpus, training: tuple[str, ...], fold: str, shipped: str, progress: Progress
) -> Iterator[None]:
    """Within it, proportions and IK are those of this fold's training people: the page's own for the shipped one."""
    if fold == shipped and not config.refit_kinematics:
        yield
        return
    task = progress.add_task(f"IK {fold}", total=config.ik.iterations)
    fitted = kinematics.fit(corpus, training, config.ik, lambda done: progress.update(task, completed=done))
    progress.remove_task(task)
    if fold == shipped:
        skeleton.PROPORTIONS_FILE.write_text(compact_json(fitted.proportions))
        ik.PARAMETERS_FILE.write_text(compact_json(fitted.parameters))
        yield
        return
    with kinematics.used(fitted):
        yield


def _train_paper(
    config: TrainConfig, corpus: PreparedCorpus, training: tuple[str, ...], test: train_paper.PaperFrames, label: str, progress: Progress
) -> tuple[torch.nn.Module, train_paper.LearningCurve]:
    frames = train_paper.frames_of(corpus, training, config.seed)
    curve, watch = train_paper.follow_learning(frames, test)
    return _fit_paper(config, frames, np.arange(len(frames.inputs)), f"paper {label}", progress, watch), curve


def _fit_paper(
    config: TrainConfig,
    frames: train_paper.PaperFrames,
    chosen: np.ndarray,
    label: str,
    progress: Progress,
    watch: Callable[[float, PaperNetwork], None] = lambda *_: None,
) -> torch.nn.Module:
    task = progress.add_task(label, total=config.paper.epochs * 100)
    batches = max(1, 2 * len(chosen) // config.paper.batch)

    def report(epoch: int, iteration: int, loss: float) -> None:
        progress.update(task, completed=100 * epoch + 100 * iteration / batches, description=f"{label} {loss:.4f}")

    network = train_paper.train(frames, chosen, config.paper, report, watch)
    progress.remove_task(task)
    return network


def _frame_random(config: TrainConfig, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The paper's protocol: 20 % of all frames, drawn at random, are the test; their neighbours train. Frames of both."""
    test = np.sort(np.random.default_rng(config.seed).choice(count, count // 5, replace=False))
    return np.setdiff1d(np.arange(count), test), test


def _learned_frame_random(config: TrainConfig, corpus: PreparedCorpus, progress: Progress) -> np.ndarray:
    frames = train_learned.held_out(corpus, tuple(corpus.people), config.learned.window_seconds)
    chosen, test = _frame_random(config, len(frames.inputs))
    task = progress.add_task("learned frame-random", total=config.learned_frame_random.steps)
    network = train_learned.train_frame_random(
        frames, chosen, config.learned_frame_random,
        lambda step, loss: progress.update(task, completed=step + 1, description=f"learned frame-random {loss:.3f}"),
    )  # fmt: skip
    progress.remove_task(task)
    tested = frames.subset(test)
    return train_learned.said_errors_cm(train_paper.predict(network, tested.inputs), tested)


def _paper_frame_random(config: TrainConfig, corpus: PreparedCorpus, progress: Progress) -> np.ndarray:
    frames = train_paper.frames_of(corpus, tuple(corpus.people), config.seed)
    chosen, test = _frame_random(config, len(frames.inputs))
    network = _fit_paper(config, frames, chosen, "paper frame-random", progress)
    return train_paper.joint_errors_cm(train_paper.predict(network, frames.inputs[test]), frames.targets[test])


def _train_learned(config: TrainConfig, corpus: PreparedCorpus, training: tuple[str, ...], label: str, progress: Progress) -> torch.nn.Module:
    task = progress.add_task(f"learned {label}", total=config.learned.steps)
    network = train_learned.train(
        corpus, training, config.learned,
        lambda step, loss, _: progress.update(task, completed=step + 1, description=f"learned {label} {loss:.3f}"),
    )  # fmt: skip
    progress.remove_task(task)
    return network


def _provenance(config: TrainConfig, corpus: PreparedCorpus, training: tuple[str, ...], errors: dict[str, dict[str, float]]) -> export.Provenance:
    source = "generated motion" if config.mocap is None else "CMU Graphics Lab Motion Capture Database and like files"
    return export.Provenance(corpus=source, corpus_hash=corpus.corpus_hash, people=training, seed=config.seed, errors=errors)


def _export(
    config: TrainConfig,
    corpus: PreparedCorpus,
    name: str,
    network: torch.nn.Module,
    out: Path,
    provenance: export.Provenance,
    curve: dict[str, Any] | None,
    fp32_out: Path | None,
) -> None:
    if name == "paper":
        first = corpus.clip_slice(0)
        tracked = corpus.positions[first][:, [4, 7, 10]].astype(np.float64)
        examples = paper_input(tracked, corpus.rotations[first].astype(np.float64)).astype(np.float32)[::7]
    else:
        examples = train_learned.held_out(corpus, provenance.people[:1], config.learned.window_seconds).inputs[::97]
    window, half_life = ((0.0,), None) if name == "paper" else (config.learned.window_seconds, config.correction_half_life)
    export.write(name, network, examples, out, VERSION, window, provenance, half_life, curve, fp32_out)


def _print_table(title: str, columns: Sequence[str], rows: dict[str, dict[str, float]], console: Console) -> None:
    table = Table(title=title)
    table.add_column("")
    for label in columns:
        table.add_column(label, justify="right")
    for row, values in rows.items():
        table.add_row(row, *(f"{values[label]:.2f}" for label in columns))
    console.print(table)


def _arguments() -> TrainConfig:
    parser = argparse.ArgumentParser(prog="npm run train --", description="Trains the networks of the page from motion capture.")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--mocap", type=Path, help="folder with .asf/.amc or .bvh files")
    source.add_argument("--generated", action="store_true", help="generated motion instead, to try the pipeline")
    parser.add_argument("--skeleton", type=Path, help="a skeleton map (docs/evaluation.md)")
    parser.add_argument("--out", type=Path, default=TrainConfig.out)
    parser.add_argument("--fp32", type=Path, help="also writes the networks with 32-bit weights there, to compare with")
    parser.add_argument("--seed", type=int, default=TrainConfig.seed)
    parser.add_argument("--threads", type=int, default=TrainConfig.threads, help="more are faster with large cores; weights differ in the last digits")
    parser.add_argument("--folds", default=",".join(TrainConfig.folds), help="who is held out in turn; the first one's networks are written (default: A,B)")
    parser.add_argument("--cross-validation", type=Path, default=TrainConfig.cross_validation, help="networks and errors of the folds go there")
    parser.add_argument("--stage", choices=TrainConfig.stages, help="this one alone; everybody takes the errors of an earlier cross-validation")
    parser.add_argument("--networks", default=",".join(TrainConfig.networks), help="train and replace only these (default: paper,learned)")
    parser.add_argument("--no-frame-random", action="store_true", help="leave the paper's own protocol out; what an earlier run found stays")
    parser.add_argument("--refit-kinematics", action="store_true", help="also fit the page's body proportions and IK anew")
    parser.add_argument("--ablate", action="store_true", help="instead of all that: the recipe without each of its parts, for docs/training.md")
    parser.add_argument("--leave-one-out", action="store_true", help="instead of all that: everybody held out in turn, for docs/training.md")
    parser.add_argument("--quick", action="store_true", help="a twentieth of the training: does it run?")
    given = parser.parse_args()
    config = TrainConfig(
        mocap=given.mocap,
        out=given.out,
        cross_validation=given.cross_validation,
        stages=(given.stage,) if given.stage else TrainConfig.stages,
        fp32_out=given.fp32,
        skeleton_map=given.skeleton,
        folds=tuple(given.folds.split(",")),
        networks=tuple(given.networks.split(",")),
        frame_random=not given.no_frame_random,
        ablate=given.ablate,
        leave_one_out=given.leave_one_out,
        refit_kinematics=given.refit_kinematics,
        seed=given.seed,
        threads=given.threads,
    )
    if unknown := set(config.folds) - set(people.FOLDS):
        parser.error(f"no fold {', '.join(sorted(unknown))}; there are {', '.join(people.FOLDS)}")
    if unknown := set(config.networks) - set(TrainConfig.networks):
        parser.error(f"no network {', '.join(sorted(unknown))}; there are {', '.join(TrainConfig.networks)}")
    config = replace(config, paper=replace(config.paper, seed=config.seed), learned=replace(config.learned, seed=config.seed))
    if given.quick:
        config = quick(config)
    return config


def quick(config: TrainConfig) -> TrainConfig:
    """The same pipeline, a twentieth of the work."""
    return replace(
        config,
        paper=replace(config.paper, epochs=1, batch=1024),
        learned=replace(config.learned, steps=80, batch=512),
        learned_frame_random=replace(config.learned_frame_random, width=64, steps=200, batch=512),
        ik=replace(config.ik, iterations=2, frames_per_person=200),
    )


if __name__ == "__main__":
    try:
        main(_arguments())
    except MocapError as error:
        sys.exit(str(error))
