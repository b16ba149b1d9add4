"""A flight's history as a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from somersault.flight._flight import Flight

# Okabe and Ito's palette: told apart by colour-blind readers too.
_COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
_MOST_LABELS = 14


def plot(flight: Flight) -> Figure:
    """Somersaults, tilt and twist, and joint angles against time."""
    from matplotlib.figure import Figure

    data = flight.dataset
    time = data["time"].values
    joints = data["joint"].values.tolist()
    rows = 3 if joints else 2
    picture = Figure(figsize=(7.2, 1.2 + 1.9 * rows), layout="constrained")
    axes = picture.subplots(rows, sharex=True)
    axes[0].plot(time, data["somersault"].values / (2 * np.pi), color=_COLORS[0])
    axes[0].set_ylabel("somersaults")
    for name, color in zip(("tilt", "twist"), _COLORS, strict=False):
        axes[1].plot(time, data[name].values, color=color)
        axes[1].annotate(f" {name}", (time[-1], float(data[name][-1])), color=color, va="center")
    axes[1].set_ylabel("tilt, twist (rad)")
    for index, name in enumerate(joints):
        color = _COLORS[index % len(_COLORS)]
        values = data["joint_angle"].values[:, index]
        axes[2].plot(time, values, color=color)
        if len(joints) <= _MOST_LABELS:
            axes[2].annotate(f" {name}", (time[-1], values[-1]), color=color, va="center")
    if joints:
        axes[2].set_ylabel("joints (rad, m)")
    for ax in axes:
        ax.spines[["top", "right"]].set_visible(False)
    axes[-1].set_xlabel("time (s)")
    axes[0].set_title(f"{data.attrs['model']}, ended by {data.attrs['ended']}", loc="left")
    return picture
