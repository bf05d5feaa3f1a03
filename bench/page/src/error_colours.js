// SPDX-License-Identifier: MIT
// From pale for no error to dark for a large one: the order stays without colour.
import { Color } from "three";

const STOPS = [[0, "#e3e9ec"], [0.35, "#f4cb62"], [0.68, "#e0662e"], [1, "#6d0d24"]].map(([at, text]) => [at, new Color(text)]);
const result = new Color();

/** The colour of an error in [0, 1]; the same object each time. */
export function errorColour(error) {
  const above = Math.max(1, STOPS.findIndex(([at]) => at >= error));
  const [low, from] = STOPS[above - 1], [high, to] = STOPS[above];
  return result.lerpColors(from, to, (error - low) / (high - low));
}

/** Paints the scale from left to right. */
export function paintScale(canvas) {
  const context = canvas.getContext("2d");
  for (let x = 0; x < canvas.width; ++x) {
    context.fillStyle = `#${errorColour(x / (canvas.width - 1)).getHexString()}`;
    context.fillRect(x, 0, 1, canvas.height);
  }
}
