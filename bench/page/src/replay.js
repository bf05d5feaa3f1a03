// SPDX-License-Identifier: MIT
// Two solvers side by side at the same frame, seen by the same camera.
import { Quaternion, Vector3 } from "three";
import { element, onWidth } from "./element.js";
import { paintScale } from "./error_colours.js";
import { format } from "./numbers.js";
import { Pane } from "./pane.js";
import { Poses } from "./poses.js";
import { onTheme } from "./theme.js";

const FRAMES_PER_SECOND = 60;

/** A camera that sees all bodies as they were built. */
function viewOf(poses, up) {
  const low = new Vector3(Infinity, Infinity, Infinity), high = low.clone().negate();
  poses.at(0, (_, position) => { low.min(position); high.max(position); });
  if (low.x > high.x) low.set(-1, 0, -1), high.set(1, 1, 1);
  const target = low.clone().add(high).multiplyScalar(0.5);
  const radius = Math.max(0.6, 0.5 * low.distanceTo(high) + 0.4);
  // as if y were up, turned to what is
  const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), new Vector3(...up));
  const direction = new Vector3(0.62, 0.5, 1).normalize().applyQuaternion(turn);
  const sun = new Vector3(0.6, 1, 0.45).applyQuaternion(turn);
  return { target, radius, sun, position: target.clone().addScaledVector(direction, 3 * radius) };
}

function selectOf(scene, chosen) {
  const select = element("select", { ariaLabel: "Solver" });
  scene.solvers.forEach((solver, i) => select.append(element("option", { value: i, textContent: solver.label })));
  select.value = chosen;
  return select;
}

/** The solver of Cairn beside the first of the others. */
function firstChoice(scene) {
  const ours = scene.solvers.findIndex((s) => s.ours);
  const other = scene.solvers.findIndex((s) => !s.ours && s.failed_at === null);
  const left = other >= 0 ? other : 0;
  return [left, ours >= 0 && ours !== left ? ours : scene.solvers.length > 1 ? (left + 1) % scene.solvers.length : left];
}

class View {
  constructor(scene, page, cursor) {
    this.scene = scene;
    this.cursor = cursor;
    this.poses = new Map();
    this.sides = firstChoice(scene).map((chosen) => {
      const canvas = element("canvas", { tabIndex: 0 });
      canvas.setAttribute("aria-label", "Replay of the scene; drag to turn, wheel to come closer");
      return { select: selectOf(scene, chosen), canvas, note: element("span", { className: "soft" }), pane: null };
    });
  }

  posesOf(solver) {
    if (!this.poses.has(solver)) this.poses.set(solver, new Poses(this.scene.replay, this.scene.replay.solvers[solver]));
    return this.poses.get(solver);
  }

  start() {
    const view = viewOf(this.posesOf(Number(this.sides[0].select.value)), this.scene.replay.up);
    for (const side of this.sides) {
      side.pane = new Pane(side.canvas, this.scene.replay, view);
      side.pane.resize(side.canvas.parentElement.clientWidth);
    }
    const [a, b] = this.sides.map((side) => side.pane);
    const link = (from, to) => from.controls.addEventListener("change", () => {
      to.camera.position.copy(from.camera.position);
      to.camera.quaternion.copy(from.camera.quaternion);
      to.controls.target.copy(from.controls.target);
      from.render();
      to.render();
    });
    link(a, b);
    link(b, a);
    this.show();
  }

  stop() {
    for (const side of this.sides) {
      side.pane?.dispose();
      side.pane = null;
      const fresh = side.canvas.cloneNode();
      side.canvas.replaceWith(fresh);
      side.canvas = fresh;
    }
  }

  show() {
    const { error_least, error_decades } = this.scene.replay;
    for (const side of this.sides) {
      if (!side.pane) continue;
      const solver = Number(side.select.value), poses = this.posesOf(solver);
      const largest = side.pane.show(poses, this.cursor.frame);
      const error = 1000 * error_least * 10 ** (largest * error_decades);
      const failed = this.scene.solvers[solver].failed_at;
      side.note.textContent = failed !== null && this.cursor.frame >= failed
        ? `failed at frame ${failed}` : `largest error ${largest > 0 ? format(error) : "below 0.1"} mm`;
    }
  }
}

/** At most so many views have a context of WebGL at a time; browsers allow 16. */
const alive = [];
const MOST_ALIVE = 4;

function keepAlive(view) {
  if (alive.includes(view)) return;
  alive.push(view);
  view.start();
  if (alive.length > MOST_ALIVE) alive.shift().stop();
}

/** Play and pause, and the frame. */
function controlsOf(page, cursor) {
  const play = element("button", { type: "button", textContent: "Play" });
  const slider = element("input", { type: "range", min: 0, max: cursor.last, step: 1, value: 0, ariaLabel: "Frame" });
  const label = element("output");
  let playing = false, before = 0;
  const tick = (now) => {
    if (!playing) return;
    const frame = cursor.frame + ((now - before) * FRAMES_PER_SECOND) / 1000;
    before = now;
    cursor.set(frame);
    if (frame >= cursor.last) toggle();
    else requestAnimationFrame(tick);
  };
  const toggle = () => {
    playing = !playing;
    play.textContent = playing ? "Pause" : "Play";
    if (playing && cursor.frame >= cursor.last) cursor.set(0);
    if (playing) requestAnimationFrame((now) => { before = now; tick(now); });
  };
  play.addEventListener("click", toggle);
  slider.addEventListener("input", () => { if (playing) toggle(); cursor.set(Number(slider.value)); });
  const follow = (frame) => {
    slider.value = Math.round(frame);
    label.textContent = `frame ${Math.round(frame)} of ${page.frames}, ${(frame / FRAMES_PER_SECOND).toFixed(2)} s`;
  };
  cursor.follow(follow);
  follow(0);
  return element("div", { className: "controls" }, play, slider, label);
}

function scaleOf(replay) {
  const canvas = element("canvas", { width: 180, height: 10 });
  paintScale(canvas);
  const most = 1000 * replay.error_least * 10 ** replay.error_decades;
  return element("div", { className: "scale" }, `overlap of contacts, gap of joints: ${1000 * replay.error_least} mm`, canvas, `${most} mm`);
}

export function replay(host, scene, page, cursor) {
  if (!scene.replay.solvers.some((solver) => solver.frames.length)) return;
  const view = new View(scene, page, cursor);
  const panes = element("div", { className: "panes" });
  for (const side of view.sides) {
    panes.append(element("div", { className: "pane" },
      element("div", { className: "controls" }, side.select, side.note), side.canvas));
    side.select.addEventListener("change", () => view.show());
  }
  const { stride } = scene.replay;
  host.append(controlsOf(page, cursor), panes, scaleOf(scene.replay), element("p", { className: "plot-note", textContent:
    "Drag to turn, wheel to come closer; both views follow. " +
    (stride > 1 ? `To keep the page small it has every ${stride}th frame; what is between is interpolated.` : "") }));
  cursor.follow(() => view.show());
  onTheme(() => { for (const side of view.sides) side.pane?.theme(); view.show(); });
  onWidth(panes, () => {
    for (const side of view.sides) side.pane?.resize(side.canvas.parentElement.clientWidth);
    view.show();
  });
  new IntersectionObserver((entries) => entries.some((e) => e.isIntersecting) && keepAlive(view),
    { rootMargin: "300px" }).observe(panes);
}
