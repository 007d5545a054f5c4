"""Networks to ONNX with 8-bit weights, each with its contract."""

import hashlib
import io
import json
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import torch
from numpy.typing import NDArray

from .features import CHEST_FEATURES, FEATURES, OUTPUTS
from .quantise import quantise_weights, run

OPSET = 17
# What onnxruntime's WASM may differ from its native build: sums in another order.
RUNTIME_TOLERANCE = 1e-4
JOINTS_IN_WORDS = "left elbow, right elbow, left shoulder, right shoulder, chest joint (the paper's spine), hips"


@dataclass(frozen=True)
class Provenance:
    """Where a model comes from."""

    corpus: str
    corpus_hash: str
    people: tuple[str, ...]
    seed: int
    errors: dict[str, dict[str, float]]


def to_onnx(network: torch.nn.Module, example: NDArray[np.float32], input_name: str, output_name: str) -> onnx.ModelProto:
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


def git_commit() -> str:
    """The commit of the code that trained, with a mark when it was changed since; 'unknown' outside a repository."""
    folder = Path(__file__).parent
    try:
        commit = subprocess.run(["git", "rev-parse", "HEAD"], cwd=folder, capture_output=True, text=True, check=True).stdout.strip()
        changed = subprocess.run(["git", "diff", "--quiet", "HEAD", "--", "."], cwd=folder, check=False).returncode
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return f"{commit}{'-modified' if changed else ''}"


def write(
    name: str,
    network: torch.nn.Module,
    examples: NDArray[np.float32],
    out: Path,
    version: str,
    window_seconds: tuple[float, ...],
    provenance: Provenance,
    correction_half_life: float | None = None,
    learning_curve: dict[str, list[float]] | None = None,
    fp32_out: Path | None = None,
) -> dict[str, Any]:
    """Writes `name`.onnx and `name`.json into `out`; examples, real inputs, measure what the 8 bits cost.

    With `fp32_out` the same network goes there with its 32-bit weights, so that the evaluation can compare the two.
    """
    input_name, output_name = ("three_points", "joints") if name == "paper" else ("features", "corrections")
    exact = to_onnx(network, examples[:1], input_name, output_name)
    quantised = quantise_weights(exact)
    content = quantised.SerializeToString()
    out.mkdir(parents=True, exist_ok=True)
    (out / f"{name}.onnx").write_bytes(content)
    before, after = run(exact, examples), run(quantised, examples)
    contract: dict[str, Any] = {
        "name": name,
        "version": version,
        "file": f"{name}.onnx",
        "bytes": len(content),
        "sha256": hashlib.sha256(content).hexdigest(),
        "inputs": [_paper_input() if name == "paper" else _learned_input(len(window_seconds))],
        "outputs": [_paper_output() if name == "paper" else _learned_output()],
        "rateHz": 60,
        "windowSeconds": window_seconds,
    }
    if correction_half_life is not None:
        contract["correctionHalfLife"] = correction_half_life
    contract |= {
        "quantisation": {
            "scheme": "int8 weights, symmetric per output channel; floating-point activations",
            "maxAbsoluteDifference": round(float(np.abs(before - after).max()), 6),
            "runtimeTolerance": RUNTIME_TOLERANCE,
        },
        "trainedOn": {"corpus": provenance.corpus, "corpusHash": provenance.corpus_hash, "people": provenance.people},
        "gitCommit": git_commit(),
        "seed": provenance.seed,
        "errors": {protocol: {joint: round(value, 2) for joint, value in row.items()} for protocol, row in provenance.errors.items()},
    }
    if learning_curve is not None:
        contract["learningCurve"] = {"unit": "cm² per coordinate, network alone"} | learning_curve
    (out / f"{name}.json").write_text(_contract_text(contract))
    if fp32_out is not None:
        fp32_out.mkdir(parents=True, exist_ok=True)
        content = exact.SerializeToString()
        (fp32_out / f"{name}.onnx").write_bytes(content)
        unquantised = contract | {
            "bytes": len(content),
            "sha256": hashlib.sha256(content).hexdigest(),
            "quantisation": {"scheme": "none: fp32", "maxAbsoluteDifference": 0, "runtimeTolerance": RUNTIME_TOLERANCE},
        }
        (fp32_out / f"{name}.json").write_text(_contract_text(unquantised))
    return contract


def _contract_text(contract: dict[str, Any]) -> str:
    return json.dumps(contract, indent=2, ensure_ascii=False) + "\n"


def _paper_input() -> dict[str, Any]:
    return {
        "name": "three_points",
        "shape": [1, 2, 3, 3],
        "meaning": "depth: position from the floor under the headset, then Euler angles (Y-X-Z); row: x, y, z; column: head, left hand, right hand",
        "unit": "m, rad",
        "frame": "floor",
    }


def _paper_output() -> dict[str, Any]:
    return {
        "name": "joints",
        "shape": [1, OUTPUTS],
        "meaning": f"{JOINTS_IN_WORDS}: x, y, z from the floor under the headset",
        "unit": "m",
        "frame": "floor",
    }


def _learned_input(taps: int) -> dict[str, Any]:
    return {
        "name": "features",
        "shape": [1, taps * FEATURES + CHEST_FEATURES],
        "meaning": f"{FEATURES} features of docs/estimation.md at each age of windowSeconds, newest first; then {CHEST_FEATURES} of what IK's chest sees",
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
