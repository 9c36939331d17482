// Opens result pages in headless Chromium, without a network, and looks for faults. DRIFTLESS names the
// program, WRITE_PAGE the one that writes the page of a result as it is; CHROMIUM the browser, where
// it is not found by its usual name.
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before} from 'node:test';
import {pathToFileURL} from 'node:url';
import {chromium} from 'playwright-core';

const folder = mkdtempSync(join(tmpdir(), 'driftless-page-'));
let written = 0;

// A result with all that the program derives from its cells: deviations, orders and answers.
export function answered(result) {
  const name = join(folder, `${++written}`);
  writeFileSync(`${name}.json`, JSON.stringify(result));
  execFileSync(process.env.DRIFTLESS, ['report', `${name}.json`, '-o', name], {stdio: 'ignore'});
  return JSON.parse(readFileSync(join(name, 'result.json'), 'utf8'));
}

export const sample = answered(
  JSON.parse(readFileSync(new URL('sample_result.json', import.meta.url), 'utf8')),
);
const flags = [
  '--no-sandbox',
  '--disable-gpu',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];
let browser;

before(async () => {
  const executablePath =
    process.env.CHROMIUM || execFileSync('which', ['chromium'], {encoding: 'utf8'}).trim();
  browser = await chromium.launch({executablePath, args: flags});
});

after(async () => {
  await browser?.close();
  rmSync(folder, {recursive: true, force: true});
});

export function page_of(result, change = (html) => html) {
  const name = join(folder, `${++written}`);
  writeFileSync(`${name}.json`, JSON.stringify(result));
  execFileSync(process.env.WRITE_PAGE, [`${name}.json`, `${name}.html`]);
  writeFileSync(`${name}.html`, change(readFileSync(`${name}.html`, 'utf8')));
  return pathToFileURL(`${name}.html`).href;
}

// Opens a page and notes what must not happen: requests, messages on the console, errors.
export async function open(url, patience = 20000) {
  const context = await browser.newContext({offline: true, viewport: {width: 1180, height: 900}});
  const page = await context.newPage();
  const faults = [];
  page.on(
    'request',
    (request) =>
      request.url() !== url &&
      !request.url().startsWith('data:') &&
      faults.push(`request: ${request.url()}`),
  );
  page.on(
    'console',
    (message) =>
      ['error', 'warning'].includes(message.type()) && faults.push(`console: ${message.text()}`),
  );
  page.on('pageerror', (error) => faults.push(`error: ${error.message}`));
  await page.goto(url);
  await ready(page, patience).catch(() => faults.push('the page never became ready'));
  return {page, faults};
}

function ready(page, timeout = 20000) {
  return page.waitForFunction(() => document.body.dataset.state === 'ready', undefined, {timeout});
}

export async function choose(page, id, title) {
  if (title === (await page.$eval(`#${id}`, (select) => select.selectedOptions[0]?.label))) return;
  await page.selectOption(`#${id}`, {label: title});
  await ready(page);
}

// How many marks each named layer of each chart has: {'chart-cost': {points: 22, ...}, ...}
export function counted_marks(page) {
  return page.evaluate(() =>
    Object.fromEntries(
      [...document.querySelectorAll('.chart')].map((chart) => {
        const layers = {};
        for (const group of chart.querySelectorAll('svg g.role-mark')) {
          const name = [...group.classList]
            .find((word) => word.endsWith('_marks'))
            ?.replace('_marks', '');
          if (name) layers[name] = (layers[name] ?? 0) + group.children.length;
        }
        return [chart.id, layers];
      }),
    ),
  );
}

// What the marks must be, from the result itself.
const equilibrium = ['kinetic_temperature', 'internal_temperature', 'internal_energy_variance'];
export const cells_of = (result, scene = result.scenes[0].name) =>
  result.cells.filter((cell) => cell.scene === scene);
const parts_of = (cell) => equilibrium.map((name) => cell.observables[name]);
const measured = (cell) =>
  cell.status === 'ok' && parts_of(cell).every((part) => part.status === 'ok' && part.deviation);
const bound_of = (cell) => Math.max(...parts_of(cell).map((part) => part.deviation.bound));
const failed = (cell) => !['ok', 'not_applicable'].includes(cell.status);

export function expected_marks(result) {
  const cells = cells_of(result);
  const shown = cells.filter(measured);
  // The error shown is the largest of the parts': hollow where that one is below noise.
  const hollow = shown.filter((cell) => {
    const sorted = parts_of(cell).sort((one, two) => two.deviation.value - one.deviation.value);
    return sorted[0].deviation.below_noise;
  }).length;
  const drifting = cells.filter(
    (cell) => cell.status === 'ok' && cell.observables.energy_drift.deviation.upper > 1e-8,
  ).length;
  const passing = shown.filter((cell) => bound_of(cell) <= 0.05).length;
  const methods = new Set(shown.map((cell) => cell.method)).size;
  return {
    'chart-cost': {
      points: shown.length,
      intervals: shown.length,
      bounds: shown.length,
      grounds: hollow,
      lines: methods,
      tolerance: 1,
      answer_ring: 1,
      failures: cells.filter((cell) => failed(cell) && cell.cost.core_seconds_per_time).length,
    },
    'chart-step': {
      points: shown.length,
      intervals: shown.length,
      grounds: hollow,
      lines: methods,
      tolerance: 1,
      failures: cells.filter(failed).length,
    },
    'chart-map': {
      squares: shown.length,
      failed_squares: cells.length - shown.length,
      texts: cells.length,
      passing,
    },
    'chart-drift': {points: drifting, intervals: drifting},
    'chart-walk': {points: drifting, intervals: drifting},
    'chart-trace': {
      traces: cells.filter((cell) => cell.time_step === 0.1 && cell.energy_trace).length,
      zero: 1,
    },
    'chart-internal-energy': {points: 24, intervals: 24, exact: 1},
    'chart-internal-energy-difference': {points: 24, intervals: 24, zero: 1},
    'chart-momentum': {points: 24, intervals: 24, exact: 1},
    'chart-momentum-difference': {points: 24, intervals: 24, zero: 1},
    'chart-radial': {points: 24, intervals: 24, exact: 1},
    'chart-radial-difference': {points: 24, intervals: 24, zero: 1},
  };
}

function differing_marks(counted, expected) {
  return Object.entries(expected).flatMap(([chart, layers]) =>
    Object.entries(layers)
      .filter(([layer, count]) => (counted[chart]?.[layer] ?? 0) !== count)
      .map(
        ([layer, count]) =>
          `marks: ${chart} has ${counted[chart]?.[layer] ?? 0} ${layer}, not ${count}`,
      ),
  );
}

// All faults of a page that is to show `result`.
export async function inspect(url, result, patience) {
  const {page, faults} = await open(url, patience);
  const found = [...faults, ...differing_marks(await counted_marks(page), expected_marks(result))];
  await page.context().close();
  return found;
}

// What the page answers now: the row that it marks.
export function shown_answer(page) {
  return page.evaluate(() => {
    const all = [...document.querySelectorAll('#answer-table tr[data-method]')];
    const rows = all.filter((row) => row.hasAttribute('data-consistent'));
    const entry = (row) =>
      row
        ? {method: row.querySelector('.method').textContent, time_step: Number(row.dataset.step)}
        : null;
    return {
      marked: document.querySelectorAll('#answer-table tr[data-best]').length,
      best: entry(rows[0]),
      next: entry(rows[1]),
    };
  });
}
