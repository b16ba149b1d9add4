"""Bodies in the air: which spins are stable, and which springs make them so.

    import somersault as so

    spin = so.spin("furrer", axis=2, pose={"shoulder": 1.4})
    layout = spin.linear(stiffness={"shoulder": 1.2})
    print(layout.stable, layout.energy_signature)

Names are imported when they are first used, so that starting costs little.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from somersault import ensembles, stability
    from somersault._errors import SomersaultError, SomersaultWarning
    from somersault.dynamics import Equations
    from somersault.ensembles import Ensemble, Report, Vary, ensemble
    from somersault.flight import (
        Flight,
        JointTakeoff,
        Landing,
        Motion,
        Takeoff,
        compliant,
        deviated_flight,
        fly,
        read_motion,
        sampled_motion,
        with_momentum,
    )
    from somersault.model import (
        Body,
        Joint,
        Model,
        athlete,
        athlete_from_measurements,
        load,
        named_pose,
        shipped,
    )
    from somersault.stability import LinearSpin, Mode, Spin, spin

__version__ = "0.1.0"

_HOME = {
    "SomersaultError": "somersault._errors",
    "SomersaultWarning": "somersault._errors",
    "Body": "somersault.model",
    "Joint": "somersault.model",
    "Model": "somersault.model",
    "athlete": "somersault.model",
    "athlete_from_measurements": "somersault.model",
    "load": "somersault.model",
    "named_pose": "somersault.model",
    "shipped": "somersault.model",
    "Equations": "somersault.dynamics",
    "Ensemble": "somersault.ensembles",
    "Report": "somersault.ensembles",
    "Vary": "somersault.ensembles",
    "ensemble": "somersault.ensembles",
    "Flight": "somersault.flight",
    "JointTakeoff": "somersault.flight",
    "Landing": "somersault.flight",
    "Motion": "somersault.flight",
    "Takeoff": "somersault.flight",
    "compliant": "somersault.flight",
    "read_motion": "somersault.flight",
    "sampled_motion": "somersault.flight",
    "with_momentum": "somersault.flight",
    "deviated_flight": "somersault.flight",
    "fly": "somersault.flight",
    "LinearSpin": "somersault.stability",
    "Mode": "somersault.stability",
    "Spin": "somersault.stability",
    "spin": "somersault.stability",
}

__all__ = [
    "Body",
    "Ensemble",
    "Equations",
    "Flight",
    "Joint",
    "JointTakeoff",
    "Landing",
    "LinearSpin",
    "Mode",
    "Model",
    "Motion",
    "Report",
    "SomersaultError",
    "SomersaultWarning",
    "Spin",
    "Takeoff",
    "Vary",
    "athlete",
    "athlete_from_measurements",
    "compliant",
    "deviated_flight",
    "ensemble",
    "ensembles",
    "fly",
    "load",
    "named_pose",
    "read_motion",
    "sampled_motion",
    "shipped",
    "spin",
    "stability",
    "with_momentum",
]


def __getattr__(name: str) -> Any:
    if name in ("ensembles", "stability"):
        return import_module(f"somersault.{name}")
    if name in _HOME:
        return getattr(import_module(_HOME[name]), name)
    raise AttributeError(f"module 'somersault' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
