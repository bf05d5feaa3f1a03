// SPDX-License-Identifier: MIT
// Colours, dashes and markers: those of the style sheet and of the tool's own pictures.

const DASHES = [[], [7, 3], [2, 2.5], [9, 3, 2, 3], [4, 2], [12, 4]];
export const STYLES = DASHES.length;

const listeners = [];

/** The value of a CSS variable now: light, dark or paper. */
export function css(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

export const colour = (style) => css(`--s${style % STYLES}`);

/** Dashes of a line in device pixels. */
export const dash = (style) => DASHES[style % STYLES].map((d) => d * devicePixelRatio);

/** Calls back when colours change. */
export function onTheme(redraw) {
  listeners.push(redraw);
}

/** Draws the marker of a style; r in device pixels. */
export function marker(context, style, x, y, r) {
  context.beginPath();
  switch (style % STYLES) {
    case 0: context.arc(x, y, r, 0, 2 * Math.PI); break;
    case 1: context.rect(x - r, y - r, 2 * r, 2 * r); break;
    case 2: polygon(context, [[x, y - 1.2 * r], [x + 1.2 * r, y + r], [x - 1.2 * r, y + r]]); break;
    case 3: polygon(context, [[x, y - 1.3 * r], [x + 1.3 * r, y], [x, y + 1.3 * r], [x - 1.3 * r, y]]); break;
    case 4: cross(context, x, y, r, r); break;
    default: plus(context, x, y, r);
  }
  context.setLineDash([]);
  context.lineWidth = 1.5 * devicePixelRatio;
  context.strokeStyle = colour(style);
  context.fillStyle = css("--paper");
  context.fill();
  context.stroke();
}

function polygon(context, corners) {
  corners.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.closePath();
}

function cross(context, x, y, dx, dy) {
  context.moveTo(x - dx, y - dy);
  context.lineTo(x + dx, y + dy);
  context.moveTo(x - dx, y + dy);
  context.lineTo(x + dx, y - dy);
}

function plus(context, x, y, r) {
  context.moveTo(x, y - r);
  context.lineTo(x, y + r);
  context.moveTo(x - r, y);
  context.lineTo(x + r, y);
}

function changed() {
  for (const redraw of listeners) redraw();
}

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
addEventListener("beforeprint", () => {
  document.documentElement.classList.add("paper");
  changed();
});
addEventListener("afterprint", () => {
  document.documentElement.classList.remove("paper");
  changed();
});
