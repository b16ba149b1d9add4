"""Versions of what computes, here and on workers."""

from __future__ import annotations

from functools import cache
from importlib.metadata import PackageNotFoundError, version


@cache
def versions(packages: tuple[str, ...]) -> dict[str, str]:
    """The versions of some packages that this process has; "(none)" for one that is missing."""
    installed = {}
    for name in packages:
        try:
            installed[name] = version(name)
        except PackageNotFoundError:
            installed[name] = "(none)"
    return installed
