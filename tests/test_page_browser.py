"""Pages in Chromium, from a file and without a network. Under software WebGL what is asserted is
what is shown, never how fast."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import browsers
import numpy as np
import pytest
from browsers import DESKTOP, NEEDS_CHROMIUM, PHONE

import somersault as so
from somersault import rigid
from somersault.view import page

pytestmark = [pytest.mark.slow, NEEDS_CHROMIUM]
EVIL = '<img src=x onerror="window.hurt=1"></script><script>window.hurt=1</script>'
Open = Callable[..., Any]


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A page of a twisting gymnast, a rigid book, and a book with hostile names."""
    twist = so.arm_tilt(duration=0.8).fly()
    book = so.fly("book", so.Takeoff(spin=6.0, tilt=0.1, velocity=(0.5, 0.0, 2.5)), 0.5)
    layout = so.fly("furrer", so.Takeoff(spin=8.0, tilt=0.05), 1.0)
    bodies = tuple(
        replace(body, joints=tuple(replace(joint, name=EVIL + joint.name) for joint in body.joints))
        for body in layout.model.bodies
    )
    hostile = replace(layout, model=replace(layout.model, name=EVIL, bodies=bodies))
    out = tmp_path_factory.mktemp("page") / "a.html"
    page([twist, book, hostile], out, labels=["twist", "book", EVIL], title=f"Three {EVIL}")
    return out


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with browsers.started() as browser:
        yield browser


@pytest.fixture
def opened(browser: Any, file: Path) -> Iterator[Open]:
    """Opens the page; in the end nothing may have gone wrong in it."""
    said: list[str] = []
    tabs = []

    def open_page(size: tuple[int, int] = DESKTOP, scheme: str = "light", **more: Any) -> Any:
        tabs.append(browsers.opened(browser, file, said, size, scheme, **more))
        settle(tabs[-1])
        return tabs[-1]

    yield open_page
    for tab in tabs:
        tab.context.close()
    assert said == []


def settle(tab: Any) -> None:
    """Wait until what was asked for is drawn."""
    tab.evaluate("() => new Promise((done) => setTimeout(() => requestAnimationFrame(done), 250))")


def seek(tab: Any, time: float) -> None:
    tab.evaluate("(time) => somersault.viewer.clock.seek(time)", time)
    settle(tab)


def now(tab: Any) -> float:
    return tab.evaluate("somersault.viewer.clock.time")


def marks(tab: Any) -> list[float]:
    """Where the time lines stand, pixels."""
    lines = tab.locator(".time-line")
    return [lines.nth(k).bounding_box()["x"] for k in range(lines.count())]


def picture(tab: Any, place: str = ".scene .canvas", keep: str = "") -> np.ndarray:
    """Pixels of a part of the page, (height, width, 3)."""
    from io import BytesIO

    from PIL import Image

    data = tab.locator(place).screenshot()
    browsers.keep(tab, keep)
    return np.asarray(Image.open(BytesIO(data)).convert("RGB")).astype(int)


def differing(one: np.ndarray, two: np.ndarray) -> float:
    """Share of the pixels that clearly differ."""
    return float(np.mean(np.abs(one - two).max(-1) > 24))


def test_scrubbing_changes_the_picture(opened: Open) -> None:
    tab = opened()
    first, ball = picture(tab, keep="desktop"), picture(tab, ".sphere .canvas")
    line = tab.locator(".time-line").first.bounding_box()["x"]
    slider = tab.locator("input[type=range]").bounding_box()
    tab.mouse.click(slider["x"] + 0.7 * slider["width"], slider["y"] + slider["height"] / 2)
    settle(tab)
    assert now(tab) == pytest.approx(0.56, abs=0.02)
    assert differing(first, picture(tab, keep="scrubbed")) > 0.005
    assert differing(ball, picture(tab, ".sphere .canvas")) > 0.001
    assert tab.locator(".time-line").first.bounding_box()["x"] > line + 100
    seek(tab, 0.0)
    assert differing(first, picture(tab)) < 1e-3


def test_the_body_is_drawn_and_orbits(opened: Open) -> None:
    tab = opened()
    before = picture(tab)
    colours = len(np.unique(before.reshape(-1, 3), axis=0))
    assert colours > 100  # shaded surfaces
    box = tab.locator(".scene canvas").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    tab.mouse.move(x, y)
    tab.mouse.down()
    tab.mouse.move(x + 120, y + 20, steps=4)
    tab.mouse.up()
    settle(tab)
    assert differing(before, picture(tab)) > 0.01
    tab.get_by_role("button", name="reset view").click()
    settle(tab)
    assert differing(before, picture(tab)) < 1e-3


def test_pointing_at_a_chart_sets_the_time(opened: Open) -> None:
    tab = opened()
    box = tab.locator(".u-over").nth(1).bounding_box()
    tab.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    assert now(tab) == pytest.approx(0.4, abs=0.005)
    assert marks(tab) == pytest.approx([box["x"] + box["width"] / 2 - 1] * 4, abs=2)
    tab.locator("#ghost").select_option("1")  # lays the charts out anew
    settle(tab)
    assert marks(tab) == pytest.approx([box["x"] + box["width"] / 2 - 1] * 4, abs=2)
    assert "turns" in tab.locator(".key output").first.inner_text()


def test_keyboard(opened: Open) -> None:
    tab = opened()
    tab.keyboard.press("ArrowRight")
    assert now(tab) == pytest.approx(0.8 / 200)
    tab.keyboard.press("Shift+ArrowRight")
    assert now(tab) == pytest.approx(11 * 0.8 / 200)
    tab.keyboard.press("ArrowLeft")
    assert now(tab) == pytest.approx(10 * 0.8 / 200)
    for _ in range(9):
        tab.keyboard.press("ArrowDown")
    assert tab.locator(".transport select").input_value() == "0.02"
    tab.keyboard.press("Space")
    tab.wait_for_function("somersault.viewer.clock.time > 0.0405")
    assert now(tab) < 0.5  # it was played slowly
    tab.keyboard.press("Space")
    held = now(tab)
    settle(tab)
    assert now(tab) == held
    tab.keyboard.press("End")
    assert now(tab) == pytest.approx(0.8)
    tab.keyboard.press("Home")
    assert now(tab) == 0
    tab.get_by_role("button", name="Play").focus()
    tab.keyboard.press("Space")  # once, not for the button and again for the page
    assert tab.evaluate("somersault.viewer.clock.playing")


def test_switching_flights(opened: Open) -> None:
    tab = opened()
    first = picture(tab)
    tab.locator("#flight").select_option("1")
    settle(tab)
    assert differing(first, picture(tab, keep="second")) > 0.01
    assert tab.evaluate("somersault.viewer.flight.label") == "book"
    assert tab.locator(".panel").count() == 3  # no joints
    assert tab.evaluate("somersault.viewer.clock.end") == pytest.approx(0.5)
    tab.locator("#flight").evaluate("(choice) => choice.blur()")
    tab.keyboard.press("1")
    settle(tab)
    seek(tab, 0.0)
    assert differing(first, picture(tab)) < 1e-3
    tab.locator("#ghost").select_option("2")
    settle(tab)
    assert differing(first, picture(tab, keep="ghost")) > 0.005


def test_the_whole_way_can_be_seen(opened: Open) -> None:
    tab = opened()
    tab.keyboard.press("2")
    tab.get_by_label("follow").uncheck()
    seek(tab, 0.1)
    low = picture(tab, keep="way")
    seek(tab, 0.3)
    assert differing(low, picture(tab)) > 0.002


def test_joints_are_chosen(opened: Open) -> None:
    tab = opened()
    tab.locator("summary").click()
    key = tab.locator("button.key[aria-pressed=false]").first
    name = key.locator("span").inner_text()
    before = picture(tab, ".panel:last-child .plot")
    key.click()
    pressed = tab.locator("button.key[aria-pressed=true]", has_text=name)
    assert pressed.count() == 1
    assert differing(before, picture(tab, ".panel:last-child .plot")) > 0.001


def test_names_are_shown_and_not_run(opened: Open) -> None:
    tab = opened()
    tab.keyboard.press("3")
    settle(tab)
    assert tab.evaluate("window.hurt") is None
    assert tab.locator("img").count() == 0
    assert EVIL in tab.locator("h1").inner_text()
    assert EVIL in tab.title()
    assert any(EVIL in name for name in tab.locator(".key span").all_inner_texts())
    assert tab.locator("#flight option").nth(2).inner_text() == EVIL


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_it_fits_and_has_the_right_colours(
    opened: Open, size: tuple[int, int], scheme: str
) -> None:
    tab = opened(size, scheme, device_scale_factor=2 if size == PHONE else 1)
    seek(tab, 0.4)
    assert tab.evaluate("document.documentElement.scrollWidth <= innerWidth")
    corner = picture(tab, ".scene", keep=f"{size[0]}_{scheme}")[12, 200]
    assert (corner.mean() > 128) == (scheme == "light")
    play = tab.get_by_role("button", name="Play").bounding_box()
    assert 0 <= play["y"] <= size[1] - play["height"]  # in reach without scrolling
    tab.get_by_role("button", name="light / dark").click()
    settle(tab)
    corner = picture(tab, ".scene")[12, 200]
    assert (corner.mean() > 128) == (scheme == "dark")


def test_energy_curves_are_those_of_the_package(opened: Open) -> None:
    tab = opened()
    inertias = [3.0, 1.0, 2.0]
    for energy, axis in ((0.45, 1), (0.18, 0)):  # round the minor and the major axis
        ours = rigid.energy_curve(inertias, energy, 721)
        theirs = tab.evaluate(
            "([inertias, energy, axis]) => somersault.energyCurve(inertias, energy, axis)",
            [inertias, 2 * energy, axis],
        )
        for one, two in zip(ours, np.array(theirs), strict=True):
            away = np.linalg.norm(two[:, None] - one[None], axis=-1).min(1)
            assert away.max() < 0.01  # of points of the one from the next of the other
            assert np.abs(np.sum(two**2 / inertias, 1) / 2 - energy).max() < 1e-12


def test_without_webgl_the_charts_remain(browser: Any, file: Path) -> None:
    context = browser.new_context(offline=True)
    tab = context.new_page()
    tab.add_init_script(
        "HTMLCanvasElement.prototype.getContext = ((was) => function (kind, ...more)"
        " { return kind.startsWith('webgl') ? null : was.call(this, kind, ...more); })"
        "(HTMLCanvasElement.prototype.getContext);"
    )
    tab.goto(file.as_uri())
    settle(tab)
    assert "no WebGL" in tab.locator(".scene").inner_text()
    tab.keyboard.press("End")
    assert now(tab) == pytest.approx(0.8)
    context.close()


def test_arrows_can_be_shown(opened: Open) -> None:
    tab = opened()
    seek(tab, 0.3)
    momentum = picture(tab)
    tab.get_by_label("spin").check()
    settle(tab)
    both = picture(tab, keep="arrows")
    assert differing(momentum, both) > 5e-4
    tab.get_by_label("angular momentum").uncheck()
    settle(tab)
    assert differing(both, picture(tab)) > 5e-4
