"""Motions from files: CSV, and OpenSim's `.mot` and `.sto`."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from somersault._core.checks import file_path, truth
from somersault._core.errors import SomersaultError
from somersault.model import Model, load
from somersault.motion._columns import columns_of
from somersault.motion._motion import Motion
from somersault.motion._samples import sampled_motion
from somersault.motion._tables import table_of


def read_motion(
    path: str | os.PathLike[str],
    model: str | Model,
    *,
    names: Mapping[str, str] | None = None,
    ignore_others: bool = False,
    degrees: bool | None = None,
    **options: Any,
) -> Motion:
    r"""A motion of a model from a .csv (.txt, .tsv), .mot or .sto file.

    A CSV has one row of names, `time` among them, then numbers; commas, tabs, semicolons (then
    with decimal commas too) or spaces between. A unit may follow in brackets: time [s] or [ms],
    joint [rad] or [deg], slide [m], [cm] or [mm]. Columns without are seconds, radians and metres.

    Columns are joints' names, or what a left–right pair shares, then with the left side's angles.
    Those of the base's coordinates in the model's file (of a .osim or .bioMod) and the
    `quaternion` and `base_position` of a CSV that a flight saved say where the base was
    (`Motion.base`). A flight's own CSV needs no options, and is not filtered.

    Parameters
    ----------
    path : path-like
        The file.
    model : str or Model
        The model that moved: a shipped name, a model file, or a model.
    names : mapping of str to str, optional
        Other columns, and the joints they are: {"arm_flex_r": "right_shoulder_flexion"}.
    ignore_others : bool, optional
        Leave out columns that are neither; otherwise they are refused.
    degrees : bool, optional
        Whether angles are in degrees, for a file that does not say so itself. It must be given for
        a .mot or .sto file of that kind.
    **options
        Those of `sampled_motion`: cutoff, rate, start, stop, gap, slack.

    Returns
    -------
    Motion
        With the pose of the base where the file has it.

    Raises
    ------
    SomersaultError
        Naming line, column or time, for anything that cannot be read or does not fit the model.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> import somersault as so
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "arm.csv"
    ...     rows = (f"{k / 100},{k / 2}" for k in range(41))
    ...     _ = file.write_text("\n".join(["time,left_shoulder [deg]", *rows]))
    ...     motion = so.read_motion(file, "furrer", cutoff=None)
    >>> motion.joints, motion.end
    (('left_shoulder',), 0.4)
    """
    model = load(model)
    file = file_path("path", path)
    truth("ignore_others", ignore_others)
    if degrees is not None:
        truth("degrees", degrees)
    try:
        table = table_of(file)
        said = table.degrees if degrees is None else degrees
        if None not in (degrees, table.degrees) and degrees != table.degrees:
            raise SomersaultError(
                f"degrees={degrees} contradicts its header, inDegrees="
                f"{'yes' if table.degrees else 'no'}; correct one of them"
            )
        if said is None and file.suffix.lower() in (".mot", ".sto"):
            raise SomersaultError(
                "its header does not say inDegrees=yes or no; say it with degrees, true or false"
            )
        columns = columns_of(
            table, model, {} if names is None else names, ignore_others, said, file.name
        )
        if columns.own:
            options = {"cutoff": None, **options}
        motion = sampled_motion(model, columns.times, columns.rows, source=file.name, **options)
        if columns.base is None:
            return motion
        first = columns.times[0] if options.get("start") is None else options["start"]
        base = columns.base.part(float(first), float(first) + motion.end)
        return replace(motion, base=base)
    except SomersaultError as mistake:
        raise SomersaultError(f"{file.name}: {mistake}") from None
