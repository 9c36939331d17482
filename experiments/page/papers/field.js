// A field on a rectangular grid: its quantity in colours, contour lines, and arrows of a velocity.
import {number} from '../format.js';
import {contour_levels, contour_lines} from './contours.js';

const ink = '#1f2933';
// Light throughout, so that lines and arrows show on it; cold to hot.
const colours = ['#6aa5d8', '#bcd9ee', '#f7f1dc', '#f3c27c', '#dc7a4a'];
const width = 470;
const most_arrows = 22; // along an axis

// Lengths on both axes are alike unless the picture would be a strip.
function height_of({x_from, x_to, y_from, y_to}) {
  const ratio = (y_to - y_from) / (x_to - x_from);
  return ratio > 0.3 && ratio < 2 ? Math.round(width * ratio) : 340;
}

const cell_width = ({x_from, x_to, columns}) => (x_to - x_from) / columns;
const cell_height = ({y_from, y_to, rows}) => (y_to - y_from) / rows;

function cells_of(field) {
  const dx = cell_width(field);
  const dy = cell_height(field);
  return field.values.flatMap((value, place) => {
    const x = field.x_from + (place % field.columns) * dx;
    const y = field.y_from + Math.floor(place / field.columns) * dy;
    const text = `${number(x + dx / 2)}, ${number(y + dy / 2)}: ${number(value)}`;
    const overlap = 1.03; // no seams between cells
    return value === null ? [] : [{x, x2: x + overlap * dx, y, y2: y + overlap * dy, value, text}];
  });
}

// Means over blocks of cells, so that arrows keep their distance.
function thinned_arrows(field) {
  const {columns, rows, arrow_x, arrow_y} = field;
  const across = Math.ceil(columns / most_arrows);
  const up = Math.ceil(rows / most_arrows);
  const arrows = [];
  for (let row = 0; row < rows; row += up) {
    for (let column = 0; column < columns; column += across) {
      let [count, x, y, u, v] = [0, 0, 0, 0, 0];
      for (let r = row; r < Math.min(row + up, rows); ++r) {
        for (let c = column; c < Math.min(column + across, columns); ++c) {
          const place = r * columns + c;
          if (arrow_x[place] === null || arrow_y[place] === null) continue;
          ++count;
          x += field.x_from + (c + 0.5) * cell_width(field);
          y += field.y_from + (r + 0.5) * cell_height(field);
          u += arrow_x[place];
          v += arrow_y[place];
        }
      }
      if (count) arrows.push({x: x / count, y: y / count, u: u / count, v: v / count});
    }
  }
  return {arrows, across, up};
}

const has_arrows = ({arrow_x}) => (arrow_x ?? []).length > 0;

export function longest_arrow(field) {
  if (!has_arrows(field)) return 0;
  return Math.max(0, ...thinned_arrows(field).arrows.map(({u, v}) => Math.hypot(u, v)));
}

// Shaft and two strokes of the head, in pixels about the arrow's middle, then back to the axes.
function strokes_of(field, height) {
  const {arrows, across, up} = thinned_arrows(field);
  const per_x = width / (field.x_to - field.x_from);
  const per_y = height / (field.y_to - field.y_from);
  const length = ({u, v}) => Math.hypot(u * per_x, v * per_y);
  const longest = Math.max(...arrows.map(length));
  const room = 1.4 * Math.min(across * cell_width(field) * per_x, up * cell_height(field) * per_y);
  const scale = longest > 0 ? room / longest : 0;
  return arrows.flatMap((arrow) => {
    const px = arrow.u * per_x * scale;
    const py = arrow.v * per_y * scale;
    if (Math.hypot(px, py) < 1) return []; // a dot would point nowhere
    const at = (x, y) => [arrow.x + x / per_x, arrow.y + y / per_y];
    const tip = at(px / 2, py / 2);
    const head = 0.32;
    const side = (turn) =>
      at(px / 2 - head * (px - turn * py * 0.6), py / 2 - head * (py + turn * px * 0.6));
    return [at(-px / 2, -py / 2), side(1), side(-1)].map(([x, y]) => ({x, y, x2: tip[0], y2: tip[1]}));
  });
}

const rules = (name, values, stroke, strokeWidth) => ({
  name,
  data: {values},
  mark: {type: 'rule', stroke, strokeWidth, strokeCap: 'round'},
  encoding: {
    x: {field: 'x', type: 'quantitative'},
    y: {field: 'y', type: 'quantitative'},
    x2: {field: 'x2'},
    y2: {field: 'y2'},
  },
});

function colour_layer(field, levels) {
  const legend = {
    title: field.quantity,
    orient: 'bottom',
    type: 'gradient',
    gradientLength: 320,
    titleLimit: 400,
    values: levels.length > 1 ? levels : undefined,
    labelOverlap: true,
  };
  const scale = {range: colours, interpolate: 'lab', zero: false, nice: false};
  const colour = {field: 'value', type: 'quantitative', scale};
  return {
    name: 'cells',
    data: {values: cells_of(field)},
    mark: {type: 'rect', clip: true},
    encoding: {
      x: {field: 'x', type: 'quantitative'},
      y: {field: 'y', type: 'quantitative'},
      x2: {field: 'x2'},
      y2: {field: 'y2'},
      fill: {...colour, legend},
      tooltip: {field: 'text', title: `${field.x.title}, ${field.y.title}: ${field.quantity}`},
    },
  };
}

// Null if there is nothing to draw.
export function field_spec(field) {
  const height = height_of(field);
  const has_values = field.values.some((value) => value !== null);
  const levels = has_values ? contour_levels(field) : [];
  const layers = [];
  if (has_values) layers.push(colour_layer(field, levels));
  if (levels.length) layers.push(rules('contours', contour_lines(field, levels), '#5b6672', 1.1));
  if (has_arrows(field)) layers.push(rules('arrows', strokes_of(field, height), ink, 1.2));
  if (!layers.length) return null;
  const axis = (title, from, to) => ({
    type: 'quantitative',
    title,
    scale: {domain: [from, to], nice: false, zero: false},
    axis: {grid: false},
  });
  return {
    width,
    height,
    encoding: {
      x: axis(field.x.title, field.x_from, field.x_to),
      y: axis(field.y.title, field.y_from, field.y_to),
    },
    layer: layers,
  };
}
