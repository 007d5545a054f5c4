import * as Plot from '@observablehq/plot';
import { type ComponentChild, render } from 'preact';
import { offerDownload } from 'threepoint-ui';
import { Button } from 'threepoint-ui/controls';
import type { Comparison } from '../../model/results/compare-conditions';
import type { ShownComparison } from './shown-results';
import { swarmOffsets } from './swarm-layout';

/** Comparisons on one scale, drawn side by side. */
export interface Chart {
  readonly comparisons: readonly Comparison[];
  readonly title: string;
  /** Returns the name of a comparison below the axis. */
  readonly nameOf: (comparison: Comparison) => string;
  readonly axis: string;
  /** The ends of the scale; the axis also covers intervals beyond them. */
  readonly domain: readonly [number, number];
  /** The unit that has one value each. */
  readonly each: 'participant' | 'group';
  /** The name of its files, without extension. */
  readonly file: string;
  /** A note after the caption of the means of two conditions. */
  readonly note: string;
}

/** The labels of two conditions or cohorts, and whether the pictures are marked as simulated. */
export interface ChartLegend extends Pick<ShownComparison, 'labels' | 'order'> {
  readonly simulated: boolean;
}

/** The page's tokens, each with the colour that saved files have. */
const colours = { first: 'var(--first, #b05510)', second: 'var(--second, #2b6cb0)' } as const;
const ink = 'var(--ink, #1d2733)';
const inkSoft = 'var(--ink-soft, #4d5a69)';
const surface = 'var(--surface, white)';
const fontFamily = 'Inter, "Segoe UI", system-ui, sans-serif';
/**
 * Wraps a note that would not fit the picture after the first part of its sentence; `letter` is the mean width of a
 * letter [pixels].
 */
const noteLines = (note: string, width: number, letter = 6.3): readonly string[] =>
  note.length * letter <= width ? [note] : note.split(/(?<=;) /);

interface HeadingProps extends ChartLegend {
  readonly title: string;
  readonly note: string;
  readonly width: number;
}

/** The title, the key and the mark of simulation inside the picture, so that copies of it keep them. */
const Heading = ({ title, note, width, labels, order, simulated }: HeadingProps) => (
  // Plots centre their labels by default.
  <g font-family={fontFamily} fill={ink} text-anchor="start">
    <text x={12} y={24} font-size={16} font-weight={650}>
      {title}
    </text>
    {order.map((side, index) => {
      const x = index === 0 ? 12 : 50 + labels[order[0]].length * 7.4;
      return (
        <>
          <rect x={x} y={38} width={12} height={12} rx={2} fill={colours[side]} />
          <text x={x + 18} y={48.5} font-size={13}>
            {labels[side]}
          </text>
        </>
      );
    })}
    {noteLines(note, width - 24).map((line, index) => (
      <text x={12} y={66 + 15 * index} font-size={12} fill={inkSoft}>
        {line}
      </text>
    ))}
    {simulated && (
      <text x={width - 12} y={24} text-anchor="end" font-size={15} font-weight={700} fill="var(--trouble, #b3261e)">
        SIMULATED
      </text>
    )}
  </g>
);

/** Returns a group with this content, to be put into a picture. */
function svgGroup(content: ComponentChild): SVGGElement {
  const group = document.createElementNS('http://www.w3.org/2000/svg', 'g');
  render(content, group);
  return group;
}

const shared = {
  marginTop: 92,
  marginLeft: 52,
  marginBottom: 40,
  style: { fontSize: '13px', color: ink, background: surface, fontFamily },
} as const;

/** Answers are whole numbers; other scales choose their own ticks. */
const ticksOf = ({ domain: [low, high] }: Pick<Chart, 'domain'>) =>
  high - low < 10 ? Array.from({ length: high - low + 1 }, (_, index) => low + index) : 5;

/** Formats ends of scales as whole numbers: "3", not "3.0". */
const tickText = (value: number): string => String(Number(value.toFixed(6)));

const widthFor = (count: number, each = 100) => Math.max(520, 90 + count * each);
const height = 360;

/** Draws comparisons side by side; `plot` is what differs between charts. */
function drawn(
  chart: Chart,
  legend: ChartLegend,
  note: string,
  { padding, ...plot }: Plot.PlotOptions & { readonly padding: number },
): SVGSVGElement {
  const { comparisons, title, axis } = chart;
  const { width = widthFor(comparisons.length) } = plot;
  const picture = Plot.plot({
    ...shared,
    height,
    fx: { label: null, domain: comparisons.map(chart.nameOf), padding },
    y: { label: null, domain: axisDomain(chart), grid: true, ticks: ticksOf(chart), tickFormat: tickText },
    color: { domain: [...sides], range: [colours.first, colours.second] },
    ...plot,
    width,
  });
  if (!(picture instanceof SVGSVGElement)) throw new Error('results/charts: expected a plain SVG from the plot');
  picture.prepend(svgGroup(<rect width="100%" height="100%" fill={surface} />));
  // Plot names its marks, but a picture has one name, and no name may stand on a group without a role.
  for (const mark of picture.querySelectorAll('[aria-label]')) mark.removeAttribute('aria-label');
  picture.append(svgGroup(<Heading {...legend} title={title} note={`${axis}; ${note}`} width={width} />));
  return picture;
}

const sides = ['first', 'second'] as const;

/** Returns the mean of each side with its 95 % confidence interval. */
const meansOf = ({ comparisons, nameOf }: Pick<Chart, 'comparisons' | 'nameOf'>) =>
  comparisons.flatMap((comparison) =>
    sides.flatMap((side) => {
      const summary = comparison[side];
      if (!summary) return [];
      const { mean, interval } = summary;
      return [{ of: nameOf(comparison), side, mean, from: interval?.low ?? mean, to: interval?.high ?? mean }];
    }),
  );

/** Returns the ends of the axis: those of the scale, or of the intervals that reach beyond it. */
export function axisDomain(chart: Pick<Chart, 'comparisons' | 'nameOf' | 'domain'>): [number, number] {
  const ends = meansOf(chart).flatMap(({ from, to }) => [from, to]);
  return [Math.min(chart.domain[0], ...ends), Math.max(chart.domain[1], ...ends)];
}

/** Draws means as bars with their 95 % confidence intervals, as figures 11 to 14 of the paper. */
export function barChart(chart: Chart, legend: ChartLegend): SVGSVGElement {
  const [low] = chart.domain;
  const bars = meansOf(chart);
  return drawn(chart, legend, 'mean and 95 % confidence interval', {
    padding: 0.25,
    x: { axis: null, domain: [...legend.order], padding: 0.12 },
    marks: [
      Plot.barY(bars, { fx: 'of', x: 'side', y1: low, y2: 'mean', fill: 'side' }),
      Plot.ruleX(bars, { fx: 'of', x: 'side', y1: 'from', y2: 'to', stroke: ink, strokeWidth: 1.5 }),
      Plot.tickY(bars, { fx: 'of', x: 'side', y: 'from', stroke: ink, insetLeft: 10, insetRight: 10 }),
      Plot.tickY(bars, { fx: 'of', x: 'side', y: 'to', stroke: ink, insetLeft: 10, insetRight: 10 }),
      Plot.text(bars, {
        fx: 'of',
        x: 'side',
        y: low,
        text: ({ mean }: { mean: number }) => (mean >= 10 ? mean.toFixed(1) : mean.toFixed(2)),
        dy: -9,
        fill: surface,
        fontWeight: 600,
      }),
      Plot.ruleY([low]),
    ],
  });
}

/** Draws every participant (or group) as a line from one condition to the other. Equal lines make a thicker one. */
export function pairedChart(chart: Chart, legend: ChartLegend): SVGSVGElement {
  const lines = chart.comparisons.flatMap((comparison) => {
    const of = chart.nameOf(comparison);
    const alike = new Map<string, { first: number; second: number; count: number }>();
    comparison.values.first.forEach((first, index) => {
      const second = comparison.values.second[index] as number;
      const key = `${of} ${first} ${second}`;
      alike.set(key, { first, second, count: (alike.get(key)?.count ?? 0) + 1 });
    });
    return [...alike].flatMap(([key, { first, second, count }]) => {
      const common = { of, key, count, rises: first > second ? 'up' : first < second ? 'down' : 'same' };
      return [
        { ...common, side: 'second', value: second },
        { ...common, side: 'first', value: first },
      ];
    });
  });
  const means = meansOf(chart);
  const { order, labels } = legend;
  return drawn(chart, legend, `left ${labels[order[0]]}, right ${labels[order[1]]}`, {
    padding: 0.2,
    x: { axis: null, domain: [...order], padding: 0.5 },
    color: {
      domain: ['up', 'same', 'down', 'first', 'second'],
      range: [colours.first, inkSoft, colours.second, colours.first, colours.second],
    },
    marks: [
      Plot.line(lines, {
        fx: 'of',
        x: 'side',
        y: 'value',
        z: 'key',
        stroke: 'rises',
        strokeOpacity: 0.55,
        strokeWidth: ({ count }: { count: number }) => 0.8 + 1.1 * count,
        strokeLinecap: 'round',
      }),
      Plot.dot(means, { fx: 'of', x: 'side', y: 'mean', fill: 'side', r: 5, stroke: surface, strokeWidth: 1.5 }),
    ],
  });
}

/** The diameter of a dot [pixels]. */
const dotDiameter = 7;
/** Positions across a comparison, from −0.5 to 0.5: means in the middle, dots outside. */
const strip = { mean: 0.07, dots: 0.29, width: 0.34 } as const;

/** Draws every participant (or group) of two cohorts as a dot next to means and 95 % confidence intervals. */
export function stripChart(chart: Chart, legend: ChartLegend): SVGSVGElement {
  const { comparisons, nameOf } = chart;
  const [low, high] = axisDomain(chart);
  const width = widthFor(comparisons.length, 130);
  const padding = 0.1;
  const comparisonWidth = ((width - shared.marginLeft - 20) * (1 - padding)) / (comparisons.length + padding);
  const diameter = ((high - low) * dotDiameter) / (height - shared.marginTop - shared.marginBottom);
  const outwards = { first: 1, second: 1, [legend.order[0]]: -1 };
  const dots = comparisons.flatMap((comparison) =>
    legend.order.flatMap((side) => {
      const values = comparison.values[side];
      const beside = swarmOffsets(
        values.map((value) => value / diameter),
        (strip.width * comparisonWidth) / dotDiameter,
      );
      return values.map((value, index) => ({
        of: nameOf(comparison),
        side,
        value,
        x: outwards[side] * strip.dots + ((beside[index] as number) * dotDiameter) / comparisonWidth,
      }));
    }),
  );
  const means = meansOf(chart).map((one) => ({ ...one, x: outwards[one.side] * strip.mean }));
  return drawn(chart, legend, `each dot a ${chart.each}, mean and 95 % confidence interval`, {
    padding,
    width,
    x: { axis: null, domain: [-0.5, 0.5] },
    marks: [
      Plot.dot(dots, { fx: 'of', x: 'x', y: 'value', fill: 'side', fillOpacity: 0.65, r: dotDiameter / 2 }),
      Plot.ruleX(means, { fx: 'of', x: 'x', y1: 'from', y2: 'to', stroke: 'side', strokeWidth: 2.5 }),
      Plot.dot(means, { fx: 'of', x: 'x', y: 'mean', fill: 'side', r: 5, stroke: surface, strokeWidth: 1.5 }),
    ],
  });
}

/** Returns the picture as an SVG file in the light colours: other programs do not know the page's tokens. */
const svgText = (svg: SVGSVGElement): string =>
  new XMLSerializer().serializeToString(svg).replaceAll(/var\(--[\w-]+, ([^()]+)\)/g, '$1');

/** Resolves with the picture at twice its size as PNG, for slides and papers that do not accept SVG. */
async function pngOf(svg: SVGSVGElement): Promise<Blob> {
  const address = URL.createObjectURL(new Blob([svgText(svg)], { type: 'image/svg+xml' }));
  try {
    const image = new Image();
    image.src = address;
    await image.decode();
    const canvas = new OffscreenCanvas(2 * image.width, 2 * image.height);
    const context = canvas.getContext('2d');
    if (!context) throw new Error('results/charts: this browser offers no 2D canvas');
    context.drawImage(image, 0, 0, canvas.width, canvas.height);
    return await canvas.convertToBlob();
  } finally {
    URL.revokeObjectURL(address);
  }
}

interface FigureProps {
  readonly svg: SVGSVGElement;
  readonly caption: string;
  /** The name of its files, without extension. */
  readonly file: string;
}

/** A picture with its caption and buttons that save it as SVG and PNG. */
export function Figure({ svg, caption, file }: FigureProps) {
  svg.setAttribute('role', 'img');
  svg.setAttribute('aria-label', caption);
  const saveSvg = () => offerDownload(`${file}.svg`, 'image/svg+xml', svgText(svg));
  const savePng = async () => offerDownload(`${file}.png`, 'image/png', await pngOf(svg));
  return (
    <figure>
      <div ref={(picture) => picture?.replaceChildren(svg)} class="picture" />
      <div class="bar">
        <figcaption class="soft">{caption}</figcaption>
        <Button label="SVG" class="small" onClick={saveSvg} />
        <Button label="PNG" class="small" onClick={savePng} />
      </div>
    </figure>
  );
}
