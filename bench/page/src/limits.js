// SPDX-License-Identifier: MIT

/** Lines of usual frame rates, and of the budget, across an axis of milliseconds. */
export function budgetLimits(page, axis) {
  const marks = [16.67, 8.333, 4, 2, 1].filter((b) => !page.budget || Math.abs(b / page.budget - 1) > 0.05);
  const limits = marks.map((value) => ({ axis, value, label: `${Number(value.toPrecision(3))}` }));
  if (page.budget) limits.push({ axis, value: page.budget, label: `budget ${page.budget} ms`, strong: true });
  return limits.sort((a, b) => (a.strong ? -1 : b.strong ? 1 : a.value - b.value))
               .sort((a, b) => a.value - b.value);
}
