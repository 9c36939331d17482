// Tables of a judgement: verdicts, findings, whatever an examination tabulates.
import {element, replace, table} from '../dom.js';
import {number} from '../format.js';

const css_class = (verdict) => verdict.replaceAll(' ', '-');
const contradicts = (finding) => finding.verdict === 'fails' && finding.claimed === true;

function counted(findings, verdict) {
  return findings.filter((finding) => finding.verdict === verdict).length;
}

// "fails 3 of 40": of the findings that are answers.
function verdict_text({verdict, findings}) {
  const mark = findings.some(contradicts) ? ' †' : '';
  if (verdict !== 'fails' && verdict !== 'not resolved') return verdict;
  const answers = findings.filter(({verdict: one}) =>
    ['fails', 'holds', 'not resolved'].includes(one),
  );
  return `${verdict} ${counted(findings, verdict)} of ${answers.length}${mark}`;
}

export function render_verdicts({methods, examinations}, choose) {
  const rows = methods.map((method) => [
    method.name,
    ...examinations.map(({name}) => {
      const conclusion = method.conclusions[name];
      const text = verdict_text(conclusion);
      return {
        text: element('button', {type: 'button', onclick: () => choose(name, method.name)}, text),
        class: `verdict ${css_class(conclusion.verdict)}`,
      };
    }),
  ]);
  replace(
    'verdicts-place',
    table('verdicts-table', '', ['method', ...examinations.map(({title}) => title)], rows),
  );
}

const with_unit = (text, unit) => (unit && unit !== '1' ? `${text} ${unit}` : text);

function value_text({value, unit}) {
  return value === undefined ? '–' : with_unit(number(value), unit);
}

function interval_text({lower, upper}) {
  return lower === undefined && upper === undefined
    ? '–'
    : `${lower === undefined ? 'below' : number(lower)} to ${upper === undefined ? '…' : number(upper)}`;
}

const numeric = (text) => ({text, class: 'number'});

function finding_row(finding) {
  const mark = contradicts(finding) ? ' †' : '';
  return [
    finding.subject,
    {text: finding.verdict + mark, class: `verdict ${css_class(finding.verdict)}`},
    numeric(value_text(finding)),
    numeric(interval_text(finding)),
    finding.sentence,
  ];
}

export function render_findings(conclusion, method) {
  const head = ['of', 'verdict', numeric('value'), numeric('95 % interval'), 'in words'];
  replace(
    'findings-place',
    element(
      'div',
      {class: 'scroll'},
      table('findings-table', method, head, conclusion.findings.map(finding_row)),
    ),
  );
}

// Subjects by methods, for a look across.
export function render_comparison(judgement, examination, choose) {
  const conclusions = judgement.methods.map((method) => method.conclusions[examination]);
  const subjects = [
    ...new Set(conclusions.flatMap(({findings}) => findings.map(({subject}) => subject))),
  ];
  const cell = (method, subject) => {
    const finding = method.conclusions[examination].findings.find((one) => one.subject === subject);
    if (!finding) return {text: '', class: 'number'};
    const text = finding.value === undefined ? finding.verdict : number(finding.value, 2);
    return {
      text: element(
        'button',
        {type: 'button', title: finding.sentence, onclick: () => choose(examination, method.name)},
        text + (contradicts(finding) ? ' †' : ''),
      ),
      class: `verdict ${css_class(finding.verdict)}`,
    };
  };
  const rows = subjects.map((subject) => [
    subject,
    ...judgement.methods.map((method) => cell(method, subject)),
  ]);
  const head = ['of', ...judgement.methods.map(({name}) => ({text: name, class: 'upright'}))];
  replace(
    'findings-place',
    element('div', {class: 'scroll tall'}, table('comparison-table', 'All methods', head, rows)),
  );
}

const any_cell = (cell) =>
  typeof cell === 'number' ? numeric(number(cell)) : cell === null ? null : String(cell);

export function render_tables(tables) {
  replace(
    'tables-place',
    ...tables.map(({title, columns, rows}, index) =>
      element(
        'div',
        {class: 'scroll'},
        table(`table-${index}`, title, columns, rows.map((row) => row.map(any_cell))),
      ),
    ),
  );
}

export function render_trade(trade, scene, observable) {
  const entry = trade.find((one) => one.scene === scene && one.observable === observable);
  const front = (entry?.points ?? [])
    .filter(({on_front}) => on_front)
    .sort((a, b) => a.cost - b.cost);
  const head = ['method', numeric('time step'), numeric('cost'), numeric('error'), numeric('95 % interval')];
  const rows = front.map((point) => [
    point.method,
    numeric(number(point.time_step)),
    numeric(number(point.cost)),
    numeric(number(point.error)),
    numeric(interval_text(point)),
  ]);
  replace('trade-place', table('trade-table', 'The front, cheapest first', head, rows));
}
