// Charts of a judgement: any examination's series, drawn without knowing the examination.
import {log_axis, log_domain, log_ticks} from '../log_axis.js';
import {method_scales} from '../palette.js';
import {number} from '../format.js';

const interval_text = ({lower, upper}) =>
  lower === undefined && upper === undefined ? '–' : `${number(lower)} to ${number(upper)}`;

function rows_of(series, {x, y}) {
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
function scaled(axis, values) {
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

const tooltip = (chart) => [
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
  const drawn = labels.filter((label) => rows.some((row) => row.name === label));
  const legend = {title: null, values: drawn, symbolOpacity: 1, ...place};
  const channel = (scale) => ({field: 'name', type: 'nominal', scale, legend});
  const stroke = channel(colour);
  const opacity = {condition: {param: 'picked', value: 1}, value: 0.1};
  const cut = (row) =>
    floor === undefined ? row : {...row, lower: Math.max(row.lower, floor)};
  return {
    width: 'container',
    height: 320,
    autosize: {type: 'fit-x', contains: 'padding'},
    data: {values: rows.map(cut)},
    layer: [
      {
        transform: [{filter: "datum.marks !== 'apart'"}],
        mark: {type: 'line', strokeWidth: 1.4},
        encoding: {x, y, stroke, order: {field: 'x', type: 'quantitative'}, opacity},
      },
      {
        mark: {type: 'rule', strokeWidth: 1.5},
        encoding: {x, y: {...y, field: 'lower'}, y2: {field: 'upper'}, stroke, opacity},
      },
      {
        name: 'points',
        params: [{name: 'picked', select: {type: 'point', fields: ['name']}, bind: 'legend'}],
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
      },
    ],
  };
}

// One series of a chart, the same of every method: the methods become the series.
export function overlaid(methods, examination, title, series_name) {
  let like = null;
  const series = [];
  for (const method of methods) {
    const chart = method.conclusions[examination]?.charts.find((one) => one.title === title);
    const own = chart?.series.find(({name}) => name === series_name);
    if (!own?.points.length) continue;
    like ??= chart;
    series.push({...own, name: method.name});
  }
  return like && {...like, series};
}

// Every chart and series of an examination that several methods share.
export function shared_series(methods, examination) {
  const counted = new Map();
  for (const method of methods) {
    for (const {title, series} of method.conclusions[examination]?.charts ?? []) {
      for (const {name, marks} of series) {
        if (marks === 'line') continue;
        const key = JSON.stringify([title, name]);
        counted.set(key, (counted.get(key) ?? 0) + 1);
      }
    }
  }
  return [...counted].filter(([, count]) => count > 1).map(([key]) => JSON.parse(key));
}

// The points of a scene and an observable, at what the error is at most, and the front through them.
export function trade_chart(trade, scene, observable) {
  const entry = trade.find((one) => one.scene === scene && one.observable === observable);
  if (!entry) return null;
  const names = [...new Set(entry.points.map(({method}) => method))];
  const point = ({cost, lower, upper}) => ({x: cost, y: upper, lower, upper});
  const front = entry.points.filter(({on_front}) => on_front).sort((a, b) => a.cost - b.cost);
  return {
    title: `${scene}, ${observable}`,
    x: {title: 'cost, core-seconds per unit of time', logarithmic: true},
    y: {title: 'error, at most (95 %)', logarithmic: true},
    series: [
      ...names.map((name) => ({
        name,
        marks: 'apart',
        points: entry.points.filter(({method}) => method === name).map(point),
      })),
      {name: 'front', marks: 'line', points: front.map(({cost, upper}) => ({x: cost, y: upper}))},
    ],
  };
}
