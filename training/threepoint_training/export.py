"""Networks to ONNX with 8-bit weights, each with its contract."""

import hashlib
import io
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import torch
from numpy.typing import NDArray

from .chest_features import CHEST_FEATURES
from .features import FEATURES
from .flat_weights import flat_file
from .lockbox_log import git_commit
from .quantise import quantise_weights, run
from .residual import OUTPUTS
from .splits import evaluation_only, in_lockbox

OPSET = 17
# What onnxruntime's WASM may differ from its native build: sums in another order.
RUNTIME_TOLERANCE = 1e-4
JOINTS_IN_WORDS = "left elbow, right elbow, left shoulder, right shoulder, chest joint (the paper's spine), hips"


@dataclass(frozen=True)
class Provenance:
    """The origin of a model."""

    corpus: str
    corpus_hash: str
    people: tuple[str, ...]
    seed: int
    errors: dict[str, dict[str, float]]

    def __post_init__(self) -> None:
        for unwanted, why in (
            (evaluation_only(self.people), "evaluation-only"),
            (in_lockbox(self.people), "in the lockbox"),
        ):
            if unwanted:
                raise ValueError(
                    f"{', '.join(unwanted)}: {why} (splits.py), never trained on; no such network is written"
                )


def to_onnx(
    network: torch.nn.Module, example: NDArray[np.float32], input_name: str, output_name: str
) -> onnx.ModelProto:
    """The network in evaluation mode as a graph of batch 1."""
    stream = io.BytesIO()
    torch.onnx.export(
        network.eval(),
        (torch.from_numpy(example),),
        stream,
        input_names=[input_name],
        output_names=[output_name],
        opset_version=OPSET,
        dynamo=False,
        do_constant_folding=True,
    )
    model = onnx.load_from_string(stream.getvalue())
    onnx.checker.check_model(model)
    return model


@dataclass(frozen=True)
class ExportConfig:
    """name: paper or learned; window_seconds: ages of the frames in its input. fp32_out: the same network goes there
    with 32-bit weights, so that the evaluation can compare the two; None: it does not.
    """

    name: str
    version: str
    out: Path
    window_seconds: tuple[float, ...]
    provenance: Provenance
    fp32_out: Path | None = None


def main(config: ExportConfig, network: torch.nn.Module, examples: NDArray[np.float32]) -> dict[str, Any]:
    """Writes NAME.onnx, NAME.json and, of the learned network, NAME.bin; returns the contract. examples, real inputs,
    measure what the 8 bits cost.
    """
    input_name, output_name = ("three_points", "joints") if config.name == "paper" else ("features", "corrections")
    exact = to_onnx(network, examples[:1], input_name, output_name)
    quantised = quantise_weights(exact)
    difference = np.abs(run(exact, examples) - run(quantised, examples)).max()
    quantisation = {
        "scheme": "int8 weights, symmetric per output channel; floating-point activations",
        "maxAbsoluteDifference": round(float(difference), 6),
        "runtimeTolerance": RUNTIME_TOLERANCE,
    }
    contract = _write(config, config.out, quantised, quantisation)
    if config.fp32_out is not None:
        _write(
            config,
            config.fp32_out,
            exact,
            {"scheme": "none: fp32", "maxAbsoluteDifference": 0, "runtimeTolerance": RUNTIME_TOLERANCE},
        )
    return contract


def _write(config: ExportConfig, out: Path, model: onnx.ModelProto, quantisation: dict[str, Any]) -> dict[str, Any]:
    """Graph, contract and, where there is a forward pass without a runtime, flat weights into a folder."""
    content = model.SerializeToString()
    out.mkdir(parents=True, exist_ok=True)
    (out / f"{config.name}.onnx").write_bytes(content)
    contract = _contract(config, content, quantisation)
    if config.name == "learned":
        flat, contract["weights"] = flat_file(model, f"{config.name}.bin")
        (out / f"{config.name}.bin").write_bytes(flat)
    (out / f"{config.name}.json").write_text(json.dumps(contract, indent=2, ensure_ascii=False) + "\n")
    return contract


def _contract(config: ExportConfig, content: bytes, quantisation: dict[str, Any]) -> dict[str, Any]:
    is_paper, provenance = config.name == "paper", config.provenance
    return {
        "name": config.name,
        "version": config.version,
        "file": f"{config.name}.onnx",
        "bytes": len(content),
        "sha256": hashlib.sha256(content).hexdigest(),
        "inputs": [_paper_input() if is_paper else _learned_input(len(config.window_seconds))],
        "outputs": [_paper_output() if is_paper else _learned_output()],
        "rateHz": 60,
        "windowSeconds": config.window_seconds,
        "quantisation": quantisation,
        "trainedOn": {"corpus": provenance.corpus, "corpusHash": provenance.corpus_hash, "people": provenance.people},
        "gitCommit": git_commit(),
        "seed": provenance.seed,
        "errors": {
            protocol: {joint: round(value, 2) for joint, value in row.items()}
            for protocol, row in provenance.errors.items()
        },
    }


def _paper_input() -> dict[str, Any]:
    return {
        "name": "three_points",
        "shape": [1, 2, 3, 3],
        "meaning": "depth: position from the floor under the headset, then Euler angles (Y-X-Z); row: x, y, z; column: head, left hand, right hand",
        "unit": "m, rad",
        "frame": "heading",
    }


def _paper_output() -> dict[str, Any]:
    return {
        "name": "joints",
        "shape": [1, OUTPUTS],
        "meaning": f"{JOINTS_IN_WORDS}: x, y, z from the floor under the headset",
        "unit": "m",
        "frame": "heading",
    }


def _learned_input(taps: int) -> dict[str, Any]:
    return {
        "name": "features",
        "shape": [1, taps * FEATURES + CHEST_FEATURES],
        "meaning": f"{FEATURES} features of docs/estimation.md at each age of windowSeconds, newest first; then {CHEST_FEATURES} in the chest frame",
        "unit": "1",
        "frame": "heading",
    }


def _learned_output() -> dict[str, Any]:
    return {
        "name": "corrections",
        "shape": [1, OUTPUTS],
        "meaning": f"{JOINTS_IN_WORDS}: x, y, z to add to those of IK",
        "unit": "eyeHeight",
        "frame": "chest",
    }
