// SPDX-License-Identifier: MIT

/** The smallest value such that a share of at least `share` is no larger; null of nothing. */
export function quantile(values, share) {
  const known = values.filter((v) => v !== null && v !== undefined).sort((a, b) => a - b);
  if (known.length === 0) return null;
  return known[Math.max(0, Math.ceil(share * known.length) - 1)];
}

export const median = (values) => quantile(values, 0.5);

/** Three digits. */
export function format(value) {
  if (value === null || value === undefined) return "-";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-3 || size >= 1e5) return value.toExponential(0).replace("e+", "e");
  return String(Number(value.toPrecision(3)));
}

/** Kind of a solver: its label without the iterations of its own. */
export const kindOf = (label) => label.split("@")[0];

/** Indices of the first solver of each kind. */
export function firstOfKinds(solvers) {
  const seen = new Set();
  return solvers.map((_, i) => i).filter((i) => {
    const kind = kindOf(solvers[i].label);
    return !seen.has(kind) && seen.add(kind);
  });
}
