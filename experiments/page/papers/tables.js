// Tables of reproduced experiments: how much agrees, and the paper's values beside ours.
import {element, table} from '../dom.js';
import {number, percent} from '../format.js';

const verdicts = ['agrees', 'differs', 'not resolved', 'ours alone'];
const css_class = (verdict) => verdict.replaceAll(' ', '-');
const numeric = (text) => ({text, class: 'number'});

// One experiment may stand in a report under several methods: what tells it apart there, fit for an id.
export const key_of = ({name, method}) => (method ? `${name}-with-${method.replace(/[^\w-]/g, '-')}` : name);
export const title_of = ({title, method}) => (method ? `${title}, with ${method}` : title);

const count_of = (rows, verdict) => rows.filter((row) => row.verdict === verdict).length;

const count_cells = (rows) =>
  verdicts.map((verdict) => {
    const count = count_of(rows, verdict);
    return {text: String(count), class: `number ${count ? css_class(verdict) : 'none'}`};
  });

function counts_table(id, head, rows, all) {
  const total = verdicts.map((verdict) => numeric(String(count_of(all, verdict))));
  const blank = head.slice(1).map(() => '');
  if (rows.length > 1) rows.push({cells: ['all', ...blank, ...total, ''], attributes: {class: 'total'}});
  const made = table(id, '', [...head, ...verdicts.map(numeric), ''], rows);
  made.classList.add('counts-table');
  return made;
}

export function overview_table(experiments) {
  const rows = experiments.map((experiment) => [
    element('a', {href: `#${key_of(experiment)}`}, title_of(experiment)),
    experiment.source,
    ...(experiment.failure ? verdicts.map(() => numeric('–')) : count_cells(experiment.rows)),
    experiment.failure ? {text: 'failed', class: 'differs'} : '',
  ]);
  const all = experiments.flatMap((experiment) => experiment.rows);
  return counts_table('overview-table', ['experiment', 'source'], rows, all);
}

// How much agrees of each quantity, where there are many values.
export function quantities_table(experiment) {
  const quantities = [...new Set(experiment.rows.map((row) => row.quantity))];
  const rows = quantities.map((quantity) => [
    quantity,
    ...count_cells(experiment.rows.filter((row) => row.quantity === quantity)),
    '',
  ]);
  return counts_table(`quantities-${key_of(experiment)}`, ['quantity'], rows, experiment.rows);
}

const minus = (text) => text.replace(/^-/, '−');

// Two digits of the error; a value without one as it is. Very large and very small ones by powers of ten.
function written(value, reach) {
  if (!(reach > 0)) return number(value, 6);
  const decimals = Math.max(0, 1 - Math.floor(Math.log10(reach)));
  return decimals > 6 || Math.abs(value) >= 1e6 ? number(value, 4) : minus(value.toFixed(decimals));
}

export function interval_text({value, low = value, high = value} = {}) {
  if (!Number.isFinite(value)) return '–';
  const below = value - low;
  const above = high - value;
  const reach = Math.max(below, above);
  const text = (one) => written(one, reach);
  if (!(reach > 0)) return text(value);
  if (Math.abs(above - below) <= 0.05 * reach) return `${text(value)} ± ${written(reach, reach)}`;
  return `${text(value)} (${text(low)} to ${text(high)})`;
}

function paper_cell({paper, paper_text}) {
  if (!paper) return paper_text ? `“${paper_text}”` : '–';
  const value = interval_text(paper);
  return paper_text ? `${value}: “${paper_text}”` : value;
}

function theory_cell({theory, theory_text}) {
  return [theory ? interval_text(theory) : '', theory_text ?? ''].filter(Boolean).join(': ') || '–';
}

// "differs by −4.2 %": of the paper's value, or else of theory's, which is said.
function verdict_text({verdict, paper, theory, ours}) {
  const other = paper ?? theory;
  if (verdict === 'ours alone' || !other) return verdict;
  const from = paper ? '' : ' (theory)';
  if (verdict !== 'differs' || !Number.isFinite(ours.value)) return verdict + from;
  const difference = ours.value - other.value;
  const sign = difference > 0 ? '+' : '';
  return `differs by ${sign}${other.value === 0 ? number(difference) : percent(difference / Math.abs(other.value))}${from}`;
}

// How many rows from each one on say the same; 0 where an earlier one says it for this one.
function spans_of(texts) {
  return texts.map((text, index) => {
    if (index > 0 && texts[index - 1] === text) return 0;
    const after = texts.findIndex((other, later) => later > index && other !== text);
    return (after < 0 ? texts.length : after) - index;
  });
}

// What rows beside each other have in common is said once.
function said_once(cells, make) {
  const spans = spans_of(cells);
  return cells.map((text, index) => (spans[index] ? make(text, spans[index]) : false));
}

const with_unit = (text, unit) => (unit && unit !== '1' ? `${text}, ${unit}` : text);

export function rows_table(experiment) {
  const {rows} = experiment;
  // Only some experiments have a theory beside a paper whose numbers are not known to us.
  const theory = rows.some((row) => row.theory);
  const head = ['quantity', 'setting', 'paper', ...(theory ? ['theory'] : []), 'ours, 95 %', 'verdict', 'explanation'];
  const quantities = said_once(
    rows.map((row) => with_unit(row.quantity, row.unit)),
    (text, rowspan) => ({text, rowspan, scope: 'rowgroup'}),
  );
  const settings = said_once(
    rows.map((row) => row.setting),
    (text, rowspan) => ({text, rowspan}),
  );
  const explanations = said_once(
    rows.map((row) => row.explanation.replaceAll('+-', '±')),
    (text, rowspan) => ({text, rowspan, class: 'explanation'}),
  );
  const body = rows.map((row, index) => ({
    cells: [
      quantities[index],
      settings[index],
      {text: paper_cell(row), class: 'value'},
      ...(theory ? [{text: theory_cell(row), class: 'value'}] : []),
      {text: interval_text(row.ours), class: 'value'},
      {text: verdict_text(row), class: `verdict ${css_class(row.verdict)}`},
      explanations[index],
    ],
  }));
  const made = table(`rows-${key_of(experiment)}`, '', head, body);
  made.classList.add('rows-table');
  return made;
}
