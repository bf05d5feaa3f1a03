// SPDX-License-Identifier: MIT
// What the threads did in the slowest frame of a solver: a row for each, what is inside something below it.
import { element, onWidth, sharpCanvas } from "./element.js";
import { format } from "./numbers.js";
import { css, onTheme } from "./theme.js";

const LEFT = 92, RIGHT = 12, BAR = 19, GAP = 12, AXIS = 24;

// Pale for the engine and for waiting, strong for the solver. A pattern for each: readable without colour.
const KINDS = {
  "Bullet": { light: "#d3d9de", dark: "#3c444b" },
  "tool": { light: "#ececec", dark: "#26292c", hatch: "/" },
  "read contacts": { light: "#9cc7e8", dark: "#2f6690" },
  "set-up": { light: "#5fa5d9", dark: "#3f86bf" },
  "sweep": { light: "#3bb08f", dark: "#2c8f72" },
  "residual": { light: "#c8a7ea", dark: "#7d58a8", hatch: "/" },
  "guards": { light: "#e7c3d6", dark: "#8d4f70" },
  "subspace step": { light: "#f2b279", dark: "#a8632a", hatch: "\\" },
  "factorise": { light: "#d96a2b", dark: "#e08347" },
  "wait": { light: "#f6d8d8", dark: "#5c3030", hatch: "x" },
  "results": { light: "#b9cf6a", dark: "#7c9130" },
  "write back": { light: "#e3d26b", dark: "#9b8a25", hatch: "\\" },
};

const isDark = () => getComputedStyle(document.documentElement).getPropertyValue("--paper").trim() < "#8";
const paint = (kind) => (KINDS[kind] ?? KINDS.Bullet)[isDark() ? "dark" : "light"];

/** Spans with their depth: how many others they are in. */
function nested(spans, timeline) {
  const open = [];
  return spans.map(([name, kind, begin, end, sweep, colour]) => {
    while (open.length && open.at(-1) <= begin + 1e-6) open.pop();
    const span = { name: timeline.names[name], kind: timeline.kinds[kind], begin, end, sweep, colour, depth: open.length };
    open.push(end);
    return span;
  });
}

/** Time of each kind without what is inside it [ms]. */
function ownTimes(workers) {
  const sums = new Map(), add = (kind, time) => sums.set(kind, (sums.get(kind) ?? 0) + time);
  for (const spans of workers) {
    const open = [];
    for (const span of spans) {
      while (open.length && open.at(-1).end <= span.begin + 1e-6) open.pop();
      add(span.kind, span.end - span.begin);
      if (open.length) add(open.at(-1).kind, span.begin - span.end);
      open.push(span);
    }
  }
  return sums;
}

function hatch(context, kind, x, y, width, height) {
  const pattern = KINDS[kind]?.hatch;
  if (!pattern || width < 3) return;
  context.save();
  context.beginPath();
  context.rect(x, y, width, height);
  context.clip();
  context.strokeStyle = css("--soft");
  context.globalAlpha = 0.55;
  context.lineWidth = 0.8;
  context.beginPath();
  for (let at = x - height; at < x + width + height; at += 7) {
    if (pattern !== "\\") context.moveTo(at, y + height), context.lineTo(at + height, y);
    if (pattern !== "/") context.moveTo(at, y), context.lineTo(at + height, y + height);
  }
  context.stroke();
  context.restore();
}

function describe(span) {
  const sweep = span.sweep >= 0 ? ` ${span.sweep + 1}, colour ${span.colour + 1}` : "";
  return `${span.name}${sweep}: ${format(span.end - span.begin)} ms`;
}

class Picture {
  constructor(timeline) {
    this.timeline = timeline;
    this.workers = timeline.workers.map((spans) => nested(spans, timeline));
    this.depths = this.workers.map((spans) => 1 + Math.max(0, ...spans.map((s) => s.depth)));
    const ends = this.workers.flat().map((s) => s.end);
    this.whole = [0, Math.max(1e-3, ...ends)];
    this.view = [...this.whole];
  }

  get height() {
    return AXIS + this.depths.reduce((sum, depth) => sum + depth * BAR + GAP, 0);
  }

  toX(time) {
    return LEFT + ((time - this.view[0]) / (this.view[1] - this.view[0])) * (this.width - LEFT - RIGHT);
  }

  toTime(x) {
    return this.view[0] + ((x - LEFT) / (this.width - LEFT - RIGHT)) * (this.view[1] - this.view[0]);
  }

  draw(canvas, width) {
    this.width = width;
    const context = sharpCanvas(canvas, width, this.height);
    context.font = "11px system-ui,sans-serif";
    context.textBaseline = "middle";
    let top = AXIS;
    this.axis(context);
    this.workers.forEach((spans, worker) => {
      context.fillStyle = css("--ink");
      context.textAlign = "right";
      context.fillText(worker === 0 ? "world's thread" : `helper ${worker}`, LEFT - 8, top + BAR / 2);
      context.save();
      context.beginPath();
      context.rect(LEFT, top, width - LEFT - RIGHT, this.depths[worker] * BAR);
      context.clip();
      for (const span of spans) this.bar(context, span, top + span.depth * BAR);
      context.restore();
      top += this.depths[worker] * BAR + GAP;
    });
  }

  axis(context) {
    const [from, to] = this.view, rough = (to - from) / 8;
    const decade = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((f) => f * decade).find((s) => s >= rough);
    context.textAlign = "center";
    context.strokeStyle = css("--rule");
    context.fillStyle = css("--soft");
    for (let time = Math.ceil(from / step) * step; time <= to; time += step) {
      const x = Math.round(this.toX(time)) + 0.5;
      context.beginPath();
      context.moveTo(x, 16);
      context.lineTo(x, this.height);
      context.stroke();
      if (x < this.width - 30) context.fillText(`${Number(time.toPrecision(4))}`, x, 8);
    }
    context.textAlign = "right";
    context.fillText("ms", this.width - 2, 8);
  }

  bar(context, span, y) {
    const x = this.toX(span.begin), width = Math.max(0.6, this.toX(span.end) - x);
    if (x + width < LEFT || x > this.width) return;
    context.fillStyle = paint(span.kind);
    context.fillRect(x, y, width, BAR - 2);
    hatch(context, span.kind, x, y, width, BAR - 2);
    if (width > 4) context.strokeStyle = css("--paper"), context.lineWidth = 0.6, context.strokeRect(x, y, width, BAR - 2);
    const text = span.name, left = Math.max(x, LEFT) + 4;
    if (x + width - left < context.measureText(text).width + 4) return;
    context.textAlign = "left";
    context.fillStyle = css("--ink");
    context.fillText(text, left, y + BAR / 2 - 1);
  }

  at(x, y) {
    const time = this.toTime(x);
    let top = AXIS;
    for (let worker = 0; worker < this.workers.length; ++worker) {
      const depth = Math.floor((y - top) / BAR);
      top += this.depths[worker] * BAR + GAP;
      if (depth < 0 || depth >= this.depths[worker]) continue;
      return this.workers[worker].find((s) => s.depth === depth && s.begin <= time && time <= s.end);
    }
    return undefined;
  }

  zoom(x, factor) {
    const time = this.toTime(x);
    const [from, to] = this.view.map((edge) => time + (edge - time) * factor);
    this.view = [Math.max(this.whole[0], from), Math.min(this.whole[1], to)];
    if (this.view[1] - this.view[0] < 1e-3) this.view[1] = this.view[0] + 1e-3;
  }

  pan(pixels) {
    const by = (pixels * (this.view[1] - this.view[0])) / (this.width - LEFT - RIGHT);
    const shift = Math.max(this.whole[0] - this.view[0], Math.min(this.whole[1] - this.view[1], by));
    this.view = this.view.map((edge) => edge + shift);
  }
}

function key(kind, time) {
  const canvas = element("canvas");
  canvas.style.width = "26px";
  const context = sharpCanvas(canvas, 26, 12);
  context.fillStyle = paint(kind);
  context.fillRect(0, 0, 26, 12);
  hatch(context, kind, 0, 0, 26, 12);
  return element("span", {}, canvas, ` ${kind} `, element("span", { className: "soft", textContent: `${format(time)} ms` }));
}

export function timeline(host, scene) {
  const shown = scene.solvers.map((_, i) => i).filter((i) => scene.solvers[i].timeline.frame >= 0);
  if (shown.length === 0) {
    host.append(element("p", { className: "soft", textContent: "Not measured in this run." }));
    return;
  }
  const select = element("select", { ariaLabel: "Solver" });
  for (const i of shown) select.append(element("option", { value: i, textContent: scene.solvers[i].label }));
  const ours = shown.find((i) => scene.solvers[i].ours);
  select.value = ours ?? shown[0];
  const whole = element("button", { type: "button", textContent: "Whole frame" });
  const facts = element("span", { className: "soft" }), note = element("p", { className: "plot-note" });
  const canvas = element("canvas", { className: "threads" }), keys = element("div", { className: "legend" });
  canvas.setAttribute("aria-label", "Timeline of the slowest frame");
  host.append(element("div", { className: "controls" }, select, whole, facts), canvas, note, keys);
  let picture = null, width = 0;
  const draw = () => width > 0 && picture.draw(canvas, width);
  const legend = () => keys.replaceChildren(
    ...[...ownTimes(picture.workers)].sort((a, b) => b[1] - a[1]).map(([kind, time]) => key(kind, time)));
  const hint = "Wheel to come closer, drag to move. Times below are without what is inside; " +
    (scene.bullet_has_zones ? "Bullet is its whole step, collision detection included." : "this Bullet was built without its profiler, so nothing of it is shown.");
  const choose = () => {
    const solver = scene.solvers[select.value], { frame, time, dropped } = solver.timeline;
    picture = new Picture(solver.timeline);
    facts.textContent = `frame ${frame}, the slowest: ${format(time)} ms in the solver` + (dropped ? `; ${dropped} spans had no room` : "");
    note.textContent = hint;
    legend();
    draw();
  };
  select.addEventListener("change", choose);
  whole.addEventListener("click", () => { picture.view = [...picture.whole]; draw(); });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    picture.zoom(event.offsetX, event.deltaY < 0 ? 0.8 : 1.25);
    draw();
  }, { passive: false });
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons) { picture.pan(-event.movementX); draw(); }
    const span = picture.at(event.offsetX, event.offsetY);
    note.textContent = span ? describe(span) : hint;
  });
  choose();
  onWidth(host, (now) => { width = now; draw(); });
  onTheme(() => { legend(); draw(); });
}
