// The page: reads the result, keeps the choosers' state and draws every part from it.
import {answer, method_label, parts_of} from './answer.js';
import {all_drawn, draw} from './chart.js';
import {difference, distribution} from './charts/distribution.js';
import {energy_drift, methods_at_rounding, methods_drawn, rounding} from './charts/energy_drift.js';
import {energy_trace} from './charts/energy_trace.js';
import {error_against_cost, failures_without_cost} from './charts/error_against_cost.js';
import {error_against_step} from './charts/error_against_step.js';
import {method_step_map} from './charts/method_step_map.js';
import {fill_select, replace} from './dom.js';
import {
  cost_unit,
  is_relative,
  number,
  observable_short,
  observable_title,
  percent,
} from './format.js';
import {method_tag} from './palette.js';
import {method_labels, scene_cells, time_steps} from './rows.js';
import {render_answer} from './sections/answer.js';
import {render_orders} from './sections/orders.js';
import {render_provenance, render_scenes} from './sections/provenance.js';
import {render_agreement, render_failures} from './sections/trust.js';

const result = JSON.parse(document.getElementById('result').textContent);
const tolerances = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1];
const usual_order = [
  'equilibrium',
  'kinetic_temperature',
  'internal_temperature',
  'internal_energy_variance',
];

const labels = method_labels(result);
const shared = {result, labels, unit: cost_unit(result)};
const state = {
  scene: result.scenes[0]?.name,
  observable: 'equilibrium',
  tolerance: 0.01,
  trace_step: null,
  law_method: null,
  law_step: null,
};

function observables() {
  const known = new Set();
  for (const cell of result.cells) {
    for (const [name, value] of Object.entries(cell.observables ?? {}))
      if (value.deviation) known.add(name);
  }
  return [...usual_order, ...[...known].filter((name) => !usual_order.includes(name))];
}

function context() {
  const {winner} = answer(result, state.scene, state.observable, state.tolerance);
  return {...shared, ...state, winner};
}

const curves_of = (cells) =>
  cells.filter((cell) => Object.values(cell.curves ?? {}).some((curve) => curve?.x?.length));

// Keeps a choice while the scene still offers it, else takes a likely one.
function kept(choice, offered, likely) {
  return offered.includes(choice)
    ? choice
    : offered.includes(likely)
      ? likely
      : (offered[0] ?? null);
}

function set_detail_choosers(now) {
  const cells = scene_cells(result, state.scene);
  const best_step = now.winner?.best.cell.time_step;
  const steps = time_steps(cells.filter((cell) => cell.energy_trace?.time?.length));
  state.trace_step = kept(state.trace_step, steps, best_step);
  fill_select(
    'trace-step',
    steps.map((value) => ({value, title: number(value)})),
    state.trace_step,
    choose('trace_step', draw_trace),
  );
  const methods = [...new Set(curves_of(cells).map(method_label))];
  state.law_method = kept(state.law_method, methods, now.winner?.label);
  fill_select(
    'law-method',
    methods.map((value) => ({value, title: value})),
    state.law_method,
    choose('law_method', draw_laws),
  );
  set_law_steps(best_step);
}

function set_law_steps(likely) {
  const cells = curves_of(scene_cells(result, state.scene)).filter(
    (cell) => method_label(cell) === state.law_method,
  );
  const steps = time_steps(cells);
  state.law_step = kept(state.law_step, steps, likely);
  fill_select(
    'law-step',
    steps.map((value) => ({value, title: number(value)})),
    state.law_step,
    choose('law_step', draw_laws),
  );
}

function choose(key, draw_again) {
  return (value) => {
    state[key] = value;
    settle(draw_again);
  };
}

function draw_errors(now) {
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
    method_step_map({...now, cells: scene_cells(result, now.scene)}),
    `Map of the error by method and time step: ${what}`,
  );
  const without = failures_without_cost(now).map(
    (row) => `${row.method} at step ${row.step_text} (${row.status_text})`,
  );
  replace(
    'cost-note',
    without.length
      ? `Failed before a cost could be taken, so not drawn: ${without.join('; ')}.`
      : '',
  );
  replace(
    'map-note',
    parts_of(now.observable).length > 1
      ? 'Each square shows the worst of kinetic temperature, internal temperature and variance of internal energy. '
      : '',
  );
}

function unit_of(now, observable) {
  const unit = scene_cells(result, now.scene)
    .map((cell) => cell.observables?.[observable]?.unit)
    .find(Boolean);
  return unit ? `, ${unit.replaceAll('^2', '²')}` : '';
}

function draw_drift(now) {
  const at_rounding = methods_at_rounding(now);
  const kept_text = `Every method measured keeps the energy to rounding (below ${number(rounding)} kT per particle).`;
  const empty = (what) =>
    at_rounding.length ? kept_text : `No ${what} was measured in this scene.`;
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
    methods_drawn(now).map((label) => method_tag(label, labels)),
  );
  replace(
    'drift-note',
    at_rounding.length
      ? `Not drawn, for their energy is kept to rounding at every step: ${at_rounding.join(', ')}.`
      : '',
  );
}

function draw_trace() {
  const spec = energy_trace({
    cells: scene_cells(result, state.scene),
    time_step: state.trace_step,
    labels,
  });
  draw(
    'chart-trace',
    spec,
    spec
      ? `Energy against time at step ${number(state.trace_step)}, one line for each method: ${state.scene}`
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

function draw_laws() {
  set_law_steps();
  const cell = scene_cells(result, state.scene).find(
    (entry) => method_label(entry) === state.law_method && entry.time_step === state.law_step,
  );
  for (const {key, id, name, title, y_title} of laws) {
    const curve = cell?.curves?.[key];
    const where = cell ? `${state.law_method} at step ${number(state.law_step)}` : state.scene;
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

function draw_all() {
  const now = context();
  replace(
    'tolerance-note',
    is_relative(state.observable)
      ? ''
      : `For this observable the tolerance is absolute: ${percent(state.tolerance)} stands for ${number(state.tolerance)}.`,
  );
  render_answer(now);
  render_orders(now);
  render_agreement(now);
  render_failures(now);
  set_detail_choosers(now);
  draw_errors(now);
  draw_drift(now);
  draw_trace();
  draw_laws();
}

// Marks the page as ready once its charts stand, for whoever waits for it.
let turn = 0;
async function settle(draw_again) {
  const mine = ++turn;
  document.body.dataset.state = 'drawing';
  draw_again();
  await all_drawn();
  if (mine === turn) document.body.dataset.state = 'ready';
}

function start() {
  document.title = `${result.name} · Driftless`;
  replace('title', result.name);
  fill_select(
    'scene',
    result.scenes.map(({name}) => ({value: name, title: name})),
    state.scene,
    choose('scene', draw_all),
  );
  fill_select(
    'observable',
    observables().map((value) => ({value, title: observable_title(value)})),
    state.observable,
    choose('observable', draw_all),
  );
  fill_select(
    'tolerance',
    tolerances.map((value) => ({value, title: percent(value)})),
    state.tolerance,
    choose('tolerance', draw_all),
  );
  render_scenes(shared);
  render_provenance(shared);
  settle(draw_all);
}

start();
