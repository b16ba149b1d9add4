"""What OpenSim makes of `.osim` files, as JSON: a program of its own.

OpenSim's package carries a CasADi that cannot be loaded into one process with ours.

    python opensim_reference.py < request.json > answer.json

The request is a list of `{"file", "hold", "poses"}`, each pose a dict of coordinates' values by
name; those that it leaves out stand at their defaults. With `hold`, axes of custom joints that
move along curves are held where the default pose has them. The answer has for each file its
coordinates and, for each pose, the centre of mass, where all bodies are, and the mass matrix over
speeds u, with what each unit speed is in rates of the coordinates and in velocities of the bodies.
"""

from __future__ import annotations

import json
import os
import sys
from typing import Any

_AXES = [f"{kind}{number}" for kind in ("rotation", "translation") for number in (1, 2, 3)]


def answer(opensim: Any, request: dict[str, Any]) -> dict[str, Any]:
    try:
        model = opensim.Model(request["file"])
        model.initSystem()
    except Exception as trouble:
        return {"error": str(trouble)}
    if request["hold"]:
        hold_curves(opensim, model)
    state = model.initSystem()
    coordinates = [model.getCoordinateSet().get(i) for i in range(model.getNumCoordinates())]
    found: dict[str, Any] = {
        "coordinates": {
            c.getName(): {
                "default": c.getDefaultValue(),
                "range": [c.getRangeMin(), c.getRangeMax()],
                "clamped": c.getDefaultClamped(),
                "locked": c.getDefaultLocked(),
            }
            for c in coordinates
        },
        "mass": model.getTotalMass(state),
        "poses": [],
    }
    for pose in request["poses"]:
        state = model.initSystem()
        for coordinate in coordinates:
            coordinate.setLocked(state, False)
        for coordinate in coordinates:
            value = pose.get(coordinate.getName(), coordinate.getDefaultValue())
            coordinate.setValue(state, value, False)
        found["poses"].append(at_pose(opensim, model, state, coordinates))
    return found


def hold_curves(opensim: Any, model: Any) -> None:
    """Replace every function of an axis that is no line by its value in the default pose."""
    defaults = {}
    for i in range(model.getNumCoordinates()):
        coordinate = model.getCoordinateSet().get(i)
        defaults[coordinate.getName()] = coordinate.getDefaultValue()
    for i in range(model.getConstraintSet().getSize()):
        coupler = opensim.CoordinateCouplerConstraint.safeDownCast(model.getConstraintSet().get(i))
        if coupler is not None:
            by = coupler.getIndependentCoordinateNames().get(0)
            value = coupler.getFunction().calcValue(opensim.Vector(1, defaults[by]))
            defaults[coupler.getDependentCoordinateName()] = value  # scale_factor is 1
    for i in range(model.getJointSet().getSize()):
        joint = opensim.CustomJoint.safeDownCast(model.getJointSet().get(i))
        for name in _AXES if joint is not None else ():
            axis = getattr(joint.updSpatialTransform(), f"upd_{name}")()
            names = axis.getCoordinateNamesInArray()
            if names.getSize() == 0:
                continue
            function = axis.getFunction()
            values = [function.calcValue(opensim.Vector(1, float(q))) for q in (-1.0, 0.1, 1.2)]
            if abs((values[1] - values[0]) / 1.1 - (values[2] - values[1]) / 1.1) > 1e-9:
                at = function.calcValue(opensim.Vector(1, defaults[names.get(0)]))
                axis.set_function(opensim.Constant(at))


def at_pose(opensim: Any, model: Any, state: Any, coordinates: list[Any]) -> dict[str, Any]:
    model.realizePosition(state)
    com = model.calcMassCenterPosition(state)
    bodies = [model.getBodySet().get(i) for i in range(model.getBodySet().getSize())]
    matrix = opensim.Matrix()
    model.getMatterSubsystem().calcM(state, matrix)
    count = state.getNU()
    rates, motions = [], []
    frames = {body.getName(): frame(body.getTransformInGround(state)) for body in bodies}
    for speed in range(count):
        unit = opensim.Vector(count, 0.0)
        unit.set(speed, 1.0)
        state.setU(unit)
        model.realizeVelocity(state)
        rates.append({c.getName(): c.getQDotValue(state) for c in coordinates})
        motions.append({b.getName(): velocity(b.getVelocityInGround(state)) for b in bodies})
    return {
        "com": [com.get(k) for k in range(3)],
        "frames": frames,
        "mass_matrix": [[matrix.get(r, c) for c in range(count)] for r in range(count)],
        "rates": rates,
        "motions": motions,
    }


def frame(transform: Any) -> list[list[float]]:
    turn, place = transform.R().asMat33(), transform.p()
    return [[turn.get(r, c) for c in range(3)] + [place.get(r)] for r in range(3)]


def velocity(spatial: Any) -> list[float]:
    """Angular, then linear velocity of a body's origin, in the ground's axes."""
    return [spatial.get(part).get(k) for part in range(2) for k in range(3)]


def main() -> None:
    out = os.dup(1)
    os.dup2(2, 1)  # OpenSim talks
    import opensim

    opensim.Logger.setLevelString("Off")
    found = [answer(opensim, request) for request in json.load(sys.stdin)]
    os.write(out, json.dumps(found).encode())


if __name__ == "__main__":
    main()
