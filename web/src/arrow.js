// An arrow of length 1 along axis 3.
import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial, Quaternion, Vector3 } from "three";

const UP = new Vector3(0, 0, 1);

export class Arrow {
  #material = new MeshBasicMaterial();

  constructor(thick = 0.012) {
    const shaft = new CylinderGeometry(thick, thick, 0.86, 12).rotateX(Math.PI / 2).translate(0, 0, 0.43);
    const head = new ConeGeometry(3 * thick, 0.14, 20).rotateX(Math.PI / 2).translate(0, 0, 0.93);
    this.object = new Group();
    this.object.add(new Mesh(shaft, this.#material), new Mesh(head, this.#material));
  }

  set color(color) {
    this.#material.color.set(color);
  }

  /** Stand at a point and reach along a vector; one of no length is not seen. */
  place(point, vector) {
    const along = new Vector3(...vector);
    const length = along.length();
    this.object.visible = length > 1e-9;
    this.object.position.set(...point);
    this.object.quaternion.copy(new Quaternion().setFromUnitVectors(UP, along.normalize()));
    this.object.scale.setScalar(length || 1);
  }
}
