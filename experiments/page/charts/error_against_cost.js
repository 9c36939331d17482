import {error_rows, failure_rows, scene_cells} from '../rows.js';
import {error_chart} from './error_chart.js';
import {error_axis, tolerance_line} from './error_axis.js';

export function error_against_cost({result, scene, observable, tolerance, unit, labels, winner}) {
  const cells = scene_cells(result, scene);
  const rows = error_rows(cells, observable, unit);
  const best = winner?.best.cell;
  return error_chart({
    rows, failures: failure_rows(cells, unit), labels,
    x: {field: 'cost', title: `cost, ${unit.name} per unit of simulated time`}, y: error_axis(observable),
    tolerance: tolerance_line(observable, tolerance),
    answer: best ? rows.find((row) => row.method === winner.label && row.time_step === best.time_step) : null,
  });
}
