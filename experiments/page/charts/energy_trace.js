// The energy's way over the run, for every method at one step: mean over replicas.
import {method_label} from '../answer.js';
import {number} from '../format.js';
import {method_scales} from '../palette.js';

export function energy_trace({cells, time_step, labels}) {
  const rows = cells
    .filter((cell) => cell.time_step === time_step && cell.energy_trace?.time?.length)
    .flatMap((cell) =>
      cell.energy_trace.time.map((time, index) => ({
        method: method_label(cell) + (cell.conditioned_on_survival ? ' (survivors)' : ''),
        base: method_label(cell),
        time,
        energy: cell.energy_trace.energy[index],
        energy_text: number(cell.energy_trace.energy[index]),
      })),
    );
  if (!rows.length) return null;
  const {colour} = method_scales(labels);
  const shown = [...new Set(rows.map((row) => row.method))];
  const base_of = new Map(rows.map((row) => [row.method, row.base]));
  const range = shown.map((label) => colour.range[labels.indexOf(base_of.get(label))]);
  const x = {
    field: 'time',
    type: 'quantitative',
    title: 'time',
    scale: {nice: false},
    axis: {tickCount: 8},
  };
  const y = {field: 'energy', type: 'quantitative', title: '[E(t) − E(0)] / (N kT)'};
  return {
    width: 'container',
    height: 300,
    autosize: {type: 'fit-x', contains: 'padding'},
    data: {values: rows},
    layer: [
      {
        name: 'zero',
        data: {values: [{energy: 0}]},
        mark: {type: 'rule', stroke: '#9aa5b1', tooltip: null},
        encoding: {y},
      },
      {
        name: 'traces',
        params: [{name: 'picked', select: {type: 'point', fields: ['method']}, bind: 'legend'}],
        transform: [{filter: {param: 'picked'}}],
        mark: {type: 'line', strokeWidth: 1.8},
        encoding: {
          x,
          y,
          stroke: {
            field: 'method',
            type: 'nominal',
            scale: {domain: shown, range},
            legend: {title: 'method', orient: 'right', symbolOpacity: 1, symbolStrokeWidth: 3},
          },
          tooltip: [
            {field: 'method', title: 'method'},
            {field: 'time', title: 'time'},
            {field: 'energy_text', title: 'energy'},
          ],
        },
      },
    ],
  };
}
