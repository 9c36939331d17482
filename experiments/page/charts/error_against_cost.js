import {is_isothermal} from '../answer.js';
import {error_rows, failure_rows, scene_cells} from '../rows.js';
import {error_axis, tolerance_line} from './error_axis.js';
import {error_chart} from './error_chart.js';

export function error_against_cost({result, scene, observable, tolerance, unit, labels, winner}) {
  const cells = scene_cells(result, scene);
  return error_chart({
    rows: error_rows(cells, observable, unit),
    failures: failure_rows(cells, unit),
    labels,
    x: {field: 'cost', title: `cost, ${unit.name} per unit time`, label_side: 'right'},
    y: error_axis(observable, is_isothermal(cells)),
    tolerance: tolerance_line(observable, tolerance),
    legend: {methods: true, orient: 'right', title: 'method'},
    is_answer: winner
      ? (row) => row.method === winner.label && row.time_step === winner.time_step
      : null,
  });
}

// Failed cells that no cost is known of have no place on the chart.
export function failures_without_cost({result, scene, unit}) {
  return failure_rows(scene_cells(result, scene), unit).filter((row) => !(row.cost > 0));
}
