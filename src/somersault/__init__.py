"""Bodies in the air: which spins are stable, and which springs make them so.

    import somersault as so

    spin = so.spin("furrer", pose={"shoulder": 1.4})
    layout = spin.linear(stiffness={"shoulder": 1.2})
    print(layout.stable, layout.energy_signature)

The public names are listed once, in `__init__.pyi`; each is imported when it is first used, so that
starting costs little.
"""

from __future__ import annotations

TYPE_CHECKING = False  # typing's, which takes time to import
if TYPE_CHECKING:
    from typing import Any

__version__ = "0.2.0"


def __getattr__(name: str) -> Any:
    """The list is read when the first name is wanted: the program heeds interrupts before."""
    import lazy_loader

    attached = lazy_loader.attach_stub(__name__, __file__)
    globals().update(zip(("__getattr__", "__dir__", "__all__"), attached, strict=True))
    return globals()[name] if name == "__all__" else attached[0](name)


def __dir__() -> list[str]:
    return list(__getattr__("__all__"))
