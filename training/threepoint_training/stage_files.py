"""Figures of stages that are measured once: a file for each, with the options that it depends on."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

Json = dict[str, Any]


def read_stage(file: Path, options: Json | None, report: Callable[[str], None] = print) -> Json | None:
    """The figures of a finished stage; None: there are none, or of other options, or the file is damaged, which is
    reported. options None: any.
    """
    if not file.exists():
        return None
    try:
        content = json.loads(file.read_text())
        figures, asked = content["figures"], content["options"]
    except (ValueError, KeyError, TypeError):
        report(f"{file} is damaged. This stage is measured again.")
        return None
    return figures if options is None or asked == json.loads(json.dumps(options)) else None


def write_stage(file: Path, options: Json, figures: Json) -> None:
    """Writes a stage as a whole or not at all."""
    file.parent.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_suffix(".unfinished")
    unfinished.write_text(json.dumps({"options": options, "figures": figures}, indent=1))
    unfinished.replace(file)
