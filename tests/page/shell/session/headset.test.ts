import type { WebGLRenderer } from 'three';
import type { Avatar, BodyTracker } from 'threepoint/three';
import { describe, expect, test, vi } from 'vitest';
import { Headset } from '../../../../src/page/shell/session/headset';
import type { PageContext } from '../../../../src/page/shell/session/page-context';
import { fake } from '../fake';

/** Emulated devices that were installed in place of the browser's own. */
let installed = 0;
vi.mock('iwer', () => ({
  metaQuest3: {},
  XRReferenceSpace: class {
    getOffsetReferenceSpace(): void {
      throw new Error('no session of this test moves its floor');
    }
  },
  XRDevice: class {
    readonly position = { set: () => undefined };
    readonly controllers = {};
    readonly hands = {};
    readonly viewSpaces = {};
    installRuntime(): void {
      installed += 1;
    }
  },
}));

/** A session that its wearer, or the device, may end at any time. */
class Session extends EventTarget {
  readonly visibilityState = 'visible';
  readonly inputSources = [];
  ended = false;
  /** Resolves the question for a boundary. */
  answerRoom: () => void = () => undefined;

  requestReferenceSpace(): Promise<XRReferenceSpace> {
    return new Promise((_, reject) => {
      this.answerRoom = () => reject(new DOMException('no boundary', 'NotSupportedError'));
    });
  }

  async end(): Promise<void> {
    if (this.ended) throw new DOMException('The session has ended already', 'InvalidStateError');
    this.ended = true;
    await Promise.resolve();
    this.dispatchEvent(new Event('end'));
  }
}

/** A page before a headset, and the notifications it received. `draw`: how the renderer takes the session. */
async function page(draw: () => Promise<void> = () => Promise.resolve()) {
  const session = new Session();
  vi.stubGlobal('window', { isSecureContext: true });
  let asked = false;
  const requestSession = async () => {
    if (asked)
      throw new DOMException('There is already an immersive session or a request for one', 'InvalidStateError');
    asked = true;
    return session;
  };
  const xr = { isSessionSupported: async () => true, requestSession };
  vi.stubGlobal('navigator', { xr });
  const happened: string[] = [];
  const told: string[] = [];
  const context = fake<PageContext>({
    switches: { emulate: false },
    settings: { actor: true, emulatorPanel: false, deviceBody: false },
    store: { preferences: {}, remember: () => undefined },
    changes: { emit: () => undefined },
    notices: { show: (_: unknown, text: string) => void told.push(text), withdraw: () => undefined },
  });
  const renderer = { xr: { setSession: draw, getReferenceSpace: () => new EventTarget() } };
  const headset = new Headset(
    context,
    fake<BodyTracker<Avatar | null>>({ tracking: null }),
    renderer as unknown as WebGLRenderer,
    'low',
  );
  headset.listen({
    entered: () => void happened.push('entered'),
    left: () => void happened.push('left'),
    refused: () => void happened.push('refused'),
    visibilityChanged: () => undefined,
    rateChanged: () => undefined,
    emulatorChanged: () => undefined,
  });
  await headset.prepare();
  return { headset, session, happened, told };
}

const soon = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));

describe('entering VR', () => {
  test('is reported once, as is leaving again', async () => {
    const { headset, session, happened, told } = await page();
    const entering = headset.enter();
    await soon();
    session.answerRoom();
    await entering;
    expect(headset.worn).toBe(true);
    headset.exit();
    headset.exit();
    await soon();
    expect(headset.worn).toBe(false);
    expect(happened).toEqual(['entered', 'left']);
    expect(told).toEqual([]);
  });

  test('happens once by a double click, or again from within', async () => {
    const { headset, session, happened, told } = await page();
    const entering = [headset.enter(), headset.enter()];
    await soon();
    session.answerRoom();
    await Promise.all(entering);
    await headset.enter();
    expect(headset.worn).toBe(true);
    expect(happened).toEqual(['entered']);
    expect(told).toEqual([]);
  });

  test('leaves no session where it ends before it has begun', async () => {
    const { headset, session, happened, told } = await page();
    const entering = headset.enter();
    await soon();
    await session.end();
    await entering;
    session.answerRoom();
    await soon();
    expect(headset.worn).toBe(false);
    expect(happened).toEqual(['refused']);
    expect(told).toEqual([expect.stringContaining('ended before it had begun')]);
  });

  test('a picture that cannot be drawn there ends the session that has begun', async () => {
    const failing = () => Promise.reject(new DOMException('no such graphics device', 'InvalidStateError'));
    const { headset, session, happened, told } = await page(failing);
    await headset.enter();
    expect(session.ended).toBe(true);
    expect(headset.worn).toBe(false);
    expect(happened).toEqual(['refused']);
    expect(told).toEqual([expect.stringContaining('no such graphics device')]);
  });
});

test('the emulated headset is installed once, however often it is asked for while it loads', async () => {
  vi.stubGlobal('window', { isSecureContext: true });
  vi.stubGlobal('navigator', { xr: { isSessionSupported: async () => false } });
  const context = fake<PageContext>({
    switches: { emulate: false },
    settings: { actor: true, emulatorPanel: false, deviceBody: false },
    notices: { show: (_: unknown, text: string) => expect(text).toBeNull(), withdraw: () => undefined },
  });
  const headset = new Headset(
    context,
    fake<BodyTracker<Avatar | null>>({ tracking: null }),
    {} as WebGLRenderer,
    'low',
  );
  await headset.prepare();
  const asked = await Promise.all([headset.ensureEmulator(), headset.ensureEmulator()]);
  expect(installed).toBe(1);
  expect(asked[0]).toBe(asked[1]);
  expect(await headset.ensureEmulator()).toBe(asked[0]);
});
