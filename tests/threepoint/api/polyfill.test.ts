import { fromAxisAngle, up } from 'threepoint/math';
import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { installBodyTracking } from '../../../src/threepoint/api/polyfill';
import { fakeHeadset } from '../xr/fake-headset';

type Fake = ReturnType<typeof fakeHeadset>;

/** A session as the browser makes it: its frames come when a test says so. */
class Session extends EventTarget {
  readonly inputSources = [];
  readonly visibilityState = 'visible';
  readonly floor: Promise<XRReferenceSpace>;
  readonly #headset: Fake;
  #callback: XRFrameRequestCallback | null = null;
  constructor(headset: Fake) {
    super();
    this.#headset = headset;
    this.floor = Promise.resolve(headset.floor);
  }
  requestReferenceSpace(): Promise<XRReferenceSpace> {
    return this.floor;
  }
  requestAnimationFrame(callback: XRFrameRequestCallback): number {
    this.#callback = callback;
    return 1;
  }
  draw(timeMs: number): void {
    this.#callback?.(timeMs, new Frame(this, this.#headset) as unknown as XRFrame);
  }
}

class Frame {
  /** The number of requests for a pose, over all frames. */
  static poseCalls = 0;
  readonly session: Session;
  readonly #headset: Fake;
  constructor(session: Session, headset: Fake) {
    this.session = session;
    this.#headset = headset;
  }
  getViewerPose(space: XRReferenceSpace) {
    return this.#headset.frame.getViewerPose(space);
  }
  getPose(space: XRSpace, base: XRSpace) {
    Frame.poseCalls += 1;
    return this.#headset.frame.getPose(space, base);
  }
}

type BodyFrame = XRFrame & {
  readonly body: ReadonlyMap<string, XRSpace>;
  fillPoses(spaces: Iterable<XRSpace>, base: XRSpace, transforms: Float32Array): boolean;
};

let headset: Fake;
let uninstall: () => void;
let timeMs = 1000;

beforeEach(() => {
  headset = fakeHeadset();
  vi.stubGlobal('XRSpace', EventTarget);
  vi.stubGlobal('XRFrame', Frame);
  vi.stubGlobal('XRSession', Session);
  vi.stubGlobal('navigator', { xr: { requestSession: async () => new Session(headset) } });
  uninstall = installBodyTracking({ estimator: 'ik' });
});

afterEach(() => {
  uninstall();
});

async function begin(): Promise<Session> {
  const session = await navigator.xr!.requestSession('immersive-vr', { optionalFeatures: ['body-tracking'] });
  const begun = session as unknown as Session;
  await begun.floor;
  return begun;
}

/** What a page sees in the session's next frame. */
function look<Result>(session: Session, see: (frame: BodyFrame) => Result): Result {
  let seen: Result | undefined;
  session.requestAnimationFrame((_, frame) => {
    seen = see(frame as BodyFrame);
  });
  timeMs += 14;
  session.draw(timeMs);
  return seen as Result;
}

const hipsIn = (frame: BodyFrame) => frame.getPose(frame.body.get('hips')!, headset.floor);
const standing = { position: { x: 5, y: 1.6, z: 0 }, orientation: fromAxisAngle(up, 0.4) };

test('joints have no pose until a session’s first frame with a head, whatever came before', async () => {
  headset.setHead(standing);
  const first = await begin();
  expect(look(first, hipsIn)?.transform.position.x).toBeCloseTo(5, 0);
  headset.setHead(null);
  expect(look(first, hipsIn)?.transform.position.x).toBeCloseTo(5, 0);
  first.dispatchEvent(new Event('end'));
  const second = await begin();
  expect(look(second, hipsIn)).toBeNull();
  headset.setHead(standing);
  expect(look(second, hipsIn)?.transform.position.x).toBeCloseTo(5, 0);
});

test('a frame asks the browser once for its floor for all joints in a space', async () => {
  headset.setHead(standing);
  const session = await begin();
  const table = headset.floor.getOffsetReferenceSpace(new XRRigidTransform({ x: 1 }, fromAxisAngle(up, 1)));
  const all = (frame: BodyFrame) => [...frame.body.values()].map((joint) => frame.getPose(joint, table)!.transform);
  look(session, all);
  Frame.poseCalls = 0;
  const [hips] = look(session, all);
  expect(Frame.poseCalls).toBe(1);
  (table as unknown as { roomFromSpace: object }).roomFromSpace = standing;
  const [moved] = look(session, all);
  expect(Frame.poseCalls).toBe(2);
  expect(moved!.position).not.toEqual(hips!.position);
});

test('all joints together are where they are singly, and no number where they are unknown', async () => {
  const session = await begin();
  const table = headset.floor.getOffsetReferenceSpace(new XRRigidTransform({ x: 1 }, fromAxisAngle(up, 1)));
  const fill = (frame: BodyFrame) => {
    const joints = [...frame.body.values()];
    const matrices = new Float32Array(16 * joints.length);
    const filled = frame.fillPoses(joints, table, matrices);
    return { filled, matrices, poses: joints.map((joint) => frame.getPose(joint, table)) };
  };
  headset.setHead(null);
  const unseen = look(session, fill);
  expect(unseen.filled).toBe(false);
  expect(unseen.matrices.every(Number.isNaN)).toBe(true);
  headset.setHead(standing);
  const { filled, matrices, poses } = look(session, fill);
  expect(filled).toBe(true);
  for (const [i, pose] of poses.entries())
    for (const [k, value] of pose!.transform.matrix.entries()) expect(matrices[16 * i + k]).toBeCloseTo(value, 6);
});

test('a program without a window, such as one of Node, is refused in a sentence', () => {
  for (const navigator of [undefined, {}]) {
    vi.stubGlobal('navigator', navigator);
    expect(() => installBodyTracking()).toThrow(
      'installBodyTracking: there is no navigator.xr here. Call it in a browser with WebXR, on a page of https: or localhost.',
    );
  }
});

test('an option that it does not know is refused', () => {
  // reason: what a page without types may pass
  expect(() => installBodyTracking({ onwarning: () => undefined } as object)).toThrow(
    '“onwarning” is not an option of installBodyTracking. Use onWarning, ',
  );
});

test('a page without a fault handler gets warnings of a missing floor and a failed network', async () => {
  const warn = vi.spyOn(console, 'warn').mockImplementation(() => undefined);
  uninstall();
  uninstall = installBodyTracking({ networks: async () => Promise.reject(new Error('learned.bin: gone')) });
  vi.spyOn(Session.prototype, 'requestReferenceSpace').mockRejectedValue(new Error('not supported'));
  await begin();
  await vi.waitFor(() => expect(warn).toHaveBeenCalledTimes(2));
  const warned = warn.mock.calls.flat().sort();
  expect(warned).toEqual([
    expect.stringMatching(/“learned”: learned\.bin: gone\./),
    expect.stringMatching(/no body: .*not supported\. Handle “onWarning”/),
  ]);
});
