"""The report in Chromium, from its folder and without a network."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import browsers
import pytest
from browsers import DESKTOP, NEEDS_CHROMIUM, PHONE

import somersault as so
from somersault.thesis import Entry, Motion, Result, reproduce, statement
from somersault.thesis._registry import ENTRIES

pytestmark = [pytest.mark.slow, NEEDS_CHROMIUM]
EVIL = '<img src=x onerror="window.hurt=1">'


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two entries of the thesis, and one with a motion and hostile words."""
    out = tmp_path_factory.mktemp("report")

    def moving() -> Result:
        flights = {
            name: so.fly("furrer", so.Takeoff(spin=8.6, tilt=tilt), 0.4)
            for name, tilt in ((EVIL, 0.01), ("more", 0.1))
        }
        claim = statement("evil", EVIL, EVIL, "a", "b", False, EVIL)
        return Result(EVIL, "ours", (claim,), motion=Motion(flights, 0.5))

    known = [entry for entry in ENTRIES if entry.id in ("table4-1", "fig4-5", "table5-1")]
    reproduce(None, out, progress=False, entries=[*known, Entry("evil", EVIL, "ch6", moving)])
    return out


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with browsers.started() as browser:
        yield browser


@pytest.fixture
def opened(browser: Any, report: Path) -> Iterator[Any]:
    said: list[str] = []
    tabs = []

    def open_page(name: str, size: tuple[int, int] = DESKTOP, scheme: str = "light") -> Any:
        tabs.append(browsers.opened(browser, report / name, said, size, scheme))
        return tabs[-1]

    yield open_page
    for tab in tabs:
        tab.context.close()
    assert said == []


def shown(tab: Any) -> list[str]:
    """IDs of the claims that are to be seen in the table of all."""
    rows = tab.locator("#all-claims tr[data-holds]:visible td.id")
    return rows.all_inner_texts()


def test_claims_are_searched(opened: Any) -> None:
    tab = opened("index.html")
    every = shown(tab)
    assert len(every) > 30
    tab.get_by_label("words").fill("furrer")
    browsers.keep(tab, "report_search")
    tab.get_by_label("words").fill("K1 fig4")
    some = shown(tab)
    assert 0 < len(some) < len(every)
    assert tab.locator("output").inner_text() == f"{len(some)} of {len(every)} claims"
    tab.get_by_role("button", name="clear").click()
    tab.wait_for_function("n => document.querySelector('output').value.startsWith(n)",
                          arg=f"{len(every)} of")  # fmt: skip
    tab.get_by_label("whether they agree").select_option("no")
    differ = shown(tab)
    assert 0 < len(differ) < len(every)
    assert tab.locator("#all-claims td.yes:visible").count() == 0
    tab.get_by_label("chapter", exact=True).select_option("ch6")
    assert shown(tab) == ["evil"]
    assert tab.locator("#all-claims tbody:visible").count() == 1
    tab.get_by_label("words").fill("nothing of the kind")
    assert shown(tab) == []


def test_a_claim_leads_to_where_it_is_explained(opened: Any) -> None:
    tab = opened("index.html")
    tab.locator("#all-claims a", has_text="fig4-5.k1").first.click()
    assert tab.url.endswith("ch4.html#fig4-5.k1")
    assert tab.locator("tr:target td.id").is_visible()


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
@pytest.mark.parametrize("name", ["index.html", "ch4.html", "ch6.html"])
def test_it_fits_and_has_the_right_colours(
    opened: Any, name: str, size: tuple[int, int], scheme: str
) -> None:
    tab = opened(name, size, scheme)
    browsers.keep(tab, f"report_{name[:-5]}_{size[0]}_{scheme}", full_page=True)
    assert tab.evaluate("document.documentElement.scrollWidth <= innerWidth")
    back = tab.evaluate("getComputedStyle(document.body).backgroundColor")
    assert back == {"light": "rgb(255, 255, 255)", "dark": "rgb(23, 28, 36)"}[scheme]


def test_the_film_plays_and_its_page_opens(opened: Any) -> None:
    tab = opened("ch6.html")
    film = tab.locator("video")
    film.evaluate("(video) => { video.preload = 'auto'; video.load(); }")
    tab.wait_for_function("document.querySelector('video').readyState >= 2", timeout=120_000)
    assert film.evaluate("(video) => video.duration") == pytest.approx(0.83, abs=0.05)
    assert film.evaluate("(video) => video.videoWidth") == 1120
    tab.get_by_role("link", name="the page", exact=True).click()
    tab.wait_for_function("window.somersault")
    assert tab.locator("#flight option").all_inner_texts() == [EVIL, "more"]


def test_words_are_shown_and_not_run(opened: Any) -> None:
    for name in ("index.html", "ch6.html"):
        tab = opened(name)
        assert EVIL in tab.locator("body").inner_text()
        assert tab.evaluate("window.hurt") is None
        assert tab.locator("img[src=x]").count() == 0
