// How what a page shows was made, and the command that repeats it.
import {replace, table} from './dom.js';

export function render_provenance({command, ...facts}, more = {}) {
  const rows = Object.entries({...more, ...facts}).map(([key, value]) => [key, String(value)]);
  replace('provenance-place', table('provenance-table', 'How it was made', ['', ''], rows));
  replace('command', command);
}
