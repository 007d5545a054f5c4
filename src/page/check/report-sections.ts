import { estimatedJoints } from 'threepoint/core';
import { jointLabels } from '../shell/stage/device-difference';
import { worlds } from './check-steps';
import type { HeadsetReport, WorldName } from './headset-report';
import { histogramEdgesMs, histogramOf } from './tracking-losses';

interface ReportSection {
  readonly title: string;
  readonly lines: readonly { readonly label: string; readonly value: string }[];
  /** What the figures mean, and what they do not. */
  readonly note: string;
}

const trackers = { head: 'Head', left: 'Left hand', right: 'Right hand' } as const;
/** A figure of fewer frames is not shown. */
const fewestFrames = 30;

const percent = (share: number): string => `${(100 * share).toFixed(1)} %`;
const capitalised = (label: string): string => label.charAt(0).toUpperCase() + label.slice(1);
const listed = (names: readonly string[]): string => names.join(', ') || 'none';
const framesText = (frames: number): string => `${frames} ${frames === 1 ? 'frame' : 'frames'}`;
/** Returns a figure with the number of its frames, or that they are too few. */
const counted = (figure: string, frames: number): string =>
  frames < fewestFrames ? `too few: ${framesText(frames)}` : `${figure} (${framesText(frames)})`;
const times = ({ p50Ms, p95Ms }: { readonly p50Ms: number; readonly p95Ms: number }): string =>
  `${p50Ms.toFixed(1)} ms, p95 ${p95Ms.toFixed(1)} ms`;

/** Returns the parts of the card, each figure with its unit. */
export const reportSections = (report: HeadsetReport): readonly ReportSection[] => [
  aboutDevice(report),
  noiseSection(report),
  lossSection(report),
  frameSection(report),
  latencySection(report),
  bodySection(report),
];

const latencyText = (quantiles: HeadsetReport['latency']['displayAhead']): string =>
  quantiles ? counted(times(quantiles), quantiles.frames) : 'not known: this browser reports no usable time';
const titleOf = (world: WorldName): string => worlds.find(({ name }) => name === world)?.title ?? world;
const notMeasured = (reason: string): string => `Not measured: ${reason}. Measure again.`;
const endedEarly = 'the check ended too early';
/** Returns why a part was not measured: the early end of the check, else the reason of the part. */
const reasonIn = ({ session }: HeadsetReport, reason: string): string => (session.complete ? reason : endedEarly);
/** Returns the lines; without one, the reason for it. */
const orNotMeasured = (
  lines: ReportSection['lines'],
  { label, reason }: { readonly label: string; readonly reason: string },
): ReportSection['lines'] => (lines.length > 0 ? lines : [{ label, value: notMeasured(reason) }]);

function aboutDevice({ device, session, features }: HeadsetReport): ReportSection {
  const { granted, asked, modes } = features;
  const { rateHz, rateReported, ratesHz } = session;
  const rates = ratesHz.length > 0 ? `, offers ${ratesHz.join(', ')} Hz` : ', offers no choice';
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
      { label: 'Frame rate', value: `${rateHz} Hz${rateReported ? '' : ' (assumed)'}${rates}` },
      {
        label: 'Duration',
        value: `${session.seconds.toFixed(0)} s${session.complete ? '' : ', ended early: later figures are missing'}`,
      },
    ],
    note: 'A refused feature may be one that needs the user’s room (immersive-ar).',
  };
}

function noiseSection(report: HeadsetReport): ReportSection {
  const { noise, unmeasured } = report;
  const measured = noise.flatMap(({ tracker, source, frames, positionMm, rotationDegrees, repeated }) => {
    const position = `${positionMm.frame.toFixed(3)} mm by frame, ${positionMm.slow.toFixed(3)} mm at 0.1 s; sway ${positionMm.sway.toFixed(1)} mm`;
    const rotation = `${rotationDegrees.frame.toFixed(4)}° by frame, ${rotationDegrees.slow.toFixed(4)}° at 0.1 s; sway ${rotationDegrees.sway.toFixed(2)}°`;
    const name = `${trackers[tracker]} (${source})`;
    return [
      { label: `${name}, position`, value: counted(position, frames) },
      { label: `${name}, rotation`, value: counted(rotation, frames) },
      { label: `${name}, repeated positions`, value: counted(percent(repeated), frames) },
    ];
  });
  return {
    title: 'Noise at rest',
    lines: [
      ...measured,
      ...unmeasured.map(({ tracker, frames, moved }) => {
        const reason = frames === 0 ? 'it was not seen' : `too few steady frames (${framesText(frames)})`;
        return { label: trackers[tracker], value: notMeasured(reasonIn(report, moved ? 'you moved' : reason)) };
      }),
    ],
    note: 'Standard deviation by axis, from second differences. Sway of the body is not counted, tremor is.',
  };
}

function lossSection(report: HeadsetReport): ReportSection {
  const bars = (lengthsMs: readonly number[]) =>
    histogramOf(lengthsMs)
      .flatMap((count, bar) => (count > 0 ? [`${count} ${rangeOf(bar)}`] : []))
      .join(', ');
  return {
    title: 'Lost hands',
    lines: orNotMeasured(
      report.losses.map(({ hand, source, lengthsMs, observedSeconds, openEnd }) => ({
        label: `${trackers[hand]} (${source})`,
        value:
          `Losses in ${observedSeconds.toFixed(0)} s: ${bars(lengthsMs) || 'none'}` +
          `${openEnd ? '; lost at the end' : ''}`,
      })),
      { label: 'Hands', reason: reasonIn(report, 'no hand was seen') },
    ),
    note: 'A loss lasts until the hand is seen again, so it includes the time for which it was hidden.',
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
    lines: orNotMeasured(
      frameTimes.map(({ world, estimator, drawnBy, missed, work }) => ({
        label: `${titleOf(world)}, ${estimator}${drawnBy === estimator ? '' : ` (drawn by ${drawnBy})`}`,
        value: counted(`${times(work)}; ${missed} late`, work.frames),
      })),
      { label: 'Frames', reason: endedEarly },
    ),
    note: 'How long the page’s thread works on a frame. The graphics device goes on after it: late frames include both.',
  };
}

function latencySection({ latency }: HeadsetReport): ReportSection {
  return {
    title: 'Latency',
    lines: [
      { label: 'From a frame’s start to its display', value: latencyText(latency.displayAhead) },
      { label: 'From a frame’s time stamp to its start', value: latencyText(latency.callbackDelay) },
    ],
    note:
      'The display time is the browser’s prediction, for which poses are predicted as well. It is not the time from a ' +
      'movement to its picture, which no page can measure.',
  };
}

function bodySection(report: HeadsetReport): ReportSection {
  const { frames, complaint, joints: distances } = report.bodyTracking;
  return {
    title: 'Body tracking against our body',
    lines: distances
      ? estimatedJoints.map((joint) => ({
          label: capitalised(jointLabels[joint]),
          value: counted(`${distances[joint].toFixed(1)} cm`, frames),
        }))
      : [{ label: 'Not compared', value: reasonIn(report, complaint ?? 'the device reports no body') }],
    note: distances ? 'Mean distance from the learned body. Neither is the ground truth.' : '',
  };
}
