// Charts of a judgement: what examinations share, and the front of error against cost.

// One series of a chart, the same of every method: the methods become the series.
export function overlaid(methods, examination, title, series_name) {
  let like = null;
  const series = [];
  for (const method of methods) {
    const chart = method.conclusions[examination]?.charts.find((one) => one.title === title);
    const own = chart?.series.find(({name}) => name === series_name);
    if (!own?.points.length) continue;
    like ??= chart;
    series.push({...own, name: method.name});
  }
  return like && {...like, series};
}

// Every chart and series of an examination that several methods share.
export function shared_series(methods, examination) {
  const counted = new Map();
  for (const method of methods) {
    for (const {title, series} of method.conclusions[examination]?.charts ?? []) {
      for (const {name, marks} of series) {
        if (marks === 'line') continue;
        const key = JSON.stringify([title, name]);
        counted.set(key, (counted.get(key) ?? 0) + 1);
      }
    }
  }
  return [...counted].filter(([, count]) => count > 1).map(([key]) => JSON.parse(key));
}

// The points of a scene and an observable, at what the error is at most, and the front through them.
export function trade_chart(trade, scene, observable) {
  const entry = trade.find((one) => one.scene === scene && one.observable === observable);
  if (!entry) return null;
  const names = [...new Set(entry.points.map(({method}) => method))];
  const point = ({cost, lower, upper}) => ({x: cost, y: upper, lower, upper});
  const front = entry.points.filter(({on_front}) => on_front).sort((a, b) => a.cost - b.cost);
  return {
    title: `${scene}, ${observable}`,
    x: {title: 'cost, core-seconds per unit of time', logarithmic: true},
    y: {title: 'error, at most (95 %)', logarithmic: true},
    series: [
      ...names.map((name) => ({
        name,
        marks: 'apart',
        points: entry.points.filter(({method}) => method === name).map(point),
      })),
      {name: 'front', marks: 'line', points: front.map(({cost, upper}) => ({x: cost, y: upper}))},
    ],
  };
}
