// What speaks against a number: replicas from off equilibrium that disagree, and failures.
import {method_label} from '../answer.js';
import {element, replace, table} from '../dom.js';
import {number, observable_short, status_title} from '../format.js';
import {method_tag} from '../palette.js';
import {scene_cells, time_steps} from '../rows.js';

function agreement(cell) {
  if (!cell) return '';
  if (!cell.off_equilibrium)
    return {text: cell.status === 'ok' ? '–' : status_title(cell.status), class: 'faint'};
  const {agrees, largest_z, observable} = cell.off_equilibrium;
  const survivors = cell.conditioned_on_survival ? ' (survivors)' : '';
  return {
    text: `${agrees ? 'agrees' : 'differs'}, z = ${number(largest_z, 2)}${survivors}`,
    class: agrees ? 'agrees' : 'differs',
    title: observable_short(observable ?? ''),
  };
}

export function render_agreement({result, scene, labels}) {
  const cells = scene_cells(result, scene);
  const steps = time_steps(cells);
  const rows = labels
    .filter((label) => cells.some((cell) => method_label(cell) === label))
    .map((label) => [
      method_tag(label, labels),
      ...steps.map((step) =>
        agreement(cells.find((cell) => method_label(cell) === label && cell.time_step === step)),
      ),
    ]);
  const threshold = cells.find((cell) => cell.off_equilibrium)?.off_equilibrium.threshold;
  const caption = `The replica that starts off equilibrium against the others: its largest deviation in standard errors, z${
    threshold ? `; beyond ${number(threshold)} it differs` : ''
  }`;
  replace(
    'agreement-place',
    table(
      'agreement-table',
      caption,
      ['method', ...steps.map((step) => `step ${number(step)}`)],
      rows,
    ),
  );
}

const numeric = (text) => ({text, class: 'number'});

export function render_failures({result, scene, labels}) {
  const failures = scene_cells(result, scene).flatMap((cell) =>
    (cell.failures ?? []).map((failure) => ({cell, failure})),
  );
  if (!failures.length) {
    replace('failures-place', element('p', {class: 'nothing'}, 'No replica of this scene failed.'));
    return;
  }
  const rows = failures.map(({cell, failure}) => [
    method_tag(method_label(cell), labels),
    numeric(number(cell.time_step)),
    numeric(String(failure.replica)),
    failure.cause,
    numeric(String(failure.step)),
    numeric(number(failure.time, 4)),
  ]);
  const caption = `Failed replicas of this scene: ${failures.length}`;
  replace(
    'failures-place',
    table(
      'failures-table',
      caption,
      [
        'method',
        numeric('time step'),
        numeric('replica'),
        'cause',
        numeric('step number'),
        numeric('time'),
      ],
      rows,
    ),
  );
}
