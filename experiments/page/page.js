// The page: reads the result, keeps the choosers' state and draws every part from it.
import {answer_of, is_isothermal, method_label, tolerances_of} from './answer.js';
import {settle} from './chart.js';
import {fill_select, replace} from './dom.js';
import {cost_unit, is_relative, number, observable_title, percent} from './format.js';
import {method_labels, scene_cells, time_steps} from './rows.js';
import {render_answer} from './sections/answer.js';
import {draw_drift, draw_errors, draw_laws, draw_trace} from './sections/charts.js';
import {render_orders} from './sections/orders.js';
import {render_provenance, render_scenes} from './sections/provenance.js';
import {render_agreement, render_failures} from './sections/trust.js';

const result = JSON.parse(document.getElementById('result').textContent);
const usual_order = [
  'equilibrium',
  'kinetic_temperature',
  'internal_temperature',
  'internal_energy_variance',
];

const labels = method_labels(result);
const tolerances = tolerances_of(result);
const shared = {result, labels, unit: cost_unit(result)};
const state = {
  scene: result.scenes[0]?.name,
  observable: 'equilibrium',
  tolerance: tolerances.includes(0.05) ? 0.05 : tolerances[0],
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
  // Where no scene has internal energies nothing usual is left but the kinetic temperature.
  const usual = is_isothermal(result.cells)
    ? usual_order.filter((name) => name === 'equilibrium' || known.has(name))
    : usual_order;
  return [...usual, ...[...known].filter((name) => !usual_order.includes(name))];
}

function context() {
  const answer = answer_of(result, state.scene, state.observable, state.tolerance);
  const winner = answer?.method
    ? {label: answer.method, time_step: answer.time_step, cost: answer.cost}
    : null;
  return {...shared, ...state, answer, winner};
}

const curves_of = (cells) =>
  cells.filter((cell) => Object.values(cell.curves ?? {}).some((curve) => curve?.x?.length));

// Keeps a choice while the scene still offers it, else takes a likely one.
function kept(choice, offered, likely) {
  return [choice, likely].find((value) => offered.includes(value)) ?? offered[0] ?? null;
}

function set_detail_choosers(now) {
  const cells = scene_cells(result, state.scene);
  const best_step = now.winner?.time_step;
  const steps = time_steps(cells.filter((cell) => cell.energy_trace?.time?.length));
  state.trace_step = kept(state.trace_step, steps, best_step);
  fill_select(
    'trace-step',
    steps.map((value) => ({value, title: number(value)})),
    state.trace_step,
    choose('trace_step', () => draw_trace(context())),
  );
  const methods = [...new Set(curves_of(cells).map(method_label))];
  state.law_method = kept(state.law_method, methods, now.winner?.label);
  fill_select(
    'law-method',
    methods.map((value) => ({value, title: value})),
    state.law_method,
    choose('law_method', () => {
      set_law_steps();
      draw_laws(context());
    }),
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
    choose('law_step', () => draw_laws(context())),
  );
}

function choose(key, draw_again) {
  return (value) => {
    state[key] = value;
    settle(draw_again);
  };
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
  // The detail choosers may have changed the state.
  const settled = context();
  draw_errors(settled);
  draw_drift(settled);
  draw_trace(settled);
  draw_laws(settled);
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
