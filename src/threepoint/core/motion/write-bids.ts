import { isTracked, type TrackedPose } from '../math/pose';
import { type Recording, recordingDuration } from '../tracking/recording';
import type { TrackingFrame } from '../tracking/tracking-frame';

/** The version of the specification that the files follow. */
export const bidsVersion = '1.11.1';

const absent = 'n/a';

/** Returns a table of BIDS: tabs, a header, `n/a` where there is no value. Throws where a row lacks a column. */
export function bidsTable(columns: readonly string[], rows: readonly Readonly<Record<string, unknown>>[]): string {
  const cell = (value: unknown, column: string): string => {
    if (value === undefined) throw new Error(`a row of a BIDS table has no "${column}"`);
    // A tab or line break within a cell would make two of it.
    return value === null || value === '' ? absent : String(value).replace(/\s+/g, ' ');
  };
  const lines = rows.map((row) => columns.map((column) => cell(row[column], column)));
  return [columns, ...lines].map((cells) => `${cells.join('\t')}\n`).join('');
}

const points = [
  { of: 'head', point: 'Head', placement: 'headset: between the eyes, −Z along the gaze' },
  {
    of: 'leftHand',
    point: 'LeftWrist',
    placement: 'left wrist: −Z towards the knuckles, +Y out of the back of the hand',
  },
  {
    of: 'rightHand',
    point: 'RightWrist',
    placement: 'right wrist: −Z towards the knuckles, +Y out of the back of the hand',
  },
] as const;

const components = [
  ...(['x', 'y', 'z'] as const).map((axis) => ({
    ...{ component: axis, type: 'POS', units: 'm' },
    of: ({ position }: TrackedPose): number => position[axis],
  })),
  ...(['x', 'y', 'z', 'w'] as const).map((axis) => ({
    ...{ component: `quat_${axis}`, type: 'ORNT', units: absent },
    of: ({ orientation }: TrackedPose): number => orientation[axis],
  })),
];

/** Every channel but the time, in the order of the columns. */
const poseChannels = points.flatMap(({ of: part, point, placement }) =>
  components.map(({ component, type, units, of }) => ({
    name: `${point}_${component}`,
    component,
    type,
    tracked_point: point,
    units,
    placement,
    reference_frame: 'floor',
    read(frame: TrackingFrame): string {
      const pose = frame[part];
      // A hand that the device only guesses was not measured.
      return pose && (part === 'head' || isTracked(pose)) ? of(pose).toFixed(6) : absent;
    },
  })),
);

const latency = {
  name: 'latency',
  component: absent,
  type: 'LATENCY',
  tracked_point: absent,
  units: 's',
  placement: absent,
  reference_frame: absent,
};

const channelColumns = ['name', 'component', 'type', 'tracked_point', 'units', 'placement', 'reference_frame'];

/** What a `*_motion.tsv` needs beside it so that its columns can be understood; the same for every recording. */
export const bidsChannels = (): string => bidsTable(channelColumns, [latency, ...poseChannels]);

/** `*_channels.json`: the frame that the channels' `reference_frame` names. */
export const bidsChannelFrames = {
  reference_frame: {
    Description: 'Frame in which positions and orientations are given.',
    Levels: {
      floor: {
        Description:
          'Origin on the floor where the headset has it (WebXR local-floor): +X right, +Y up, +Z backward, right-handed, in metres. ' +
          'Quaternions turn a point of the tracked part into this frame.',
        RotationRule: 'right-hand',
        RotationOrder: absent,
        SpatialAxes: 'RUB',
      },
    },
  },
};

/**
 * `*_motion.tsv`: a row per frame without a header, columns as `bidsChannels` names them: seconds since the first frame
 * by the recording's clock, which runs on in pauses; then head and wrists [m, unit quaternions, floor frame], `n/a`
 * where a hand was not seen or only guessed.
 */
export function bidsMotion({ frames }: Recording): string {
  const start = frames[0]!.time;
  return frames
    .map((frame) => `${(frame.time - start).toFixed(6)}\t${poseChannels.map(({ read }) => read(frame)).join('\t')}\n`)
    .join('');
}

/** `*_motion.json`: rates [Hz], counts of channels and how missing values look. */
export function bidsMotionSidecar(recording: Recording): Readonly<Record<string, unknown>> {
  const { device, rateHz, frames } = recording;
  const count = (type: string) => poseChannels.filter((channel) => channel.type === type).length;
  const duration = recordingDuration(recording);
  return {
    SamplingFrequency: rateHz,
    SamplingFrequencyEffective: duration > 0 ? (frames.length - 1) / duration : absent,
    TrackingSystemName: device,
    TrackedPointsCount: points.length,
    MotionChannelCount: poseChannels.length + 1,
    POSChannelCount: count('POS'),
    ORNTChannelCount: count('ORNT'),
    LATENCYChannelCount: 1,
    ACCELChannelCount: 0,
    ANGACCELChannelCount: 0,
    GYROChannelCount: 0,
    JNTANGChannelCount: 0,
    MAGNChannelCount: 0,
    VELChannelCount: 0,
    MiscChannelCount: 0,
    MissingValues: absent,
  };
}
