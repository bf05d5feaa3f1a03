// SPDX-License-Identifier: MIT
import { addChart } from "./chart.js";
import { element } from "./element.js";
import { legend } from "./legend.js";

const LEAST_SCENES = 3;

/** Median frame time against bodies, where the run has several scenes. */
export function scaling(host, _, page) {
  if (page.scenes.length < LEAST_SCENES) {
    host.append(element("p", { className: "soft",
      textContent: "Time against bodies: not measured in this run, which would need three scenes." }));
    return;
  }
  const scenes = [...page.scenes].sort((a, b) => a.bodies - b.bodies);
  const lines = scenes[0].solvers.map((solver, style) => {
    const points = new Map();
    for (const scene of scenes) {
      const p50 = scene.solvers[style]?.p50;
      if (p50) points.set(scene.bodies, p50);
    }
    return { style, x: [...points.keys()], y: [...points.values()] };
  });
  addChart(host, {
    title: "Median frame time against bodies, scene by scene", lines,
    note: scenes.map((scene) => `${scene.bodies}: ${scene.name}`).join(", "),
    x: { log: true, label: "bodies" }, y: { log: true, label: "median time in the solver [ms]" },
  });
  const section = document.querySelector("section");
  const box = legend(section.firstElementChild, scenes[0].solvers.map((_, i) => i));
  host.append(box);
}
