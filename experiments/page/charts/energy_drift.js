// The systematic drift of the energy, and its random walk, against the step.
import {error_rows, scene_cells, size_rows} from '../rows.js';
import {step_axis} from './error_against_step.js';
import {error_chart} from './error_chart.js';

// Below this, in kT per particle, an energy counts as kept to rounding and stays off the chart.
export const rounding = 1e-8;

export function drift_rows({result, scene, unit}, observable) {
  const cells = scene_cells(result, scene);
  const rows = observable === 'energy_drift' ? error_rows(cells, observable, unit) : [];
  return rows.length ? rows : size_rows(cells, observable, unit);
}

// Methods that the charts of drift or walk show.
export function methods_drawn(context) {
  const rows = ['energy_drift', 'energy_walk'].flatMap((observable) =>
    drift_rows(context, observable),
  );
  return context.labels.filter((label) =>
    rows.some((row) => row.method === label && row.upper > rounding),
  );
}

export function energy_drift(context, observable, title) {
  const cells = scene_cells(context.result, context.scene);
  const rows = drift_rows(context, observable).filter((row) => row.upper > rounding);
  if (!rows.length) return null;
  return error_chart({
    rows,
    failures: [],
    labels: context.labels,
    legend: {methods: false, orient: 'bottom'},
    x: step_axis(cells),
    y: {title, scale: 1, size_title: 'size'},
    height: 300,
  });
}

// Methods whose every measured step lies at rounding.
export function methods_at_rounding(context) {
  const rows = drift_rows(context, 'energy_drift');
  const all = [...new Set(rows.map((row) => row.method))];
  return all.filter((method) =>
    rows.every((row) => row.method !== method || row.upper <= rounding),
  );
}
