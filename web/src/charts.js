// Quantities against time, one panel for each unit, with one time line through all of them.
import uPlot from "uplot";
import { el, fixed } from "./dom.js";
import { locate, rowAt } from "./moment.js";
import { colors } from "./theme.js";

const WHOLE = window.matchMedia("(min-width: 1000px) and (min-height: 620px)"); // as in page.css
const LOWEST = 112;
const HIGHEST = 230;
const LEGEND = 32;
const NUMBERS = 54; // pixels beside a chart; as the padding of .legend in page.css
const TIME_AXIS = 36; // more, of the last panel
const UNITS = { "\u00b0": "\u00b0", 1: "" }; // as they stand after a number, the others after a space
const LEAST_ROOM = 1e-2; // of any unit: what stands still is a line, not its rounding
const FONT = "12px system-ui, sans-serif";

export class Charts {
  #panels = [];

  /** @param seek called with a time that was pointed at */
  constructor(place, seek) {
    this.place = place;
    this.seek = seek;
    new ResizeObserver(() => this.#panels.forEach((panel) => panel.resize(this.#height()))).observe(place);
  }

  /** @param panels [{title, unit, digits, color, series: [{name, values, shown}]}]; color: of the first line */
  show(times, panels) {
    for (const panel of this.#panels) panel.destroy();
    this.place.replaceChildren();
    this.#panels = panels.map((panel, k) => new Panel(this.place, times, panel, this.seek, k === panels.length - 1, this.#height(panels.length)));
  }

  /** Of each panel: as high as there is room beside the scene, and not too low on a phone. */
  #height(count = this.#panels.length) {
    if (!WHOLE.matches) return LOWEST; // the page is as long as its charts, not the other way round
    const room = (this.place.clientHeight - TIME_AXIS) / count - LEGEND;
    return Math.min(Math.max(room, LOWEST), HIGHEST);
  }

  at(time) {
    this.time = time;
    for (const panel of this.#panels) panel.at(time);
  }

  setTheme() {
    for (const panel of this.#panels) panel.draw();
    this.at(this.time);
  }
}

class Panel {
  constructor(place, times, panel, seek, last, height) {
    Object.assign(this, { times, panel, seek, last, height });
    this.shown = panel.series.map((series) => series.shown);
    this.marker = el("div", { class: "time-line" });
    this.plotPlace = el("div", { class: "plot" });
    this.legend = el("div", { class: "legend" });
    place.append(el("section", { class: "panel" }, this.legend, this.plotPlace));
    this.draw();
  }

  draw() {
    this.plot?.destroy();
    const { ink, edge: grid, lines } = colors();
    const { unit, title } = this.panel;
    const axis = { stroke: ink, grid: { stroke: grid, width: 1 }, ticks: { stroke: grid, width: 1, size: 4 }, font: FONT, labelFont: FONT, gap: 3 };
    const options = {
      ...this.#size(),
      padding: [6, 12, this.last ? 0 : 6, 0],
      legend: { show: false },
      cursor: { drag: { x: false, y: false }, points: { show: false }, y: false },
      scales: { x: { time: false, range: [this.times[0], this.#end()] }, y: { range: padded } },
      axes: [
        this.last ? { ...axis, size: 22, label: "time (s)", labelSize: 18 } : { ...axis, size: 0, values: [] },
        { ...axis, label: `${title} (${unit})`, size: NUMBERS, labelSize: 18, labelGap: 2, space: 26, values: tidy },
      ],
      hooks: { draw: [() => this.#mark()] }, // it lays itself out later than it is asked to
      series: [
        {},
        ...this.panel.series.map((series, k) => ({
          label: series.name, stroke: this.#color(k, lines), width: 1.8, pxAlign: 0, show: this.shown[k],
          dash: k >= lines.length ? [6, 4] : undefined, points: { show: this.times.length < 2 },
        })),
      ],
    };
    this.plotPlace.replaceChildren();
    this.plot = new uPlot(options, [this.times, ...this.panel.series.map((series) => series.values)], this.plotPlace);
    this.plot.over.append(this.marker);
    this.#pointing(this.plot.over);
    this.#legend(lines);
  }

  resize(height) {
    this.height = height;
    this.plot.setSize(this.#size());
  }

  at(time) {
    this.time = time;
    this.#mark();
    const here = locate(this.times, time);
    const unit = UNITS[this.panel.unit] ?? `\u00a0${this.panel.unit}`;
    this.panel.series.forEach(({ values }, k) => {
      this.values[k].textContent = `${fixed(rowAt(values, 1, here)[0], this.panel.digits)}${unit}`;
    });
  }

  #mark() {
    if (this.time === undefined || !this.plot) return;
    this.marker.style.transform = `translateX(${this.plot.valToPos(this.time, "x")}px)`;
  }

  destroy() {
    this.plot.destroy();
  }

  #color(k, lines) {
    return lines[(this.panel.color + k) % lines.length];
  }

  #size() {
    const width = Math.max(160, this.plotPlace.clientWidth);
    return { width, height: this.height + (this.last ? TIME_AXIS : 0) };
  }

  #end() {
    const end = this.times[this.times.length - 1];
    return end > this.times[0] ? end : this.times[0] + 1;
  }

  /** Pointing at the chart, with a mouse or a finger, sets the time. */
  #pointing(over) {
    over.style.touchAction = "pan-y";
    const move = (event) => this.seek(this.plot.posToVal(event.clientX - over.getBoundingClientRect().left, "x"));
    over.addEventListener("pointerdown", (event) => {
      over.setPointerCapture(event.pointerId);
      move(event);
    });
    over.addEventListener("pointermove", (event) => event.buttons && move(event));
  }

  /** Names with their values now; where there are several, each can be left out. */
  #legend(lines) {
    this.values = this.panel.series.map(() => el("output"));
    const many = this.panel.series.length > 1;
    const items = this.panel.series.map((series, k) => {
      const swatch = el("i", { style: `background:${this.#color(k, lines)}` });
      const inside = [swatch, el("span", {}, series.name), this.values[k]];
      if (!many) return el("span", { class: "key" }, ...inside);
      const choose = (event) => {
        this.shown[k] = !this.shown[k];
        this.plot.setSeries(k + 1, { show: this.shown[k] });
        event.currentTarget.setAttribute("aria-pressed", this.shown[k]);
      };
      return el("button", { class: "key", type: "button", "aria-pressed": String(this.shown[k]), onclick: choose }, ...inside);
    });
    const first = items.filter((_, k) => this.panel.series[k].shown);
    const others = items.filter((_, k) => !this.panel.series[k].shown);
    const more = el("details", {}, el("summary", {}, `${others.length} more`), ...others);
    this.legend.replaceChildren(...first, ...(others.length ? [more] : []));
  }
}

/** Numbers on an axis, without the dust of their rounding and with a real minus sign. */
function tidy(_, values) {
  return values.map((value) => String(Number(value.toPrecision(6))).replaceAll("-", "\u2212"));
}

/** Room above and below, and for what stands still. */
function padded(_, low, high) {
  if (low === null || high === null) return [-1, 1];
  const room = Math.max(0.08 * (high - low), 1e-3 * Math.max(Math.abs(low), Math.abs(high)), LEAST_ROOM);
  return [low - room, high + room];
}
