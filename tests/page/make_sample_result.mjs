// Writes sample_result.json: an invented but plausible result for the tests of the page, without what
// the program derives from its cells (deviations, orders, answers). Always the same bytes:
// node tests/page/make_sample_result.mjs
import {writeFileSync} from 'node:fs';

const time_steps = [0.01, 0.02, 0.05, 0.1, 0.2];
const boltzmann_temperature = 0.55;
const shape = 51;
const replicas = 4;

// order and size of the error at step 0.1, core-seconds per step, step from which it fails, and how.
// The limit of this one is not the model: it is named beside an answer, never the answer.
const inconsistent = 'isoenergetic-verlet';
const methods = [
  {
    name: 'averaged-drift',
    options: {as_published: true},
    order: 1,
    size: 0.031,
    per_step: 1.0e-4,
    drift: 2e-3,
    fails_from: 0.2,
    failure: 'negative_internal_energy',
  },
  {
    name: 'avalos-mackie-implicit',
    order: 1,
    size: 0.012,
    per_step: 3.4e-4,
    drift: 6e-4,
    fails_from: 0.2,
    failure: 'not_converged',
  },
  {
    name: 'avalos-mackie-midpoint',
    order: 2,
    size: 0.006,
    per_step: 3.9e-4,
    drift: 0,
    fails_from: 1,
    failure: '',
  },
  {
    name: 'espanol',
    order: 1,
    size: 0.035,
    per_step: 0.9e-4,
    drift: 3e-3,
    fails_from: 0.1,
    failure: 'unstable',
    noise_only: true,
  },
  {
    name: 'marsh-coveney',
    order: 1,
    size: 0.028,
    per_step: 0.95e-4,
    drift: 2.4e-3,
    fails_from: 0.2,
    failure: 'unstable',
    noise_only: true,
  },
  {
    name: 'shardlow-s1',
    order: 1,
    size: 0.008,
    per_step: 1.4e-4,
    drift: 0,
    fails_from: 1,
    failure: '',
  },
  {
    name: 'shardlow-s2',
    order: 2,
    size: 0.005,
    per_step: 2.2e-4,
    drift: 0,
    fails_from: 1,
    failure: '',
  },
  {
    name: 'isoenergetic-verlet',
    order: 2,
    size: 0.015,
    per_step: 1.3e-4,
    drift: 0,
    fails_from: 0.2,
    failure: 'unstable',
    noise_only: true,
  },
];

let random_state = 20240229;
function uniform() {
  // mulberry32
  random_state = (random_state + 0x6d2b79f5) | 0;
  let t = Math.imul(random_state ^ (random_state >>> 15), 1 | random_state);
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
  return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
}
const normal = () => Math.sqrt(-2 * Math.log(1 - uniform())) * Math.cos(2 * Math.PI * uniform());
const rounded = (value, digits = 5) => Number(value.toPrecision(digits));

function measured(exact, bias, relative_error, unit, scale = Math.abs(exact)) {
  const error = relative_error * scale;
  const mean = exact + bias * scale + error * normal();
  return {
    mean: rounded(mean, 7),
    error: rounded(error, 3),
    effective_samples: Math.round(2e3 + 6e3 * uniform()),
    exact: rounded(exact, 7),
    degrees_of_freedom: 60,
    unit,
    status: 'ok',
  };
}

function measured_only(mean, error, unit) {
  return {
    mean: rounded(mean, 6),
    error: rounded(error, 3),
    effective_samples: Math.round(2e3 + 3e3 * uniform()),
    unit,
    status: 'ok',
  };
}

function distance(bias) {
  const error = 4e-6;
  const mean = bias * bias * 0.3 + error * normal();
  return {
    mean: rounded(mean),
    error: rounded(error),
    effective_samples: 4000,
    exact: 0,
    unit: '1',
    status: 'ok',
  };
}

function observables_of(method, time_step, scene_index) {
  const bias = method.size * (time_step / 0.1) ** method.order;
  const noise = 6e-4;
  const drift = method.drift * (time_step / 0.1) ** 2;
  const values = {
    kinetic_temperature: measured(1.1, -bias, noise, 'T'),
    internal_temperature: measured(1.1, 0.4 * bias, noise * 0.7, 'T'),
    internal_energy_mean: measured(shape * boltzmann_temperature, 0.05 * bias, noise * 0.3, 'kT'),
    internal_energy_variance: measured(
      shape * boltzmann_temperature ** 2,
      1.2 * bias,
      noise * 2.5,
      'kT^2',
    ),
    internal_energy_skewness: measured(2 / Math.sqrt(shape), 2 * bias, noise * 20, '1'),
    momentum_distance: distance(bias),
    internal_energy_distance: distance(0.8 * bias),
    pressure: measured(0.55, -bias, noise * 1.5, 'm/(l t^2)'),
    kinetic_share: measured(0.0287, -bias, noise * 1.2, '1'),
    energy_drift: measured(0, method.drift ? drift : 0, method.drift ? 4e-6 : 1e-13, 'kT/time', 1),
    energy_walk: measured_only(
      method.drift ? 2 * method.drift * (time_step / 0.1) : 2e-24,
      method.drift ? (1e-4 * method.drift) / 1e-3 : 4e-25,
      '(kT)^2/time',
    ),
    momentum_error: measured_only(3e-15, 6e-16, 'momentum'),
  };
  if (scene_index === 1)
    not_resolved(values.internal_energy_skewness, 'needs 20 relaxation times, had 14');
  if (method.name === 'averaged-drift' && time_step === 0.01) {
    for (const name of [
      'internal_temperature',
      'internal_energy_mean',
      'internal_energy_variance',
      'internal_energy_skewness',
      'internal_energy_distance',
    ]) {
      not_resolved(values[name], 'replicas disagree beyond their errors');
    }
  }
  return values;
}

function not_resolved(observable, note) {
  observable.status = 'not_resolved';
  observable.note = note;
}

function log_gamma(x) {
  // Stirling series, enough for x > 8
  return (
    (x - 0.5) * Math.log(x) - x + 0.5 * Math.log(2 * Math.PI) + 1 / (12 * x) - 1 / (360 * x ** 3)
  );
}

function curve(from, to, exact_law, measured_law) {
  const count = 24;
  const x = Array.from({length: count}, (_, i) => from + ((to - from) * (i + 0.5)) / count);
  const exact = x.map(exact_law);
  const peak = Math.max(...exact);
  const error = x.map((value) => 0.012 * Math.sqrt(measured_law(value) * peak));
  const density = x.map((value, i) => Math.max(0, measured_law(value) + error[i] * normal()));
  return {
    x: x.map((v) => rounded(v, 4)),
    density: density.map((v) => rounded(v, 4)),
    error: error.map((v) => rounded(v, 3)),
    exact: exact.map((v) => rounded(v, 4)),
  };
}

const gamma_law = (scale) => (u) =>
  Math.exp((shape - 1) * Math.log(u / scale) - u / scale - log_gamma(shape)) / scale;
const normal_law = (variance) => (p) =>
  Math.exp((-p * p) / (2 * variance)) / Math.sqrt(2 * Math.PI * variance);

function curves_of(method, time_step) {
  const bias = method.size * (time_step / 0.1) ** method.order;
  const radial =
    method.name.startsWith('shardlow')
      ? {
          radial_distribution: curve(
            0,
            2.4,
            () => 1,
            () => 1,
          ),
        }
      : {};
  return {
    ...radial,
    internal_energy: curve(
      16,
      42,
      gamma_law(boltzmann_temperature),
      gamma_law(boltzmann_temperature * (1 + bias)),
    ),
    momentum: curve(
      -2.5,
      2.5,
      normal_law(boltzmann_temperature),
      normal_law(boltzmann_temperature * (1 - 3 * bias)),
    ),
  };
}

function trace_of(method, time_step) {
  const time = Array.from({length: 20}, (_, i) => rounded((i + 1) * 25, 4));
  const slope = method.drift * (time_step / 0.1) ** 2;
  const walk = method.drift ? 3e-4 : 1e-14;
  return {time, energy: time.map((t) => rounded(slope * t + walk * Math.sqrt(t) * normal(), 4))};
}

function failures_of(method, time_step) {
  const failed = time_step > method.fails_from ? replicas : 2;
  return Array.from({length: failed}, (_, replica) => {
    const step = Math.round(20 + 4000 * uniform() * (0.1 / time_step) ** 2);
    const causes = {
      unstable: 'momentum is not finite',
      negative_internal_energy: `internal energy of particle ${Math.floor(1000 * uniform())} fell below zero`,
      not_converged: 'fixed-point iteration did not converge in 200 iterations',
    };
    return {replica, cause: causes[method.failure], step, time: rounded(step * time_step, 6)};
  });
}

function off_equilibrium_of(method, time_step) {
  const bias = method.size * (time_step / 0.1) ** method.order;
  const largest_z = rounded(0.8 + 2 * uniform() + (bias > 0.04 ? 5 : 0), 3);
  return {
    agrees: largest_z <= 5,
    largest_z,
    threshold: 5,
    observable: uniform() < 0.5 ? 'internal_temperature' : 'internal_energy_variance',
  };
}

function cost_of(method, time_step, failed) {
  return {
    core_seconds_per_time:
      failed && method.failure === 'not_converged'
        ? null
        : rounded((method.per_step / time_step) * (1 + 0.02 * normal()), 4),
    spread: 0.03,
    pair_evaluations_per_step: 4000,
    random_numbers_per_step: 8000,
    solver_iterations_per_step: method.per_step > 3e-4 ? 7 : 0,
    steps: Math.round(500 / time_step),
  };
}

function cell_of(scene, scene_index, method, time_step) {
  const cell = {
    scene: scene.name,
    method: method.name,
    options: method.options ?? {},
    time_step,
    consistent: method.name !== inconsistent,
  };
  if (method.noise_only && scene.parameters.friction_closure === 'friction') {
    return {
      ...cell,
      status: 'not_applicable',
      reason: `${method.name} is built for the noise closure; this scene has the friction closure`,
      replicas: 0,
      failed_replicas: 0,
      conditioned_on_survival: false,
      observables: {},
      failures: [],
      curves: {},
    };
  }
  const failed = time_step >= method.fails_from;
  const failures = failed ? failures_of(method, time_step) : [];
  const survivors = replicas - failures.length;
  const measured_fields =
    survivors === 0
      ? {observables: {}, curves: {}}
      : {
          observables: observables_of(method, time_step, scene_index),
          off_equilibrium: off_equilibrium_of(method, time_step),
          curves: curves_of(method, time_step),
          energy_trace: trace_of(method, time_step),
        };
  return {
    ...cell,
    status: failed ? method.failure : 'ok',
    replicas,
    failed_replicas: failures.length,
    conditioned_on_survival: failed && survivors > 0,
    ...measured_fields,
    failures,
    cost: cost_of(method, time_step, failed),
  };
}

const shared_parameters = {
  particles: 1000,
  density: 1,
  temperature: 1.1,
  boltzmann: 0.5,
  mass: 1,
  heat_capacity: 50,
  repulsion: 0,
  friction: 1,
  friction_range: 1.24,
  conduction: 850,
  heat_form: 'inverse-temperature',
  heat_range: 1.24,
  weight_exponent: 2,
  frame_velocity: [0, 0, 0],
  frozen: false,
};
const scenes = ['friction', 'noise'].map((closure) => ({
  name: `mackie-1999, ${closure} closure`,
  preset: 'mackie-1999',
  parameters: {...shared_parameters, friction_closure: closure},
  relaxation_time: 11.4,
  resolves_internal_energy: true,
  kinetic_relaxation_time: 1.9,
  resolves_kinetic_energy: true,
  energy_per_particle: 28.875,
  note:
    closure === 'noise'
      ? 'The same friction coefficient at the temperature T, but with the noise amplitude held constant.'
      : undefined,
}));
const cells = scenes.flatMap((scene, index) =>
  methods.flatMap((method) => time_steps.map((step) => cell_of(scene, index, method, step))),
);
const study = {
  format: 'driftless-study/1',
  name: 'first light',
  scenes: scenes.map((scene) => ({
    preset: scene.preset,
    friction_closure: scene.parameters.friction_closure,
  })),
  methods: methods.map((method) =>
    method.options ? {name: method.name, options: method.options} : method.name,
  ),
  time_steps,
  duration: {equilibrate: 60, measure: 500, sample_every: 1},
  replicas,
  seed: 1999,
};
const result = {
  format: 'driftless-result/1',
  name: 'first light',
  provenance: {
    version: '0.1.0',
    commit: '0123456789abcdef0123456789abcdef01234567',
    dirty: false,
    compiler: 'g++ 12.2.0',
    flags: '-O3 -march=native',
    cpu: 'Example CPU @ 2.60GHz',
    threads: 4,
    seed: 1999,
    date: '2024-02-29T12:00:00Z',
    command: 'driftless run studies/first-light.json -o driftless-results/first-light',
  },
  study,
  scenes,
  methods: methods.map(({name}) => ({
    name,
    title: `The method ${name}`,
    reference: 'A Journal 1, 1 (1999)',
    conserves: 'momentum',
    consistent: name !== inconsistent,
    galilean: name !== inconsistent,
  })),
  cells,
};

const {cells: listed_cells, ...rest} = result;
const text = JSON.stringify(rest, null, 1).replace(
  /\n\}$/,
  `,\n "cells": [\n${listed_cells.map((cell) => JSON.stringify(cell)).join(',\n')}\n ]\n}\n`,
);
writeFileSync(new URL('sample_result.json', import.meta.url), text);
