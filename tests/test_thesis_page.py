"""The pages of the reproduction: words cannot break them, and the counts are right."""

from __future__ import annotations

import csv

import pytest

from somersault.thesis import reproduce, verdict
from somersault.thesis._page import ChapterPage, Section, chapter_page, index_page

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
    section = Section("<s>", "<t>", "<says>", "<ours>", "<p>", [HOSTILE], table, "<csv>")
    chapter = ChapterPage("ch9", "<title>", [section])
    index = index_page([chapter], [("<w>", "<p>", "<c>", "<y>")])
    whole = index + chapter_page(chapter)
    for bad in ("<script", "<b>id", "<where>", "<says>", "<ours>", "<h>", "<c>", "<w>", "<i>",
                "<s>", "<t>", "<csv>", "<y>"):  # fmt: skip
        assert bad not in whole, bad
    assert whole.count("<title>") == 2
    assert "a &lt; b &amp; c" in index


def test_what_is_beyond_the_thesis_is_marked():
    section = Section("x", "X", "says", "ours", None, [], beyond=True)
    assert "Beyond the thesis" in chapter_page(ChapterPage("ch9", "Nine", [section]))
    assert "Every claim agrees." in index_page([ChapterPage("ch9", "Nine", [section])], [])


@pytest.mark.parametrize(
    ("count", "differ", "said"),
    [
        (428, 21, "428 claims were checked: 407 agree; 21 of the thesis's numbers are misprints or "
         "differ, each explained."),
        (12, 1, "12 claims were checked: 11 agree; 1 of the thesis's numbers is a misprint or "
         "differs, as explained."),
        (9, 0, "9 claims were checked, and all agree."),
        (0, 0, "Nothing here was checked."),
    ],
)  # fmt: skip
def test_the_verdict_reads_as_a_result(count, differ, said):
    assert verdict(count, differ) == said


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
