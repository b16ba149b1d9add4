// Lines of a thickness in pixels on the sphere: strong in front, faint behind.
import { GreaterDepth, Group, LessEqualDepth } from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";

export class SphereLines {
  #front;
  #back;

  constructor(width, lift = 1.004, faint = 0.28) {
    this.lift = lift;
    this.#front = new LineMaterial({ linewidth: width, depthFunc: LessEqualDepth });
    this.#back = new LineMaterial({
      linewidth: width / 2, depthFunc: GreaterDepth, transparent: true, opacity: faint, depthWrite: false,
    });
    this.object = new Group();
  }

  set color(color) {
    this.#front.color.set(color);
    this.#back.color.set(color);
  }

  /** @param curves lists of points of the unit sphere */
  draw(curves) {
    const numbers = [];
    for (const curve of curves) {
      for (let k = 1; k < curve.length; k++) {
        for (const point of [curve[k - 1], curve[k]]) numbers.push(...point.map((x) => this.lift * x));
      }
    }
    this.object.children[0]?.geometry.dispose();
    this.object.clear();
    this.count = numbers.length / 6;
    if (!this.count) return;
    this.geometry = new LineSegmentsGeometry().setPositions(numbers);
    this.object.add(new LineSegments2(this.geometry, this.#back), new LineSegments2(this.geometry, this.#front));
  }

  /** Draw the first segments alone. */
  cut(segments) {
    if (this.count) this.geometry.instanceCount = Math.min(segments, this.count);
    this.object.visible = segments > 0;
  }
}
