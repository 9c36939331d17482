// The page of a judgement: verdicts of all methods, and behind each the findings.
import {draw, settle} from '../chart.js';
import {element, fill_select, replace} from '../dom.js';
import {render_provenance} from '../provenance.js';
import {chart_spec} from '../series_chart.js';
import {overlaid, shared_series, trade_chart} from './charts.js';
import {
  render_comparison,
  render_findings,
  render_tables,
  render_trade,
  render_verdicts,
} from './tables.js';

const judgement = JSON.parse(document.getElementById('result').textContent);
const trade = judgement.trade ?? [];
const labels = judgement.methods.map(({name}) => name);
const every_method = 'all methods';
const state = {
  examination: judgement.examinations[0]?.name,
  method: judgement.methods.length > 1 ? every_method : labels[0],
  overlay: 0,
  trade_scene: trade[0]?.scene,
  trade_observable: trade[0]?.observable,
};

const show = (id, visible) => {
  document.getElementById(id).hidden = !visible;
};
const as_options = (values) => values.map((value) => ({value, title: value}));

function choose(examination, method) {
  Object.assign(state, {examination, method, overlay: 0});
  settle(draw_examination);
  document.getElementById('choosers').scrollIntoView({behavior: 'smooth'});
}

const chooser = (key, draw_again) => (value) => {
  state[key] = value;
  settle(draw_again);
};

function draw_overlay() {
  const shared = shared_series(judgement.methods, state.examination);
  const wanted = state.method === every_method && shared.length > 0;
  show('overlay', wanted);
  if (!wanted) return;
  state.overlay = Math.min(state.overlay, shared.length - 1);
  fill_select(
    'overlay-chart',
    shared.map(([title, name], value) => ({value, title: `${title}: ${name}`})),
    state.overlay,
    chooser('overlay', draw_overlay),
  );
  const [title, name] = shared[state.overlay];
  const chart = overlaid(judgement.methods, state.examination, title, name);
  draw('chart-overlay', chart_spec(chart, labels), `${title}, ${name}, of all methods`);
}

function draw_details(conclusion) {
  const {charts = [], tables = []} = conclusion ?? {};
  show('details', charts.length + tables.length > 0);
  const place = (index) => `chart-${state.examination}-${state.method}-${index}`;
  replace(
    'charts-place',
    ...charts.map(({title}, index) =>
      element(
        'div',
        {},
        element('h3', {}, title),
        element('div', {class: 'chart', id: place(index)}),
      ),
    ),
  );
  charts.forEach((chart, index) => draw(place(index), chart_spec(chart), `${chart.title}, ${state.method}`));
  render_tables(tables);
}

function draw_examination() {
  const {title, question, depth} = judgement.examinations.find(({name}) => name === state.examination);
  const method = judgement.methods.find(({name}) => name === state.method);
  const conclusion = method?.conclusions[state.examination];
  replace('examination-title', method ? `${title}: ${method.title}` : title);
  replace('question', `${question} Depth ${depth}.`);
  fill_select(
    'examination',
    judgement.examinations.map(({name: value, title}) => ({value, title})),
    state.examination,
    chooser('examination', draw_examination),
  );
  fill_select(
    'method',
    as_options([...(labels.length > 1 ? [every_method] : []), ...labels]),
    state.method,
    chooser('method', draw_examination),
  );
  if (conclusion) render_findings(conclusion, method.name);
  else render_comparison(judgement, state.examination, choose);
  draw_overlay();
  draw_details(conclusion);
}

function draw_trade() {
  if (!trade.length) return;
  show('trade', true);
  const scenes = [...new Set(trade.map(({scene}) => scene))];
  fill_select('trade-scene', as_options(scenes), state.trade_scene, chooser('trade_scene', draw_trade));
  const observables = trade
    .filter(({scene}) => scene === state.trade_scene)
    .map(({observable}) => observable);
  if (!observables.includes(state.trade_observable)) state.trade_observable = observables[0];
  fill_select(
    'trade-observable',
    as_options(observables),
    state.trade_observable,
    chooser('trade_observable', draw_trade),
  );
  const chart = trade_chart(trade, state.trade_scene, state.trade_observable);
  draw('chart-trade', chart && chart_spec(chart, [...labels, 'front']), `Error against cost, ${chart?.title}`);
  render_trade(trade, state.trade_scene, state.trade_observable);
}

function start() {
  const count = labels.length;
  const title = count === 1 ? `Judgement of ${labels[0]}` : `Judgement of ${count} methods`;
  document.title = `${title} · Driftless`;
  replace('title', `${title}, depth ${judgement.depth}`);
  render_verdicts(judgement, choose);
  render_provenance(judgement.provenance, {depth: judgement.depth});
  settle(() => {
    draw_trade();
    draw_examination();
  });
}

start();
