// SPDX-License-Identifier: MIT
// One view of the replay: a scene of three.js with an instance for every part of a body.
import { Color, DirectionalLight, HemisphereLight, InstancedMesh, Matrix4, MeshLambertMaterial, PerspectiveCamera, Quaternion, Scene, Vector3, WebGLRenderer, DoubleSide } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { errorColour } from "./error_colours.js";
import { geometryOf } from "./shapes.js";
import { css } from "./theme.js";

const shaded = new Color(), placed = new Matrix4();
const ONE = new Vector3(1, 1, 1), NOWHERE = new Matrix4().makeScale(0, 0, 0);

function matrixOf(pose) {
  return new Matrix4().compose(new Vector3(...pose.slice(0, 3)), new Quaternion(...pose.slice(3)), ONE);
}

/** Meshes of bodies: for each shape one, with as many instances as there are parts of it. */
class Bodies {
  #parts = []; // by body: [{mesh, index, local}]

  constructor(scene, replay, bodies, material) {
    const counts = replay.shapes.map(() => 0);
    for (const part of bodies.flat()) ++counts[part.shape];
    this.meshes = replay.shapes.map((shape, s) => {
      if (counts[s] === 0) return null;
      const mesh = new InstancedMesh(geometryOf(shape), material, counts[s]);
      mesh.frustumCulled = false;
      for (let i = 0; i < counts[s]; ++i) mesh.setMatrixAt(i, NOWHERE), mesh.setColorAt(i, new Color("#fff"));
      scene.add(mesh);
      return mesh;
    });
    const used = replay.shapes.map(() => 0);
    this.#parts = bodies.map((parts) => parts.map((part) => (
      { mesh: this.meshes[part.shape], index: used[part.shape]++, local: matrixOf(part.pose) })));
  }

  place(body, world, colour) {
    // neighbours of the same colour are told apart by a shade
    shaded.copy(colour).multiplyScalar(1 - 0.035 * ((body * 7) % 5));
    for (const { mesh, index, local } of this.#parts[body] ?? []) {
      mesh.setMatrixAt(index, placed.multiplyMatrices(world, local));
      mesh.setColorAt(index, shaded);
    }
  }

  hideFrom(first) {
    for (let body = first; body < this.#parts.length; ++body) this.place(body, NOWHERE, new Color("#fff"));
  }

  done() {
    for (const mesh of this.meshes) {
      if (!mesh) continue;
      mesh.instanceMatrix.needsUpdate = true;
      mesh.instanceColor.needsUpdate = true;
    }
  }
}

export class Pane {
  constructor(canvas, replay, view) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(42, 4 / 3, view.radius / 100, view.radius * 60);
    this.camera.up.set(...replay.up);
    this.camera.position.copy(view.position);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.target.copy(view.target);
    this.controls.update();
    const sun = new DirectionalLight("#ffffff", 1.9);
    sun.position.copy(view.sun);
    const sky = new HemisphereLight("#ffffff", "#7d8288", 1.5);
    sky.position.set(...replay.up);
    this.scene.add(sun, sky);
    const still = new Bodies(this.scene, replay, replay.still_bodies, new MeshLambertMaterial({ side: DoubleSide }));
    this.still = still;
    this.stillPoses = replay.still_poses.map(matrixOf);
    this.bodies = new Bodies(this.scene, replay, replay.bodies, new MeshLambertMaterial());
    this.theme();
  }

  /** Colours of what does not move. */
  theme() {
    this.scene.background = new Color(css("--card"));
    const ground = new Color(css("--rule"));
    this.stillPoses.forEach((pose, i) => this.still.place(i, pose, ground));
    this.still.done();
  }

  resize(width) {
    const height = Math.round(width * 0.72);
    this.renderer.setPixelRatio(devicePixelRatio);
    this.renderer.setSize(width, height, false);
    this.canvas.style.height = `${height}px`;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  /** Returns the largest error, in [0, 1]. */
  show(poses, frame) {
    let shown = 0, largest = 0;
    const world = new Matrix4();
    poses.at(frame, (body, position, rotation, error) => {
      this.bodies.place(body, world.compose(position, rotation, ONE), errorColour(error));
      largest = Math.max(largest, error);
      shown = body + 1;
    });
    this.bodies.hideFrom(shown);
    this.bodies.done();
    this.render();
    return largest;
  }

  render() {
    this.renderer.render(this.scene, this.camera);
  }

  dispose() {
    this.controls.dispose();
    for (const mesh of [...this.bodies.meshes, ...this.still.meshes]) mesh?.geometry.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }
}
