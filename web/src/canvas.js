// A canvas that three.js draws on, as large as its place, drawn when something has changed.
import { PerspectiveCamera, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

export class Canvas {
  #asked = false;

  /** @param place an element; throws where the browser has no WebGL */
  constructor(place, scene, fieldOfView) {
    this.scene = scene;
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.camera = new PerspectiveCamera(fieldOfView, 1, 0.01, 2000);
    this.camera.up.set(0, 0, 1);
    place.append(this.renderer.domElement);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.draw());
    this.beforeDraw = () => {};
    new ResizeObserver(() => this.#resize(place)).observe(place);
    this.#resize(place);
  }

  /** Draw in the next frame. */
  draw() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => this.#draw());
  }

  #draw() {
    this.#asked = false;
    this.beforeDraw();
    this.renderer.render(this.scene, this.camera);
  }

  #resize(place) {
    const { clientWidth: width, clientHeight: height } = place;
    if (!width || !height) return;
    this.size = { width, height };
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.setSize(width, height);
    this.#draw(); // at once: resizing has emptied the canvas
  }
}
