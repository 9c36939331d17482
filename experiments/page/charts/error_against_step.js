import {is_isothermal} from '../answer.js';
import {error_rows, failure_rows, scene_cells, time_steps} from '../rows.js';
import {error_axis, tolerance_line} from './error_axis.js';
import {error_chart} from './error_chart.js';

// The steps themselves as ticks while they are few.
export function step_axis(cells) {
  const steps = time_steps(cells);
  const ticks = steps.length <= 8 ? {ticks: steps} : {};
  const domain = [steps[0] / 1.35, steps[steps.length - 1] * 1.25];
  const aside = (domain[1] / domain[0]) ** (1 / 110);
  return {field: 'time_step', title: 'time step', domain, aside, label_side: 'left', ...ticks};
}

export function error_against_step({result, scene, observable, tolerance, unit, labels}) {
  const cells = scene_cells(result, scene);
  if (!cells.length) return null;
  return error_chart({
    rows: error_rows(cells, observable, unit),
    failures: failure_rows(cells, unit),
    labels,
    legend: {methods: false, orient: 'bottom'},
    x: step_axis(cells),
    y: error_axis(observable, is_isothermal(cells)),
    tolerance: tolerance_line(observable, tolerance),
  });
}
