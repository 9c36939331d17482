// A measured density over its exact curve, and below it the difference with its error.
import {interval_reach} from '../format.js';

const measured = '#0072b2';
const law = '#1f2933';

function rows_of(curve) {
  return curve.x.map((x, index) => {
    const density = curve.density[index];
    const half = interval_reach(curve.error?.[index]);
    const exact = curve.exact?.[index] ?? null;
    const difference = exact === null ? null : density - exact;
    return {
      x,
      density,
      exact,
      low: density - half,
      high: density + half,
      half,
      difference,
      difference_low: exact === null ? null : difference - half,
      difference_high: exact === null ? null : difference + half,
    };
  });
}

// A few bins with next to no samples (g(r) near 0) must not set the scale; their bars leave the frame.
function firm(rows) {
  const halves = rows.map((row) => row.half).sort((a, b) => a - b);
  return rows.filter((row) => row.half <= 6 * halves[Math.floor(halves.length / 2)]);
}

function domain_of(rows, lows, highs) {
  const low = Math.min(0, ...firm(rows).map((row) => row[lows]));
  const high = Math.max(0, ...firm(rows).map((row) => row[highs]));
  const space = 0.05 * (high - low || 1);
  return [low < 0 ? low - space : low, high + space];
}

const encoding_x = (title) => ({
  field: 'x',
  type: 'quantitative',
  title,
  scale: {zero: false, nice: false, padding: 6},
});

const encoding_y = (field, title, domain, tickCount) => ({
  field,
  type: 'quantitative',
  title,
  axis: {minExtent: 52, maxExtent: 52, tickCount},
  scale: {domain},
});

const tips = [
  {field: 'x', format: '.4~g'},
  {field: 'density', title: 'measured', format: '.4~g'},
  {field: 'exact', title: 'exact', format: '.4~g'},
  {field: 'half', title: '95 % half width', format: '.2~g'},
];

// The measured points with their intervals, over what lies beneath them.
function panel(rows, height, beneath, x, y, [low, high], stroke) {
  return {
    width: 'container',
    height,
    autosize: {type: 'fit-x', contains: 'padding'},
    data: {values: rows},
    layer: [
      ...beneath,
      {
        name: 'intervals',
        mark: {type: 'rule', clip: true, strokeWidth: 1.6},
        encoding: {x, y: {...y, field: low}, y2: {field: high}, stroke},
      },
      {
        name: 'points',
        mark: {type: 'point', clip: true, filled: true, size: 34, fill: measured, opacity: 1},
        encoding: {x, y, tooltip: tips},
      },
    ],
  };
}

export function distribution({curve, title, y_title}) {
  if (!curve?.x?.length) return null;
  const rows = rows_of(curve);
  const from_zero = rows.map((row) => ({...row, low: 0}));
  const x = encoding_x(title);
  const y = encoding_y('density', y_title, domain_of(from_zero, 'low', 'high'), 5);
  const has_law = rows.some((row) => row.exact !== null);
  const domain = has_law ? ['measured', 'exact law'] : ['measured'];
  const kind = (name) => ({
    datum: name,
    type: 'nominal',
    scale: {domain, range: [measured, law]},
    legend: {title: null, orient: 'top', symbolType: 'stroke', symbolStrokeWidth: 3},
  });
  const exact = {
    name: 'exact',
    mark: {type: 'line', strokeWidth: 1.6, interpolate: 'cardinal', tooltip: null},
    encoding: {x, y: {...y, field: 'exact'}, stroke: kind('exact law')},
  };
  return panel(rows, 240, has_law ? [exact] : [], x, y, ['low', 'high'], kind('measured'));
}

export function difference({curve, title}) {
  const rows = curve?.x?.length ? rows_of(curve).filter((row) => row.exact !== null) : [];
  if (!rows.length) return null;
  const ends = ['difference_low', 'difference_high'];
  const y = encoding_y('difference', 'measured − exact', domain_of(rows, ...ends), 4);
  const zero = {
    name: 'zero',
    data: {values: [{difference: 0}]},
    mark: {type: 'rule', stroke: law, strokeWidth: 1.4, tooltip: null},
    encoding: {y},
  };
  return panel(rows, 120, [zero], encoding_x(title), y, ends, {value: measured});
}
