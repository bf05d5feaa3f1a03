// SPDX-License-Identifier: MIT
// Fills the places of the page that the tool left for scripts.
import uPlotStyle from "uplot/dist/uPlot.min.css";
import { element } from "./element.js";
import { errorTime } from "./error_time.js";
import { facts } from "./facts.js";
import { FrameCursor } from "./frame_cursor.js";
import { histogram } from "./histogram.js";
import { profile } from "./profile.js";
import { replay } from "./replay.js";
import { scaling } from "./scaling.js";
import { strip } from "./strip.js";
import { timeline } from "./timeline.js";

const PLOTS = { "error-time": errorTime, profile, histogram, strip, replay, timeline, facts, scaling };

const page = JSON.parse(document.getElementById("data").textContent);
document.head.append(element("style", { textContent: uPlotStyle }));
document.documentElement.classList.add("with-scripts");
const cursors = page.scenes.map(() => new FrameCursor(page.frames));

for (const host of document.querySelectorAll("[data-plot]")) {
  const scene = Number(host.dataset.scene ?? 0);
  try {
    PLOTS[host.dataset.plot](host, page.scenes[scene], page, cursors[scene]);
    host.dataset.drawn = "yes";
  } catch (error) {
    // one picture that fails must not take the others with it
    console.error(error);
    host.append(element("p", { className: "soft", textContent: `This picture failed: ${error.message}` }));
  }
}
