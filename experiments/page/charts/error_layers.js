// The layers of a chart of errors: grid, failed cells, tolerance, answer, points with intervals.
import {failure_cross} from '../palette.js';

export const band_row = 17;

const tooltips = (size_title) => [
  {field: 'method', title: 'method'},
  {field: 'step_text', title: 'time step'},
  {field: 'cost_text', title: 'cost per unit time'},
  {field: 'error_text', title: size_title},
  {field: 'interval_text', title: '95 % interval'},
  {field: 'bound_text', title: 'at most (for an answer)'},
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

// The axis would draw its grid from the frame's top, not from the band's lower edge.
export function layer_of_grid(x, band) {
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

export function layers_of_points(x, y, {stroke, fill, shape}, size_title, pickable) {
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
      // Up to the bound that answers need; in a chart without one it ends where the interval does.
      name: 'bounds',
      mark: {type: 'rule', strokeWidth: 0.7},
      encoding: {x, y: {...y, field: 'upper'}, y2: {field: 'bound'}, stroke, opacity},
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
        tooltip: tooltips(size_title),
      },
    },
  ];
}

export function layers_of_failures(failures, x, stroke, band, label_side) {
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

export function layers_of_tolerance(tolerance, scale, y, points, domain_x) {
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

export function layers_of_answer(answer, x, y) {
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
