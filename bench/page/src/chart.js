// SPDX-License-Identifier: MIT
// Lines over a linear or logarithmic axis, drawn by uPlot; every line may have x of its own.
import uPlot from "uplot";
import { element, onWidth } from "./element.js";
import { format } from "./numbers.js";
import { colour, css, dash, marker, onTheme } from "./theme.js";

const HEIGHT = 290;
const FONT = "11px system-ui,sans-serif";

/** Splits of a logarithmic axis: decades, and 2 and 5 where there are few of them. */
function logSplits(low, high) {
  const decades = Math.log10(high / low);
  const factors = decades < 2.2 ? [1, 2, 5] : [1];
  const splits = [];
  const stride = decades > 8 ? 2 : 1;
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); e += stride) {
    for (const f of factors) {
      const value = Number((f * 10 ** e).toPrecision(3));
      if (value >= low * 0.999 && value <= high * 1.001) splits.push(value);
    }
  }
  return splits;
}

/** Smallest and largest of what is there, with room around it. */
function rangeOf(values, scale) {
  const known = values.filter((v) => Number.isFinite(v) && (!scale.log || v > 0));
  let low = scale.low ?? Math.min(...known), high = scale.high ?? Math.max(...known);
  if (known.length === 0 && (scale.low === undefined || scale.high === undefined)) return [0.1, 1];
  if (scale.log) {
    if (scale.decades) low = Math.max(low, high / 10 ** scale.decades);
    return [scale.low ?? low / 1.25, scale.high ?? Math.max(high * 1.25, low * 2)];
  }
  const room = 0.05 * (high - low || Math.abs(high) || 1);
  return [scale.low ?? low - room, scale.high ?? high + room];
}

function axisOf(scale, range, size) {
  const axis = {
    stroke: () => css("--soft"), font: FONT, label: scale.label, labelFont: FONT, labelSize: 18, size,
    gap: 4, grid: { stroke: () => css("--rule"), width: 1 }, ticks: { show: false },
    values: (_, splits) => splits.map(scale.format ?? format), filter: (_, splits) => splits,
  };
  if (scale.log) axis.splits = () => logSplits(...range);
  return axis;
}

/** Markers of every line, or of every so many of its points. */
function drawMarkers(plot, lines) {
  for (const line of lines) {
    if (line.markers === false) continue;
    const every = Math.max(1, Math.floor(line.x.length / 10));
    const first = Math.floor((every * (line.style % 6)) / 6);
    line.x.forEach((x, i) => {
      if (i % every !== first || line.y[i] === null) return;
      const px = plot.valToPos(x, "x", true), py = plot.valToPos(line.y[i], "y", true);
      marker(plot.ctx, line.style, px, py, 3.2 * devicePixelRatio);
      if (line.ringed?.[i]) ring(plot.ctx, line.style, px, py);
    });
  }
}

function ring(context, style, x, y) {
  context.beginPath();
  context.arc(x, y, 6.5 * devicePixelRatio, 0, 2 * Math.PI);
  context.lineWidth = devicePixelRatio;
  context.strokeStyle = colour(style);
  context.stroke();
}

/** A thin line from low to high at each point. */
function drawSpread(plot, line) {
  const context = plot.ctx;
  context.strokeStyle = colour(line.style);
  context.lineWidth = devicePixelRatio;
  context.setLineDash([]);
  context.globalAlpha = 0.6;
  context.beginPath();
  line.x.forEach((x, i) => {
    const px = plot.valToPos(x, "x", true);
    context.moveTo(px, plot.valToPos(line.spread.low[i], "y", true));
    context.lineTo(px, plot.valToPos(line.spread.high[i], "y", true));
  });
  context.stroke();
  context.globalAlpha = 1;
}

/** Lines at fixed values with a label, labels kept apart. */
function drawLimits(plot, limits) {
  const context = plot.ctx, ratio = devicePixelRatio, box = plot.bbox;
  context.font = `${11 * ratio}px system-ui,sans-serif`;
  context.textAlign = "left";
  context.textBaseline = "top";
  let free = -Infinity;
  for (const limit of limits) {
    const p = Math.round(plot.valToPos(limit.value, limit.axis, true)) + 0.5;
    const inside = limit.axis === "x" ? p >= box.left && p <= box.left + box.width
                                      : p >= box.top && p <= box.top + box.height;
    if (!inside) continue;
    context.setLineDash(limit.strong ? [5 * ratio, 3 * ratio] : [ratio, 3 * ratio]);
    context.strokeStyle = css(limit.strong ? "--ink" : "--soft");
    context.lineWidth = (limit.strong ? 1.4 : 1) * ratio;
    context.beginPath();
    if (limit.axis === "x") context.moveTo(p, box.top), context.lineTo(p, box.top + box.height);
    else context.moveTo(box.left, p), context.lineTo(box.left + box.width, p);
    context.stroke();
    const width = context.measureText(limit.label).width;
    if (p < free) continue;
    context.setLineDash([]);
    const [tx, ty] = limit.axis === "x" ? [p + 3 * ratio, box.top + 2 * ratio]
                                        : [box.left + box.width - width - 4 * ratio, p - 14 * ratio];
    context.fillStyle = css("--paper");
    context.fillRect(tx - ratio, ty - ratio, width + 2 * ratio, 13 * ratio);
    context.fillStyle = css(limit.strong ? "--ink" : "--soft");
    context.fillText(limit.label, tx, ty);
    if (limit.axis === "x") free = tx + width + 4 * ratio;
  }
}

function clipped(plot, draw) {
  const { left, top, width, height } = plot.bbox;
  plot.ctx.save();
  plot.ctx.beginPath();
  plot.ctx.rect(left - 8, top, width + 16, height + 8);
  plot.ctx.clip();
  draw();
  plot.ctx.restore();
}

function optionsOf(chart, width) {
  const { lines, x, y, limits = [] } = chart;
  const all = (get) => lines.flatMap(get);
  const xRange = rangeOf([...all((l) => l.x), ...limits.filter((l) => l.axis === "x" && l.strong).map((l) => l.value)], x);
  const yRange = rangeOf(all((l) => [...l.y, ...(l.spread ? [...l.spread.low, ...l.spread.high] : [])]), y);
  return {
    width, height: chart.height ?? HEIGHT, legend: { show: false }, padding: [8, 14, 0, 0],
    cursor: { drag: { x: false, y: false }, points: { show: false } },
    scales: {
      x: { time: false, distr: x.log ? 3 : 1, range: () => xRange },
      y: { distr: y.log ? 3 : 1, range: () => yRange },
    },
    axes: [axisOf(x, xRange, 30), axisOf(y, yRange, 52)],
    series: [{}, ...lines.map((line) => ({
      stroke: () => colour(line.style), width: line.width ?? 1.6, dash: dash(line.style).map((d) => d / devicePixelRatio),
      spanGaps: true, points: { show: false },
      paths: line.stepped ? uPlot.paths.stepped({ align: 1 }) : undefined,
    }))],
    hooks: {
      drawAxes: [(plot) => clipped(plot, () => lines.forEach((l) => l.spread && drawSpread(plot, l)))],
      draw: [(plot) => { drawLimits(plot, limits); clipped(plot, () => drawMarkers(plot, lines)); }],
    },
  };
}

/**
 * Adds a picture to `host`:
 * {title, note, height, lines: [{style, x, y, stepped, spread, ringed, markers}],
 *  x, y: {log, low, high, decades, label, format}, limits: [{axis, value, label, strong}]}
 */
export function addChart(host, chart) {
  const box = element("div", { className: "chart" });
  const figure = element("figure", {}, element("div", { className: "plot-title", textContent: chart.title }), box);
  if (chart.note) figure.append(element("p", { className: "plot-note", textContent: chart.note }));
  host.append(figure);
  const lines = chart.lines.filter((line) => line.x.length > 0);
  const data = lines.length ? uPlot.join(lines.map((line) => [line.x, line.y])) : [[], []];
  let plot = null;
  onWidth(box, (width) => {
    plot?.destroy();
    plot = new uPlot(optionsOf({ ...chart, lines }, width), data, box);
  });
  onTheme(() => plot?.redraw(false));
  return figure;
}
