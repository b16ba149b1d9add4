// Scene, charts and sphere of some flights, tied to one clock. Where the flights come from is not
// its business: a page carries them, a studio asks for them.
import { Charts } from "./charts.js";
import { Clock } from "./clock.js";
import { el, fixed } from "./dom.js";
import { FlightScene } from "./scene.js";
import { MomentumSphere } from "./sphere.js";
import { onTheme, toggleTheme, usePalette } from "./theme.js";
import { Transport } from "./transport.js";

const NO_WEBGL = "This browser has no WebGL, so there is no picture here; the charts work without it.";

export class Viewer {
  /** @param data {title, palette, models, flights} */
  constructor(place, data) {
    usePalette(data.palette);
    this.data = data;
    this.clock = new Clock();
    this.#lay(place);
    this.charts = new Charts(this.chartPlace, (time) => {
      this.clock.playing = false;
      this.clock.seek(time);
    });
    this.scene = drawn(this.scenePlace, () => new FlightScene(this.scenePlace));
    this.sphere = drawn(this.spherePlace, () => new MomentumSphere(this.spherePlace));
    if (this.scene) this.scene.onSpacing = (spacing) => (this.scale.textContent = `grid ${spacing} m`);
    new Transport(this.transportPlace, this.clock);
    this.clock.listen(() => this.#at(this.clock.time));
    onTheme(() => [this.scene, this.charts, this.sphere].forEach((part) => part?.setTheme()));
    document.addEventListener("keydown", (event) => this.#key(event));
    this.select(0);
  }

  /** Show one of the flights. */
  select(index) {
    const flight = this.data.flights[index];
    const first = this.index === undefined;
    this.index = index;
    this.flight = flight;
    this.choice.value = index;
    const ghost = this.data.flights[Number(this.ghost.value)];
    const other = ghost && ghost !== flight ? { flight: ghost, model: this.data.models[ghost.model] } : undefined;
    this.scene?.show(flight, this.data.models[flight.model], other);
    this.sphereCard.hidden = !flight.sphere; // on a fixed base angular momentum is not kept
    if (flight.sphere) this.sphere?.show(flight);
    this.charts.show(flight.times, flight.panels);
    this.clock.range(flight.times[0], flight.times[flight.times.length - 1]);
    if (first) this.clock.seek(flight.times[0]);
    this.scene?.frame();
  }

  #at(time) {
    const { flight } = this;
    this.scene?.at(time);
    this.charts.at(time);
    const inertias = flight.sphere && this.sphere?.at(time);
    if (inertias) this.facts.textContent = facts(flight, inertias);
  }

  #lay(place) {
    const { title, flights } = this.data;
    const options = () => flights.map((flight, k) => el("option", { value: k }, flight.label));
    this.choice = el("select", { id: "flight", "aria-label": "flight", onchange: () => this.select(Number(this.choice.value)) }, ...options());
    this.ghost = el("select", { id: "ghost", "aria-label": "ghost", onchange: () => this.select(this.index) }, el("option", { value: -1 }, "none"), ...options());
    const several = flights.length > 1;
    const header = el(
      "header", {}, el("h1", {}, title),
      several ? el("label", {}, "flight ", this.choice) : "",
      several ? el("label", {}, "ghost ", this.ghost) : "",
      el("button", { type: "button", class: "quiet theme", onclick: toggleTheme, title: "light or dark" }, "light / dark"),
    );
    this.scale = el("span", { class: "note scale" });
    this.scenePlace = el("div", { class: "canvas" });
    this.spherePlace = el("div", { class: "canvas" });
    this.chartPlace = el("div", { class: "charts" });
    this.transportPlace = el("div", { class: "transport" });
    this.facts = el("p", { class: "note facts" });
    const box = (label, change, on = true) =>
      el("label", {}, el("input", { type: "checkbox", checked: on && "", onchange: (event) => change(event.target.checked) }), label);
    const tools = el(
      "div", { class: "tools" },
      box("follow", (on) => this.scene?.setFollow(on)),
      box(el("b", { class: "momentum" }, "angular momentum"), (on) => this.scene?.setVector("momentum", on)),
      box(el("b", { class: "spin" }, "spin"), (on) => this.scene?.setVector("spin", on), false),
      el("button", { type: "button", class: "quiet", onclick: () => this.scene?.frame() }, "reset view"),
    );
    const legend = el(
      "p", { class: "note" },
      el("b", { class: "minor" }, "round the minor axis"), " \u00b7 ", el("b", { class: "separatrix" }, "separatrix"), " \u00b7 ",
      el("b", { class: "major" }, "round the major axis"), " \u00b7 ", el("b", { class: "trail" }, "this flight"),
    );
    this.sphereCard = el(
      "section", { class: "card sphere" }, el("h2", {}, "Momentum sphere"), this.spherePlace, legend, this.facts,
    );
    place.append(
      header,
      el("main", {},
        el("section", { class: "card scene" }, el("h2", {}, "Motion"), this.scenePlace, tools, this.scale),
        this.sphereCard,
        el("section", { class: "card histories" }, el("h2", {}, "Against time"), this.chartPlace),
      ),
      el("footer", {}, this.transportPlace),
    );
  }

  #key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const digit = Number(event.key);
    if (digit >= 1 && digit <= this.data.flights.length) this.select(digit - 1);
  }
}

function facts(flight, inertias) {
  const order = flight.jointsMove ? "of the moment; the curves go with the joints" : "of the body as it is held";
  const numbers = inertias.map((value) => Number(value.toPrecision(3))).join(", ");
  const { values, longest } = flight.vectors.momentum;
  const size = longest ? `h = ${spanned(values, longest)} kg m\u00b2/s` : "no angular momentum";
  return `Principal axes ${order}. I = ${numbers} kg m\u00b2, ${size}.`;
}

// A length that stays, or from where to where one goes: a robot's momentum is another on the ground.
function spanned(values, longest) {
  const lengths = [];
  for (let k = 0; k < values.length; k += 3) lengths.push(Math.hypot(values[k], values[k + 1], values[k + 2]));
  const shown = (value) => String(Number(value.toPrecision(3)));
  const [least, most] = [Math.min(...lengths), longest];
  return least > 0.99 * most ? shown(most) : `${shown(least)} to ${shown(most)}`;
}

function drawn(place, make) {
  try {
    return make();
  } catch (error) {
    place.replaceChildren(el("p", { class: "note missing" }, NO_WEBGL));
    return undefined;
  }
}
