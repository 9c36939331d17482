// Tables of reproduced experiments: how much agrees, and the paper's values beside ours.
import {element, table} from '../dom.js';
import {number, percent} from '../format.js';

const verdicts = ['agrees', 'differs', 'not resolved', 'ours alone'];
const css_class = (verdict) => verdict.replaceAll(' ', '-');
const numeric = (text) => ({text, class: 'number'});

// One experiment may stand in a report under several methods: what tells it apart there, fit for an id.
export const key_of = ({name, method}) => (method ? `${name}-with-${method.replace(/[^\w-]/g, '-')}` : name);
export const title_of = ({title, method}) => (method ? `${title}, with ${method}` : title);

export function overview_table(experiments) {
  const rows = experiments.map((experiment) => {
    const {source, rows: values, failure} = experiment;
    const counts = verdicts.map((verdict) => {
      const count = values.filter((row) => row.verdict === verdict).length;
      return {text: failure ? '–' : String(count), class: `number ${count ? css_class(verdict) : 'none'}`};
    });
    return [
      element('a', {href: `#${key_of(experiment)}`}, title_of(experiment)),
      source,
      ...counts,
      failure ? {text: 'failed', class: 'differs'} : '',
    ];
  });
  const total = verdicts.map((verdict) =>
    numeric(String(experiments.flatMap((one) => one.rows).filter((row) => row.verdict === verdict).length)),
  );
  const head = ['experiment', 'source', ...verdicts.map(numeric), ''];
  if (rows.length > 1) rows.push({cells: ['all', '', ...total, ''], attributes: {class: 'total'}});
  return table('overview-table', '', head, rows);
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

const with_unit = (text, unit) => (unit && unit !== '1' ? `${text}, ${unit}` : text);

export function rows_table(experiment) {
  const {rows} = experiment;
  // Only some experiments have a theory beside a paper whose numbers are not known to us.
  const theory = rows.some((row) => row.theory);
  const head = ['quantity', 'setting', 'paper', ...(theory ? ['theory'] : []), 'ours, 95 %', 'verdict', 'explanation'];
  const body = rows.map((row) => [
    with_unit(row.quantity, row.unit),
    row.setting,
    {text: paper_cell(row), class: 'value'},
    ...(theory ? [{text: theory_cell(row), class: 'value'}] : []),
    {text: interval_text(row.ours), class: 'value'},
    {text: verdict_text(row), class: `verdict ${css_class(row.verdict)}`},
    {text: row.explanation.replaceAll('+-', '±'), class: 'explanation'},
  ]);
  const made = table(`rows-${key_of(experiment)}`, '', head, body);
  made.classList.add('rows-table');
  return made;
}
