// Many series with points at the same few places: a row for each series, where a chart over the places
// would draw all of them over each other.
import {method_scales} from '../palette.js';
import {rows_of, scaled, tooltip} from '../series_chart.js';

const fewest_series = 8;
const most_places = 5;

const places_of = (rows) => [...new Set(rows.map((row) => row.x))].sort((a, b) => a - b);

export function is_crowded({x, y, series}) {
  const has_lines = series.some(({marks}) => marks === 'line');
  const places = places_of(rows_of(series, {x, y}));
  return !has_lines && series.length >= fewest_series && places.length <= most_places;
}

export function side_by_side_spec(chart) {
  const rows = rows_of(chart.series, chart);
  const names = chart.series.map(({name}) => name);
  const places = places_of(rows).map((place) => rows.find((row) => row.x === place).x_text);
  const {colour, shape} = method_scales(places);
  const values = scaled(
    chart.y,
    rows.flatMap((row) => [row.y, row.upper]),
  );
  const legend = {title: chart.x.title, orient: 'top', symbolOpacity: 1};
  const channel = (scale) => ({field: 'x_text', type: 'nominal', scale, legend});
  const y = {field: 'name', type: 'nominal', sort: names, title: null, axis: {grid: true, bandPosition: 0}};
  const beside = {yOffset: {field: 'x_text', type: 'nominal', sort: places}};
  const x = {field: 'y', type: 'quantitative', title: chart.y.title, scale: values.scale, axis: values.axis};
  const cut = (row) =>
    values.floor === undefined ? row : {...row, lower: Math.max(row.lower, values.floor)};
  return {
    width: 'container',
    height: names.length * (8 + 9 * places.length),
    autosize: {type: 'fit-x', contains: 'padding'},
    data: {values: rows.map(cut)},
    layer: [
      {
        mark: {type: 'rule', strokeWidth: 1.5},
        encoding: {y, ...beside, x: {...x, field: 'lower'}, x2: {field: 'upper'}, stroke: channel(colour)},
      },
      {
        name: 'points',
        mark: {type: 'point', size: 36, filled: true},
        encoding: {
          y,
          ...beside,
          x,
          stroke: channel(colour),
          fill: channel(colour),
          shape: channel(shape),
          tooltip: tooltip(chart),
        },
      },
    ],
  };
}
