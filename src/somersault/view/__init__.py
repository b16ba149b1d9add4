"""Pictures and films of models, of their motions and of their stability.

What is drawn of a motion is a `somersault.history.History`, whatever made it.

The names are listed in `__init__.pyi` and imported when they are first used: a flight that nobody
looks at loads no renderer.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
