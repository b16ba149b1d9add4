// The body in the air: figure, shadow, ground, momentum.
import {
  AmbientLight, Box3, BufferGeometry, DirectionalLight, DoubleSide, Float32BufferAttribute, GridHelper, Group,
  HemisphereLight, Line, LineBasicMaterial, Matrix4, MeshBasicMaterial, Scene, Vector3,
} from "three";
import { Arrow } from "./arrow.js";
import { Canvas } from "./canvas.js";
import { Figure } from "./figure.js";
import { locate, rowAt } from "./moment.js";
import { colors } from "./theme.js";

const LIGHT = new Vector3(0.35, 0.25, 1); // where it comes from
const EYE = new Vector3(0.8, 0.62, 0.3); // front, left, up: from where one first looks
const GHOST = 0.25;

export class FlightScene {
  #shadow = new MeshBasicMaterial({ side: DoubleSide });
  #line = new LineBasicMaterial();
  #grid = new LineBasicMaterial();
  #figures = new Group();

  constructor(place) {
    const scene = new Scene();
    const sun = new DirectionalLight(0xffffff, 2.1);
    sun.position.copy(LIGHT);
    this.arrows = { momentum: new Arrow(), spin: new Arrow() };
    this.vectors = { momentum: true, spin: false };
    scene.add(new AmbientLight(0xffffff, 0.35), new HemisphereLight(0xffffff, 0x8794a8, 1.3), sun);
    scene.add(this.#figures, this.arrows.momentum.object, this.arrows.spin.object);
    this.canvas = new Canvas(place, scene, 32);
    this.follow = true;
    this.centre = new Vector3();
  }

  /** Show a flight, and another as a ghost if one is given: {flight, model}. */
  show(flight, model, ghost) {
    this.flight = flight;
    this.ghost = ghost?.flight;
    for (const old of [this.figure, this.shadow, this.ghostFigure]) old?.dispose();
    this.figure = new Figure(model);
    this.shadow = new Figure(model, { material: this.#shadow });
    this.ghostFigure = ghost && new Figure(ghost.model, { opacity: GHOST });
    this.#figures.clear();
    this.#figures.add(this.figure.object, this.shadow.object);
    if (this.ghostFigure) this.#figures.add(this.ghostFigure.object);
    this.shadow.object.matrixAutoUpdate = false;
    this.#ground();
    this.#path();
    this.setTheme();
  }

  /** Look from the front left, from so far that the body, or its whole way, has room. */
  frame() {
    const { middle, room } = this.#room();
    middle.z -= 0.12 * room; // there is a ground to be seen
    const { camera, controls } = this.canvas;
    const narrow = Math.min(1, camera.aspect);
    const away = (1.12 * room) / (Math.sin((camera.fov * Math.PI) / 360) * narrow);
    controls.target.copy(middle);
    camera.position.copy(EYE).normalize().multiplyScalar(away).add(middle);
    camera.near = away / 200;
    camera.far = away * 60;
    camera.updateProjectionMatrix();
    controls.update();
    this.canvas.draw();
  }

  setFollow(follow) {
    this.follow = follow;
    this.#ground();
    this.at(this.time);
    this.frame();
  }

  /** Where everything is at a time. */
  at(time) {
    this.time = time;
    const { flight } = this;
    const here = locate(flight.times, time);
    const centre = new Vector3(...rowAt(flight.centre, 3, here));
    this.figure.pose(flight, time);
    this.shadow.pose(flight, time);
    if (this.ghostFigure) {
      this.ghostFigure.pose(this.ghost, time);
      const own = new Vector3(...rowAt(this.ghost.centre, 3, locate(this.ghost.times, time)));
      this.ghostFigure.object.position.copy(centre).sub(own); // the turns are compared, not the ways
    }
    const floor = this.follow ? centre.z - 1.25 * flight.reach : flight.floor;
    this.shadow.object.matrix.copy(flattened(floor + 2e-3 * flight.reach));
    this.grid.position.z = floor;
    if (this.follow) {
      const { camera, controls } = this.canvas;
      const moved = centre.clone().sub(this.centre);
      camera.position.add(moved);
      controls.target.add(moved);
      this.grid.position.set(centre.x, centre.y, floor);
      controls.update();
    }
    this.centre.copy(centre);
    for (const [name, arrow] of Object.entries(this.arrows)) {
      const { values, longest } = flight.vectors[name];
      const scale = longest && (1.15 * flight.reach) / longest;
      arrow.place(centre.toArray(), rowAt(values, 3, here).map((value) => scale * value));
      arrow.object.visible &&= this.vectors[name];
    }
    this.canvas.draw();
  }

  /** Whether an arrow is shown, of "momentum" or "spin". */
  setVector(name, shown) {
    this.vectors[name] = shown;
    this.at(this.time);
  }

  setTheme() {
    const { shadow, momentum, spin, edge, path } = colors();
    this.#shadow.color.set(shadow);
    this.#line.color.set(path);
    this.arrows.momentum.color = momentum;
    this.arrows.spin.color = spin;
    this.#grid.color.set(edge);
    this.canvas.draw();
  }

  /** The middle of what is to be seen, and how far it reaches from there. */
  #room() {
    const { centre, reach } = this.flight;
    if (this.follow) return { middle: this.centre.clone(), room: reach };
    const box = new Box3().setFromArray(centre);
    return { middle: box.getCenter(new Vector3()), room: reach + box.getSize(new Vector3()).length() / 2 };
  }

  #ground() {
    const { middle, room } = this.#room();
    this.grid?.removeFromParent();
    this.grid?.geometry.dispose();
    const spacing = niceSpacing(room / 2);
    this.grid = new GridHelper(16 * spacing, 16, 0xffffff, 0xffffff);
    this.grid.geometry.rotateX(Math.PI / 2); // three's ground is its 1-3 plane
    this.grid.material = this.#grid;
    this.grid.position.copy(middle);
    this.canvas.scene.add(this.grid);
    this.onSpacing?.(spacing);
  }

  #path() {
    this.path?.removeFromParent();
    this.path?.geometry.dispose();
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new Float32BufferAttribute(this.flight.centre, 3));
    this.path = new Line(geometry, this.#line);
    this.canvas.scene.add(this.path);
  }
}

/** The matrix that casts everything on the plane at a height, along the light. */
function flattened(height) {
  const { x, y, z } = LIGHT;
  return new Matrix4().set(
    1, 0, -x / z, (height * x) / z,
    0, 1, -y / z, (height * y) / z,
    0, 0, 0, height,
    0, 0, 0, 1,
  );
}

/** 1, 2 or 5 times a power of ten, near a length. */
function niceSpacing(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [1, 2, 5, 10].reduce((best, k) => (k * power <= length * 1.01 ? k * power : best), power);
}
