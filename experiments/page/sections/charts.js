// Draws the page's charts, each with the words for those who cannot see it and for where it is empty.
import {is_isothermal, method_label, parts_of} from '../answer.js';
import {draw} from '../chart.js';
import {difference, distribution} from '../charts/distribution.js';
import {
  energy_drift,
  methods_at_rounding,
  methods_drawn,
  rounding,
} from '../charts/energy_drift.js';
import {energy_trace} from '../charts/energy_trace.js';
import {error_against_cost, failures_without_cost} from '../charts/error_against_cost.js';
import {error_against_step} from '../charts/error_against_step.js';
import {method_step_map} from '../charts/method_step_map.js';
import {replace} from '../dom.js';
import {number, observable_short} from '../format.js';
import {method_tag} from '../palette.js';
import {failure_rows, scene_cells} from '../rows.js';

export function draw_errors(now) {
  const what = `${observable_short(now.observable)}, ${now.scene}`;
  const empty = `No cell of ${now.scene} has a resolved error of ${observable_short(now.observable)}: the map below says why.`;
  const cost = error_against_cost(now);
  draw(
    'chart-cost',
    cost,
    cost ? `Error against cost on logarithmic axes, one line for each method: ${what}` : empty,
  );
  const step = error_against_step(now);
  draw(
    'chart-step',
    step,
    step ? `Error against time step on logarithmic axes, one line for each method: ${what}` : empty,
  );
  draw(
    'chart-map',
    method_step_map({...now, cells: scene_cells(now.result, now.scene)}),
    `Map of the error by method and time step: ${what}`,
  );
  const uncosted = failures_without_cost(now);
  const without = [...new Set(uncosted.map((row) => row.method))].map((method) => {
    const steps = uncosted.filter((row) => row.method === method).map((row) => row.step_text);
    return `${method} at step ${steps.join(', ')}`;
  });
  replace(
    'failed-note',
    failure_rows(scene_cells(now.result, now.scene), now.unit).length
      ? ' Crosses in the band along the top are cells that failed (u < 0: an internal energy fell below zero).'
      : '',
  );
  replace(
    'cost-note',
    without.length
      ? `Failed before a cost could be taken, so not drawn: ${without.join('; ')}.`
      : '',
  );
  replace(
    'map-note',
    parts_of(now.observable, is_isothermal(scene_cells(now.result, now.scene))).length > 1
      ? 'Each square shows the worst of kinetic temperature, internal temperature and variance of internal energy. '
      : '',
  );
}

function unit_of(now, observable) {
  const unit = scene_cells(now.result, now.scene)
    .map((cell) => cell.observables?.[observable]?.unit)
    .find(Boolean);
  return unit ? `, ${unit.replaceAll('^2', '²')}` : '';
}

export function draw_drift(now) {
  const at_rounding = methods_at_rounding(now);
  const kept_text = `Every method measured keeps the energy to rounding (below ${number(rounding)} kT per particle).`;
  const isothermal = is_isothermal(scene_cells(now.result, now.scene));
  const empty = (what) => {
    if (isothermal) return 'Energy comes and goes with the bath of an isothermal scene.';
    return at_rounding.length ? kept_text : `No ${what} was measured in this scene.`;
  };
  const drift = energy_drift(now, 'energy_drift', '|drift|, kT per particle and unit time');
  const walk = energy_drift(now, 'energy_walk', `random walk${unit_of(now, 'energy_walk')}`);
  draw(
    'chart-drift',
    drift,
    drift
      ? `Energy drift against time step on logarithmic axes: ${now.scene}`
      : empty('energy drift'),
  );
  draw(
    'chart-walk',
    walk,
    walk
      ? `Random walk of the energy against time step on logarithmic axes: ${now.scene}`
      : empty('random walk of the energy'),
  );
  replace(
    'drift-legend',
    methods_drawn(now).map((label) => method_tag(label, now.labels)),
  );
  replace(
    'drift-note',
    at_rounding.length
      ? `Not drawn, for their energy is kept to rounding at every step: ${at_rounding.join(', ')}.`
      : '',
  );
}

export function draw_trace({result, labels, scene, trace_step}) {
  const spec = energy_trace({
    cells: scene_cells(result, scene),
    time_step: trace_step,
    labels,
  });
  draw(
    'chart-trace',
    spec,
    spec
      ? `Energy against time at step ${number(trace_step)}, one line for each method: ${scene}`
      : 'No energy trace was recorded in this scene.',
  );
}

const laws = [
  {
    key: 'internal_energy',
    id: 'internal-energy',
    name: 'Internal energy u of a particle',
    title: 'internal energy u',
    y_title: 'density',
  },
  {
    key: 'momentum',
    id: 'momentum',
    name: 'Momentum component p of a particle',
    title: 'momentum component p',
    y_title: 'density',
  },
  {
    key: 'radial_distribution',
    id: 'radial',
    name: 'Radial distribution g(r)',
    title: 'distance r',
    y_title: 'g(r)',
  },
];

export function draw_laws({result, scene, law_method, law_step}) {
  const cell = scene_cells(result, scene).find(
    (entry) => method_label(entry) === law_method && entry.time_step === law_step,
  );
  for (const {key, id, name, title, y_title} of laws) {
    const curve = cell?.curves?.[key];
    const where = cell ? `${law_method} at step ${number(law_step)}` : scene;
    document.getElementById(`law-${id}`).hidden =
      key === 'radial_distribution' && !curve?.x?.length;
    const both = {curve, title, y_title};
    draw(
      `chart-${id}`,
      distribution(both),
      curve
        ? `${name}: measured density over the exact law, ${where}`
        : `${name}: nothing was recorded in this scene.`,
    );
    const below = difference(both);
    draw(
      `chart-${id}-difference`,
      below,
      below ? `${name}: measured less exact density, ${where}` : 'No exact law to subtract.',
    );
  }
  replace(
    'law-note',
    cell?.conditioned_on_survival
      ? 'Some replicas of this cell failed: these curves are of the survivors alone.'
      : '',
  );
}
