// What was simulated, by what, and the command that repeats it.
import {element, replace, table} from '../dom.js';
import {number} from '../format.js';

function value_text(value) {
  if (value === null || value === undefined) return '–';
  if (typeof value === 'number') return number(value, 6);
  if (Array.isArray(value)) return `[${value.map(value_text).join(', ')}]`;
  return typeof value === 'object' ? JSON.stringify(value) : String(value);
}

const words = (key) => key.replaceAll('_', ' ');

// Keys a reader looks for first; the file has them by the alphabet.
const first_keys = [
  'particles',
  'density',
  'temperature',
  'boltzmann',
  'mass',
  'isothermal',
  'heat_capacity',
  'friction',
  'friction_closure',
  'friction_range',
  'conduction',
  'heat_form',
  'heat_range',
  'repulsion',
  'repulsion_range',
  'weight_exponent',
];

function parameter_keys(scenes) {
  const keys = [...new Set(scenes.flatMap((scene) => Object.keys(scene.parameters ?? {})))].filter(
    (key) => key !== 'name' && key !== 'preset',
  );
  return [
    ...first_keys.filter((key) => keys.includes(key)),
    ...keys.filter((key) => !first_keys.includes(key)),
  ];
}

export function render_scenes({result}) {
  const {scenes} = result;
  const keys = parameter_keys(scenes);
  const isothermal = scenes.some((scene) => scene.parameters?.isothermal);
  const derived = [
    'relaxation_time',
    ...(isothermal ? ['kinetic_relaxation_time'] : []),
    'energy_per_particle',
    'resolves_internal_energy',
    ...(isothermal ? ['resolves_kinetic_energy'] : []),
  ];
  const differs = (key) =>
    new Set(scenes.map((scene) => JSON.stringify(scene.parameters?.[key]))).size > 1;
  const rows = [
    ['preset', ...scenes.map((scene) => value_text(scene.preset))],
    ...keys.map((key) => ({
      attributes: {class: differs(key) ? 'differing' : null},
      cells: [words(key), ...scenes.map((scene) => value_text(scene.parameters?.[key]))],
    })),
    ...derived.map((key) => [words(key), ...scenes.map((scene) => value_text(scene[key]))]),
    ...(scenes.some((scene) => scene.note)
      ? [['note', ...scenes.map((scene) => scene.note ?? '–')]]
      : []),
  ];
  replace(
    'scenes-place',
    table(
      'scenes-table',
      'Parameters of the scenes, in program units; rows that differ between scenes are set bold',
      ['', ...scenes.map((scene) => scene.name)],
      rows,
    ),
  );
}

export function render_provenance({result}) {
  const {command, version, commit, dirty, compiler, flags, cpu, threads, seed, date} =
    result.provenance ?? {};
  const {duration, replicas, time_steps: steps} = result.study ?? {};
  const rows = [
    ['version', value_text(version)],
    ['commit', `${commit || '–'}${dirty ? ', with uncommitted changes' : ''}`],
    ...Object.entries({compiler, flags, cpu, threads, seed, date}).map(([key, value]) => [
      key,
      typeof value === 'number' ? String(value) : value_text(value),
    ]),
    ['time steps', value_text(steps)],
    ['replicas', value_text(replicas)],
    ...['equilibrate', 'measure', 'sample_every'].map((key) => [
      words(key),
      value_text(duration?.[key]),
    ]),
  ];
  replace('provenance-place', table('provenance-table', 'Provenance', ['', ''], rows));
  replace('command', command ?? '–');
  replace('study', JSON.stringify(result.study ?? {}, null, 2));
}
