// Charts of points with intervals and lines, as judgements and reproduced experiments hold them: drawn
// without knowing what they show.
import {number} from './format.js';
import {log_axis, log_domain, log_ticks} from './log_axis.js';
import {method_scales} from './palette.js';

const interval_text = ({lower, upper}) =>
  lower === undefined && upper === undefined ? '–' : `${number(lower)} to ${number(upper)}`;

// A row of data for every point.
export function rows_of(series, {x, y}) {
  return series.flatMap(({name, points, marks}) =>
    points
      .filter((point) => (!x.logarithmic || point.x > 0) && (!y.logarithmic || point.y > 0))
      .map((point) => ({
        name,
        marks,
        ...point,
        lower: point.lower ?? point.y,
        upper: point.upper ?? point.y,
        x_text: number(point.x),
        y_text: number(point.y),
        interval_text: interval_text(point),
      })),
  );
}

// A logarithmic axis ends a little below the smallest value, where intervals that go on are cut.
export function scaled(axis, values) {
  if (!axis.logarithmic) return {scale: {zero: false, nice: true}, axis: {}};
  const domain = log_domain(values, 1.6);
  return {
    floor: domain[0],
    scale: {type: 'log', domain, nice: false},
    axis: log_axis(log_ticks(domain)),
  };
}

function encodings(chart, rows) {
  const x = scaled(chart.x, rows.map((row) => row.x));
  const y = scaled(chart.y, rows.flatMap((row) => [row.y, row.upper]));
  return {
    floor: y.floor,
    x: {field: 'x', type: 'quantitative', title: chart.x.title, scale: x.scale, axis: x.axis},
    y: {field: 'y', type: 'quantitative', title: chart.y.title, scale: y.scale, axis: y.axis},
  };
}

export const tooltip = (chart) => [
  {field: 'name', title: 'series'},
  {field: 'x_text', title: chart.x.title},
  {field: 'y_text', title: chart.y.title},
  {field: 'interval_text', title: '95 % interval'},
];

// `labels`: the names that own the colours. Without them the chart is one of many side by side, with its
// own series.
export function chart_spec(chart, labels = null) {
  return labels
    ? spec_of(chart, labels, {orient: 'right'})
    : spec_of(
        chart,
        chart.series.map(({name}) => name),
        {orient: 'bottom', columns: 1},
      );
}

function spec_of(chart, labels, place) {
  const rows = rows_of(chart.series, chart);
  if (!rows.length) return null;
  const {x, y, floor} = encodings(chart, rows);
  const {colour, shape} = method_scales(labels);
  const theory = new Set(chart.series.filter(({marks}) => marks === 'line').map(({name}) => name));
  shape.range = shape.range.map((mark, index) => (theory.has(labels[index]) ? 'stroke' : mark));
  const drawn = labels.filter((label) => rows.some((row) => row.name === label));
  const legend = {title: null, values: drawn, symbolOpacity: 1, labelLimit: 460, ...place};
  const channel = (scale) => ({field: 'name', type: 'nominal', scale, legend});
  const stroke = channel(colour);
  const opacity = {condition: {param: 'picked', value: 1}, value: 0.1};
  const cut = (row) =>
    floor === undefined ? row : {...row, lower: Math.max(row.lower, floor)};
  const picked = [{name: 'picked', select: {type: 'point', fields: ['name']}, bind: 'legend'}];
  // Beside lines of theory measured points stand for themselves.
  const joined = theory.size ? "datum.marks === 'line'" : "datum.marks !== 'apart'";
  // A layer without rows would leave its axes without an extent.
  const pointed = rows.some(({marks}) => marks !== 'line');
  const lines = {
    ...(pointed ? {} : {params: picked}),
    transform: [{filter: joined}],
    mark: {type: 'line', strokeWidth: 1.4},
    encoding: {x, y, stroke, order: {field: 'x', type: 'quantitative'}, opacity},
  };
  const intervals = {
    mark: {type: 'rule', strokeWidth: 1.5},
    encoding: {x, y: {...y, field: 'lower'}, y2: {field: 'upper'}, stroke, opacity},
  };
  const points = {
    name: 'points',
    params: picked,
    transform: [{filter: "datum.marks !== 'line'"}],
    mark: {type: 'point', size: 60, filled: true},
    encoding: {
      x,
      y,
      stroke,
      fill: channel(colour),
      shape: channel(shape),
      opacity,
      tooltip: tooltip(chart),
    },
  };
  return {
    width: 'container',
    height: 320,
    autosize: {type: 'fit-x', contains: 'padding'},
    data: {values: rows.map(cut)},
    layer: pointed ? [lines, intervals, points] : [lines],
  };
}
