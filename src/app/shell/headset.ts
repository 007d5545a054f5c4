import { firstLine, reasonOf } from '../../core/errors/reasons';
import { type Buttons, nothingPressed } from '../../core/games/button-presses';
import type { TrackingFrame } from '../../core/tracking/tracking-frame';
import { easeEmulatedPicture, type Quality } from '../../scene/renderer';
import type { Notices } from '../../ui/notices';
import { type Emulator, installEmulator } from '../../xr/emulator';
import { giveFramesToEvents } from '../../xr/frameless-events';
import { buzz, type Pulse } from '../../xr/haptics';
import { describeXrSupport, requestVrSession } from '../../xr/session';
import { createTracker, type Tracker } from '../../xr/tracker';
import type { Settings } from './settings';
import type { Stage } from './stage';
import type { Switches } from './switches';

/** The rate [Hz] at which a window, and the emulator in it, draws. */
const windowRateHz = 60;
/** What a headset draws at that does not say [Hz]. */
const usualRateHz = 72;
/** Seconds of tracked frames after which the headset's height says something about who wears it. */
const settleSeconds = 0.7;
/** How far one push of a stick turns [rad]. */
const snapAngle = Math.PI / 6;

/** What entering would start, and why that is not a real headset; null: it is, or was not asked for. */
export interface Readiness {
  readonly real: boolean;
  readonly sentence: string | null;
}

export interface HeadsetOptions {
  readonly renderer: Stage['renderer'];
  readonly quality: Quality;
  readonly switches: Pick<Switches, 'emulate'>;
  readonly settings: Pick<Settings, 'actor' | 'emulatorPanel'>;
  readonly notices: Pick<Notices, 'show'>;
  onEnter(): void;
  onLeave(): void;
  /** Entering failed; the notice is already there. */
  onRefused(): void;
  /** The floor lies elsewhere from one frame to the next. */
  onJump(): void;
  /** The session went behind a menu of the device, or came back. */
  onVisibility(state: XRVisibilityState): void;
  /** The emulator is there now. */
  onEmulator(): void;
}

interface Session {
  readonly xr: XRSession;
  readonly tracker: Tracker;
  /** When the first frame was tracked [s]; 'done' once the height of the headset was taken. */
  settledSince: number | 'done' | null;
}

/** The headset that is worn, real or emulated, and the session in it. */
export interface Headset {
  readonly worn: boolean;
  readonly emulator: Emulator | null;
  readonly visibility: XRVisibilityState | 'none';
  readonly input: Tracker['input'] | null;
  /** Of the device; null: it does not say, or there is none. */
  readonly rateHz: number | null;
  /** What frame times are measured against [Hz]. */
  readonly pictureRateHz: number;
  /** Asks the browser what there is; the emulator is loaded where it is wanted at once. */
  prepare(): Promise<Readiness>;
  /** Never rejects: what goes wrong becomes a notice. */
  enter(): Promise<void>;
  exit(): void;
  /** The emulator where there is no headset, loaded when it is first needed; null and a notice where it fails. */
  ensureEmulator(): Promise<Emulator | null>;
  /** Head, hands and buttons as the device has them; null: the head is not seen. */
  read(deviceFrame: XRFrame | undefined, time: number): TrackingFrame | null;
  readonly buttons: Buttons;
  /** The height of the eyes [m], once in a session, as soon as the headset has been worn calmly for a moment; else null. */
  settledHeight(frame: TrackingFrame): number | null;
  recentre(): void;
  /** Turns whoever pushed a stick; whether somebody did. */
  turnByStick(): boolean;
  buzz(pulses: readonly Pulse[]): void;
}

export function createHeadset(options: HeadsetOptions): Headset {
  const { renderer, quality, switches, settings, notices } = options;
  let emulator: Emulator | null = null;
  let session: Session | null = null;
  let real = false;

  async function ensureEmulator(): Promise<Emulator | null> {
    if (real || emulator) return emulator;
    try {
      emulator = await installEmulator();
    } catch (error) {
      notices.show('error', `The emulated headset could not be loaded: ${firstLine(reasonOf(error))}`);
    }
    options.onEmulator();
    return emulator;
  }

  async function begin(): Promise<void> {
    const xr = await requestVrSession();
    giveFramesToEvents(xr);
    await renderer.xr.setSession(xr);
    const space = renderer.xr.getReferenceSpace();
    if (!space) throw new Error('the headset offers no floor to stand on (local-floor)');
    if (emulator) easeEmulatedPicture(renderer, quality);
    const tracker = createTracker(xr, space, (moved) => renderer.xr.setReferenceSpace(moved));
    session = { xr, tracker, settledSince: null };
    xr.addEventListener('end', () => {
      session = null;
      options.onLeave();
    });
    xr.addEventListener('visibilitychange', () => options.onVisibility(xr.visibilityState));
    space.addEventListener('reset', options.onJump);
    if (!settings.actor) emulator?.release();
  }

  return {
    get worn() {
      return session !== null;
    },
    get emulator() {
      return emulator;
    },
    get visibility() {
      return session?.xr.visibilityState ?? 'none';
    },
    get input() {
      return session?.tracker.input ?? null;
    },
    get rateHz() {
      return session?.xr.frameRate ?? (emulator ? windowRateHz : null);
    },
    get pictureRateHz() {
      return session && !emulator ? (session.xr.frameRate ?? usualRateHz) : windowRateHz;
    },
    async prepare() {
      const support = await describeXrSupport();
      real = support.kind === 'device' && !switches.emulate;
      if (switches.emulate || !settings.actor) await ensureEmulator();
      return { real, sentence: real || switches.emulate ? null : support.sentence };
    },
    async enter() {
      try {
        if (!real) {
          const there = await ensureEmulator();
          if (!there) return;
          await there.setPanelVisible(settings.emulatorPanel);
        }
        await begin();
      } catch (error) {
        notices.show('error', `VR could not be entered: ${firstLine(reasonOf(error))}. The desktop view goes on.`);
        options.onRefused();
        return;
      }
      options.onEnter();
    },
    exit: () => void session?.xr.end(),
    ensureEmulator,
    read: (deviceFrame, time) => (session && deviceFrame ? session.tracker.read(deviceFrame, time) : null),
    get buttons() {
      return session?.tracker.buttons ?? nothingPressed;
    },
    settledHeight({ time, head }) {
      if (!session || session.settledSince === 'done') return null;
      session.settledSince ??= time;
      if (time - session.settledSince < settleSeconds) return null;
      session.settledSince = 'done';
      return head.position.y;
    },
    recentre: () => session?.tracker.recentre(),
    turnByStick() {
      const way = session?.tracker.takeTurn() ?? 0;
      if (way !== 0) session?.tracker.turn(way * snapAngle);
      return way !== 0;
    },
    buzz(pulses) {
      if (session) buzz(session.xr, pulses);
    },
  };
}
