// The page of a judgement in headless Chromium.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {choose, counted_marks, open, page_of} from './inspection.mjs';

const finding = (subject, verdict, value, claimed) => ({
  subject,
  verdict,
  value,
  lower: value - 0.01,
  upper: value + 0.01,
  unit: '1',
  sentence: `It is ${value} too high.`,
  claimed,
});

const chart = (scale) => ({
  title: 'Largest stable step',
  x: {title: 'phi/k', logarithmic: true},
  y: {title: 'step', logarithmic: true},
  series: [
    {
      name: 'measured',
      marks: 'points',
      points: [1, 10, 100].map((x) => ({x, y: scale * x, lower: 0, upper: 2 * scale * x})),
    },
    {name: 'estimate', marks: 'line', points: [1, 100].map((x) => ({x, y: x}))},
  ],
});

const method = (name, scale, findings) => ({
  name,
  title: `${name} of <somebody>`,
  conclusions: {
    stability: {
      verdict: findings.some(({verdict}) => verdict === 'fails') ? 'fails' : 'holds',
      findings,
      charts: [chart(scale)],
      tables: [{title: 'Causes', columns: ['phi/k', 'cause'], rows: [[1, 'non-finite'], [2, null]]}],
    },
  },
});

const trade_point = (name, cost, error, on_front) => ({
  method: name,
  time_step: 0.1,
  cost,
  error,
  lower: 0.5 * error,
  upper: 2 * error,
  on_front,
});

const judgement = {
  format: 'driftless-judgement/1',
  depth: 'quick',
  provenance: {command: 'driftless judge all', seed: 1},
  examinations: [{name: 'stability', title: 'Stability', question: 'How large a step?', depth: 'quick'}],
  methods: [
    method('good', 1, [finding('energy', 'holds', 0.001, true)]),
    method('bad', 0.1, [finding('energy', 'fails', 0.3, true)]),
  ],
  trade: [
    {
      scene: 'ideal',
      observable: 'kinetic_temperature',
      points: [trade_point('good', 1, 0.1, true), trade_point('bad', 2, 0.2, false)],
    },
  ],
};

test('verdicts, charts of all methods and the front are drawn, without a fault', async () => {
  const {page, faults} = await open(page_of(judgement));
  const verdicts = await page.$$eval('#verdicts-table td', (cells) =>
    cells.map(({textContent}) => textContent),
  );
  assert.deepEqual(verdicts, ['holds', 'fails 1 of 1 †']);
  const marks = await counted_marks(page);
  assert.equal(marks['chart-overlay'].points, 6);
  assert.equal(marks['chart-trade'].points, 2);
  assert.match(await page.textContent('#trade-table'), /good/);
  assert.doesNotMatch(await page.textContent('#trade-table tbody'), /bad/);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test('a click on a verdict shows the findings, charts and tables of that method', async () => {
  const {page, faults} = await open(page_of(judgement));
  await page.click('#verdicts-table tbody tr:nth-child(2) button');
  await page.waitForFunction(() => document.body.dataset.state === 'ready');
  assert.match(await page.textContent('#findings-table'), /It is 0.3 too high/);
  assert.match(await page.textContent('#tables-place'), /non-finite/);
  assert.match(await page.textContent('#examination-title'), /bad of <somebody>/);
  assert.equal(await page.locator('#charts-place svg.marks').count(), 1);
  // The same chart again, in a container of its own.
  await choose(page, 'method', 'all methods');
  await choose(page, 'method', 'bad');
  assert.equal(await page.locator('#charts-place svg.marks').count(), 1);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test('a judgement of nothing much is a page all the same', async () => {
  const bare = {...judgement, methods: [judgement.methods[0]]};
  delete bare.trade;
  bare.methods[0].conclusions.stability.charts = [];
  const {page, faults} = await open(page_of(bare));
  assert.equal(await page.isVisible('#trade'), false);
  assert.match(await page.textContent('#findings-table'), /energy/);
  assert.deepEqual(faults, []);
  await page.context().close();
});
