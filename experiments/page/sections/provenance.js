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

export function render_scenes({result}) {
  const {scenes} = result;
  const keys = [...new Set(scenes.flatMap((scene) => Object.keys(scene.parameters ?? {})))];
  const derived = ['relaxation_time', 'energy_per_particle', 'resolves_internal_energy'];
  const differs = (key) => new Set(scenes.map((scene) => JSON.stringify(scene.parameters?.[key]))).size > 1;
  const rows = [
    ['preset', ...scenes.map((scene) => value_text(scene.preset))],
    ...keys.map((key) => ({attributes: {class: differs(key) ? 'differing' : null}, cells: [words(key), ...scenes.map((scene) => value_text(scene.parameters?.[key]))]})),
    ...derived.map((key) => [words(key), ...scenes.map((scene) => value_text(scene[key]))]),
    ...(scenes.some((scene) => scene.note) ? [['note', ...scenes.map((scene) => scene.note ?? '–')]] : []),
  ];
  replace('scenes-place', table('scenes-table', 'Parameters of the scenes, in program units; rows that differ between scenes are set bold', ['', ...scenes.map((scene) => scene.name)], rows));
}

export function render_provenance({result}) {
  const {command, commit, dirty, ...rest} = result.provenance ?? {};
  const {duration, replicas, time_steps: steps} = result.study ?? {};
  const rows = [
    ...Object.entries(rest).map(([key, value]) => [words(key), value_text(value)]),
    ['commit', `${commit ?? '–'}${dirty ? ', with uncommitted changes' : ''}`],
    ['time steps', value_text(steps)], ['replicas', value_text(replicas)],
    ...Object.entries(duration ?? {}).map(([key, value]) => [`duration: ${words(key)}`, value_text(value)]),
  ];
  replace('provenance-place', table('provenance-table', 'Provenance', ['', ''], rows));
  replace('command', command ?? '–');
  replace('study', JSON.stringify(result.study ?? {}, null, 2));
}
