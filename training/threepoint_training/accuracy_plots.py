"""The figures of docs/accuracy.md: drawn from what `npm run tool -- evaluate` measured, the same bytes for the same
measurements.
"""

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .accuracy_tables import JOINTS, held_out

Json = dict[str, Any]
# The palette of Okabe and Ito, which is safe for colour-blind readers; marks differ as well.
COLOURS = {"ik": "#D55E00", "learned": "#0072B2"}
MARKS = {"ik": "s", "learned": "o"}
# The colours of the paper's figure 7 for docs/paper.md, where the network is blue and IK red.
PAPER_COLOURS = {"ik": "#D55E00", "paper": "#0072B2", "paper-published": "#56B4E9"}
NAMES = {"ik": "IK", "paper": "paper", "learned": "learned", "paper-published": "paper, 3.5"}
TRUTH, FAINT = "#222222", "#999999"
WIDTH = 8.6

STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#555555",
    "axes.titlesize": 10.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.8,
    "lines.linewidth": 1.8,
    "lines.markersize": 5.5,
    "legend.frameon": False,
    "savefig.facecolor": "white",
    # Paths look alike everywhere; the salt keeps the names inside the file from changing.
    "svg.fonttype": "path",
    "svg.hashsalt": "threepoint",
}


def save(figure: Figure, folder: Path, name: str) -> None:
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None, "Creator": None})
    plt.close(figure)


def panels_of(rows: int, columns: int, height: float, **options: Any) -> tuple[Figure, Any]:
    """A figure as wide as the page, with one panel or an array of them."""
    return plt.subplots(rows, columns, figsize=(WIDTH, height), layout="constrained", **options)


def note(axes: Axes, text: str, at: tuple[float, float], **options: Any) -> None:
    """A text beside this place, by an offset in points."""
    axes.annotate(text, at, textcoords="offset points", **options)


def label_ends(axes: Axes, ends: dict[str, tuple[float, str, str]], least: float) -> None:
    """Names at the right ends of lines, {key: (y, text, colour)}, pushed apart to `least` in units of y."""
    placed: list[float] = []
    for _, (y, text, colour) in sorted(ends.items(), key=lambda item: item[1][0]):
        at = max(y, placed[-1] + least) if placed else y
        placed.append(at)
        place = {"xycoords": ("axes fraction", "data"), "xytext": (6, 0), "annotation_clip": False}
        note(axes, text, (1, at), va="center", color=colour, fontweight="bold", **place)


def by_joint(evaluation: Json, folder: Path) -> None:
    """Median and 95th percentile by joint."""
    figures = held_out(evaluation)
    figure, axes = panels_of(1, 1, 4.5)
    rows = np.arange(len(JOINTS))[::-1]
    for number, (method, colour) in enumerate(COLOURS.items()):
        y = rows + 0.18 * (1 - 2 * number)
        median = np.array([figures[method]["joints"][joint]["median"] for joint in JOINTS])
        p95 = np.array([figures[method]["joints"][joint]["p95"] for joint in JOINTS])
        axes.hlines(y, median, p95, color=colour, linewidth=2, alpha=0.55)
        axes.plot(median, y, MARKS[method], color=colour)
        axes.plot(p95, y, "|", color=colour, markersize=9, markeredgewidth=2)
        style = {"va": "center", "color": colour, "fontweight": "bold", "fontsize": 9}
        note(axes, NAMES[method], (p95[-1], y[-1]), xytext=(8, 0), **style)
    axes.set_yticks(rows, JOINTS.values())
    axes.set(xlabel="error [cm]: mark = median, end of the line = 95th percentile", xlim=(0, None))
    axes.margins(x=0.09)
    axes.set_xlim(0, axes.get_xlim()[1])
    axes.grid(axis="y", visible=False)
    axes.set_title("Error by joint, people held out")
    save(figure, folder, "by-joint")


def losses(evaluation: Json, folder: Path) -> None:
    """Error while a hand is not seen, relative to the same frames with it seen."""
    estimators = evaluation["robustness"]["estimators"]
    figure, panels = panels_of(1, 2, 3.3)
    durations = [0] + [loss["milliseconds"] for loss in estimators["ik"]["losses"]]
    at = np.arange(len(durations))
    for axes, figure_name, title, aim in (
        (panels[0], "all", "All joints", 1.3),
        (panels[1], "elbow", "The elbow of that arm", 1.8),
    ):
        ends = {}
        for method, colour in COLOURS.items():
            ratios = [1.0] + [
                loss["during"][f"{figure_name}Cm"] / loss["during"][f"{figure_name}SeenCm"]
                for loss in estimators[method]["losses"]
            ]
            axes.plot(at, ratios, color=colour, marker=MARKS[method])
            ends[method] = (ratios[-1], NAMES[method], colour)
        axes.axhline(aim, color=FAINT, linestyle=(0, (2, 2)), linewidth=1.2, zorder=1)
        note(axes, f"aim for 2 s: {aim} ×", (0, aim), xytext=(0, 4), color="#666666", fontsize=9)
        axes.set_xticks(at, [f"{ms} ms" if ms < 1000 else f"{ms // 1000} s" for ms in durations])
        low, high = axes.get_ylim()
        axes.set(ylim=(min(low, 0.97), high + 0.04 * (high - low)), xlabel="hand not seen for")
        label_ends(axes, ends, 0.065 * (high - low))
        axes.set_title(title)
    panels[0].set_ylabel("error relative to the hand seen")
    save(figure, folder, "lost-hand")


def offsets(evaluation: Json, folder: Path) -> None:
    """What a tracker mounted elsewhere adds to the error, by axis."""
    estimators = evaluation["robustness"]["estimators"]
    figure, panels = panels_of(2, 3, 5.0, sharex=True, sharey=True)
    directions = {
        "headset": ("x: to the right", "y: up", "z: backwards"),
        "grips": ("x: to the outside of the hand", "y: out of the back of the hand", "z: towards the forearm"),
    }
    for row, (tracker, titles) in enumerate(directions.items()):
        for column, axis in enumerate("xyz"):
            axes = panels[row, column]
            axes.axhspan(0.3, 10, color="#f0f0f0", zorder=0)
            axes.axhline(0, color="#555555", linewidth=0.8)
            for method, colour in COLOURS.items():
                clean = estimators[method]["mpjpeCm"]
                points = sorted(
                    [
                        (o["offsetCm"], o["mpjpeCm"] - clean)
                        for o in estimators[method]["offsets"]
                        if o["tracker"] == tracker and o["axis"] == axis
                    ]
                    + [(0, 0.0)]
                )
                axes.plot(*zip(*points, strict=True), color=colour, marker=MARKS[method], label=NAMES[method])
            axes.set_title(f"{tracker}, {titles[column]}", fontsize=8.6)
            axes.set_xticks([-3, -1, 0, 1, 3], ["−3", "−1", "0", "1", "3"])
    lines = [line for axes in panels.flat for line in axes.get_lines()]
    values = np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in lines])
    panels[0, 0].set_ylim(values.min() - 0.06, max(0.4, values.max() + 0.08))
    figure.supxlabel("offset [cm]; grey: more than the aim allows at ±3 cm", fontsize=10)
    figure.supylabel("added to the MPJPE [cm]", fontsize=10)
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper right", ncols=3, labelcolor=list(COLOURS.values()))
    save(figure, folder, "tracker-offset")


def wrong_measures(evaluation: Json, folder: Path) -> None:
    """What a wrong calibration adds to the error."""
    estimators = evaluation["robustness"]["estimators"]
    figure, panels = panels_of(1, 2, 3.2, sharey=True)
    values, all_ends = [0.0], []
    for axes, key, title in ((panels[0], "heights", "Eye height wrong by"), (panels[1], "spans", "Arm span wrong by")):
        if key == "heights":
            axes.axhspan(0.2, 10, color="#f0f0f0", zorder=0)
        axes.axhline(0, color="#555555", linewidth=0.8)
        ends = {}
        for method, colour in COLOURS.items():
            clean = estimators[method]["mpjpeCm"]
            points = sorted([(h["percent"], h["mpjpeCm"] - clean) for h in estimators[method][key]] + [(0, 0.0)])
            axes.plot(*zip(*points, strict=True), color=colour, marker=MARKS[method])
            ends[method] = (points[-1][1], NAMES[method], colour)
            values += [added for _, added in points]
        ticks = [percent for percent, _ in points]
        axes.set_xticks(ticks, [f"{'−' if percent < 0 else ''}{abs(percent)} %" for percent in ticks])
        axes.set_title(title)
        all_ends.append(ends)
    low, high = min(values) - 0.06, max(*values, 0.25) + 0.06
    panels[0].set_ylim(low, high)
    for axes, ends in zip(panels, all_ends, strict=True):
        label_ends(axes, ends, 0.065 * (high - low))
    panels[0].set_ylabel("added to the MPJPE [cm]")
    style = {"ha": "center", "color": "#666666", "fontsize": 9}
    note(panels[0], "more than the aim allows", (0, high), xytext=(0, -11), **style)
    save(figure, folder, "wrong-measures")


BONES = (
    ("hips", "chest", "neck", "head"),
    ("neck", "leftUpperArm", "leftLowerArm", "leftHand"),
    ("neck", "rightUpperArm", "rightLowerArm", "rightHand"),
)


def _seen_from(point: list[float], turn: float) -> tuple[float, float]:
    """A point of a person who faces the beholder, turned by `turn` [rad]: to the right of the page, up."""
    right, height, back = point
    return -(right * np.cos(turn) + back * np.sin(turn)), height


def last_epoch(figures: Json, folder: Path) -> None:
    """The paper's figures 4 and 5: the loss of each batch and the error of the right shoulder in the last epoch."""
    figure, panels = panels_of(1, 2, 3.0)
    losses, heights = figures["loss"], figures["rightShoulderHeightCm"]
    panels[0].plot(np.arange(len(losses)), losses, color=COLOURS["learned"], linewidth=0.9)
    panels[0].set(xlabel="batch of the last epoch", ylabel="MSE, standardised", ylim=(0, None))
    panels[0].set_title("Loss of a batch")
    panels[1].plot(np.linspace(0, len(losses), len(heights)), heights, color=COLOURS["learned"])
    panels[1].set(xlabel="batch of the last epoch", ylabel="MAE [cm]", ylim=(0, None))
    panels[1].set_title("Height of the right shoulder, test frames")
    save(figure, folder, "last-epoch")


def poses(pictures: list[Json], folder: Path, colours: dict[str, str] = COLOURS) -> None:
    """The paper's figure 7: six motions, the truth and what each method makes of it."""
    columns = ["truth", *colours]
    half_width, head_height, head_radius = 0.66, 0.08, 0.095

    def turn_of(picture: Json) -> float:
        """The side that moves is turned to the beholder."""
        return np.radians(40 if picture["motion"].startswith("left") else -40)

    def points(picture: Json) -> np.ndarray:
        return np.array(
            [_seen_from(point, turn_of(picture)) for body in picture["bodies"].values() for point in body.values()]
        )

    # Each row as high as its poses need, at one scale.
    bottoms = [points(picture)[:, 1].min() - 0.06 for picture in pictures]
    tops = [
        max(points(picture)[:, 1].max(), max(body["head"][1] for body in picture["bodies"].values()) + 0.18) + 0.06
        for picture in pictures
    ]
    heights = [top - bottom for top, bottom in zip(tops, bottoms, strict=True)]
    inches_per_metre = WIDTH / len(columns) / (2 * half_width) * 0.93
    figure, panels = plt.subplots(
        len(pictures), len(columns), figsize=(WIDTH, inches_per_metre * sum(heights) * 1.04 + 0.4), squeeze=False,
        gridspec_kw={"height_ratios": heights, "wspace": 0, "hspace": 0.02, "left": 0.06, "right": 0.995, "top": 0.965, "bottom": 0.005},
    )  # fmt: skip
    for row, picture in enumerate(pictures):
        turn = turn_of(picture)
        x_of_all = points(picture)[:, 0]
        centre = (x_of_all.min() + x_of_all.max()) / 2
        for column, method in enumerate(columns):
            axes = panels[row, column]
            for of in dict.fromkeys(("truth", method)):
                body = picture["bodies"][of]
                faint = of != method
                colour = TRUTH if method == "truth" else "#b8b8b8" if faint else colours[method]
                for bone in BONES:
                    x, y = np.transpose([_seen_from(body[joint], turn) for joint in bone])
                    caps = {"solid_capstyle": "round", "solid_joinstyle": "round"}
                    axes.plot(x - centre, y, color=colour, linewidth=4 if faint else 2.4, **caps)
                    if not faint:
                        axes.plot(x - centre, y, ".", color=colour, markersize=7)
                x, y = _seen_from(body["head"], turn)
                line = {"fill": False, "color": colour, "linewidth": 3 if faint else 2.2}
                axes.add_patch(plt.Circle((x - centre, y + head_height), head_radius, **line))
            axes.set_aspect("equal")
            axes.set(xlim=(-half_width, half_width), ylim=(bottoms[row], tops[row]), xticks=[], yticks=[])
            axes.grid(visible=False)
            for spine in axes.spines.values():
                spine.set_visible(False)
            if row == 0:
                colour = TRUTH if method == "truth" else colours[method]
                axes.set_title(NAMES.get(method, "truth"), color=colour, loc="center", fontsize=11)
            if column == 0:
                axes.set_ylabel(picture["motion"].replace(" hand ", " hand\n"), fontsize=9.5, fontweight="bold")
    save(figure, folder, "six-motions")
