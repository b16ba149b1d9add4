"""The pages of the reproduction: words cannot break them, and the counts are right."""

from __future__ import annotations

import csv

import pytest

import somersault as so
from somersault.thesis import Entry, Motion, Result, reproduce, verdict
from somersault.thesis._drawn import drawn
from somersault.thesis._motion import Written
from somersault.thesis._page import ChapterPage, Section, chapter_page, index_page
from somersault.thesis._page_tables import printed

HOSTILE = {
    "id": "<b>id",
    "where": "<where>",
    "claim": "a < b & c",
    "thesis": "<script>alert(1)</script>",
    "computed": 1.5,
    "unit": "1",
    "tolerance": 0.5,
    "holds": False,
    "note": '"note" <i>',
}


def test_pages_escape_everything():
    table = (("<h>",), [("<c>",)])
    motion = Written("<film>", "<still>", "<page>", "<data>", ("<left>", "<right>"), 0.5)
    section = Section(
        "<s>", "<t>", "<says>", "<ours>", "<p>", [HOSTILE], table, "<csv>", "<drawn>", motion
    )
    chapter = ChapterPage("ch9", "<title>", [section])
    index = index_page([chapter], [("<w>", "<p>", "<c>", "<y>")])
    whole = index + chapter_page(chapter)
    assert whole.count("<script") == 1  # that of the index's filter
    for bad in ("<script>alert", "<film>", "<still>", "<page>", "<data>", "<left>", "<drawn>",
                "<b>id", "<where>", "<says>", "<ours>", "<h>", "<c>", "<w>", "<i>",
                "<s>", "<t>", "<csv>", "<y>"):  # fmt: skip
        assert bad not in whole, bad
    assert whole.count("<title>") == 2
    assert "a &lt; b &amp; c" in index


@pytest.mark.parametrize(
    ("words", "shown"),
    [
        ("0e+00 rad", "0 rad"),
        ("-3.2e-05 rad", "−3.2 × 10⁻⁵ rad"),
        ("1e-10, 2.5e+00", "10⁻¹⁰, 2.5"),
        ("from -0.5 to (-.3, 1.5)", "from −0.5 to (−.3, 1.5)"),
        ("figures 4-7, fig4-9, 2012-13, k-1, --c", "figures 4-7, fig4-9, 2012-13, k-1, --c"),
        ("a < -1", "a &lt; −1"),
    ],
)
def test_numbers_are_printed_as_in_a_book(words, shown):
    assert printed(words) == shown


def test_what_is_beyond_the_thesis_is_marked():
    section = Section("x", "X", "says", "ours", None, [], beyond=True)
    assert "Beyond the thesis" in chapter_page(ChapterPage("ch9", "Nine", [section]))
    assert "Every claim agrees." in index_page([ChapterPage("ch9", "Nine", [section])], [])


@pytest.mark.parametrize(
    ("count", "differ", "missed", "said"),
    [
        (428, 21, 0, "428 claims were checked: 407 agree; 21 of the thesis's numbers are misprints "
         "or differ, each explained."),
        (12, 1, 0, "12 claims were checked: 11 agree; 1 of the thesis's numbers is a misprint or "
         "differs, as explained."),
        (595, 31, 6, "595 claims were checked: 558 agree; 31 of the thesis's numbers are misprints "
         "or differ, each explained, and 6 aims of the package's own are not met."),
        (13, 0, 1, "13 claims were checked: 12 agree; 1 aim of the package's own is not met."),
        (9, 0, 0, "9 claims were checked, and all agree."),
        (0, 0, 0, "Nothing here was checked."),
    ],
)  # fmt: skip
def test_the_verdict_reads_as_a_result(count, differ, missed, said):
    assert verdict(count, differ, missed) == said


def test_aims_of_our_own_are_counted_apart():
    def claim(id, thesis, holds):
        return {**HOSTILE, "id": id, "thesis": thesis, "computed": "x", "holds": holds}

    claims = [
        claim("theirs", "grows", False), claim("ours", "not said", False),
        claim("also", "not said", True), claim("right", "grows", True),
    ]  # fmt: skip
    chapter = ChapterPage("ch9", "Nine", [Section("x", "X", "says", "ours", None, claims)])
    said = (
        "4 claims were checked: 2 agree; 1 of the thesis's numbers is a misprint or differs, as "
        "explained, and 1 aim of the package's own is not met."
    )
    page, index = chapter_page(chapter), index_page([chapter], [])
    assert said in page
    assert said in index
    assert "2 of 4 claims agree; 1 misprinted or different, 1 aim not met" in page
    assert page.count("≠ differs") == page.count("not met</td>") == 1
    assert "".join(f'<td class="n">{n}</td>' for n in (4, 2, 1, 1)) in index
    assert "<b>1</b>misprint or difference, explained" in index
    assert "<b>1</b>aim not met" in index


def test_tables_can_be_downloaded(tmp_path):
    reproduce(["table4-1"], tmp_path, progress=False)
    page = (tmp_path / "ch4.html").read_text(encoding="utf-8")
    assert 'href="tables/table4-1.csv"' in page
    assert "<code>somersault reproduce table4-1</code>" in page
    with (tmp_path / "tables/table4-1.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["parameter", "thesis", "model", "unit"]
    assert rows[1][0] == "mb"
    assert len(rows) == 15


def test_without_an_encoder_there_is_a_still_and_the_page():
    motion = Written(None, "films/x.png", "pages/x.html", "data/x-motion.csv", ("a",), 0.5)
    page = chapter_page(ChapterPage("ch9", "Nine", [Section("x", "X", "s", "o", None, [],
                                                            motion=motion)]))  # fmt: skip
    assert "<video" not in page
    assert '<a href="pages/x.html"><img src="films/x.png"' in page


def test_numbers_of_a_picture_are_those_that_are_drawn():
    from matplotlib.figure import Figure

    figure = Figure()
    left, right, empty, off = figure.subplots(1, 4)
    left.set(title="a, b", xlabel="$x$ (s)", ylabel="y")
    left.plot([0, 1, 2], [3.0, float("nan"), 5.0], color="#0072B2")
    left.plot([0, 1], [1, 1], label="named")
    left.axhline(2.0)
    left.scatter([7], [8], c=[9.0], label="dots")
    left.fill_between([0, 1], [0, 0], [1, 2], label="band")
    right.bar([1, 2], [3, 4], label="bars")
    right.pcolormesh([0, 1, 2], [0, 1], [[5.0, 6.0]])
    right.contour([0, 1], [0, 1], [[0, 1], [0, 1]], levels=[0.5])
    empty.text(0, 0, "words")
    off.plot([1], [1])
    off.axis("off")
    text = drawn(figure)
    rows = list(csv.DictReader(text.splitlines()))
    assert {row["panel"] for row in rows} == {"a, b", "2"}

    def of(**wanted):
        return [
            [row["x"], row["y"], row["value"]]
            for row in rows
            if all(row[name] == value for name, value in wanted.items())
        ]

    assert of(name="blue") == [["0", "3", ""], ["2", "5", ""]]
    assert of(name="named") == [["0", "1", ""], ["1", "1", ""]]
    assert of(name="dots") == [["7", "8", "9"]]
    assert {"x axis": "x (s)", "y axis": "y"}.items() <= rows[0].items()
    assert ["1", "2", ""] in of(name="band")
    assert of(name="bars") == [["1", "3", ""], ["2", "4", ""]]
    assert of(**{"drawn as": "map"}) == [["0.5", "0.5", "5"], ["1.5", "0.5", "6"]]
    assert {row[0] for row in of(**{"drawn as": "contour"})} == {"0.5"}
    assert len(of(**{"drawn as": "line"})) == 4
    assert drawn(Figure()) is None


def test_a_motion_has_film_page_and_numbers(tmp_path):
    flights = {
        name: so.fly("furrer", so.Takeoff(spin=8.6, tilt=tilt), 0.2, samples=5)
        for name, tilt in (("a, little", 0.01), ("</script>", 0.1))
    }
    book = so.fly("book", so.Takeoff(spin=8.6), 0.2, samples=3)

    def entry(name):
        motion = Motion({**flights, "book": book}, 0.5, {"size": (192, 112)})
        return Entry(name, "<b>Title", "ch4", lambda: Result("says", "ours", motion=motion))

    for out in ("one", "two"):
        reproduce(None, tmp_path / out, progress=False, entries=[entry("x")])
    files = sorted(
        str(p.relative_to(tmp_path / "one")) for p in (tmp_path / "one").rglob("*") if p.is_file()
    )
    assert files == [
        "ch4.html", "claims.json", "data/x-motion.csv", "films/x.mp4", "films/x.png", "index.html",
        "pages/x.html",
    ]  # fmt: skip
    for name in files:
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()
    av = pytest.importorskip("av")
    with av.open(str(tmp_path / "one/films/x.mp4")) as film:
        assert len(list(film.decode(video=0))) == 0.2 / 0.5 * 25 + 1
    rows = list(
        csv.DictReader(
            (tmp_path / "one/data/x-motion.csv").read_text(encoding="utf-8").splitlines()
        )
    )
    assert len(rows) == 5 + 5 + 3
    assert [row["motion"] for row in rows[4:6]] == ["a, little", "</script>"]
    last = flights["a, little"]
    assert float(rows[4]["somersault [rad]"]) == pytest.approx(last.landing.somersault, rel=1e-6)
    assert rows[12]["left_shoulder [rad or m]"] == ""  # a book has none
    page = (tmp_path / "one/ch4.html").read_text(encoding="utf-8")
    assert "From left to right: a, little, &lt;/script&gt;, book." in page
    assert 'src="films/x.mp4" poster="films/x.png"' in page
