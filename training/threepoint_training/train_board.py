"""Trains the networks that the board compares with ours, on the people that ours is trained on there: `npm run tool --
train --board`.

A stage is one network. It is written as a whole; a run that was ended goes on from the checkpoint beside it.
"""

import json
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch.nn.attention import SDPBackend, sdpa_kernel
from torch.utils.flop_counter import FlopCounterMode

from . import quaternion
from .arrays import Array
from .augment import AugmentConfig, draw_windows
from .board_networks import NETWORKS, WindowNetwork
from .body_parts import BodyParts
from .chest_features import CHEST_FEATURES
from .export import to_onnx
from .features import FEATURES
from .model import CorrectionNetwork, PaperNetwork
from .motion_files import MocapError
from .prepared_corpus import PreparedCorpus
from .shared_constants import REPOSITORY
from .splits import FOLDS, training_people
from .stage_files import read_stage, write_stage
from .window_features import FRAMES, INPUTS, window_features

Json = dict[str, Any]
Report = Callable[[str], None]

# People whose error ends a training, and who are left out of it: basketball, tai chi, conversation.
VALIDATION = ("006", "012", "018", "019")


@dataclass(frozen=True)
class BoardConfig:
    """out: the folder of the stages, in a folder for each corpus and seed. steps: the budget of a training.

    A training ends earlier when the error on the validation people has not fallen at `patience` looks in a row.
    """

    out: Path = REPOSITORY / ".cache/board"
    networks: tuple[str, ...] = tuple(NETWORKS)
    validation: tuple[str, ...] = VALIDATION
    seed: int = 2460
    steps: int = 40_000
    batch: int = 64
    learning_rate: float = 3e-4
    weight_decay: float = 1e-2
    average_half_life_steps: float = 300.0
    watch_every: int = 100
    watched_windows: int = 1024
    patience: int = 30
    # The bodies, trackers and errors that our network is trained with, in windows of one frame more.
    augment: AugmentConfig = field(default_factory=lambda: AugmentConfig(window_frames=tuple(range(FRAMES + 1))))


@dataclass(frozen=True)
class _Windows:
    """Inputs [N, INPUTS], and in eye heights, from the headset's floor point in its heading: the six joints and both
    wrists [N, 8, 3].
    """

    inputs: torch.Tensor
    targets: torch.Tensor
    eye_height: Array


def _drawn(parts: BodyParts, count: int, config: AugmentConfig, random: np.random.Generator) -> _Windows:
    windows = draw_windows(parts, count, config, random)
    # The wrists to be reached are the tracked ones, which no body may miss.
    joints = np.concatenate([windows.truth, windows.positions[:, -1, 1:]], axis=1)
    from_floor = joints - windows.positions[:, -1, :1] * np.array([1.0, 0.0, 1.0])
    to_heading = quaternion.conjugate(quaternion.heading(windows.rotations[:, -1, 0]))
    turned = quaternion.rotate(np.broadcast_to(to_heading[:, None], (*joints.shape[:2], 4)), from_floor)
    targets = turned / windows.body.eye_height[:, None]
    return _Windows(
        torch.from_numpy(window_features(windows.positions, windows.rotations, windows.body)),
        torch.from_numpy(targets.astype(np.float32)),
        windows.body.eye_height[:, 0],
    )


def _error_cm(network: WindowNetwork, windows: _Windows) -> float:
    """Mean distance [cm] of the six joints, before torso and arm fitting."""
    with torch.no_grad():
        joints = torch.cat([network.joints(inputs) for inputs in windows.inputs.split(256)])
    distances = (joints - windows.targets).norm(dim=-1)[:, :6].numpy()
    return float((distances * windows.eye_height[:, None]).mean()) * 100


class _Training:
    """One network in training, and all that a checkpoint keeps of it."""

    def __init__(self, name: str, config: BoardConfig, parts: BodyParts) -> None:
        torch.manual_seed(config.seed)
        self.config, self.parts = config, parts
        self.random = np.random.default_rng(config.seed)
        self.network, self.averaged = NETWORKS[name](), NETWORKS[name]()
        self.network.normalise(_drawn(parts, config.watched_windows, config.augment, self.random).inputs)
        self.averaged.load_state_dict(self.network.state_dict())
        self.averaged.eval()
        self.optimiser = torch.optim.AdamW(
            self.network.parameters(), lr=config.learning_rate, weight_decay=config.weight_decay
        )
        self.step, self.seconds = 0, 0.0
        self.curve: list[tuple[int, float]] = []
        self.best: dict[str, torch.Tensor] = {}

    @property
    def best_look(self) -> int:
        """The index of the look with the least error on validation people."""
        return min(range(len(self.curve)), key=lambda look: self.curve[look][1])

    @property
    def stopped_falling(self) -> bool:
        """Whether as many looks as the patience came after the best one."""
        return bool(self.curve) and len(self.curve) - 1 - self.best_look >= self.config.patience

    def descend(self) -> None:
        """Does one step."""
        config = self.config
        begun = time.process_time()
        drawn = _drawn(self.parts, config.batch, config.augment, self.random)
        self.network.train()
        loss = (self.network.joints(drawn.inputs) - drawn.targets).norm(dim=-1).mean()
        self.optimiser.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(self.network.parameters(), 1.0)
        self.optimiser.step()
        self.step += 1
        keep = min(0.5 ** (1 / config.average_half_life_steps), self.step / (10 + self.step))
        with torch.no_grad():
            for average, value in zip(self.averaged.parameters(), self.network.parameters(), strict=True):
                average.lerp_(value, 1 - keep)
        self.seconds += time.process_time() - begun

    def look(self, validation: _Windows) -> float:
        """Measures the averaged network on the validation people, and keeps it where it is the best so far."""
        self.curve.append((self.step, round(_error_cm(self.averaged, validation), 3)))
        if self.best_look == len(self.curve) - 1:
            self.best = {name: value.clone() for name, value in self.averaged.state_dict().items()}
        return self.curve[-1][1]

    def save(self, file: Path, options: Json) -> None:
        """Writes the checkpoint as a whole."""
        unfinished = file.with_suffix(".unfinished")
        kept = {name: getattr(self, name) for name in ("step", "seconds", "curve", "best")}
        modules = {name: getattr(self, name).state_dict() for name in ("network", "averaged", "optimiser")}
        chance = {"random": self.random.bit_generator.state, "torch": torch.get_rng_state()}
        torch.save({"options": options, "kept": kept, "modules": modules, "chance": chance}, unfinished)
        unfinished.replace(file)

    def resume(self, file: Path, options: Json, report: Report) -> None:
        """Goes on from a checkpoint; raises MocapError for one that is damaged or of other options."""
        if not file.exists():
            return
        try:
            content = torch.load(file, weights_only=False)
            if content["options"] != options:
                raise ValueError("it is of other options")
            for name, state in content["modules"].items():
                getattr(self, name).load_state_dict(state)
            for name, value in content["kept"].items():
                setattr(self, name, value)
            self.random.bit_generator.state = content["chance"]["random"]
            torch.set_rng_state(content["chance"]["torch"])
        except Exception as error:  # noqa: BLE001 - a damaged file fails in many ways
            raise MocapError(f"{file} does not fit: {error}. Remove it, and this network is trained again.") from error
        report(f"{file.stem}: goes on from step {self.step}")


def multiply_adds(network: torch.nn.Module, inputs: torch.Tensor) -> int:
    """Multiplications with addition of one run, in matrices, convolutions and attention."""
    torch.backends.mha.set_fastpath_enabled(False)
    with torch.no_grad(), sdpa_kernel(SDPBackend.MATH), FlopCounterMode(display=False) as counter:
        network.eval()(inputs)
    return counter.get_total_flops() // 2


def sizes() -> dict[str, Json]:
    """Parameters and multiply-adds of every network of the board."""
    taps = len(AugmentConfig().window_frames)
    networks: dict[str, tuple[torch.nn.Module, tuple[int, ...]]] = {
        "paper": (PaperNetwork(), (1, 2, 3, 3)),
        "learned": (CorrectionNetwork(taps, 192, 0.0), (1, taps * FEATURES + CHEST_FEATURES)),
        **{name: (network(), (1, INPUTS)) for name, network in NETWORKS.items()},
    }
    return {
        name: {
            "parameters": sum(parameter.numel() for parameter in network.parameters()),
            "multiplyAdds": multiply_adds(network, torch.ones(shape)),
        }
        for name, (network, shape) in networks.items()
    }


def _train(
    name: str, config: BoardConfig, options: Json, sides: dict[str, BodyParts], file: Path, report: Report
) -> Json:
    """Trains one network until its error on the validation people stops falling or the budget ends; writes NAME.onnx
    and returns the figures.
    """
    training = _Training(name, config, sides["training"])
    training.resume(file.with_suffix(".checkpoint"), options, report)
    plain = replace(config.augment, recombined=0.0)
    validation = _drawn(sides["validation"], config.watched_windows, plain, np.random.default_rng(config.seed))
    while training.step < config.steps and not training.stopped_falling:
        training.descend()
        if training.step % config.watch_every == 0 or training.step == config.steps:
            error = training.look(validation)
            training.save(file.with_suffix(".checkpoint"), options)
            report(f"{name}: step {training.step}, {error:.2f} cm on the validation people, {training.seconds:.0f} s")
    best = NETWORKS[name]()
    best.load_state_dict(training.best)
    file.with_suffix(".onnx").write_bytes(
        to_onnx(best, validation.inputs[:1].numpy(), "window", "joints").SerializeToString()
    )
    best_step, best_cm = training.curve[training.best_look]
    return {
        "steps": training.step,
        "windows": training.step * config.batch,
        "seconds": round(training.seconds),
        "bestStep": best_step,
        "validationCm": best_cm,
        "stoppedFalling": training.stopped_falling,
        "curve": training.curve,
    }


def folder_of(corpus: PreparedCorpus, config: BoardConfig) -> Path:
    """The folder of the stages on this motion; motion without the people of the board raises MocapError."""
    if missing := sorted({*FOLDS["board"], *config.validation} - set(corpus.people)):
        raise MocapError(f"the board needs people that are missing in this motion: {', '.join(missing)}")
    return config.out / f"{corpus.corpus_hash[:16]}-{config.seed}"


def main(corpus: PreparedCorpus, config: BoardConfig, report: Report = print) -> Path:
    """Runs the trainings that are not finished; returns the folder of their files."""
    people = tuple(name for name in training_people("board", tuple(corpus.people)) if name not in config.validation)
    folder = folder_of(corpus, config)
    folder.mkdir(parents=True, exist_ok=True)
    # The folder, the choice of networks, and when to end change no step.
    same = replace(config, out=Path(), networks=(), steps=0, patience=0)
    options = json.loads(json.dumps({"people": people, **asdict(same)}, default=str))
    sides: dict[str, BodyParts] = {}
    for name in config.networks:
        file = folder / f"{name}.json"
        own = options | {"network": name}
        budget = own | {"steps": config.steps, "patience": config.patience}
        if read_stage(file, budget, report) is not None:
            report(f"{file.stem}: finished before")
            continue
        if not sides:
            who = {"training": people, "validation": config.validation}
            sides = {side: BodyParts(corpus, names, config.augment.balance) for side, names in who.items()}
        write_stage(file, budget, _train(name, config, own, sides, file, report))
    return folder
