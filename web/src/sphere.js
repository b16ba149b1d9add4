// The momentum sphere: where the angular momentum points, as seen from the principal axes.
import { Mesh, MeshBasicMaterial, MeshLambertMaterial, Scene, SphereGeometry, Vector3, HemisphereLight } from "three";
import { Arrow } from "./arrow.js";
import { Canvas } from "./canvas.js";
import { energyMap } from "./curves.js";
import { el } from "./dom.js";
import { SphereLines } from "./lines.js";
import { locate, rowAt } from "./moment.js";
import { colors } from "./theme.js";

const NAMES = ["front", "left", "head"];
const EYE = new Vector3(0.72, 0.58, 0.36);
const MIDDLE = new Vector3(0.1, 0.1, 0.24); // of the sphere with its axes
const CHANGED = 2e-3; // of an inertia: below it the curves stay as they are

export class MomentumSphere {
  #drawnFor = [0, 0, 0];

  constructor(place) {
    const scene = new Scene();
    this.ball = new Mesh(
      new SphereGeometry(1, 64, 40),
      new MeshLambertMaterial({ transparent: true, opacity: 0.82, polygonOffset: true, polygonOffsetFactor: 1 }),
    );
    this.minor = new SphereLines(1.6);
    this.major = new SphereLines(1.6);
    this.separatrix = new SphereLines(2.4, 1.005);
    this.whole = new SphereLines(1.6, 1.008);
    this.trail = new SphereLines(3.2, 1.01);
    this.point = new Mesh(new SphereGeometry(0.055, 24, 16), new MeshBasicMaterial());
    this.arrows = NAMES.map((_, k) => {
      const arrow = new Arrow(0.012);
      const way = [0, 0, 0];
      way[k] = 0.42;
      arrow.place(way.map((x) => x / 0.42), way);
      return arrow;
    });
    scene.add(new HemisphereLight(0xffffff, 0xaab6c6, 3), this.ball, this.point);
    for (const part of [this.minor, this.major, this.separatrix, this.whole, this.trail, ...this.arrows]) {
      scene.add(part.object);
    }
    this.canvas = new Canvas(place, scene, 28);
    this.canvas.camera.position.copy(EYE).normalize().multiplyScalar(5.8).add(MIDDLE);
    this.canvas.controls.target.copy(MIDDLE);
    this.canvas.controls.enablePan = false;
    this.canvas.controls.minDistance = 3;
    this.canvas.controls.maxDistance = 14;
    this.labels = NAMES.map((name) => el("span", { class: "axis-label" }, name));
    place.append(...this.labels);
    this.canvas.beforeDraw = () => this.#placeLabels();
    this.canvas.controls.update();
  }

  show(flight) {
    this.flight = flight;
    this.#drawnFor = [0, 0, 0];
    const points = [];
    for (let k = 0; k < flight.sphere.direction.length; k += 3) points.push(Array.from(flight.sphere.direction.slice(k, k + 3)));
    const turning = points.some((point) => Math.hypot(...point) > 0);
    this.whole.draw(turning ? [points] : []);
    this.trail.draw(turning ? [points] : []);
    this.point.visible = turning;
    this.setTheme();
  }

  at(time) {
    const { flight } = this;
    const here = locate(flight.times, time);
    const inertias = rowAt(flight.sphere.inertias, 3, here);
    if (inertias.some((value, k) => Math.abs(value - this.#drawnFor[k]) > CHANGED * value)) {
      this.#drawnFor = inertias;
      this.map = energyMap(inertias);
      for (const name of ["minor", "major", "separatrix"]) this[name].draw(this.map[name]);
    }
    const way = new Vector3(...rowAt(flight.sphere.direction, 3, here));
    this.point.position.copy(way.normalize()).multiplyScalar(1.012);
    this.trail.cut(here.before + (here.share > 0 ? 1 : 0));
    this.canvas.draw();
    return inertias;
  }

  setTheme() {
    const { ball, minor, major, ink, axis, faint } = colors();
    this.ball.material.color.set(ball);
    this.minor.color = minor;
    this.major.color = major;
    this.separatrix.color = ink;
    this.whole.color = faint;
    this.trail.color = axis;
    this.point.material.color.set(ink);
    for (const arrow of this.arrows) arrow.color = faint;
    this.canvas.draw();
  }

  #placeLabels() {
    const { width, height } = this.canvas.size ?? {};
    if (!width || !this.labels) return;
    this.labels.forEach((label, k) => {
      const tip = new Vector3().setComponent(k, 1.52).project(this.canvas.camera);
      const x = inside(((tip.x + 1) / 2) * width, label.offsetWidth / 2, width);
      const y = inside(((1 - tip.y) / 2) * height, label.offsetHeight / 2, height);
      label.style.transform = `translate(${x}px, ${y}px) translate(-50%, -50%)`;
    });
  }
}

/** A middle from which something so wide to both sides stays between 0 and the end. */
function inside(middle, half, end) {
  return Math.max(half, Math.min(middle, end - half));
}
