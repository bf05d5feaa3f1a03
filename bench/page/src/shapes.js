// SPDX-License-Identifier: MIT
import { BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, CylinderGeometry, SphereGeometry, Vector3 } from "three";
import { ConvexGeometry } from "three/examples/jsm/geometries/ConvexGeometry.js";

function corners(numbers) {
  const points = [];
  for (let i = 0; i + 2 < numbers.length; i += 3) points.push(new Vector3(...numbers.slice(i, i + 3)));
  return points;
}

/** The geometry of a shape of the replay. */
export function geometryOf({ kind, numbers }) {
  switch (kind) {
    case "box": return new BoxGeometry(...numbers.map((half) => 2 * half));
    case "sphere": return new SphereGeometry(numbers[0], 20, 14);
    case "cylinder": return new CylinderGeometry(numbers[0], numbers[0], numbers[1], 20);
    case "capsule": return new CapsuleGeometry(numbers[0], numbers[1], 6, 14);
    case "hull": return new ConvexGeometry(corners(numbers));
    default: {
      const mesh = new BufferGeometry();
      mesh.setAttribute("position", new BufferAttribute(new Float32Array(numbers), 3));
      mesh.computeVertexNormals();
      return mesh;
    }
  }
}
