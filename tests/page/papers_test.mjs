// The page of reproduced experiments in headless Chromium, and its contour lines.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {contour_levels, contour_lines} from '../../experiments/page/papers/contours.js';
import {field_spec} from '../../experiments/page/papers/field.js';
import {counted_marks, open, page_of} from './inspection.mjs';

const row = (quantity, verdict, value, paper) => ({
  quantity,
  setting: 'by <somebody>, step 0.1',
  unit: 'k T',
  paper,
  ours: {value, low: value - 0.01, high: value + 0.01},
  verdict,
  explanation: 'It is +- so.',
});

// A convection roll: temperature falls upwards, the fluid turns about the middle.
function roll(columns, rows) {
  const [values, arrow_x, arrow_y] = [[], [], []];
  for (let r = 0; r < rows; ++r) {
    for (let c = 0; c < columns; ++c) {
      const [x, z] = [(c + 0.5) / columns, (r + 0.5) / rows];
      const [sin, cos] = [Math.sin, Math.cos].map((wave) => (a, b) => wave(Math.PI * a) * b);
      values.push(2.8 - 2 * z - 0.5 * sin(2 * z, cos(x, 1)));
      arrow_x.push(-0.1 * sin(x, cos(z, 1)));
      arrow_y.push(0.1 * cos(x, sin(z, 1)));
    }
  }
  return {
    x: {title: 'x*', logarithmic: false},
    y: {title: 'z*', logarithmic: false},
    x_from: 0,
    x_to: 40,
    y_from: 0,
    y_to: 20,
    columns,
    rows,
    quantity: 'temperature T*',
    values,
    contours: [],
    arrow_x,
    arrow_y,
  };
}

const series = (name, marks) => ({
  name,
  marks,
  points: [1, 2, 3].map((x) => ({x, y: x * x, lower: x * x - 0.2, upper: x * x + 0.2})),
});
const chart = (...all) => ({
  title: 'course',
  x: {title: 'time', logarithmic: false},
  y: {title: 'temperature', logarithmic: false},
  series: all,
});

const papers = {
  format: 'driftless-papers/1',
  provenance: {command: 'driftless reproduce all', seed: 1},
  experiments: [
    {
      name: 'roll',
      source: 'MAN Fig. 4',
      title: 'The convection <roll>',
      question: 'How does the fluid turn?',
      effort: 'quick',
      command: 'driftless reproduce roll --quick',
      commit: 'abcdef0',
      rows: [
        row('wall pressure', 'agrees', 1.137, {value: 1.1372, low: 1.1322, high: 1.1422}),
        {...row('strength', 'differs', 0.9, {value: 1, low: 1, high: 1}), setting: 'at <other> settings'},
        {...row('sense', 'ours alone', 1), ours: {}, paper_text: 'it turns'},
      ],
      pictures: [
        {title: 'Isotherms', caption: 'Hot below.', field: roll(40, 20)},
        {title: 'Course', caption: '', chart: chart(series('ours', 'points'), series('theory', 'line'))},
        {title: 'Lines alone', caption: '', chart: chart(series('theory', 'line'))},
      ],
      remarks: ['The friction is chosen.'],
    },
    {
      name: 'broken',
      source: 'MAN Fig. 5',
      title: 'Another',
      question: 'What else?',
      effort: 'full',
      command: 'driftless reproduce broken',
      commit: 'abcdef1',
      failure: 'part 1: the box is too small',
      rows: [],
      pictures: [],
      remarks: [],
    },
  ],
};

test('rows, verdicts and pictures are shown, without a fault', async () => {
  const {page, faults} = await open(page_of(papers));
  const cells = await page.$$eval('#rows-roll tbody tr', (rows) =>
    rows.map((one) => [...one.children].map(({textContent}) => textContent)),
  );
  assert.deepEqual(cells[0].slice(2, 5), ['1.1372 ± 0.0050', '1.137 ± 0.010', 'agrees']);
  assert.deepEqual(cells[0].slice(5), ['It is ± so.']);
  assert.deepEqual(cells[1].slice(2), ['1', '0.900 ± 0.010', 'differs by −10 %']);
  assert.deepEqual(cells[2].slice(2, 5), ['“it turns”', '–', 'ours alone']);
  const overview = await page.$$eval('#overview-table tbody tr', (rows) =>
    rows.map((one) => [...one.children].map(({textContent}) => textContent)),
  );
  assert.deepEqual(overview[0], ['The convection <roll>', 'MAN Fig. 4', '1', '1', '0', '1', '']);
  assert.equal(overview[1].at(-1), 'failed');
  assert.deepEqual(overview[2].slice(2), ['1', '1', '0', '1', '']);
  assert.match(await page.textContent('#broken'), /the box is too small/);
  assert.match(await page.textContent('#roll'), /driftless reproduce roll --quick \(commit abcdef0\)/);
  assert.match(await page.textContent('#roll'), /The longest arrow is 0\.0\d+\./);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test('what rows beside each other have in common is said once', async () => {
  const [experiment] = papers.experiments;
  const rows = ['agrees', 'differs', 'agrees'].map((verdict) => row('strength', verdict, 1));
  rows[2].explanation = 'It is not.';
  rows.push(row('sense', 'agrees', 1));
  const {page} = await open(page_of({...papers, experiments: [{...experiment, rows}]}));
  const spans = await page.$$eval('#rows-roll tbody tr', (all) =>
    all.map((one) => [...one.children].map(({rowSpan}) => rowSpan)),
  );
  assert.deepEqual(spans, [
    [3, 4, 1, 1, 1, 2],
    [1, 1, 1],
    [1, 1, 1, 1],
    [1, 1, 1, 1, 1],
  ]);
  await page.context().close();
});

test('many values are counted by quantity, and listed for who asks', async () => {
  const [experiment] = papers.experiments;
  const rows = Array.from({length: 13}, (_, n) => row(n % 2 ? 'odd' : 'even', n < 3 ? 'differs' : 'agrees', n));
  const {page} = await open(page_of({...papers, experiments: [{...experiment, rows}]}));
  const counts = await page.$$eval('#quantities-roll tbody tr', (all) =>
    all.map((one) => [...one.children].map(({textContent}) => textContent)),
  );
  assert.deepEqual(counts, [
    ['even', '5', '2', '0', '0', ''],
    ['odd', '5', '1', '0', '0', ''],
    ['all', '10', '3', '0', '0', ''],
  ]);
  assert.equal(await page.locator('#rows-roll').isVisible(), false);
  await page.click('#roll summary:has-text("All 13 values")');
  assert.equal(await page.locator('#rows-roll').isVisible(), true);
  await page.context().close();
});

test('many series at the same few places stand side by side', async () => {
  const [experiment] = papers.experiments;
  const pictures = [8, 7].map((count) => ({
    title: `${count} series`,
    caption: '',
    chart: chart(...Array.from({length: count}, (_, n) => series(`method ${n}`, 'points'))),
  }));
  const {page, faults} = await open(page_of({...papers, experiments: [{...experiment, pictures}]}));
  const texts = (index) =>
    page.$$eval(`#chart-roll-${index} svg text`, (all) => all.map(({textContent}) => textContent));
  const marks = await counted_marks(page);
  assert.equal(marks['chart-roll-0'].points, 24);
  assert.equal(marks['chart-roll-1'].points, 21);
  // The series are the axis and the places the legend, or the other way round.
  const names = (count) => Array.from({length: count}, (_, n) => `method ${n}`);
  assert.deepEqual((await texts(0)).slice(-13), ['temperature', ...names(8), '1', '2', '3', 'time']);
  assert.deepEqual((await texts(1)).slice(-8), ['temperature', ...names(7)]);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test('theory has a column of its own, and a verdict against it says so', async () => {
  const theory = {value: 1, low: 1, high: 1};
  const [experiment] = papers.experiments;
  const rows = [
    {...row('one', 'differs', 1.2), theory, theory_text: 'eq. 5'},
    {...row('two', 'agrees', 1), theory},
    row('three', 'differs', 1.2, {value: 1, low: 1, high: 1}),
  ];
  const {page} = await open(page_of({...papers, experiments: [{...experiment, rows: rows.map((one, n) => ({...one, setting: `${n}`}))}]}));
  const columns = await page.$$eval('#rows-roll tr', (all) =>
    all.map((one) => [...one.children].map(({textContent}) => textContent).slice(2, 6)),
  );
  assert.deepEqual(columns, [
    ['paper', 'theory', 'ours, 95 %', 'verdict'],
    ['–', '1: eq. 5', '1.200 ± 0.010', 'differs by +20 % (theory)'],
    ['–', '1', '1.000 ± 0.010', 'agrees (theory)'],
    ['1', '–', '1.200 ± 0.010', 'differs by +20 %'],
  ]);
  await page.context().close();
});

test('an experiment under another method stands beside the one with the paper\'s', async () => {
  const [experiment] = papers.experiments;
  const other = {...experiment, method: 'groot-warren:lambda=0.5'};
  const {page, faults} = await open(page_of({...papers, experiments: [experiment, other]}));
  const id = 'roll-with-groot-warren-lambda-0-5';
  const titles = await page.$$eval('h2', (all) => all.map(({textContent}) => textContent));
  assert.ok(titles.includes('The convection <roll>'));
  assert.ok(titles.includes('The convection <roll>, with groot-warren:lambda=0.5'));
  await page.click(`#overview-table a[href="#${id}"]`);
  assert.equal(await page.evaluate(() => document.querySelector(':target').id), id);
  const twice = await page.$$eval('[id]', (all) => all.length - new Set(all.map((one) => one.id)).size);
  assert.equal(twice, 0);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test('a link of the overview leads to its experiment', async () => {
  const {page} = await open(page_of(papers));
  await page.click('#overview-table a[href="#broken"]');
  assert.equal(await page.evaluate(() => document.querySelector(':target').id), 'broken');
  await page.context().close();
});

test('a field has its cells, contours and arrows; charts their points', async () => {
  const {page, faults} = await open(page_of(papers));
  const marks = await counted_marks(page);
  assert.equal(marks['chart-roll-0'].cells, 800);
  assert.ok(marks['chart-roll-0'].contours > 100);
  // 40 columns are thinned to 20, 20 rows stay; three strokes each.
  assert.ok(marks['chart-roll-0'].arrows > 3 * 350 && marks['chart-roll-0'].arrows <= 3 * 400);
  assert.equal(marks['chart-roll-1'].points, 3);
  assert.equal(await page.locator('#chart-roll-2 svg.marks').count(), 1);
  assert.deepEqual(faults, []);
  await page.context().close();
});

const plane = (values, columns) => ({
  x_from: 0,
  x_to: columns,
  y_from: 0,
  y_to: values.length / columns,
  columns,
  rows: values.length / columns,
  values,
});

test('contour lines lie where the field has their level', () => {
  const field = roll(16, 12);
  field.values = field.values.map((_, n) => (n % 16) + 2 * Math.floor(n / 16));
  const levels = [3.5, 10.25, 20];
  const lines = contour_lines(field, levels);
  assert.ok(lines.length > 30);
  // value = column + 2 row, columns at x = 2.5 (column + 1/2), rows at y = (20/12) (row + 1/2)
  const value = (x, y) => x / 2.5 - 0.5 + 2 * ((y * 12) / 20 - 0.5);
  for (const {x, y, x2, y2} of lines) {
    const level = levels.find((one) => Math.abs(value(x, y) - one) < 1e-9);
    assert.ok(level !== undefined, `${x}, ${y} is on no level`);
    assert.ok(Math.abs(value(x2, y2) - level) < 1e-9);
  }
});

test('a saddle is joined through its middle on the side of the mean', () => {
  const ends = (values) =>
    contour_lines(plane(values, 2), [1]).map(({x, y, x2, y2}) => [x, y, x2, y2].map((one) => one - 0.5));
  // High at lower left and upper right; the mean is above the level, so the low corners are cut off.
  for (const [x, y, x2, y2] of ends([4, 0, 0, 4])) {
    const [middle_x, middle_y] = [(x + x2) / 2, (y + y2) / 2];
    assert.ok((middle_x > 0.5) === (middle_y < 0.5), `${middle_x}, ${middle_y}`);
  }
  // The mean is below: the high corners are cut off.
  for (const [x, y, x2, y2] of ends([1.5, 0, 0, 1.5])) {
    const [middle_x, middle_y] = [(x + x2) / 2, (y + y2) / 2];
    assert.ok((middle_x > 0.5) === (middle_y > 0.5), `${middle_x}, ${middle_y}`);
  }
  assert.equal(ends([4, 0, 0, 4]).length, 2);
  assert.deepEqual(ends([4, null, 0, 4]), []);
});

test('levels are round, within the extremes, and the field’s own where it names them', () => {
  assert.deepEqual(contour_levels({values: [0.8, 2.8]}), [1, 1.2, 1.4, 1.6, 1.8, 2, 2.2, 2.4, 2.6]);
  assert.deepEqual(contour_levels({values: [0.8, null, 2.8], contours: [2]}), [2]);
  assert.deepEqual(contour_levels({values: [1, 1]}), []);
});

test('arrows have the direction of the flow', () => {
  const field = {...roll(1, 1), values: [], arrow_x: [3], arrow_y: [4]};
  const shaft = field_spec(field).layer.find(({name}) => name === 'arrows').data.values[0];
  const [across, up] = [shaft.x2 - shaft.x, shaft.y2 - shaft.y];
  assert.ok(across > 0 && Math.abs(up / across - 4 / 3) < 0.05);
  assert.equal(field_spec({...field, arrow_x: [], arrow_y: []}), null);
});
