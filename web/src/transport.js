// Play and pause, the time, the speed; and the same from the keyboard.
import { SPEEDS } from "./clock.js";
import { el, fixed } from "./dom.js";

const STEPS = 200; // of an arrow key, over the whole

export class Transport {
  constructor(place, clock) {
    this.clock = clock;
    this.play = el("button", { type: "button", class: "play", onclick: () => clock.toggle() });
    this.scrub = el("input", {
      type: "range", min: 0, max: 1, step: "any", "aria-label": "time",
      oninput: () => clock.seek(Number(this.scrub.value)),
    });
    this.readout = el("output", { class: "time" });
    this.speed = el(
      "select", { "aria-label": "speed", title: "speed (up and down arrows)", onchange: () => clock.setSpeed(Number(this.speed.value)) },
      ...SPEEDS.map((speed) => el("option", { value: speed }, `\u00d7 ${speed}`)),
    );
    place.append(this.play, this.scrub, this.readout, this.speed);
    clock.listen(() => this.#update());
    document.addEventListener("keydown", (event) => this.#key(event));
  }

  #update() {
    const { time, start, end, playing, speed } = this.clock;
    this.scrub.min = start;
    this.scrub.max = end;
    this.scrub.value = time;
    this.scrub.setAttribute("aria-valuetext", `${fixed(time, 3)} s`);
    this.readout.textContent = `${fixed(time, 3)} s`;
    this.speed.value = speed;
    this.play.textContent = playing ? "Pause" : "Play";
    this.play.setAttribute("aria-pressed", playing);
    this.play.title = "space";
  }

  #key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.target.closest("select")) return;
    const { clock } = this;
    const step = ((clock.end - clock.start) / STEPS) * (event.shiftKey ? 10 : 1);
    const faster = (by) => {
      const place = SPEEDS.indexOf(clock.speed) - by;
      clock.setSpeed(SPEEDS[Math.min(Math.max(place, 0), SPEEDS.length - 1)]);
    };
    const keys = {
      " ": () => clock.toggle(),
      ArrowLeft: () => clock.step(-step),
      ArrowRight: () => clock.step(step),
      ArrowUp: () => faster(1),
      ArrowDown: () => faster(-1),
      Home: () => clock.step(-Infinity),
      End: () => clock.step(Infinity),
    };
    if (!(event.key in keys)) return;
    event.preventDefault();
    keys[event.key]();
  }
}
