// Method against step: the worst-case error as a colour, and a word where there is no number.
import {judge, method_label, passes} from '../answer.js';
import {bound_text, deviation, number, observable_short, status_title} from '../format.js';
import {time_steps} from '../rows.js';

const words = {
  not_applicable: 'not applicable',
  not_resolved: 'not resolved',
  no_exact_value: 'no exact value',
};

function text_of(cell, judgement, observable) {
  if (judgement.state === 'failed')
    return cell.status === 'negative_internal_energy' ? 'u < 0' : status_title(cell.status);
  if (judgement.state === 'below_noise') return `< ${bound_text(judgement.bound, observable)}`;
  return words[judgement.state] ?? deviation(judgement.value, observable);
}

function rows_of(cells, observable, tolerance) {
  return cells.map((cell) => {
    const judgement = judge(cell, observable);
    return {
      method: method_label(cell),
      step: number(cell.time_step),
      state: judgement.state,
      bound: judgement.bound ?? null,
      text: text_of(cell, judgement, observable),
      passes: passes(judgement, tolerance),
      bound_text: judgement.bound === undefined ? '–' : bound_text(judgement.bound, observable),
      note: judgement.worst
        ? `${observable_short(judgement.worst)} ${judgement.note ?? ''}`
        : (judgement.note ?? '').replaceAll('_', ' '),
    };
  });
}

function encodings(labels, steps) {
  return {
    x: {
      field: 'step',
      type: 'ordinal',
      sort: steps.map((step) => number(step)),
      title: 'time step',
      axis: {labelAngle: 0, orient: 'bottom'},
    },
    y: {field: 'method', type: 'nominal', sort: labels, title: null, axis: {labelLimit: 240}},
  };
}

export function method_step_map({cells, observable, tolerance, labels}) {
  if (!cells.length) return null;
  const present = labels.filter((label) => cells.some((cell) => method_label(cell) === label));
  const steps = time_steps(cells);
  const rows = rows_of(cells, observable, tolerance);
  const bounds = rows.map((row) => row.bound).filter((bound) => bound > 0);
  const domain = bounds.length
    ? [Math.min(...bounds), Math.max(Math.max(...bounds), Math.min(...bounds) * 1.01)]
    : [0.01, 0.1];
  const dark = Math.sqrt(domain[0] * domain[1]) * 1.6;
  const tips = [
    {field: 'method', title: 'method'},
    {field: 'step', title: 'time step'},
    {field: 'text', title: 'error'},
    {field: 'bound_text', title: 'at most'},
    {field: 'note', title: 'note'},
  ];
  const shared = encodings(present, steps);
  const font = steps.length > 9 ? 10.5 : 12;
  return {
    width: 'container',
    height: 32 * present.length,
    autosize: {type: 'fit-x', contains: 'padding'},
    data: {values: rows},
    layer: [
      {
        name: 'failed_squares',
        transform: [{filter: '!isValid(datum.bound)'}],
        mark: {type: 'rect', fill: '#edeff2', stroke: 'white', strokeWidth: 2},
        encoding: {...shared, tooltip: tips},
      },
      {
        name: 'squares',
        transform: [{filter: 'isValid(datum.bound)'}],
        mark: {type: 'rect', stroke: 'white', strokeWidth: 2},
        encoding: {
          ...shared,
          tooltip: tips,
          fill: {
            field: 'bound',
            type: 'quantitative',
            scale: {type: 'log', domain, scheme: 'blues', nice: false},
            legend: null,
          },
        },
      },
      {
        name: 'passing',
        transform: [{filter: 'datum.passes'}],
        mark: {type: 'rect', filled: false, stroke: '#1f2933', strokeWidth: 2, tooltip: null},
        encoding: shared,
      },
      {
        name: 'texts',
        mark: {type: 'text', fontSize: font, tooltip: null},
        encoding: {
          ...shared,
          text: {field: 'text'},
          color: {
            condition: [
              {test: '!isValid(datum.bound)', value: '#616e7c'},
              {test: `datum.bound > ${dark}`, value: 'white'},
            ],
            value: '#1f2933',
          },
        },
      },
    ],
  };
}
