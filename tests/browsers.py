"""A Chromium that is there, driven by Playwright, with the network off."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
NEEDS_CHROMIUM = pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not there")
DESKTOP, PHONE = (1280, 800), (390, 844)
_PICTURES = os.environ.get("SOMERSAULT_PICTURES")  # a folder to keep screenshots in
_QUIET = [
    "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync",
]  # fmt: skip


@contextmanager
def started() -> Iterator[Any]:
    """A browser."""
    playwright = pytest.importorskip("playwright.sync_api", reason="Playwright is not there")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=_QUIET)
        yield browser
        browser.close()


def opened(
    browser: Any, file: Path, said: list[str], size: tuple[int, int], scheme: str, **more: Any
) -> Any:
    """A tab with a file; errors and requests that leave the machine are appended to `said`."""
    context = browser.new_context(
        viewport={"width": size[0], "height": size[1]}, color_scheme=scheme, offline=True, **more
    )
    tab = context.new_page()
    tab.on("console", lambda message: message.type == "error" and said.append(message.text))
    tab.on("pageerror", lambda error: said.append(str(error)))
    tab.on("request", lambda ask: ask.url.startswith("http") and said.append(ask.url))
    tab.goto(file.as_uri())
    return tab


def keep(tab: Any, name: str, **options: Any) -> None:
    """Keep a screenshot, where somebody wants to look at it."""
    if _PICTURES and name:
        Path(_PICTURES).mkdir(parents=True, exist_ok=True)
        tab.screenshot(path=Path(_PICTURES) / f"{name}.png", **options)
