// SPDX-License-Identifier: MIT
import { addChart } from "./chart.js";
import { element } from "./element.js";
import { legend } from "./legend.js";

const LEAST_SCENES = 3;

/** What time depends on, where the run has several scenes. */
export function scaling(host, _, page) {
  if (page.scenes.length < LEAST_SCENES) {
    host.append(element("p", { className: "soft",
      textContent: "Pictures of scaling need three scenes; this run has fewer." }));
    return;
  }
  addTimings(host, page.scenes.filter((scene) => scene.scaling));
  addBodies(host, [...page.scenes].sort((a, b) => a.bodies - b.bodies));
}

/** Time of a row with every number of threads and every instruction set; the legend is in the section. */
function addTimings(host, scenes) {
  if (scenes.length < LEAST_SCENES) return;
  scenes.sort((a, b) => a.scaling.rows - b.scaling.rows);
  const x = scenes.map((scene) => scene.scaling.rows);
  const note = scenes.map((scene) => `${scene.scaling.rows}: ${scene.name}`).join(", ");
  const picture = (title, kind, firstStyle) => addChart(host, {
    title, note,
    lines: scenes[0].scaling[kind].map((_, i) => ({
      style: firstStyle + i, x, y: scenes.map((scene) => scene.scaling[kind][i]) })),
    x: { log: true, label: "rows" }, y: { log: true, label: "ten sweeps [ns a row]" },
  });
  picture("Time against rows, by threads", "threads", 0);
  picture("Time against rows, by instruction set", "targets", scenes[0].scaling.threads.length);
}

/** Median frame time against bodies. */
function addBodies(host, scenes) {
  const lines = scenes[0].solvers.map((_, style) => {
    const known = scenes.filter((scene) => scene.solvers[style]?.p50);
    return { style, x: known.map((scene) => scene.bodies), y: known.map((scene) => scene.solvers[style].p50) };
  });
  addChart(host, {
    title: "Median frame time against bodies, scene by scene", lines,
    note: scenes.map((scene) => `${scene.bodies}: ${scene.name}`).join(", "),
    x: { log: true, label: "bodies" }, y: { log: true, label: "median time in the solver [ms]" },
  });
  const section = document.querySelector("section");
  host.append(legend(section.firstElementChild, lines.map((_, i) => i)));
}
