// Numbers and words as a reader wants them.

const superscripts = {
  '-': '⁻',
  0: '⁰',
  1: '¹',
  2: '²',
  3: '³',
  4: '⁴',
  5: '⁵',
  6: '⁶',
  7: '⁷',
  8: '⁸',
  9: '⁹',
};

export function power_of_ten(exponent) {
  return `10${[...String(exponent)].map((digit) => superscripts[digit]).join('')}`;
}

function with_minus(text) {
  return text.replace(/^-/, '−');
}

// `digits` significant digits; powers of ten outside 1e-4 .. 1e6.
export function number(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const exponent = Math.floor(Math.log10(Math.abs(value)));
  if (exponent < -4 || exponent > 5) {
    return with_minus(
      `${Number((value / 10 ** exponent).toPrecision(digits))}·${power_of_ten(exponent)}`,
    );
  }
  return with_minus(String(Number(value.toPrecision(digits))));
}

// A mean and its standard error as 1.0983(7); the error keeps two digits where it starts with 1.
export function with_error(mean, error) {
  if (!Number.isFinite(mean)) return '–';
  if (!(error > 0)) return number(mean, 6);
  const size = Math.floor(Math.log10(Math.max(Math.abs(mean), error)));
  const scale = size < -4 || size > 5 ? 10 ** size : 1;
  const scaled_error = error / scale;
  const exponent = Math.floor(Math.log10(scaled_error));
  const leading = Math.floor(scaled_error / 10 ** exponent);
  const decimals = Math.max(0, -exponent + (leading === 1 ? 1 : 0));
  const shown_error =
    decimals === 0
      ? String(Math.round(scaled_error))
      : String(Math.round(scaled_error * 10 ** decimals));
  const text = `${with_minus((mean / scale).toFixed(decimals))}(${shown_error})`;
  return scale === 1 ? text : `${text}·${power_of_ten(size)}`;
}

export function percent(value, digits = 2) {
  return `${number(value * 100, digits)} %`;
}

// A bound is rounded up, never below itself.
export function bound_text(value, observable, digits = 2) {
  if (!(value > 0)) return deviation(value, observable, digits);
  const unit = 10 ** (Math.floor(Math.log10(value)) + 1 - digits);
  return deviation(unit * Math.ceil((value / unit) * (1 - 1e-12)), observable, digits);
}

// What 95 % intervals reach to either side of a value with this standard error.
export function interval_reach(error) {
  return 1.96 * (error ?? 0);
}

export function deviation(value, observable, digits = 2) {
  return is_relative(observable) ? percent(value, digits) : number(value, digits);
}

// Deviations of these are absolute: kT per particle and unit time, or a distance of distributions.
const absolute = new Set(['energy_drift', 'momentum_distance', 'internal_energy_distance']);
export function is_relative(observable) {
  return !absolute.has(observable);
}

const titles = {
  equilibrium: 'equilibrium (the worst of the next three)',
  kinetic_temperature: 'kinetic temperature',
  internal_temperature: 'internal temperature',
  internal_energy_variance: 'variance of internal energy',
  configurational_temperature: 'configurational temperature',
  internal_energy_mean: 'mean internal energy',
  internal_energy_skewness: 'skewness of internal energy',
  momentum_distance: 'distribution of momenta',
  internal_energy_distance: 'distribution of internal energies',
  kinetic_share: 'kinetic share of the energy',
  energy_drift: 'energy drift',
};

export function observable_title(name) {
  return titles[name] ?? name.replaceAll('_', ' ');
}

export function observable_short(name) {
  return name === 'equilibrium' ? 'equilibrium' : observable_title(name);
}

const statuses = {
  ok: 'ok',
  unstable: 'unstable',
  negative_internal_energy: 'negative internal energy',
  not_converged: 'not converged',
  not_applicable: 'not applicable',
};

export function status_title(status) {
  return statuses[status] ?? status.replaceAll('_', ' ');
}

// Costs are shown in one unit throughout a page: s, ms or µs by their median.
export function cost_unit(result) {
  const costs = result.cells
    .map((cell) => cell.cost?.core_seconds_per_time)
    .filter((cost) => cost > 0)
    .sort((a, b) => a - b);
  const median = costs[Math.floor(costs.length / 2)] ?? 1;
  if (median < 1e-3) return {factor: 1e6, name: 'core-µs'};
  if (median < 1) return {factor: 1e3, name: 'core-ms'};
  return {factor: 1, name: 'core-s'};
}
