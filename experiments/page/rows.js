// From cells to the flat rows that charts draw.
import {cost_of, judge, method_label} from './answer.js';
import {
  bound_text,
  deviation,
  interval_reach,
  number,
  observable_short,
  status_title,
  with_error,
} from './format.js';

export function scene_cells(result, scene) {
  return result.cells.filter((cell) => cell.scene === scene);
}

export function method_labels(result) {
  return [...new Set(result.cells.map(method_label))];
}

export function time_steps(cells) {
  return [...new Set(cells.map((cell) => cell.time_step))].sort((a, b) => a - b);
}

function shared_fields(cell, unit) {
  const cost = cost_of(cell);
  return {
    method: method_label(cell),
    time_step: cell.time_step,
    step_text: number(cell.time_step),
    cost: cost === null ? null : cost * unit.factor,
    cost_text: cost === null ? 'not known' : `${number(cost * unit.factor)} ${unit.name}`,
  };
}

// Deviations of an observable, with texts for tooltips.
export function error_rows(cells, observable, unit) {
  return cells
    .map((cell) => ({cell, judgement: judge(cell, observable)}))
    .filter(({judgement}) => judgement.upper > 0)
    .map(({cell, judgement}) => ({
      ...shared_fields(cell, unit),
      value: judgement.value,
      lower: judgement.lower,
      upper: judgement.upper,
      bound: judgement.bound,
      below_noise: judgement.state === 'below_noise',
      error_text: deviation(judgement.value, observable),
      interval_text: `${deviation(judgement.lower, observable)} … ${deviation(judgement.upper, observable)}`,
      bound_text: bound_text(judgement.bound, observable),
      worst_text: observable_short(judgement.worst),
      mean_text: mean_text(cell.observables[judgement.worst]),
    }));
}

// A measured size without an exact value, such as the random walk of the energy.
export function size_rows(cells, observable, unit) {
  return cells
    .filter((cell) => cell.status === 'ok' && Number.isFinite(cell.observables?.[observable]?.mean))
    .map((cell) => {
      const {mean, error} = cell.observables[observable];
      const value = Math.abs(mean);
      const half = interval_reach(error);
      const below_noise = value - half <= 0;
      return {
        ...shared_fields(cell, unit),
        value,
        lower: Math.max(0, value - half),
        upper: value + half,
        below_noise,
        error_text: number(value, 2),
        interval_text: `${number(Math.max(0, value - half), 2)} … ${number(value + half, 2)}`,
        worst_text: observable_short(observable),
        mean_text: with_error(mean, error),
      };
    })
    .filter((row) => row.upper > 0);
}

export function failure_rows(cells, unit) {
  const failed = cells.filter((cell) => cell.status !== 'ok' && cell.status !== 'not_applicable');
  return failed.map((cell) => ({
    ...shared_fields(cell, unit),
    status_text: status_title(cell.status),
    short_text: {negative_internal_energy: 'u < 0'}[cell.status] ?? status_title(cell.status),
    failed_text: `${cell.failed_replicas} of ${cell.replicas} replicas`,
    cause_text: cell.failures?.[0]?.cause ?? '',
  }));
}

export function mean_text(observable) {
  if (!observable || !Number.isFinite(observable.mean)) return '–';
  const exact = Number.isFinite(observable.exact)
    ? `, exact ${with_error(observable.exact, observable.exact_error)}`
    : '';
  return `${with_error(observable.mean, observable.error)}${exact}`;
}
