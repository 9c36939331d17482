// Sizes on two logarithmic axes with 95 % intervals, hollow where below noise; failed cells as
// crosses in a band along the top. Shared by the charts of error against cost and against step.
import {error_domain, log_axis, log_domain, log_ticks} from '../log_axis.js';
import {failure_cross, method_scales} from '../palette.js';

const band_row = 17;
const hollow_key = 'below noise: interval reaches 0';
const failed_key = 'failed';
const key_ink = '#3e4c59';

const tooltips = (size_title) => [
  {field: 'method', title: 'method'},
  {field: 'step_text', title: 'time step'},
  {field: 'cost_text', title: 'cost per unit time'},
  {field: 'error_text', title: size_title},
  {field: 'interval_text', title: '95 % interval'},
  {field: 'worst_text', title: 'observable'},
  {field: 'mean_text', title: 'measured'},
];

const failure_tooltips = [
  {field: 'method', title: 'method'},
  {field: 'step_text', title: 'time step'},
  {field: 'status_text', title: 'status'},
  {field: 'failed_text', title: 'failed'},
  {field: 'cause_text', title: 'first cause'},
];

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

// The axis would draw its grid from the frame's top, not from the band's lower edge.
function layer_of_grid(x, band) {
  const data = {values: x.axis.values.map((tick) => ({x: tick}))};
  return {
    name: 'grid',
    data,
    mark: {
      type: 'rule',
      y: band,
      y2: 'height',
      stroke: '#e8ecf0',
      strokeWidth: 1,
      tooltip: null,
      aria: false,
    },
    encoding: {x},
  };
}

function layers_of_points(x, y, {stroke, fill, shape}, tooltip, pickable) {
  const params = pickable
    ? [{name: 'picked', select: {type: 'point', fields: ['method']}, bind: 'legend'}]
    : [];
  const opacity = pickable ? {condition: {param: 'picked', value: 1}, value: 0.12} : {value: 1};
  return [
    {
      name: 'lines',
      mark: {type: 'line', strokeWidth: 1.3},
      encoding: {x, y, stroke, order: {field: 'time_step', type: 'quantitative'}, opacity},
    },
    {
      name: 'intervals',
      mark: {type: 'rule', strokeWidth: 1.6},
      encoding: {x, y: {...y, field: 'lower'}, y2: {field: 'upper'}, stroke, opacity},
    },
    {
      name: 'grounds',
      transform: [{filter: 'datum.below_noise'}],
      mark: {type: 'point', filled: true, size: 85, fill: 'white', opacity: 1, tooltip: null},
      encoding: {x, y, shape},
    },
    {
      name: 'points',
      params,
      mark: {type: 'point', size: 85, strokeWidth: 1.8},
      encoding: {
        x,
        y,
        stroke,
        fill,
        shape,
        fillOpacity: {condition: {test: 'datum.below_noise', value: 0}, value: 1},
        opacity,
        tooltip,
      },
    },
  ];
}

function layers_of_failures(failures, x, stroke, band, label_side) {
  if (!failures.length) return [];
  const place = {expr: `datum.row * ${band_row} + ${band_row / 2 + 3}`};
  const side = label_side === 'left' ? {align: 'right', dx: -9} : {align: 'left', dx: 9};
  const data = {values: failures};
  return [
    {
      name: 'band',
      data: {values: [{}]},
      mark: {type: 'rect', x: 0, x2: 'width', y: 0, y2: band, fill: '#f4f1ec', tooltip: null},
    },
    {
      name: 'failures',
      data,
      mark: {
        type: 'point',
        shape: failure_cross,
        size: 70,
        strokeWidth: 2.4,
        filled: false,
        opacity: 1,
        y: place,
      },
      encoding: {x, stroke, tooltip: failure_tooltips},
    },
    {
      name: 'failure_labels',
      data,
      mark: {type: 'text', ...side, fontSize: 11, fill: '#52606d', y: place, tooltip: null},
      encoding: {x, text: {field: 'short_text'}},
    },
  ];
}

// A text on a white rim, readable over lines.
function layers_of_label(name, data, mark, encoding) {
  const shared = {type: 'text', fontSize: 12, tooltip: null, ...mark};
  return [
    {
      name: `${name}_ground`,
      data,
      mark: {...shared, fill: 'white', stroke: 'white', strokeWidth: 4, aria: false},
      encoding,
    },
    {name, data, mark: {...shared, fill: '#1f2933'}, encoding},
  ];
}

const label_places = [
  {align: 'left', x: 0, dx: 6, dy: -9},
  {align: 'right', x: 'width', dx: -6, dy: -9},
  {align: 'left', x: 0, dx: 6, dy: 9},
  {align: 'right', x: 'width', dx: -6, dy: 9},
];

// The end of the line, and its side, where the label is least in the way of marks and bars.
function quietest_place(points, value, domain_x, domain_y) {
  const span_x = Math.log(domain_x[1] / domain_x[0]);
  const label_height = (domain_y[1] / domain_y[0]) ** 0.06;
  const crowd = ({align, dy}) => {
    const [low, high] = dy < 0 ? [value, value * label_height] : [value / label_height, value];
    return points.filter((row) => {
      const across = Math.log(row.x / domain_x[0]) / span_x;
      return (
        (align === 'left' ? across < 0.25 : across > 0.75) && row.upper > low && row.lower < high
      );
    }).length;
  };
  return label_places.reduce((best, place) => (crowd(place) < crowd(best) ? place : best));
}

function layers_of_tolerance(tolerance, scale, y, points, domain_x) {
  if (!tolerance) return [];
  const value = tolerance.value * scale;
  const data = {values: [{value, text: tolerance.text}]};
  return [
    {
      name: 'tolerance',
      data,
      mark: {type: 'rule', strokeDash: [6, 4], strokeWidth: 1.4, stroke: '#1f2933', tooltip: null},
      encoding: {y},
    },
    ...layers_of_label(
      'tolerance_label',
      data,
      quietest_place(points, value, domain_x, y.scale.domain),
      {y, text: {field: 'text'}},
    ),
  ];
}

function layers_of_answer(answer, x, y) {
  if (!answer) return [];
  const data = {values: [answer]};
  return [
    {
      name: 'answer_ring',
      data,
      mark: {
        type: 'point',
        shape: 'circle',
        size: 420,
        stroke: '#1f2933',
        strokeWidth: 1.6,
        filled: false,
        opacity: 1,
        tooltip: null,
      },
      encoding: {x, y},
    },
    ...layers_of_label(
      'answer_label',
      data,
      {align: 'right', dx: -13, dy: 9, fontWeight: 600, text: 'answer'},
      {x, y},
    ),
  ];
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
      ...layers_of_points(
        encoding_x,
        encoding_y,
        encodings,
        tooltips(y.size_title),
        legend.methods,
      ),
    ],
  };
}
