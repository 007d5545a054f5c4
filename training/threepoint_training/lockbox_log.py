"""The log of the lockbox. Motion of its people is read only through `permitted`, which adds a row to the log."""

import json
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from .motion_files import MocapError, Source
from .splits import in_lockbox

LOG = Path(__file__).parents[1] / "lockbox-log.json"


@dataclass(frozen=True)
class LockboxAccess:
    """The purpose of reading motion of lockbox people, and the log that records it."""

    purpose: str
    log: Path = LOG


def permitted(
    sources: Sequence[Source], named: tuple[str, ...] | None, access: LockboxAccess | None
) -> tuple[list[Source], list[str]]:
    """The sources that may be read, and a sentence about those that are left out.

    People of the lockbox are read only where `named` has them, and a row of the log then states the purpose. Without
    `access` that is refused.
    """
    people = in_lockbox([source.person for source in sources])
    if not people:
        return list(sources), []
    if named is None:
        others = [source for source in sources if source.person not in people]
        if not others:
            raise MocapError(f"all of this motion is of lockbox people ({', '.join(people)}); name them with --people")
        return others, [f"{', '.join(people)}: in the lockbox; left out"]
    if access is None:
        raise MocapError(f"{', '.join(people)}: in the lockbox; only an evaluation that is logged may read them")
    append(access.log, {**stamp(), "people": list(people), "purpose": access.purpose})
    return list(sources), []


def stamp() -> dict[str, Any]:
    """The first columns of a row: date and commit."""
    return {"date": datetime.now(UTC).date().isoformat(), "gitCommit": git_commit()}


def append(log: Path, row: dict[str, Any]) -> None:
    """Adds a row to the log."""
    rows = json.loads(log.read_text()) if log.exists() else []
    log.write_text(json.dumps([*rows, row], indent=2) + "\n")


def git_commit() -> str:
    """The commit of the code that runs, with a mark when it was changed since; 'unknown' outside a repository."""
    folder = Path(__file__).parent
    try:
        commit = subprocess.run(
            ["git", "rev-parse", "HEAD"], cwd=folder, capture_output=True, text=True, check=True
        ).stdout.strip()
        changed = subprocess.run(["git", "diff", "--quiet", "HEAD", "--", "."], cwd=folder, check=False).returncode
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return f"{commit}{'-modified' if changed else ''}"
