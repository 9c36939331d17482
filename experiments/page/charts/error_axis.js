import {parts_of} from '../answer.js';
import {deviation, is_relative, observable_short} from '../format.js';

const units = {
  energy_drift: '|energy drift|, kT per particle and unit time',
  momentum_distance: 'distance from the exact law of momenta',
  internal_energy_distance: 'distance from the exact law of internal energies',
};

export function error_axis(observable, isothermal = false) {
  const parts = parts_of(observable, isothermal);
  const title =
    parts.length > 1
      ? 'largest of the three equilibrium errors, %'
      : `error of ${observable_short(parts[0])}, %`;
  return {
    title: units[observable] ?? title,
    scale: is_relative(observable) ? 100 : 1,
    size_title: 'error',
  };
}

export function tolerance_line(observable, tolerance) {
  return {value: tolerance, text: `tolerance ${deviation(tolerance, observable)}`};
}
