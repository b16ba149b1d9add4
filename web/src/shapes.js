// Geometry of shapes by their kind. Sizes are in m and in the order of the package's shapes.
import {
  BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, CylinderGeometry, SphereGeometry,
} from "three";

const AROUND = 32;
const upright = (geometry) => geometry.rotateX(Math.PI / 2); // three's axis of turning is y, ours is 3

const BUILDERS = {
  sphere: ({ sizes: [radius] }) => new SphereGeometry(radius, AROUND, 20),
  ellipsoid: ({ sizes }) => new SphereGeometry(1, AROUND, 20).scale(...sizes),
  capsule: ({ sizes: [radius, half] }) => upright(new CapsuleGeometry(radius, 2 * half, 8, AROUND)),
  cylinder: ({ sizes: [radius, half] }) =>
    upright(new CylinderGeometry(radius, radius, 2 * half, AROUND)),
  box: ({ sizes: [x, y, z] }) => new BoxGeometry(2 * x, 2 * y, 2 * z),
  mesh: ({ vertices, faces }) => {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(vertices, 3));
    geometry.setIndex(new BufferAttribute(faces, 1));
    geometry.computeVertexNormals();
    return geometry;
  },
};

export function geometryOf(shape) {
  return BUILDERS[shape.kind](shape);
}
