// Which claims are shown: by words, by chapter, and by whether they hold. Without this script all are.
const form = document.getElementById("filter");
const table = document.getElementById("all-claims");
const words = form.elements.words;
const chapter = form.elements.chapter;
const holds = form.elements.holds;
const rows = [...table.querySelectorAll("tr[data-holds]")].map((row) => ({
  row,
  text: row.textContent.toLowerCase(),
  chapter: row.closest("tbody").dataset.chapter,
  holds: row.dataset.holds,
}));

function show() {
  const wanted = words.value.toLowerCase().split(/\s+/).filter(Boolean);
  let shown = 0;
  for (const one of rows) {
    const fits =
      (!chapter.value || chapter.value === one.chapter) &&
      (!holds.value || holds.value === one.holds) &&
      wanted.every((word) => one.text.includes(word));
    one.row.hidden = !fits;
    shown += fits;
  }
  for (const part of table.tBodies) part.hidden = !part.querySelector("tr[data-holds]:not([hidden])");
  form.elements.count.value = `${shown} of ${rows.length} claims`;
}

form.hidden = false;
form.addEventListener("input", show);
form.addEventListener("submit", (event) => event.preventDefault());
form.addEventListener("reset", () => setTimeout(show));
show();
