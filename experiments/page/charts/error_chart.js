// Sizes on two logarithmic axes with 95 % intervals, hollow where below noise; failed cells as
// crosses in a band along the top. Shared by the charts of error against cost and against step.
import {error_domain, log_axis, log_domain, log_ticks} from '../log_axis.js';
import {failure_cross, method_scales} from '../palette.js';
import {
  band_row,
  layer_of_grid,
  layers_of_answer,
  layers_of_failures,
  layers_of_points,
  layers_of_tolerance,
} from './error_layers.js';

const hollow_key = 'below noise: interval reaches 0';
const failed_key = 'failed';
const key_ink = '#3e4c59';

// Where methods share a step their intervals would hide each other: each method a little aside.
function placed(rows, x) {
  const present = [...new Set(rows.map((row) => row.method))];
  const aside = (row) =>
    x.aside ? x.aside ** (present.indexOf(row.method) - (present.length - 1) / 2) : 1;
  return rows.map((row) => ({...row, x: row[x.field] * aside(row)}));
}

function clamped(row, floor, scale) {
  return {
    ...row,
    value: Math.max(row.value * scale, floor),
    lower: Math.max(row.lower * scale, floor),
    upper: row.upper * scale,
    bound: (row.bound ?? row.upper) * scale,
  };
}

// The methods' scales with two more entries, so that the legend also names hollow marks and crosses.
function keyed_scales(labels) {
  const {colour, shape} = method_scales(labels);
  const extended = ({domain, range}, hollow, failed) => ({
    domain: [...domain, hollow_key, failed_key],
    range: [...range, hollow, failed],
  });
  return {
    stroke: extended(colour, key_ink, key_ink),
    fill: extended(colour, 'white', key_ink),
    shape: extended(shape, 'circle', failure_cross),
  };
}

function keyed_encodings(labels, rows, failures, legend_place) {
  const scales = keyed_scales(labels);
  const drawn = labels.filter((label) =>
    [...rows, ...failures].some((row) => row.method === label),
  );
  const values = [
    ...(legend_place.methods ? drawn : []),
    ...(rows.some((row) => row.below_noise) ? [hollow_key] : []),
    ...(failures.length ? [failed_key] : []),
  ];
  const {methods, ...place} = legend_place;
  const legend = values.length
    ? {title: null, values, symbolOpacity: 1, symbolStrokeWidth: 1.8, ...place}
    : null;
  const channel = (scale) => ({field: 'method', type: 'nominal', scale, legend});
  return {stroke: channel(scales.stroke), fill: channel(scales.fill), shape: channel(scales.shape)};
}

// x: {field, title, label_side, ticks?, domain?, aside?: factor between neighbours}; y: {title, scale: factor from
// rows to axis, size_title}; tolerance: {value, text} or null; is_answer: picks the answer's row, or null; legend:
// {methods: whether it names them, orient, ...}. Returns null where there is nothing to draw.
export function error_chart({
  rows,
  failures,
  x,
  y,
  tolerance = null,
  is_answer = null,
  labels,
  legend,
  height = 430,
}) {
  const drawn = placed(
    rows.filter((row) => row[x.field] > 0),
    x,
  );
  const crossed = failures.filter((row) => row[x.field] > 0);
  if (!drawn.length && !crossed.length) return null;
  const failed_methods = [...new Set(crossed.map((row) => row.method))];
  const crosses = crossed.map((row) => ({
    ...row,
    x: row[x.field],
    row: failed_methods.indexOf(row.method),
  }));
  const band = crosses.length ? failed_methods.length * band_row + 6 : 0;
  const domain = error_domain(drawn, tolerance ? [tolerance.value] : []).map(
    (end) => end * y.scale,
  );
  const domain_x =
    x.domain ??
    log_domain(
      [...drawn, ...crosses].map((row) => row.x),
      1.25,
    );
  const encodings = keyed_encodings(labels, drawn, crosses, legend);
  const encoding_x = {
    field: 'x',
    type: 'quantitative',
    title: x.title,
    scale: {type: 'log', domain: domain_x, nice: false},
    axis: {...log_axis(x.ticks ?? log_ticks(domain_x)), grid: false},
  };
  const encoding_y = {
    field: 'value',
    type: 'quantitative',
    title: y.title,
    axis: log_axis(log_ticks(domain)),
    scale: {type: 'log', domain, nice: false, range: [height, band]},
  };
  const points = drawn.map((row) => clamped(row, domain[0], y.scale));
  return {
    width: 'container',
    height,
    autosize: {type: 'fit-x', contains: 'padding'},
    data: {values: points},
    layer: [
      layer_of_grid(encoding_x, band),
      ...layers_of_failures(crosses, encoding_x, encodings.stroke, band, x.label_side),
      ...layers_of_tolerance(tolerance, y.scale, encoding_y, points, domain_x),
      ...layers_of_answer(is_answer ? points.find(is_answer) : null, encoding_x, encoding_y),
      ...layers_of_points(encoding_x, encoding_y, encodings, y.size_title, legend.methods),
    ],
  };
}
