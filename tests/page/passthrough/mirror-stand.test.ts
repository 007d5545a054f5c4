import { fromAxisAngle, identity, type Pose, rotate, up, vec3 } from 'threepoint/math';
import { describe, expect, test, vi } from 'vitest';
import { MirrorStand, meetsMirror } from '../../../src/page/passthrough/mirror-stand';
import { fakeHeadset, type Seen } from '../../threepoint/xr/fake-headset';

type Place = Pose<'floor'>;
const at = (x: number, y: number, z: number, turned = 0): Place => ({
  position: vec3(x, y, z),
  orientation: turned === 0 ? identity : fromAxisAngle(up, turned),
});

/** A space of the room that the device tracks, and may correct. */
interface Held {
  at: Seen;
}

class FakeAnchor {
  deleted = false;
  readonly anchorSpace: Held;
  constructor(
    place: Place,
    readonly handle: string,
  ) {
    this.anchorSpace = { at: place };
  }
  delete(): void {
    this.deleted = true;
  }
  async requestPersistentHandle(): Promise<string> {
    return this.handle;
  }
}

/** A headset with a real floor at this height, and what it has of hit tests and anchors. */
function room({ floorHeight = 0.02, hitTest = true, anchors = true, handle = undefined as string | undefined } = {}) {
  vi.stubGlobal('XRRay', class {});
  const headset = fakeHeadset();
  const made: FakeAnchor[] = [];
  const deleted: string[] = [];
  const stored: Record<string, FakeAnchor> = { known: new FakeAnchor(at(2, floorHeight, 1, Math.PI / 2), 'known') };
  let hit: Seen = at(0.1, floorHeight, -2.2);
  Object.assign(headset.session, {
    requestReferenceSpace: async () => ({}),
    restorePersistentAnchor: async (name: string) => {
      const found = stored[name];
      if (!found) throw new DOMException('unknown', 'InvalidStateError');
      return found;
    },
    deletePersistentAnchor: async (name: string) => void deleted.push(name),
    ...(hitTest && { requestHitTestSource: async () => ({ cancel: () => undefined }) }),
  });
  const { frame, floor } = headset;
  Object.assign(frame, {
    getHitTestResults: () => (hit ? [{ getPose: () => frame.getPose({ at: hit } as never, floor) }] : []),
    ...(anchors && {
      createAnchor: async (transform: { place: Place }) => {
        const anchor = new FakeAnchor(transform.place, `anchor ${made.length + 1}`);
        made.push(anchor);
        return anchor;
      },
    }),
  });
  const kept = {
    handle,
    store(next: string | undefined) {
      kept.handle = next;
    },
  };
  let covered = false;
  const stand = new MirrorStand({
    session: headset.session,
    floorSpace: () => floor,
    isCovered: () => covered,
    kept,
  });
  let time = 0;
  return {
    ...headset,
    stand,
    kept,
    made,
    deleted,
    cover: () => {
      covered = true;
    },
    setHit: (next: Seen) => {
      hit = next;
    },
    /** Draws frames for this long [s]. */
    async draw(seconds: number) {
      for (const end = time + seconds; time < end; time += 1 / 72) {
        stand.update(frame, time);
        await Promise.resolve();
      }
      await new Promise((resolve) => setTimeout(resolve));
      stand.update(frame, time);
    },
  };
}

const fire = (session: XRSession, type: string, inputSource: object, frame: XRFrame) =>
  session.dispatchEvent(Object.assign(new Event(type), { inputSource, frame }));

describe('the mirror in the room of its user', () => {
  test('stands on the real floor of a hit test, faces the user, and is kept anchored', async () => {
    const { stand, draw, kept } = room({ floorHeight: 0.03 });
    await draw(1);
    const { x, y, z, turned } = stand.place;
    expect(y).toBeCloseTo(0.03, 6);
    expect(Math.hypot(x, z)).toBeGreaterThan(1.2);
    expect(Math.hypot(x, z)).toBeLessThan(2.6);
    expect(turned).toBeCloseTo(Math.atan2(-x, -z), 6);
    expect(stand.anchored).toBe(true);
    expect(kept.handle).toBe('anchor 1');
  });

  test('goes where its anchor goes when the device corrects its map', async () => {
    const { stand, draw, made } = room();
    await draw(1);
    made[0]!.anchorSpace.at = at(0.4, 0, -2, 0.2);
    await draw(0.1);
    expect(stand.place).toMatchObject({ x: 0.4, z: -2, turned: expect.closeTo(0.2, 6) });
  });

  test('stands where it stood on the last visit, by its persistent anchor', async () => {
    const { stand, draw, made } = room({ handle: 'known', floorHeight: 0.02 });
    await draw(1);
    expect(stand.place).toMatchObject({ x: 2, z: 1, turned: expect.closeTo(Math.PI / 2, 6) });
    expect(made).toEqual([]);
  });

  test('is placed as on a first visit where the device has forgotten the room', async () => {
    const { stand, draw, kept } = room({ handle: 'forgotten' });
    await draw(1);
    expect(stand.place.z).toBeLessThan(-1);
    expect(kept.handle).toBe('anchor 1');
  });

  test.each([
    ['without hit tests', { hitTest: false }],
    ['without anchors', { anchors: false }],
    ['without either', { hitTest: false, anchors: false }],
  ])('stands on the floor of the session %s', async (_, features) => {
    const { stand, draw, session } = room({ ...features, floorHeight: 0 });
    await draw(1);
    expect(stand.place.y).toBe(0);
    expect(Math.hypot(stand.place.x, stand.place.z)).toBeGreaterThan(1);
    expect(session).toBeDefined();
  });

  test('does not stand on a table: after six seconds it takes the session’s floor', async () => {
    const { stand, draw, setHit } = room();
    setHit(at(0, 0.75, -0.8));
    await draw(5);
    expect(stand.anchored).toBe(false);
    await draw(2);
    expect(stand.anchored).toBe(true);
    expect(stand.place.y).toBe(0);
  });

  test('is moved by a controller’s grip, keeps its height, and is anchored on release', async () => {
    const { stand, draw, session, frame, floor, made, deleted, kept } = room();
    await draw(1);
    const ray = { at: at(0.2, 1.1, -0.3) as Seen };
    const source = { targetRaySpace: ray, targetRayMode: 'tracked-pointer' };
    fire(session, 'squeezestart', source, frame);
    // The hand turns to the left by a quarter.
    ray.at = at(-0.3, 1.1, 0, Math.PI / 2);
    const spaces = vi.spyOn(Object.getPrototypeOf(floor), 'getOffsetReferenceSpace');
    await draw(0.2);
    // A device keeps each space that is made: a drag makes none in its frames.
    expect(spaces).not.toHaveBeenCalled();
    expect(stand.place.x).toBeLessThan(-1);
    expect(Math.abs(stand.place.z)).toBeLessThan(0.01);
    expect(stand.place.turned).toBeCloseTo(Math.PI / 2, 3);
    const { y } = stand.place;
    fire(session, 'squeezeend', source, frame);
    ray.at = at(0, 1.1, -0.3);
    await draw(0.2);
    expect(spaces).toHaveBeenCalledTimes(1);
    spaces.mockRestore();
    expect(stand.place.x).toBeLessThan(-1);
    expect(stand.place.y).toBe(y);
    expect(made[0]?.deleted).toBe(true);
    expect(kept.handle).toBe('anchor 2');
    expect(deleted).toEqual(['anchor 1']);
  });

  test('is drawn nearer by a pinch that is pulled back, and never through its user', async () => {
    const { stand, draw, session, frame } = room();
    await draw(1);
    const before = Math.hypot(stand.place.x, stand.place.z);
    const ray = { at: at(0, 1.1, -0.5) as Seen };
    const source = { targetRaySpace: ray, targetRayMode: 'tracked-pointer', hand: {} };
    fire(session, 'selectstart', source, frame);
    ray.at = at(0, 1.1, -0.4);
    await draw(0.1);
    expect(Math.hypot(stand.place.x, stand.place.z)).toBeCloseTo(before - 0.4, 3);
    ray.at = at(0, 1.1, 0.3);
    await draw(0.1);
    expect(Math.hypot(stand.place.x, stand.place.z)).toBeGreaterThanOrEqual(0.9);
  });

  test('stays where a ray misses it, a trigger is pulled, or the menu covers it', async () => {
    const { stand, draw, session, frame, cover } = room();
    await draw(1);
    const before = stand.place;
    const grabbing = async (type: string, ray: Place, more: object = {}) => {
      const space = { at: ray as Seen };
      fire(session, type, { targetRaySpace: space, targetRayMode: 'tracked-pointer', ...more }, frame);
      space.at = at(0, 1.1, 0, Math.PI);
      await draw(0.1);
    };
    await grabbing('squeezestart', at(0, 1.1, -0.3, Math.PI / 2));
    await grabbing('selectstart', at(0, 1.1, -0.3));
    cover();
    await grabbing('squeezestart', at(0, 1.1, -0.3));
    expect(stand.place).toEqual(before);
  });

  test('is let alone after the session: an anchor that arrives late is deleted', async () => {
    const { stand, draw, frame, kept } = room();
    const late = new FakeAnchor(at(0, 0, -1.5), 'late');
    let arrive: (() => void) | undefined;
    const createAnchor = () =>
      new Promise((resolve) => {
        arrive = () => resolve(late);
      });
    Object.assign(frame, { createAnchor });
    await draw(0.05);
    stand.dispose();
    arrive!();
    await draw(0.05);
    expect(late.deleted).toBe(true);
    expect(kept.handle).toBeUndefined();
  });
});

test.each([
  ['in the middle', { origin: vec3(0, 1.5, 0), direction: vec3(0, 0, -1) }, true],
  ['from behind it', { origin: vec3(0, 1.5, -4), direction: vec3(0, 0, 1) }, true],
  ['beside it', { origin: vec3(1.2, 1.5, 0), direction: vec3(0, 0, -1) }, false],
  ['above it', { origin: vec3(0, 2.6, 0), direction: vec3(0, 0, -1) }, false],
  ['away from it', { origin: vec3(0, 1.5, 0), direction: vec3(0, 0, 1) }, false],
])('a ray meets the mirror %s', (_, ray, meets) => {
  expect(meetsMirror(ray, { x: 0, y: 0, z: -2, turned: 0 })).toBe(meets);
  // Turned and moved together, nothing changes.
  const turn = fromAxisAngle(up, 1.1);
  const foot = rotate(turn, vec3(0, 0, -2));
  const turnedRay = { origin: rotate(turn, ray.origin), direction: rotate(turn, ray.direction) };
  expect(meetsMirror(turnedRay, { ...foot, turned: 1.1 })).toBe(meets);
});
