// SPDX-License-Identifier: MIT
// The frames of all solvers in a row each: how long each took. A click chooses the frame.
import { element, onWidth, sharpCanvas } from "./element.js";
import { format } from "./numbers.js";
import { colour, css, onTheme } from "./theme.js";

const ROW = 44, LEFT = 132, RIGHT = 16, BOTTOM = 22;

/** The time that fills a row [ms]: the budget twice, or what is longest. */
function fullTime(scene, page) {
  const longest = Math.max(...scene.solvers.flatMap((s) => s.time.map((t) => t ?? 0)), 1e-6);
  return page.budget ? Math.min(longest, 2 * page.budget) : longest;
}

function drawRow(context, solver, style, top, view) {
  const { width, full, budget, frames } = view;
  const height = ROW - 10, bottom = top + height;
  const step = (width - LEFT - RIGHT) / frames;
  context.fillStyle = css("--ink");
  context.textAlign = "right";
  context.textBaseline = "middle";
  context.fillText(solver.label, LEFT - 10, top + height / 2);
  solver.time.forEach((time, i) => {
    if (time === null) return;
    const over = budget && time > budget;
    const bar = Math.min(1, time / full) * height;
    context.fillStyle = over ? css("--bad") : colour(style);
    context.fillRect(LEFT + i * step, bottom - bar, Math.max(0.7, step - (step > 3 ? 1 : 0)), bar);
    if (over) context.fillRect(LEFT + i * step, top - 4, Math.max(0.7, step), 2.5);
  });
  context.strokeStyle = css("--rule");
  context.strokeRect(LEFT - 0.5, top - 0.5, width - LEFT - RIGHT + 1, height + 1);
  if (!budget || budget > full) return;
  const y = Math.round(bottom - (budget / full) * height) + 0.5;
  context.setLineDash([4, 3]);
  context.strokeStyle = css("--ink");
  context.beginPath();
  context.moveTo(LEFT, y);
  context.lineTo(width - RIGHT, y);
  context.stroke();
  context.setLineDash([]);
}

function drawAxis(context, view, rows) {
  const y = rows * ROW + 8;
  context.fillStyle = css("--soft");
  context.textAlign = "center";
  context.textBaseline = "top";
  const step = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 1e4].find((s) => view.frames / s <= 8) ?? 1e5;
  const scale = (view.width - LEFT - RIGHT) / view.frames;
  for (let frame = 0; frame <= view.frames; frame += step) {
    context.fillText(String(frame), LEFT + frame * scale, y);
  }
}

function drawCursor(context, view, rows, frame) {
  const x = LEFT + (Math.min(frame, view.frames) * (view.width - LEFT - RIGHT)) / view.frames;
  context.strokeStyle = css("--ink");
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(x, 2);
  context.lineTo(x, rows * ROW + 4);
  context.stroke();
  context.lineWidth = 1;
}

export function strip(host, scene, page, cursor) {
  const canvas = element("canvas", { className: "strip", tabIndex: 0 });
  canvas.setAttribute("role", "slider");
  canvas.setAttribute("aria-label", "Frame times; a click moves the replay to the frame");
  const full = fullTime(scene, page), rows = scene.solvers.length;
  const view = { width: 0, full, budget: page.budget, frames: page.frames };
  host.append(element("div", { className: "plot-title strip-title", textContent: "Frame by frame" }), canvas,
    element("p", { className: "plot-note", textContent:
      `A full row is ${format(full)} ms. ${page.budget ? "Dashed: the budget; frames above it are marked on top. " : ""}` +
      "A click moves the replay there." }));

  const draw = () => {
    if (view.width === 0) return;
    const context = sharpCanvas(canvas, view.width, rows * ROW + BOTTOM);
    context.font = "12px system-ui,sans-serif";
    scene.solvers.forEach((solver, i) => drawRow(context, solver, i, i * ROW + 7, view));
    drawAxis(context, view, rows);
    drawCursor(context, view, rows, cursor.frame);
  };
  onWidth(host, (width) => { view.width = width; draw(); });
  onTheme(draw);
  cursor.follow(draw);
  const choose = (event) => {
    const x = event.clientX - canvas.getBoundingClientRect().left - LEFT;
    cursor.set(Math.floor((x * page.frames) / (view.width - LEFT - RIGHT)));
  };
  canvas.addEventListener("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); choose(event); });
  canvas.addEventListener("pointermove", (event) => event.buttons && choose(event));
  canvas.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (by) { cursor.set(Math.round(cursor.frame) + by); event.preventDefault(); }
  });
}
