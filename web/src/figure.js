// A model that takes poses.
import { Group, Matrix4, Mesh, MeshStandardMaterial, Quaternion, SRGBColorSpace, Vector3 } from "three";
import { locate } from "./moment.js";
import { geometryOf } from "./shapes.js";

const LEAST = 0.3; // opacity: what a file makes invisible is part of the body too
const FRAME = 7; // numbers a body: its place, and its turn as w, x, y, z

export class Figure {
  /** @param model {bodies: [{name, shapes: [{kind, sizes, position, rotation, color}]}]} */
  constructor(model, { material, opacity = 1 } = {}) {
    this.object = new Group();
    this.bodies = model.bodies.map((body) => {
      const group = new Group();
      for (const shape of body.shapes) {
        const mesh = new Mesh(geometryOf(shape), material ?? paint(shape.color, opacity));
        const r = shape.rotation;
        const pose = new Matrix4().set(...r[0], 0, ...r[1], 0, ...r[2], 0, 0, 0, 0, 1);
        mesh.applyMatrix4(pose.setPosition(...shape.position));
        group.add(mesh);
      }
      this.object.add(group);
      return group;
    });
  }

  /** Stand as in a flight at a time. */
  pose(flight, time) {
    const at = locate(flight.times, time);
    const { frames } = flight;
    const [from, to] = [new Vector3(), new Vector3()];
    const [start, end] = [new Quaternion(), new Quaternion()];
    this.bodies.forEach((group, body) => {
      const one = FRAME * (at.before * this.bodies.length + body);
      const two = FRAME * (at.after * this.bodies.length + body);
      from.fromArray(frames, one);
      to.fromArray(frames, two);
      group.position.lerpVectors(from, to, at.share);
      start.set(frames[one + 4], frames[one + 5], frames[one + 6], frames[one + 3]);
      end.set(frames[two + 4], frames[two + 5], frames[two + 6], frames[two + 3]);
      group.quaternion.slerpQuaternions(start, end, at.share);
    });
  }

  dispose() {
    this.object.traverse((part) => {
      part.geometry?.dispose();
      part.material?.dispose();
    });
  }
}

function paint([red, green, blue, own], opacity) {
  const made = new MeshStandardMaterial({ roughness: 0.65, metalness: 0, side: 2 });
  made.color.setRGB(red, green, blue, SRGBColorSpace);
  const seen = opacity * Math.max(own, LEAST);
  if (seen < 1) Object.assign(made, { transparent: true, opacity: seen, depthWrite: opacity === 1 });
  return made;
}
