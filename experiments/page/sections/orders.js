// The fitted order of each method, beside the chart of error against step; its marks are the legend.
import {is_isothermal, method_label, parts_of} from '../answer.js';
import {replace, table} from '../dom.js';
import {observable_short} from '../format.js';
import {method_tag} from '../palette.js';
import {scene_cells} from '../rows.js';

const short_heads = {
  kinetic_temperature: 'kinetic T',
  internal_temperature: 'internal T',
  internal_energy_variance: 'Var u',
};

function order_text(orders, method, observable) {
  const fit = orders.find((entry) => entry.observable === observable && entry.method === method);
  if (!fit || !Number.isFinite(fit.order)) return {text: '–', class: 'number'};
  const error = Number.isFinite(fit.error) ? ` ± ${fit.error.toFixed(2)}` : '';
  return {
    text: `${fit.order.toFixed(2)}${error}`,
    class: 'number',
    title: `fitted to ${fit.points} steps`,
  };
}

export function render_orders({result, scene, observable, labels}) {
  const orders = (result.orders ?? []).filter((entry) => entry.scene === scene);
  const parts = parts_of(observable, is_isothermal(scene_cells(result, scene)));
  const heads = parts.map((part) =>
    parts.length > 1 ? (short_heads[part] ?? observable_short(part)) : 'order',
  );
  const applicable = new Set(
    scene_cells(result, scene)
      .filter((cell) => cell.status !== 'not_applicable')
      .map(method_label),
  );
  const rows = labels
    .filter((label) => applicable.has(label))
    .map((label) => [
      method_tag(label, labels),
      ...parts.map((part) => order_text(orders, label, part)),
    ]);
  replace(
    'order-table-place',
    table(
      'order-table',
      'fitted order: the slope of error against step, ± one standard error',
      ['method', ...heads],
      rows,
    ),
  );
}
