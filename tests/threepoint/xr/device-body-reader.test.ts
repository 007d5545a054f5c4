import { defaultCalibration, deviceJoint } from 'threepoint/core';
import { identity, vec3 } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { XRBodyPoser } from '../../../src/threepoint/core/motion/xr-body';
import { deviceJointNames } from '../../../src/threepoint/core/tracking/device-body';
import { DeviceBodyReader } from '../../../src/threepoint/xr/device-body-reader';
import { TrackedSession } from '../../../src/threepoint/xr/tracked-session';
import { fakeHeadset, type Seen } from './fake-headset';

/** The specification's joints, as a device lists them. */
const names = new XRBodyPoser(defaultCalibration).names;
/** Returns the position of a joint, which is unique by its name's rank. */
const placeOf = (name: string) => vec3(names.indexOf(name) / 100, 1, 0.25);

/** A headset that reports a body, which the test may change before each frame. */
function headsetWithBody() {
  const headset = fakeHeadset();
  const joints = new Map<string, { at: Seen }>(
    names.map((name) => [name, { at: { position: placeOf(name), orientation: identity } }]),
  );
  const frame = headset.frame as unknown as Record<string, unknown>;
  frame.body = joints;
  return { ...headset, frame, joints };
}

/** The joints of a Pico headset with motion trackers, and the names of the same places in WebXR Body Tracking. */
const pico: Readonly<Record<string, string>> = {
  pelvis: 'hips',
  'left-hip': 'left-upper-leg',
  'right-hip': 'right-upper-leg',
  spine1: 'spine-lower',
  'left-knee': 'left-lower-leg',
  'right-knee': 'right-lower-leg',
  spine2: 'spine-middle',
  'left-ankle': 'left-foot-ankle',
  'right-ankle': 'right-foot-ankle',
  spine3: 'spine-upper',
  'left-foot': 'left-foot-ball',
  'right-foot': 'right-foot-ball',
  neck: 'neck',
  'left-collar': 'left-shoulder',
  'right-collar': 'right-shoulder',
  head: 'head',
  'left-shoulder': 'left-arm-upper',
  'right-shoulder': 'right-arm-upper',
  'left-elbow': 'left-arm-lower',
  'right-elbow': 'right-arm-lower',
  'left-wrist': 'left-hand-wrist',
  'right-wrist': 'right-hand-wrist',
  'left-hand': 'left-hand-palm',
  'right-hand': 'right-hand-palm',
};

const read = (reader: DeviceBodyReader, { frame, floor }: { frame: unknown; floor: XRReferenceSpace }) =>
  reader.read(frame as XRFrame, floor);

const missing = 'left-arm-lower';

describe('the body that a device reports', () => {
  test.each<[string, (headset: ReturnType<typeof headsetWithBody>) => void]>([
    ['of 83 joints', () => undefined],
    [
      'of 84, a root first, the odd one spelt as the specification has it',
      ({ frame, joints }) => {
        const [odd, rest] = ['left-hand-middle-metacarpal', new Map(joints)];
        const spelt = rest.get(odd);
        rest.delete(odd);
        frame.body = new Map([['root', { at: null }], ['left-hand-middle-phalanx-metacarpal', spelt], ...rest]);
      },
    ],
    ['of a browser that fills no poses at once', ({ frame }) => void delete frame.fillPoses],
  ])('%s is read joint by joint, into the same memory', (_, change) => {
    const headset = headsetWithBody();
    change(headset);
    const reader = new DeviceBodyReader();
    const body = read(reader, headset);
    expect(reader.problem).toBeNull();
    for (const [index, name] of deviceJointNames.entries())
      expect([...(body ?? []).slice(3 * index, 3 * index + 3)]).toEqual([
        expect.closeTo(placeOf(name).x, 6),
        1,
        expect.closeTo(0.25, 6),
      ]);
    expect(deviceJoint(body!, 'leftLowerArm', vec3(0, 0, 0)).x).toBeCloseTo(placeOf('left-arm-lower').x, 6);
    expect(read(reader, headset)).toBe(body);
  });

  test.each<[string, (headset: ReturnType<typeof headsetWithBody>) => void, RegExp]>([
    ['is not there', ({ frame }) => void delete frame.body, /reports no body/],
    ['is null', ({ frame }) => void Object.assign(frame, { body: null }), /reports no body/],
    ['is not seen', ({ joints }) => void joints.set(missing, { at: null }), /lost the body/],
    [
      'has no numbers',
      ({ joints }) => void joints.set(missing, { at: { position: vec3(Number.NaN, 0, 0), orientation: identity } }),
      /lost the body/,
    ],
    ['lacks a joint', ({ joints }) => void joints.delete(missing), /has no left-arm-lower/],
    [
      'cannot be asked',
      ({ frame }) => {
        frame.fillPoses = () => {
          throw new DOMException('the frame is over', 'InvalidStateError');
        };
      },
      /cannot be read: the frame is over/,
    ],
  ])('%s: it is none, with a sentence, and comes back when the device has it', (_, spoil, sentence) => {
    const headset = headsetWithBody();
    const reader = new DeviceBodyReader();
    const { getPose: ask } = headset.frame;
    const { fillPoses } = headset.frame;
    spoil(headset);
    expect(read(reader, headset)).toBeNull();
    expect(reader.problem).toMatch(sentence);
    const well = headsetWithBody();
    Object.assign(headset.frame, { body: well.joints, fillPoses, getPose: ask });
    expect(read(reader, headset)).not.toBeNull();
    expect(reader.problem).toBeNull();
  });

  test.each<[string, (headset: ReturnType<typeof headsetWithBody>) => void]>([
    [
      'under its own names',
      ({ frame, joints }) => {
        frame.body = new Map(Object.entries(pico).map(([name, standard]) => [name, joints.get(standard)]));
      },
    ],
    [
      'under the names of WebXR',
      ({ frame, joints }) => {
        frame.body = new Map(Object.values(pico).map((name) => [name, joints.get(name)]));
      },
    ],
    [
      'among the other joints of WebXR, which it does not see',
      ({ joints }) => {
        const seen = Object.values(pico);
        for (const name of joints.keys()) if (!seen.includes(name)) joints.set(name, { at: null });
      },
    ],
  ])('has Pico’s 24 joints, %s; a joint that it lacks is at its neighbour', (_, change) => {
    const headset = headsetWithBody();
    change(headset);
    const reader = new DeviceBodyReader();
    const body = read(reader, headset);
    expect(reader.problem).toBeNull();
    const placeRead = (name: string) => body?.[3 * deviceJointNames.indexOf(name)];
    for (const name of Object.values(pico)) expect(placeRead(name)).toBeCloseTo(placeOf(name).x, 6);
    expect(placeRead('left-scapula')).toBeCloseTo(placeOf('left-shoulder').x, 6);
    expect(placeRead('right-foot-transverse')).toBeCloseTo(placeOf('right-foot-ball').x, 6);
  });

  test('is in the tracked frame of a tracker that reads it, and in no other', () => {
    const headset = headsetWithBody();
    const frame = headset.frame as unknown as XRFrame;
    const reads = new TrackedSession({ ...headset, bodyReader: new DeviceBodyReader() });
    expect(reads.read(frame, 1)?.deviceBody).toHaveLength(3 * deviceJointNames.length);
    expect(new TrackedSession(headset).read(frame, 1)).not.toHaveProperty('deviceBody');
  });
});
