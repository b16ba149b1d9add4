"""A model file compiled by MuJoCo: here, or as a process that can be given limits.

Run as a program with a file and limits it writes what the file holds to its standard output, one
line of JSON and then MuJoCo's own binary model. It imports little, so that it starts soon.
"""

from __future__ import annotations

import json
import os
import sys
import warnings
from typing import Any

from somersault._core.limited import limit

REFUSALS = (ValueError, RuntimeError, OSError, AttributeError)
MOST_COMPILED = 2**29  # bytes of what is handed back


def compile_file(path: str) -> tuple[Any, list[bool]]:
    """The compiled model in a file, and of each body whether its inertia is made from its geoms.

    Any of `REFUSALS`, or MuJoCo's own FatalError, says what is wrong with the file.
    """
    import mujoco

    mujoco.set_mju_user_warning(lambda _: None)  # else it writes a log where one stands
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what MuJoCo will do otherwise one day
            spec = mujoco.MjSpec.from_file(os.fsencode(path))  # a name may be no text
            # Room for a simulation, which there will be none of: some ask for many gigabytes.
            spec.memory = spec.njmax = spec.nconmax = spec.nstack = -1
            return spec.compile(), _from_shapes(spec)
    except mujoco.FatalError as error:
        raise RuntimeError(str(error)) from None


def _from_shapes(spec: Any) -> list[bool]:
    """Of each body, in the order of their numbers, whether its inertia is made from its geoms."""
    import mujoco

    way = spec.compiler.inertiafromgeom
    always = way == mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE
    never = way == mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    bodies = sorted(spec.bodies, key=lambda body: body.id)
    return [
        len(body.geoms) > 0 and (always or not (never or body.explicitinertial)) for body in bodies
    ]


def _main(path: str, *limits: str) -> None:
    import mujoco
    import numpy as np

    limit(*limits)
    with os.fdopen(os.dup(1), "wb") as out:
        silent = os.open(os.devnull, os.O_WRONLY)
        os.dup2(silent, 1)  # what libraries print is no part of the answer
        try:
            model, from_shapes = compile_file(path)
            size = int(mujoco.mj_sizeModel(model))
            if size > MOST_COMPILED:
                raise MemoryError
        except (MemoryError, *REFUSALS) as error:
            said = "bad_alloc" if isinstance(error, MemoryError) else str(error)
            out.write(json.dumps({"error": said or type(error).__name__}).encode())
            return
        binary = np.empty(size, np.uint8)
        mujoco.mj_saveModel(model, None, binary)
        out.write(json.dumps({"from_shapes": from_shapes}).encode() + b"\n" + binary.tobytes())


if __name__ == "__main__":
    _main(*sys.argv[1:])
