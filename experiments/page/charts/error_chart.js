// Sizes on two logarithmic axes with 95 % intervals, hollow where below noise; failed cells as
// crosses in a band along the top. Shared by the charts of error against cost and against step.
import {axis_label, error_domain, log_domain, log_ticks} from '../log_axis.js';
import {failure_cross, method_scales} from '../palette.js';
import {states} from '../rows.js';

const height = 430;
const band_row = 17;

const tooltip = (x) => [
  {field: 'method', title: 'method'}, {field: 'step_text', title: 'time step'}, {field: 'cost_text', title: 'cost per unit time'},
  {field: 'error_text', title: x.size_title ?? 'error'}, {field: 'interval_text', title: '95 % interval'},
  {field: 'worst_text', title: 'observable'}, {field: 'mean_text', title: 'measured'}, {field: 'state', title: 'state'},
];

function clamped(rows, floor, scale) {
  return rows.map((row) => ({...row, value: Math.max(row.value * scale, floor), lower: Math.max(row.lower * scale, floor), upper: row.upper * scale}));
}

function axis_x(x, rows, failures) {
  const domain = x.domain ?? log_domain([...rows, ...failures].map((row) => row[x.field]), 1.25);
  return {
    field: x.field, type: 'quantitative', title: x.title, scale: {type: 'log', domain, nice: false},
    axis: {values: x.ticks ?? log_ticks(domain), labelExpr: axis_label, labelOverlap: true},
  };
}

function by_method(scale, method_legend) {
  return {field: 'method', type: 'nominal', scale, legend: method_legend ? {title: 'method (click to single out)', orient: 'right'} : null};
}

function layers_of_points(x, y, stroke, shape, tips) {
  const opacity = {condition: {param: 'picked', value: 1}, value: 0.12};
  const hollow = {
    field: 'state', type: 'nominal', sort: Object.values(states), scale: {domain: Object.values(states), range: [1, 0]},
    legend: {title: null, orient: 'bottom', direction: 'horizontal', symbolType: 'circle', symbolFillColor: '#3e4c59', symbolStrokeColor: '#3e4c59', labelLimit: 400},
  };
  return [
    {name: 'lines', mark: {type: 'line', strokeWidth: 1.3}, encoding: {x, y, stroke, order: {field: 'time_step', type: 'quantitative'}, opacity}},
    {name: 'intervals', mark: {type: 'rule', strokeWidth: 1.6}, encoding: {x, y: {...y, field: 'lower'}, y2: {field: 'upper'}, stroke, opacity}},
    {name: 'grounds', transform: [{filter: 'datum.below_noise'}], mark: {type: 'point', filled: true, size: 85, fill: 'white', opacity: 1}, encoding: {x, y, shape}},
    {name: 'points', params: [{name: 'picked', select: {type: 'point', fields: ['method']}, bind: 'legend'}],
      mark: {type: 'point', size: 85, strokeWidth: 1.8}, encoding: {x, y, stroke, fill: stroke, shape, fillOpacity: hollow, opacity, tooltip: tips}},
  ];
}

function layers_of_failures(failures, x, stroke, band) {
  if (!failures.length) return [];
  const place = {expr: `datum.row * ${band_row} + ${band_row / 2 + 3}`};
  const tips = [{field: 'method', title: 'method'}, {field: 'step_text', title: 'time step'}, {field: 'status_text', title: 'status'},
    {field: 'failed_text', title: 'failed'}, {field: 'cause_text', title: 'first cause'}];
  return [
    {name: 'band', data: {values: [{}]}, mark: {type: 'rect', x: 0, x2: 'width', y: 0, y2: band, fill: '#f4f1ec', tooltip: null}},
    {name: 'failures', data: {values: failures}, mark: {type: 'point', shape: failure_cross, size: 70, strokeWidth: 2.4, filled: false, y: place}, encoding: {x, stroke, tooltip: tips}},
    {name: 'failure_labels', data: {values: failures}, mark: {type: 'text', align: 'right', dx: -8, fontSize: 11, fill: '#52606d', y: place}, encoding: {x, text: {field: 'short_text'}}},
  ];
}

function layers_of_tolerance(tolerance, text, y) {
  if (!(tolerance > 0)) return [];
  const data = {values: [{value: tolerance, text}]};
  return [
    {name: 'tolerance', data, mark: {type: 'rule', strokeDash: [6, 4], strokeWidth: 1.4, stroke: '#1f2933', tooltip: null}, encoding: {y}},
    {name: 'tolerance_label', data, mark: {type: 'text', align: 'left', x: 6, dy: -7, fontSize: 12, fill: '#1f2933', tooltip: null}, encoding: {y, text: {field: 'text'}}},
  ];
}

function layers_of_answer(answer, x, y) {
  if (!answer) return [];
  const data = {values: [answer]};
  return [
    {name: 'answer', data, mark: {type: 'point', shape: 'circle', size: 420, stroke: '#1f2933', strokeWidth: 1.6, filled: false, tooltip: null}, encoding: {x, y}},
    {name: 'answer_label', data, mark: {type: 'text', dy: 19, fontSize: 12, fontWeight: 600, fill: '#1f2933', text: 'answer', tooltip: null}, encoding: {x, y}},
  ];
}

// x: {field, title, ticks?, domain?}; y: {title, scale: factor from rows to axis}; tolerance: {value, text} or null;
// answer: the row of the answer or null. Returns null where there is nothing to draw.
export function error_chart({rows, failures, x, y, tolerance = null, answer = null, labels, method_legend = true}) {
  const drawn = rows.filter((row) => row[x.field] > 0);
  const crossed = failures.filter((row) => row[x.field] > 0);
  if (!drawn.length && !crossed.length) return null;
  const band = crossed.length ? (Math.max(...crossed.map((row) => row.row)) + 1) * band_row + 6 : 0;
  const domain = error_domain(drawn, tolerance ? [tolerance.value] : []).map((end) => end * y.scale);
  const scales = method_scales(labels);
  const stroke = by_method(scales.colour, method_legend);
  const shape = by_method(scales.shape, method_legend);
  const encoding_x = axis_x(x, drawn, crossed);
  const encoding_y = {
    field: 'value', type: 'quantitative', title: y.title, axis: {values: log_ticks(domain), labelExpr: axis_label},
    scale: {type: 'log', domain, nice: false, range: [height, band]},
  };
  const [answer_row] = answer ? clamped([answer], domain[0], y.scale) : [null];
  return {
    width: 'container', height, autosize: {type: 'fit-x', contains: 'padding'},
    data: {values: clamped(drawn, domain[0], y.scale)},
    layer: [
      ...layers_of_failures(crossed, encoding_x, stroke, band),
      ...layers_of_tolerance((tolerance?.value ?? 0) * y.scale, tolerance?.text, encoding_y),
      ...layers_of_points(encoding_x, encoding_y, stroke, shape, tooltip(y)),
      ...layers_of_answer(answer_row, encoding_x, encoding_y),
    ],
  };
}
