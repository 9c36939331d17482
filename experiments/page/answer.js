// The rule of an answer: which method and step keeps an observable within a tolerance at least cost.
// No document and no chart here, so that it runs under node as well as in the page.

export const equilibrium_parts = [
  'kinetic_temperature',
  'internal_temperature',
  'internal_energy_variance',
];

export function parts_of(observable) {
  return observable === 'equilibrium' ? equilibrium_parts : [observable];
}

// The name of a method together with its options, as the result's answers and orders have it.
export function method_label(cell) {
  return [
    cell.method,
    ...Object.entries(cell.options ?? {}).map(([name, value]) => `${name} ${value}`),
  ].join(', ');
}

// What a cell says of an observable: {state, value, lower, upper, worst, note}. The states are
// 'failed', 'not_applicable', 'not_resolved', 'no_exact_value', 'below_noise' and 'resolved'; only the
// last two carry numbers. The worst of several deviations lies between the largest of their lower
// and the largest of their upper ends.
export function judge(cell, observable) {
  if (cell.status === 'not_applicable') return {state: 'not_applicable', note: cell.reason ?? ''};
  if (cell.status !== 'ok') return {state: 'failed', note: cell.status};
  const parts = parts_of(observable).map((name) => ({name, ...cell.observables?.[name]}));
  const unresolved = parts.find((part) => part.status === 'not_resolved');
  if (unresolved)
    return {state: 'not_resolved', note: unresolved.note ?? '', worst: unresolved.name};
  const without = parts.find((part) => !part.deviation);
  if (without) return {state: 'no_exact_value', note: without.note ?? '', worst: without.name};
  const largest = (end) => Math.max(...parts.map((part) => part.deviation[end]));
  const upper = largest('upper');
  const value = largest('value');
  return {
    // The value shown is that of one part: it is below noise if that part is.
    state: parts.find((part) => part.deviation.value === value).deviation.below_noise
      ? 'below_noise'
      : 'resolved',
    value,
    lower: largest('lower'),
    upper,
    worst: parts.find((part) => part.deviation.upper === upper).name,
  };
}

export function cost_of(cell) {
  return cell.cost?.core_seconds_per_time ?? null;
}

export function passes(judgement, tolerance) {
  return judgement.upper !== undefined && judgement.upper <= tolerance;
}

// One entry for each method of the scene, in the file's order: its judged cells and, of those that
// pass, the cheapest (`best`, null where none passes with a known cost).
export function methods_of(result, scene, observable, tolerance) {
  const entries = new Map();
  for (const cell of result.cells.filter((candidate) => candidate.scene === scene)) {
    const label = method_label(cell);
    if (!entries.has(label)) {
      entries.set(label, {label, consistent: cell.consistent, judged: [], best: null});
    }
    const entry = entries.get(label);
    const judged = {cell, judgement: judge(cell, observable), cost: cost_of(cell)};
    entry.judged.push(judged);
    if (!passes(judged.judgement, tolerance) || judged.cost === null) continue;
    if (!entry.best || judged.cost < entry.best.cost) entry.best = judged;
  }
  return [...entries.values()];
}

// The entries with a passing cell, cheapest first; those whose limit is not the model come last.
export function ranked(entries) {
  return entries
    .filter((entry) => entry.best)
    .sort((a, b) => b.consistent - a.consistent || a.best.cost - b.best.cost);
}

// The cheapest method whose limit is the model, the next of these, and the cheapest method of
// another limit if that is cheaper than both; each null where there is none.
export function answer(result, scene, observable, tolerance) {
  const passing = ranked(methods_of(result, scene, observable, tolerance));
  const [winner = null, runner_up = null] = passing.filter((entry) => entry.consistent);
  const other = passing.find((entry) => !entry.consistent);
  const cheaper = other && (!winner || other.best.cost < winner.best.cost);
  return {winner, runner_up, cheaper_inconsistent: cheaper ? other : null};
}
