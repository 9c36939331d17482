import {number} from './format.js';

// Domains and ticks of logarithmic axes. An interval that reaches zero ends at the frame's lower edge.

export function log_domain(values, padding = 1.3) {
  const positive = values.filter((value) => value > 0 && Number.isFinite(value));
  if (!positive.length) return [0.1, 10];
  return [Math.min(...positive) / padding, Math.max(...positive) * padding];
}

export function log_ticks([from, to]) {
  const decades = Math.log10(to / from);
  const steps = decades > 4.5 ? [1] : decades > 2.2 ? [1, 3] : [1, 2, 5];
  const every = Math.ceil(decades / 9);
  const ticks = [];
  for (let exponent = Math.floor(Math.log10(from)); exponent <= Math.log10(to); ++exponent) {
    if (exponent % every !== 0) continue;
    for (const step of steps) ticks.push(Number(`${step}e${exponent}`));
  }
  return ticks.filter((tick) => tick >= from && tick <= to);
}

// The floor lies below the smallest upper end and the smallest resolved value; what is below noise,
// or an interval that almost reaches zero, must not stretch the axis towards zero.
export function error_domain(rows, also = []) {
  const firm = rows.flatMap((row) =>
    row.below_noise
      ? [row.upper, row.bound]
      : [row.value, row.upper, row.bound, Math.max(row.lower, row.value / 4)],
  );
  const [low, high] = log_domain([...firm, ...also], 1);
  return [low / (rows.some((row) => row.below_noise) ? 2.5 : 1.4), high * 1.5];
}

// An axis of these ticks, labelled as the rest of the page writes numbers.
export function log_axis(ticks) {
  const labels = JSON.stringify(ticks.map((tick) => number(tick).replace(/^1·/, '')));
  return {
    values: ticks,
    labelExpr: `${labels}[indexof(${JSON.stringify(ticks)}, datum.value)]`,
    labelOverlap: true,
  };
}
