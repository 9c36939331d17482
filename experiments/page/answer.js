// What the cells say, and the answer that the result holds: which method and step is shown to keep an
// observable within a tolerance at least cost. The choice and its sentence are made by the program
// alone (experiments/answers.cpp); here they are looked up. No document and no chart.

export const equilibrium_parts = [
  'kinetic_temperature',
  'internal_temperature',
  'internal_energy_variance',
];

// An isothermal scene has no internal energies: of the equilibrium only the kinetic temperature is left.
export function parts_of(observable, isothermal = false) {
  if (observable !== 'equilibrium') return [observable];
  return isothermal ? equilibrium_parts.slice(0, 1) : equilibrium_parts;
}

export function is_isothermal(cells) {
  return cells.some((cell) => cell.isothermal === true);
}

// The name of a method together with its options, as the result's answers and orders have it.
export function method_label(cell) {
  return [
    cell.method,
    ...Object.entries(cell.options ?? {}).map(([name, value]) => `${name} ${value}`),
  ].join(', ');
}

// What a cell says of an observable: {state, value, lower, upper, bound, worst, note}. The states are
// 'failed', 'not_applicable', 'not_resolved', 'no_exact_value', 'below_noise' and 'resolved'; only the
// last two carry numbers. The worst of several deviations lies between the largest of their lower
// and the largest of their upper ends, and below the largest of their bounds.
export function judge(cell, observable) {
  if (cell.status === 'not_applicable') return {state: 'not_applicable', note: cell.reason ?? ''};
  if (cell.status !== 'ok') return {state: 'failed', note: cell.status};
  const parts = parts_of(observable, cell.isothermal).map((name) => ({name, ...cell.observables?.[name]}));
  const unresolved = parts.find((part) => part.status === 'not_resolved');
  if (unresolved)
    return {state: 'not_resolved', note: unresolved.note ?? '', worst: unresolved.name};
  const without = parts.find((part) => part.deviation?.bound === undefined);
  if (without) return {state: 'no_exact_value', note: without.note ?? '', worst: without.name};
  const largest = (end) => Math.max(...parts.map((part) => part.deviation[end]));
  const bound = largest('bound');
  const value = largest('value');
  return {
    // The value shown is that of one part: it is below noise if that part is.
    state: parts.find((part) => part.deviation.value === value).deviation.below_noise
      ? 'below_noise'
      : 'resolved',
    value,
    lower: largest('lower'),
    upper: largest('upper'),
    bound,
    worst: parts.find((part) => part.deviation.bound === bound).name,
  };
}

export function cost_of(cell) {
  return cell.cost?.core_seconds_per_time ?? null;
}

export function passes(judgement, tolerance) {
  return judgement.bound !== undefined && judgement.bound <= tolerance;
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

// The result's answer: {method, time_step, upper, sentence, cells_compared, level, ...}, or undefined.
export function answer_of(result, scene, observable, tolerance) {
  return result.answers?.find(
    (entry) =>
      entry.scene === scene && entry.observable === observable && entry.tolerance === tolerance,
  );
}

export function tolerances_of(result) {
  return [...new Set((result.answers ?? []).map((entry) => entry.tolerance))].sort((a, b) => a - b);
}
