// The result page in headless Chromium: what it must show, and that the inspection notices faults.
import assert from 'node:assert/strict';
import {test} from 'node:test';
import {
  answered,
  cells_of,
  choose,
  counted_marks,
  expected_marks,
  inspect,
  open,
  page_of,
  sample,
  shown_answer,
} from './inspection.mjs';

test('the sample is drawn whole, without a network and without a word on the console', async () => {
  assert.deepEqual(await inspect(page_of(sample), sample), []);
});

test('each chart says what it shows to those who cannot see it', async () => {
  const {page} = await open(page_of(sample));
  const names = await page.$$eval('.chart', (charts) =>
    charts.map((chart) => chart.getAttribute('aria-label')),
  );
  assert.equal(new Set(names).size, names.length);
  assert.ok(
    names.every((name) => name.length > 20),
    names.join('\n'),
  );
  await page.context().close();
});

test('points below noise are drawn hollow and named in the legend', async () => {
  const {page} = await open(page_of(sample));
  const drawn = await page.$$eval('#chart-cost .points_marks path', (paths) =>
    paths.map((path) => path.getAttribute('fill-opacity')),
  );
  const hollow = expected_marks(sample)['chart-cost'].grounds;
  assert.ok(hollow > 0);
  assert.equal(drawn.filter((opacity) => opacity === '0').length, hollow);
  assert.match(await page.textContent('#chart-cost .role-legend'), /below noise/);
  await page.context().close();
});

test('every mark and bar stays inside its chart', async () => {
  const {page} = await open(page_of(sample));
  const outside = await page.evaluate(() =>
    [...document.querySelectorAll('.chart svg')].flatMap((svg) => {
      const frame = svg.getBoundingClientRect();
      return [
        ...svg.querySelectorAll(
          '.points_marks path, .intervals_marks line, .failures_marks path, .role-mark text',
        ),
      ]
        .filter((mark) => {
          const box = mark.getBoundingClientRect();
          return (
            box.left < frame.left - 1 ||
            box.right > frame.right + 1 ||
            box.top < frame.top - 1 ||
            box.bottom > frame.bottom + 1
          );
        })
        .map((mark) => `${svg.closest('.chart').id}: ${mark.parentNode.getAttribute('class')}`);
    }),
  );
  assert.deepEqual(outside, []);
  await page.context().close();
});

test('every interval covers its point, also where it reaches zero', async () => {
  const {page} = await open(page_of(sample));
  const uncovered = await page.evaluate(() =>
    ['chart-cost', 'chart-step', 'chart-drift', 'chart-walk'].flatMap((id) => {
      const middle = (mark) => {
        const box = mark.getBoundingClientRect();
        return (box.top + box.bottom) / 2;
      };
      const points = [...document.querySelectorAll(`#${id} .points_marks path`)];
      return [...document.querySelectorAll(`#${id} .intervals_marks line`)]
        .map((bar, index) => [bar.getBoundingClientRect(), middle(points[index])])
        .filter(([box, at]) => !(box.top <= at + 1 && at - 1 <= box.bottom))
        .map(([box, at]) => `${id}: ${at} is not within ${box.top} .. ${box.bottom}`);
    }),
  );
  assert.deepEqual(uncovered, []);
  await page.context().close();
});

const tolerance_titles = {
  0.001: '0.1 %',
  0.002: '0.2 %',
  0.005: '0.5 %',
  0.01: '1 %',
  0.02: '2 %',
  0.05: '5 %',
  0.1: '10 %',
};
const observable_titles = {
  equilibrium: 'equilibrium (the worst of the next three)',
  kinetic_temperature: 'kinetic temperature',
  internal_energy_variance: 'variance of internal energy',
  energy_drift: 'energy drift',
};

test('for every scene, observable and tolerance the page answers as the result does', async () => {
  const {page, faults} = await open(page_of(sample));
  const seen = new Set();
  for (const entry of sample.answers.filter(({observable}) => observable in observable_titles)) {
    await choose(page, 'scene', entry.scene);
    await choose(page, 'observable', observable_titles[entry.observable]);
    await choose(page, 'tolerance', tolerance_titles[entry.tolerance]);
    const what = `${entry.scene}, ${entry.observable}, ${entry.tolerance}`;
    const {marked, best, next} = await shown_answer(page);
    assert.equal(marked, entry.method ? 1 : 0, what);
    assert.deepEqual(
      best,
      entry.method && {method: entry.method, time_step: entry.time_step},
      what,
    );
    assert.deepEqual(
      next,
      entry.runner_up && {method: entry.runner_up.method, time_step: entry.runner_up.time_step},
      what,
    );
    assert.equal(await page.textContent('#answer-sentence'), entry.sentence, what);
    seen.add(JSON.stringify(best));
  }
  assert.ok(seen.size > 4, 'the choosers change the answer');
  assert.deepEqual(faults, []);
  await page.context().close();
});

test('the page says how sure an answer is and among how many it was chosen', async () => {
  const {page} = await open(page_of(sample));
  const [entry] = sample.answers.filter(({tolerance}) => tolerance === 0.05);
  assert.ok(entry.cells_compared > 10);
  assert.match(
    await page.textContent('#answer-level'),
    new RegExp(`bounds of all ${entry.cells_compared} cells .* probability of 95 %`),
  );
  assert.match(await page.textContent('#answer-table'), /methods are shown to keep equilibrium/);
  await page.context().close();
});

test('failed cells are explained where there are some', async () => {
  const cells = sample.cells.filter((cell) => ['ok', 'not_applicable'].includes(cell.status));
  for (const [result, expected] of [
    [sample, /Crosses/],
    [{...sample, cells}, /^$/],
  ]) {
    const {page, faults} = await open(page_of(result));
    assert.match(await page.textContent('#failed-note'), expected);
    assert.deepEqual(faults, []);
    await page.context().close();
  }
});

test('the caption says beyond which z the replica off equilibrium differs', async () => {
  const {page} = await open(page_of(sample));
  assert.match(await page.textContent('#agreement-table caption'), /beyond 5 it differs/);
  await page.context().close();
});

test('the table says why a method has no step that passes', async () => {
  const {page} = await open(page_of(sample));
  assert.match(
    await page.textContent('#answer-table'),
    /not applicable: espanol is built for the noise closure/,
  );
  await choose(page, 'tolerance', '0.1 %');
  assert.match(await page.textContent('#answer-table'), /below noise, but not resolved to 0\.1 %/);
  await choose(page, 'observable', 'skewness of internal energy');
  await choose(page, 'scene', sample.scenes[1].name);
  assert.match(
    await page.textContent('#answer-table'),
    /not resolved \(skewness of internal energy\): needs 20 relaxation times/,
  );
  await page.context().close();
});

test('steps and methods of the detail charts can be chosen', async () => {
  const {page, faults} = await open(page_of(sample));
  await choose(page, 'trace-step', '0.01');
  assert.match(await page.getAttribute('#chart-trace', 'aria-label'), /step 0\.01/);
  await choose(page, 'law-method', 'avalos-mackie-implicit');
  await choose(page, 'law-step', '0.2');
  assert.match(
    await page.getAttribute('#chart-momentum', 'aria-label'),
    /avalos-mackie-implicit at step 0\.2/,
  );
  assert.match(await page.textContent('#law-note'), /survivors/);
  assert.equal(await page.isVisible('#law-radial'), false);
  assert.deepEqual(faults, []);
  await page.context().close();
});

test('failures, parameters and the command are there', async () => {
  const {page} = await open(page_of(sample));
  const failures = cells_of(sample).flatMap((cell) => cell.failures).length;
  assert.equal(await page.locator('#failures-table tbody tr').count(), failures);
  assert.equal(await page.locator('#agreement-table tbody tr').count(), 8);
  assert.match(await page.textContent('#scenes-table'), /friction closure\s*frictionnoise/);
  assert.equal(await page.textContent('#command'), sample.provenance.command);
  await page.context().close();
});

function without_ok_cells() {
  const cells = sample.cells.map((cell) => ({
    ...cell,
    status: cell.status === 'not_applicable' ? cell.status : 'unstable',
    observables: {},
    curves: {},
    energy_trace: undefined,
    off_equilibrium: undefined,
    failures: [{replica: 0, cause: 'momentum is not finite', step: 3, time: 0.1}],
    cost: {...cell.cost, core_seconds_per_time: null},
  }));
  return answered({...sample, cells});
}

test('a result without one good cell still makes a page', async () => {
  const {page, faults} = await open(page_of(without_ok_cells()));
  assert.deepEqual(faults, []);
  assert.match(
    await page.textContent('#answer-sentence'),
    /no method and step of this study is shown to be/,
  );
  assert.match(await page.textContent('#answer-table'), /failed at every step: unstable/);
  const marks = await counted_marks(page);
  assert.equal(marks['chart-map'].failed_squares, cells_of(sample).length);
  assert.equal(marks['chart-step'].failures, 25);
  assert.equal(await page.getAttribute('#chart-trace', 'data-state'), 'empty');
  await page.context().close();
});

test('names in a result are text, never markup', async () => {
  const name = '</script><img src=x onerror="document.title=1"> & <b>bold</b>';
  const {page, faults} = await open(page_of({...sample, name}));
  assert.equal(await page.textContent('#title'), name);
  assert.deepEqual(faults, []);
  await page.context().close();
});

// Tests of the test: what it must not overlook.
test('a script error is noticed', async () => {
  const found = await inspect(
    page_of(sample, (html) =>
      html.replace(
        /<\/body>\s*<\/html>\s*$/,
        '<script>throw new Error("planted")</script></body></html>',
      ),
    ),
    sample,
  );
  assert.deepEqual(found, ['error: planted']);
});

test('a way out to the network is noticed', async () => {
  const found = await inspect(
    page_of(sample, (html) =>
      html.replace(
        /<\/body>\s*<\/html>\s*$/,
        '<img src="http://127.0.0.1:9/planted.png"></body></html>',
      ),
    ),
    sample,
  );
  assert.ok(
    found.length > 0 && found.every((fault) => fault.includes('planted.png')),
    found.join('\n'),
  );
});

test('a broken field of a chart is noticed', async () => {
  const broken = structuredClone(sample);
  for (const cell of broken.cells) if (cell.curves.momentum) delete cell.curves.momentum.density;
  const found = await inspect(page_of(broken), sample, 3000);
  assert.ok(
    found.some((fault) => fault.startsWith('error:')),
    found.join('\n'),
  );
});

test('a chart that lost marks is noticed', async () => {
  const cells = sample.cells.filter(
    (cell) => !(cell.method === 'shardlow-s1' && cell.time_step === 0.05),
  );
  const found = await inspect(page_of({...sample, cells}), sample);
  assert.ok(
    found.some((fault) => fault.startsWith('marks: chart-cost')) &&
      found.some((fault) => fault.startsWith('marks: chart-map')),
    found.join('\n'),
  );
});
