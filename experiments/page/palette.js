// A colour and a shape for each method, the same in every chart and table of a page.
import {element} from './dom.js';

// Okabe and Ito's colours (yellow darkened for a white ground), then Tol's muted ones.
const colours = [
  '#0072b2',
  '#d55e00',
  '#009e73',
  '#cc79a7',
  '#e69f00',
  '#56b4e9',
  '#332288',
  '#7a6a00',
  '#882255',
  '#44aa99',
  '#333333',
  '#aa4499',
];
const star =
  'M0,-1L0.26,-0.36L0.95,-0.31L0.42,0.14L0.59,0.81L0,0.45L-0.59,0.81L-0.42,0.14L-0.95,-0.31L-0.26,-0.36Z';
const hexagon = 'M0,-0.9L0.78,-0.45L0.78,0.45L0,0.9L-0.78,0.45L-0.78,-0.45Z';
const hourglass = 'M-0.75,-0.85L0.75,-0.85L-0.75,0.85L0.75,0.85Z';
const shapes = [
  'circle',
  'square',
  'triangle-up',
  'diamond',
  'triangle-down',
  'cross',
  hexagon,
  star,
  'triangle-right',
  'triangle-left',
  hourglass,
];

export const failure_cross = 'M-0.8,-0.8L0.8,0.8M0.8,-0.8L-0.8,0.8';

// Scales of Vega-Lite for a field that holds a method's label.
export function method_scales(labels) {
  return {
    colour: {domain: labels, range: labels.map((_, index) => colours[index % colours.length])},
    shape: {domain: labels, range: labels.map((_, index) => shapes[index % shapes.length])},
  };
}

const outlines = {
  circle: 'M-0.8,0A0.8,0.8,0,1,0,0.8,0A0.8,0.8,0,1,0,-0.8,0Z',
  square: 'M-0.72,-0.72H0.72V0.72H-0.72Z',
  'triangle-up': 'M0,-0.85L0.9,0.75H-0.9Z',
  'triangle-down': 'M0,0.85L0.9,-0.75H-0.9Z',
  'triangle-right': 'M0.85,0L-0.75,0.9V-0.9Z',
  'triangle-left': 'M-0.85,0L0.75,0.9V-0.9Z',
  diamond: 'M0,-0.95L0.75,0L0,0.95L-0.75,0Z',
  cross: 'M-0.3,-0.9H0.3V-0.3H0.9V0.3H0.3V0.9H-0.3V0.3H-0.9V-0.3H-0.3Z',
};

// The method's mark and its name, for tables.
export function method_tag(label, labels) {
  const index = Math.max(0, labels.indexOf(label));
  const colour = colours[index % colours.length];
  const shape = shapes[index % shapes.length];
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  for (const [key, value] of Object.entries({
    viewBox: '-1.15 -1.15 2.3 2.3',
    width: 13,
    height: 13,
    'aria-hidden': 'true',
    class: 'method-mark',
  })) {
    svg.setAttribute(key, value);
  }
  path.setAttribute('d', outlines[shape] ?? shape);
  path.setAttribute('fill', colour);
  svg.append(path);
  return element('span', {class: 'method'}, svg, label);
}
