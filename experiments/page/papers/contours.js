// Contour lines of a field by marching squares between the centres of its cells.

const about = 9; // levels where the field names none

// The field's own levels, or round ones between its extremes.
export function contour_levels({contours = [], values}) {
  if (contours.length) return contours;
  const known = values.filter((value) => value !== null);
  const low = Math.min(...known);
  const high = Math.max(...known);
  if (!(high > low)) return [];
  const raw = (high - low) / about;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((one) => one >= 0.7 * raw);
  const levels = [];
  for (let n = Math.floor(low / step) + 1; n * step < high; ++n)
    levels.push(Number((n * step).toPrecision(12)));
  return levels;
}

// Which edges (bottom 0, right 1, top 2, left 3) a line joins; bits are corners above the level,
// counter-clockwise from the lower left. The two saddles are told apart by the mean of the corners.
const joined = [
  [], [[3, 0]], [[0, 1]], [[3, 1]], [[1, 2]], null, [[0, 2]], [[3, 2]],
  [[2, 3]], [[2, 0]], null, [[2, 1]], [[1, 3]], [[1, 0]], [[0, 3]], [],
];

function edges_of(corners, level) {
  const above = corners.map((value) => value > level);
  const index = above.reduce((bits, is, corner) => bits + (is ? 1 << corner : 0), 0);
  if (joined[index]) return joined[index];
  const middle_above = corners.reduce((sum, value) => sum + value, 0) / 4 > level;
  // Corners 0 and 2 above (5), or 1 and 3 (10): they are joined through the middle if it is above.
  return (index === 5) === middle_above ? [[0, 1], [2, 3]] : [[3, 0], [1, 2]];
}

// Segments {x, y, x2, y2} in the field's axes. Squares with an unknown corner have none.
export function contour_lines(field, levels) {
  const {columns, rows, values} = field;
  const dx = (field.x_to - field.x_from) / columns;
  const dy = (field.y_to - field.y_from) / rows;
  const segments = [];
  for (let row = 0; row + 1 < rows; ++row) {
    for (let column = 0; column + 1 < columns; ++column) {
      const first = row * columns + column;
      const corners = [first, first + 1, first + columns + 1, first + columns].map((n) => values[n]);
      if (corners.includes(null)) continue;
      for (const level of levels) {
        const crossing = (edge) => {
          const [from, to] = [corners[edge], corners[(edge + 1) % 4]];
          const part = (level - from) / (to - from);
          const [along, across] = [[part, 0], [1, part], [1 - part, 1], [0, 1 - part]][edge];
          return [
            field.x_from + (column + 0.5 + along) * dx,
            field.y_from + (row + 0.5 + across) * dy,
          ];
        };
        for (const [one, other] of edges_of(corners, level)) {
          const [[x, y], [x2, y2]] = [crossing(one), crossing(other)];
          segments.push({x, y, x2, y2});
        }
      }
    }
  }
  return segments;
}
