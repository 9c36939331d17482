// One embedded chart in a container of the page: drawn anew whenever a chooser changes what it shows.
import embed from 'vega-embed';

const font = 'system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif';
const ink = '#1f2933';
const config = {
  font,
  background: null,
  view: {stroke: '#c9d1d9'},
  axis: {
    labelColor: ink,
    titleColor: ink,
    labelFontSize: 12,
    titleFontSize: 13,
    titleFontWeight: 600,
    titlePadding: 8,
    gridColor: '#e8ecf0',
    domainColor: '#7b8794',
    tickColor: '#7b8794',
  },
  legend: {
    labelColor: ink,
    titleColor: ink,
    labelFontSize: 12,
    titleFontSize: 12,
    labelLimit: 260,
    symbolSize: 90,
    rowPadding: 4,
  },
  text: {font},
};

const views = new Map();
const drawn = new WeakMap();  // by container: a new one of the same id is empty
const turns = new Map();

// spec null says there is nothing to draw; `description` then tells the reader why.
export function draw(id, spec, description) {
  const turn = (turns.get(id) ?? Promise.resolve()).then(() => draw_now(id, spec, description));
  turns.set(id, turn);
  return turn;
}

async function draw_now(id, spec, description) {
  const container = document.getElementById(id);
  if (!container) return; // the page has moved on
  container.setAttribute('role', 'figure');
  container.setAttribute('aria-label', description);
  const wanted = JSON.stringify([spec, description]);
  if (drawn.get(container) === wanted) return;
  drawn.set(container, wanted);
  views.get(id)?.finalize();
  views.delete(id);
  if (!spec) {
    const note = document.createElement('p');
    note.className = 'nothing';
    note.textContent = description;
    container.replaceChildren(note);
    container.dataset.state = 'empty';
    return;
  }
  try {
    const actions = {export: {svg: true, png: true}, source: false, compiled: false, editor: false};
    views.set(
      id,
      await embed(
        container,
        {...spec, description},
        {
          mode: 'vega-lite',
          renderer: 'svg',
          actions,
          config,
          downloadFileName: id,
          tooltip: {theme: 'light'},
        },
      ),
    );
    container.dataset.state = 'drawn';
  } catch (error) {
    container.textContent = `This chart could not be drawn: ${error.message}`;
    container.dataset.state = 'failed';
    console.error(`chart ${id}: ${error.message}`);
  }
}

// Draws, and marks the page as ready once its charts stand, for whoever waits for it.
let last = 0;
export async function settle(draw_again) {
  const mine = ++last;
  document.body.dataset.state = 'drawing';
  draw_again();
  await Promise.all(turns.values());
  if (mine === last) document.body.dataset.state = 'ready';
}
