"""Bodies in the air: which spins are stable, and which springs make them so.

    import somersault as so

    spin = so.spin("furrer", pose={"shoulder": 1.4})
    layout = spin.linear(stiffness={"shoulder": 1.2})
    print(layout.stable, layout.energy_signature)

The public names are listed once, in `__init__.pyi`; each is imported when it is first used, so that
starting costs little.
"""

import lazy_loader

__version__ = "0.2.0"

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
