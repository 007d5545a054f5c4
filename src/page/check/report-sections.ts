import { estimatedJoints } from 'threepoint/core';
import { jointLabels } from '../shell/stage/device-difference';
import type { HeadsetReport } from './headset-report';
import { histogramEdgesMs, histogramOf } from './tracking-losses';

interface ReportSection {
  readonly title: string;
  readonly lines: readonly { readonly label: string; readonly value: string }[];
  /** What the figures mean, and what they do not. */
  readonly note: string;
}

const trackers = { head: 'Head', left: 'Left hand', right: 'Right hand' } as const;
const worlds = { mirror: 'Mirror', archery: 'Archery', ball: 'Ball court' } as const;

const percent = (share: number): string => `${(100 * share).toFixed(1)} %`;
const capitalised = (label: string): string => label.charAt(0).toUpperCase() + label.slice(1);
const listed = (names: readonly string[]): string => names.join(', ') || 'none';
const times = (quantiles: { readonly p50Ms: number; readonly p95Ms: number } | null): string =>
  quantiles ? `${quantiles.p50Ms.toFixed(1)} ms, p95 ${quantiles.p95Ms.toFixed(1)} ms` : 'not reported by this browser';

/** Returns the parts of the card, each figure with its unit. */
export const reportSections = (report: HeadsetReport): readonly ReportSection[] => [
  aboutDevice(report),
  noiseSection(report),
  lossSection(report),
  frameSection(report),
  latencySection(report),
  bodySection(report),
];

function aboutDevice({ device, session, features }: HeadsetReport): ReportSection {
  const { granted, asked, modes } = features;
  const rates = session.ratesHz.length > 0 ? `, offers ${session.ratesHz.join(', ')} Hz` : ', offers no choice';
  return {
    title: device.emulated ? 'Device (emulated)' : 'Device',
    lines: [
      { label: 'Browser', value: device.userAgent },
      { label: 'Input profiles', value: listed(device.profiles) },
      { label: 'Session modes', value: listed(modes) },
      { label: 'Features granted', value: granted ? listed(granted) : 'not reported by this browser' },
      {
        label: 'Features refused',
        value: granted ? listed(asked.filter((name) => !granted.includes(name))) : 'unknown',
      },
      { label: 'Frame rate', value: session.rateHz ? `${session.rateHz} Hz${rates}` : `not reported${rates}` },
      {
        label: 'Duration',
        value: `${session.seconds.toFixed(0)} s${session.complete ? '' : ', ended early: later figures are missing'}`,
      },
    ],
    note: 'A refused feature may be one that needs the user’s room (immersive-ar).',
  };
}

function noiseSection({ noise }: HeadsetReport): ReportSection {
  return {
    title: 'Noise at rest',
    lines: noise.flatMap(({ tracker, source, positionMm, rotationDegrees, rateHz, repeated }) => [
      {
        label: `${trackers[tracker]} (${source}), position`,
        value: `${positionMm.frame.toFixed(3)} mm by frame, ${positionMm.slow.toFixed(3)} mm at 0.1 s; sway ${positionMm.sway.toFixed(1)} mm`,
      },
      {
        label: `${trackers[tracker]} (${source}), rotation`,
        value: `${rotationDegrees.frame.toFixed(4)}° by frame, ${rotationDegrees.slow.toFixed(4)}° at 0.1 s; sway ${rotationDegrees.sway.toFixed(2)}°`,
      },
      { label: `${trackers[tracker]}, samples`, value: `${rateHz.toFixed(1)} Hz, ${percent(repeated)} repeated` },
    ]),
    note: 'Standard deviation by axis, from second differences. Sway is the person and not counted; tremor is counted.',
  };
}

function lossSection({ losses }: HeadsetReport): ReportSection {
  const bars = (lengthsMs: readonly number[]) =>
    histogramOf(lengthsMs)
      .flatMap((count, bar) => (count > 0 ? [`${count} ${rangeOf(bar)}`] : []))
      .join(', ');
  return {
    title: 'Lost hands',
    lines: losses.map(({ hand, source, lengthsMs, observedSeconds, openEnd }) => ({
      label: `${trackers[hand]} (${source})`,
      value:
        `Losses in ${observedSeconds.toFixed(0)} s: ${bars(lengthsMs) || 'none'}` +
        `${openEnd ? '; lost at the end' : ''}`,
    })),
    note: 'A loss lasts until the hand is seen again, so it includes the time that the person hid it.',
  };
}

/** Returns the range of a bar of the histogram in words. */
function rangeOf(bar: number): string {
  const [from, to] = [histogramEdgesMs[bar - 1], histogramEdgesMs[bar]];
  if (from === undefined) return `up to ${to} ms`;
  return to === undefined ? `over ${from} ms` : `of ${from} to ${to} ms`;
}

function frameSection({ frameTimes }: HeadsetReport): ReportSection {
  return {
    title: 'Frames by world and estimator',
    lines: frameTimes.map(({ world, estimator, drawnBy, rateHz, frames, missed, work }) => ({
      label: `${worlds[world]}, ${estimator}${drawnBy === estimator ? '' : ` (drawn by ${drawnBy})`}`,
      value: `${times(work)}; ${missed} of ${frames} late at ${rateHz.toFixed(0)} Hz`,
    })),
    note: 'Work of the page’s thread in a frame. The graphics device works on after it: late frames count both.',
  };
}

function latencySection({ latency }: HeadsetReport): ReportSection {
  return {
    title: 'Latency',
    lines: [
      { label: 'From a frame’s start to its display', value: times(latency.displayAhead) },
      { label: 'From a frame’s time stamp to its start', value: times(latency.callbackDelay) },
    ],
    note:
      'The display time is the browser’s prediction, for which poses are predicted as well. It is not the time from a ' +
      'movement to its picture, which no page can measure.',
  };
}

function bodySection({ bodyTracking }: HeadsetReport): ReportSection {
  const { frames, complaint, joints: distances } = bodyTracking;
  return {
    title: 'Body tracking against our body',
    lines: distances
      ? estimatedJoints.map((joint) => ({
          label: capitalised(jointLabels[joint]),
          value: `${distances[joint].toFixed(1)} cm`,
        }))
      : [{ label: 'Not compared', value: complaint ?? 'the device reports no body' }],
    note: distances ? `Mean distance over ${frames} frames of the learned body. Neither of the two is the truth.` : '',
  };
}
