// The answer in a sentence, and the table of every method's cheapest step that passes.
import {answer_of, methods_of, ranked} from '../answer.js';
import {element, replace, table} from '../dom.js';
import {
  bound_text,
  deviation,
  number,
  observable_short,
  percent,
  status_title,
  with_error,
} from '../format.js';
import {method_tag} from '../palette.js';

function sentence({result, observable, tolerance}, scene) {
  return answer_of(result, scene, observable, tolerance)?.sentence ?? '';
}

// Why no step of a method passes, from its judged cells.
function reason(entry, observable, tolerance) {
  const with_state = (...states) =>
    entry.judged.filter(({judgement}) => states.includes(judgement.state));
  const numbers = with_state('resolved', 'below_noise').sort(
    (a, b) => a.judgement.bound - b.judgement.bound,
  );
  const failed = with_state('failed');
  if (with_state('not_applicable').length === entry.judged.length)
    return `not applicable: ${entry.judged[0].judgement.note}`;
  if (failed.length === entry.judged.length) return `failed at every step: ${causes(failed)}`;
  if (!numbers.length) return without_numbers(entry, with_state);
  if (numbers.some(({judgement}) => judgement.bound <= tolerance))
    return 'passes, but its cost is not known';
  const {cell, judgement} = numbers[0];
  const at = `${told_apart(judgement.bound, tolerance, observable)} at step ${number(cell.time_step)}`;
  if (judgement.state === 'below_noise')
    return `below noise, but not resolved to ${deviation(tolerance, observable)}: could be up to ${at}`;
  if (judgement.lower > tolerance)
    return `too wrong at every step: at best ${deviation(judgement.value, observable)}, at step ${number(cell.time_step)}`;
  return `undecided: ${deviation(judgement.value, observable)} measured, could be up to ${at}`;
}

// With as many digits as show that the value is not the tolerance.
function told_apart(value, tolerance, observable) {
  const texts = [2, 3, 4, 5].map((digits) => bound_text(value, observable, digits));
  return texts.find((text) => text !== deviation(tolerance, observable, 5)) ?? texts[3];
}

function without_numbers(entry, with_state) {
  const [first] = [...with_state('not_resolved'), ...with_state('no_exact_value')];
  if (!first) return 'nothing was measured';
  const words = first.judgement.state === 'not_resolved' ? 'not resolved' : 'no exact value';
  const note = first.judgement.note ? `: ${first.judgement.note}` : '';
  return `${words} (${observable_short(first.judgement.worst)})${note}`;
}

function causes(failed) {
  const kinds = [...new Set(failed.map(({cell}) => status_title(cell.status)))];
  return kinds.join(', ');
}

function row_of(entry, context) {
  const {observable, tolerance, unit, labels, winner} = context;
  const name = method_tag(entry.label, labels);
  if (!entry.best) {
    return {
      attributes: {class: 'none'},
      cells: [name, {text: reason(entry, observable, tolerance), colspan: 6, class: 'reason'}],
    };
  }
  const {cell, judgement, cost} = entry.best;
  const drift = cell.observables.energy_drift;
  const is_winner = entry.label === winner?.label;
  return {
    attributes: {
      class: is_winner ? 'best' : null,
      'data-method': cell.method,
      'data-step': cell.time_step,
      'data-best': is_winner,
      'data-consistent': entry.consistent,
    },
    cells: [
      element('span', {}, name, badge(entry, is_winner)),
      numeric(number(cell.time_step)),
      numeric(number(cost * unit.factor)),
      numeric(winner ? `${number(cost / winner.cost, 2)}×` : '–'),
      numeric(
        judgement.state === 'below_noise' ? 'below noise' : deviation(judgement.value, observable),
      ),
      numeric(bound_text(judgement.bound, observable)),
      numeric(drift ? with_error(drift.mean, drift.error) : '–'),
    ],
  };
}

function badge(entry, is_winner) {
  if (is_winner) return element('span', {class: 'badge'}, 'answer');
  if (entry.consistent) return null;
  return element('span', {class: 'badge warning'}, 'its limit is not the model');
}

const numeric = (text) => ({text, class: 'number'});

export function render_answer(context) {
  const {result, scene, observable, tolerance, unit, answer} = context;
  const others = result.scenes.map((entry) => entry.name).filter((name) => name !== scene);
  replace('answer-sentence', sentence(context, scene));
  replace(
    'other-answers',
    others.length
      ? element(
          'ul',
          {},
          others.map((name) => element('li', {}, sentence(context, name))),
        )
      : null,
  );
  const entries = methods_of(result, scene, observable, tolerance);
  const passing = ranked(entries);
  const rest = entries.filter((entry) => !entry.best);
  const head = [
    'method',
    'cheapest step that passes',
    `cost, ${unit.name} per unit time`,
    'relative cost',
    'error',
    'at most',
    'energy drift, kT per particle and unit time',
  ];
  const caption = `${scene}: ${passing.length || 'none'} of ${entries.length} methods ${passing.length > 1 ? 'are' : 'is'} shown to keep ${observable_short(observable)} within ${deviation(tolerance, observable)}`;
  replace(
    'answer-level',
    answer?.cells_compared
      ? `A step passes where the bound of its error (“at most”) is within the tolerance. The bounds of all ${answer.cells_compared} cells of this scene that were compared hold at once with a probability of ${percent(answer.level)}: so does the answer's, though it is chosen among many. `
      : '',
  );
  replace(
    'answer-table-place',
    table(
      'answer-table',
      caption,
      head,
      [...passing, ...rest].map((entry) => row_of(entry, context)),
    ),
  );
}
