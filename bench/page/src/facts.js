// SPDX-License-Identifier: MIT
import { addChart } from "./chart.js";
import { element } from "./element.js";
import { legend } from "./legend.js";

const FACTS = [
  { name: "residual", title: "Residual, in the own run of each", label: "m/s", log: true },
  { name: "energy", title: "Energy, kinetic and potential", label: "kJ", factor: 1e-3 },
  { name: "penetration", title: "Deepest overlap", label: "mm", factor: 1e3, log: true },
  { name: "height_lost", title: "Height lost", label: "mm", factor: 1e3 },
  { name: "joint_gap", title: "Largest gap of a joint", label: "mm", factor: 1e3, log: true },
];

function lineOf(values, fact, style) {
  const line = { style, x: [], y: [] };
  values.forEach((value, frame) => {
    if (value === null || (fact.log && value <= 0)) return;
    line.x.push(frame);
    line.y.push(value * (fact.factor ?? 1));
  });
  return line;
}

export function facts(host, scene, page) {
  const grid = element("div", { className: "plots" });
  host.append(grid);
  for (const fact of FACTS) {
    const lines = scene.solvers.map((solver, i) =>
      lineOf(fact.name === "residual" ? solver.residual : solver.facts[fact.name], fact, i));
    if (lines.every((line) => line.x.length === 0)) continue;
    addChart(grid, {
      title: `${fact.title} [${fact.label}]`, height: 230, lines,
      x: { low: 0, high: page.frames, label: "frame" },
      y: { log: fact.log, decades: 6 },
    });
  }
  host.append(legend(host, scene.solvers.map((_, i) => i)));
}
