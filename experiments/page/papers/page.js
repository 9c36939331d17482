// The page of reproduced experiments: what agrees, then every experiment with its rows and pictures.
import {draw, settle} from '../chart.js';
import {element, replace} from '../dom.js';
import {number} from '../format.js';
import {render_provenance} from '../provenance.js';
import {chart_spec} from '../series_chart.js';
import {field_spec, longest_arrow} from './field.js';
import {is_crowded, side_by_side_spec} from './side_by_side.js';
import {key_of, overview_table, quantities_table, rows_table, title_of} from './tables.js';

const papers = JSON.parse(document.getElementById('result').textContent);
const chart_id = (experiment, index) => `chart-${key_of(experiment)}-${index}`;

function picture_note({caption, field}) {
  const longest = field ? longest_arrow(field) : 0;
  const arrows = longest > 0 ? `The longest arrow is ${number(longest)}.` : '';
  return [caption, arrows].filter(Boolean).join(' ');
}

function pictures_of(experiment) {
  if (!experiment.pictures.length) return null;
  return element(
    'div',
    {class: 'pictures'},
    experiment.pictures.map((picture, index) =>
      element(
        'div',
        {},
        element('h3', {}, picture.title),
        element(
          'div',
          {class: 'scroll'},
          element('div', {
            class: picture.field ? 'chart field' : 'chart',
            id: chart_id(experiment, index),
          }),
        ),
        element('p', {class: 'note'}, picture_note(picture)),
      ),
    ),
  );
}

const most_shown = 12;

// Many values are counted, and listed for who asks for them.
function values_of(experiment) {
  const count = experiment.rows.length;
  if (!count) return null;
  const listed = element('div', {class: 'scroll'}, rows_table(experiment));
  if (count <= most_shown) return listed;
  return [
    element('div', {class: 'scroll'}, quantities_table(experiment)),
    element('details', {}, element('summary', {}, `All ${count} values`), listed),
  ];
}

function remarks_of({remarks}) {
  if (!remarks.length) return null;
  return element(
    'ul',
    {class: 'remarks'},
    remarks.map((remark) => element('li', {}, remark)),
  );
}

function section_of(experiment) {
  const {name, source, question, failure, command, commit} = experiment;
  const title = title_of(experiment);
  return element(
    'section',
    {id: key_of(experiment), class: 'experiment', 'aria-label': title},
    element('p', {class: 'kind'}, `${source} · ${name}`),
    element('h2', {}, title),
    element('p', {}, question),
    element('p', {class: 'note'}, element('code', {}, command), ` (commit ${commit})`),
    failure ? element('p', {class: 'failure'}, `It failed. ${failure}`) : null,
    pictures_of(experiment),
    values_of(experiment),
    remarks_of(experiment),
  );
}

function spec_of(chart, field) {
  if (chart) return is_crowded(chart) ? side_by_side_spec(chart) : chart_spec(chart);
  return field ? field_spec(field) : null;
}

function draw_pictures() {
  for (const experiment of papers.experiments) {
    experiment.pictures.forEach(({title, chart, field}, index) => {
      draw(chart_id(experiment, index), spec_of(chart, field), `${title}, ${experiment.source}${experiment.method ? ` with ${experiment.method}` : ''}`);
    });
  }
}

function start() {
  const count = papers.experiments.length;
  const title = count === 1 ? title_of(papers.experiments[0]) : `${count} experiments of the papers`;
  document.title = `${title} · Driftless`;
  replace('title', title);
  replace('overview-place', overview_table(papers.experiments));
  replace('experiments-place', ...papers.experiments.map(section_of));
  render_provenance(papers.provenance);
  settle(draw_pictures);
}

start();
