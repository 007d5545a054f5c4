"""Fits body proportions and IK parameters without the people held out, so that errors are those of new people."""

import json
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from . import fit_ik, fit_proportions, skeleton, solve_ik
from .fit_ik import FitIkConfig
from .prepared_corpus import PreparedCorpus


@dataclass(frozen=True)
class Kinematics:
    """Body proportions and IK parameters, with the keys of their files in src/threepoint/core."""

    proportions: dict[str, Any]
    parameters: dict[str, Any]


def fit(
    corpus: PreparedCorpus, people: tuple[str, ...], config: FitIkConfig, report: Callable[[int], None] = lambda _: None
) -> Kinematics:
    """Fitted on these people; report(iterations done)."""
    proportions = fit_proportions.fit(corpus, people)
    sample = fit_ik.sample(corpus, people, proportions, config.frames_per_person, config.seed)
    return Kinematics(proportions, fit_ik.fit(sample, config, lambda iteration, _: report(iteration + 1)))


@contextmanager
def used(fitted: Kinematics) -> Iterator[None]:
    """A context in which skeletons and IK use these instead of the page's."""
    saved = skeleton.load_proportions, solve_ik.load_parameters
    skeleton.load_proportions, solve_ik.load_parameters = (lambda: fitted.proportions), (lambda: fitted.parameters)
    try:
        yield
    finally:
        skeleton.load_proportions, solve_ik.load_parameters = saved


def write(fitted: Kinematics) -> None:
    """Replaces the page's body proportions and IK parameters."""
    skeleton.PROPORTIONS_FILE.write_text(_compact_json(fitted.proportions))
    solve_ik.PARAMETERS_FILE.write_text(_compact_json(fitted.parameters))


def _compact_json(content: Any) -> str:
    """JSON with a line per innermost list."""

    def on_one_line(match: re.Match[str]) -> str:
        return f"[{' '.join(match[1].split())}]"

    return re.sub(r"\[\s+([^\[\]{}]*?)\s+\]", on_one_line, json.dumps(content, indent=2)) + "\n"
