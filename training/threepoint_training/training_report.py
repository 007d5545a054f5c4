"""What a run of the training shows while it goes on, and the tables at its end."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

LABELS = ("left elbow", "right elbow", "left shoulder", "right shoulder", "spine", "pelvis")

# Takes how much of a task is done, and how it is called from now on (None: as before).
Advance = Callable[[float, str | None], None]


class TrainingReport:
    """Progress bars of a run, and the errors it found: MPJPE [cm] by row and joint."""

    def __init__(self, console: Console) -> None:
        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
        self.console = console
        self.progress = Progress(*columns, console=console, transient=not console.is_terminal)
        self.rows: dict[str, dict[str, float]] = {}

    def found(self, row: str, errors: np.ndarray) -> None:
        """Keeps errors [F, 6] in cm as a row, and prints their mean at once: a run takes most of an hour."""
        self.rows[row] = {"mean": float(errors.mean())} | dict(zip(LABELS, errors.mean(axis=0).tolist(), strict=True))
        self.console.print(f"{row}: {self.rows[row]['mean']:.2f} cm")

    @contextmanager
    def task(self, label: str, total: float | None) -> Iterator[Advance]:
        """A bar for as long as the block lasts."""
        task = self.progress.add_task(label, total=total)
        yield lambda done, description: self.progress.update(task, completed=done, description=description or label)
        self.progress.remove_task(task)

    def table(self, title: str, columns: Iterable[str], rows: dict[str, dict[str, float]]) -> None:
        """Prints figures by row and column."""
        labels = list(columns)
        table = Table(title=title)
        table.add_column("")
        for label in labels:
            table.add_column(label, justify="right")
        for row, values in rows.items():
            table.add_row(row, *(f"{values[label]:.2f}" for label in labels))
        self.console.print(table)
