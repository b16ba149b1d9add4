"""The programs in scripts/, as modules."""

from __future__ import annotations

import importlib.util
import sys
from functools import cache
from pathlib import Path
from types import ModuleType

SCRIPTS = Path(__file__).parents[1] / "scripts"


@cache
def program(name: str) -> ModuleType:
    """scripts/NAME.py, without running it."""
    spec = importlib.util.spec_from_file_location(name, SCRIPTS / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    if str(SCRIPTS) not in sys.path:  # as when they are run
        sys.path.append(str(SCRIPTS))
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module
