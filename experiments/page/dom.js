// Elements without a framework. Text always goes in as text, never as markup.

export function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) node.addEventListener(key.slice(2), value);
    else if (value !== null && value !== undefined && value !== false)
      node.setAttribute(key, value === true ? '' : value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return node;
}

export function replace(id, ...children) {
  document
    .getElementById(id)
    .replaceChildren(...children.flat().filter((child) => child !== null && child !== undefined));
}

// rows: arrays of strings, nodes or {text, ...attributes} cells; the first cell heads its row. false: no
// cell, as one of a row above reaches down.
export function table(id, caption, head, rows) {
  return element(
    'table',
    {id},
    element('caption', {}, caption),
    element(
      'thead',
      {},
      element(
        'tr',
        {},
        head.map((title) => table_cell('th', title, {scope: 'col'})),
      ),
    ),
    element(
      'tbody',
      {},
      rows.map((row) =>
        element(
          'tr',
          row.attributes ?? {},
          (row.cells ?? row).map((cell, column) =>
            cell === false ? null : table_cell(column ? 'td' : 'th', cell, column ? {} : {scope: 'row'}),
          ),
        ),
      ),
    ),
  );
}

function table_cell(tag, cell, attributes) {
  if (cell === null || cell === undefined) return element(tag, attributes, '–');
  if (typeof cell === 'string' || cell instanceof Node) return element(tag, attributes, cell);
  const {text, ...more} = cell;
  return element(tag, {...attributes, ...more}, text);
}

// options: [{value, title}]; calls changed(value) with the option's own value.
export function fill_select(id, options, chosen, changed) {
  const select = document.getElementById(id);
  select.replaceChildren(
    ...options.map((option, index) =>
      element('option', {value: String(index), selected: option.value === chosen}, option.title),
    ),
  );
  select.disabled = options.length === 0;
  select.onchange = () => changed(options[Number(select.value)].value);
}
