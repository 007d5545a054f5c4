import type { WebGLRenderer } from 'three';
import { firstLine, type HapticPulse, type PaperMethod, reasonOf } from 'threepoint/core';
import {
  type BoundarySize,
  type DeviceCommands,
  defaultSavings,
  describeXrSupport,
  drawSession,
  endSession,
  FrameRateControl,
  gripDevice,
  isSessionOffered,
  playPulses,
  readBoundary,
  requestPassthroughSession,
  requestVrSession,
  type Savings,
  type XrFault,
} from 'threepoint/internal';
import type { Avatar, BodyTracker } from 'threepoint/three';
import type { TrackedSession } from 'threepoint/webxr';
import { type Emulator, installEmulator } from '../../emulator/emulator';
import { type Quality, reduceEmulatedResolution } from '../../scene/renderer';
import type { PageContext } from './page-context';
import type { Preferences } from './preferences';

/** The rate [Hz] at which a window, and the emulator in it, draws. */
const windowRateHz = 60;
/** The assumed rate of a headset that reports none [Hz]. */
const usualRateHz = 72;
/** The angle of a snap turn [rad]. */
const snapAngle = Math.PI / 6;

/** The kind of session that entering would start, and the reason if it is not a real headset; null: none. */
interface Readiness {
  readonly real: boolean;
  readonly sentence: string | null;
  /** A session may show the room around the user. */
  readonly passthrough: boolean;
}

/** What the page does when something happens to the session or to the emulator. */
export interface HeadsetListener {
  entered(): void;
  left(): void;
  /** Entering failed; the notice is already there. */
  refused(): void;
  /** The session went behind a menu of the device, or came back. */
  visibilityChanged(): void;
  /** The device draws at another rate from now on. */
  rateChanged(): void;
  /** The emulator is there now, or could not be loaded. */
  emulatorChanged(): void;
}

interface Session {
  readonly xr: XRSession;
  /** The session shows the room around the user. */
  readonly passthrough: boolean;
  /** What the device's boundary leaves [m]; null: the device does not report it. */
  readonly room: BoundarySize | null;
  readonly rates: FrameRateControl;
}

type HeldDevices = NonNullable<Preferences['gripDevices']>;

/** Returns whether a hand holds this controller. A pinch that aims by the eyes has a grip, too, while it lasts. */
const isHeld = ({ hand, gripSpace, handedness, targetRayMode }: XRInputSource): boolean =>
  Boolean(gripSpace) && !hand && handedness !== 'none' && targetRayMode === 'tracked-pointer';

/** Returns the controllers that hands hold, by the names of their offsets. */
const heldDevices = (sources: Iterable<XRInputSource>): HeldDevices =>
  Object.fromEntries([...sources].filter(isHeld).map(({ handedness, profiles }) => [handedness, gripDevice(profiles)]));

/** The headset that is worn, real or emulated, and the session in it. */
export class Headset {
  readonly #context: PageContext;
  readonly #tracker: BodyTracker<Avatar | null, PaperMethod>;
  readonly #renderer: WebGLRenderer;
  readonly #quality: Quality;
  #listener: HeadsetListener | null = null;
  #emulator: Emulator | null = null;
  #entering = false;
  #installing: Promise<void> | null = null;
  #session: Session | null = null;
  #fault: XrFault | null = null;
  /** There is a device: the emulator is not needed. */
  #real = false;
  #passthroughOffered = false;

  constructor(
    context: PageContext,
    tracker: BodyTracker<Avatar | null, PaperMethod>,
    renderer: WebGLRenderer,
    quality: Quality,
  ) {
    this.#context = context;
    this.#tracker = tracker;
    this.#renderer = renderer;
    this.#quality = quality;
  }

  listen(listener: HeadsetListener): void {
    this.#listener = listener;
  }

  get worn(): boolean {
    return this.#session !== null;
  }

  /** Why no real headset can be worn here; null: one can, or the emulated one was asked for. */
  get fault(): XrFault | null {
    return this.#fault;
  }

  /** The room that the boundary of the headset leaves; null: the device does not report it, or is not worn. */
  get room(): BoundarySize | null {
    return this.#session?.room ?? null;
  }

  get emulator(): Emulator | null {
    return this.#emulator;
  }

  get visibility(): XRVisibilityState | 'none' {
    return this.#session?.xr.visibilityState ?? 'none';
  }

  /** The controllers in the user's hands, by the names of their offsets; null: no headset is worn. */
  get heldDevices(): HeldDevices | null {
    return this.#session && heldDevices(this.#session.xr.inputSources);
  }

  get input(): TrackedSession['inputs']['input'] | null {
    return this.tracking?.inputs.input ?? null;
  }

  /** The session that shows the room around the user; null: the worn headset shows another world, or none is worn. */
  get passthrough(): XRSession | null {
    return this.#session?.passthrough ? this.#session.xr : null;
  }

  get passthroughOffered(): boolean {
    return this.#passthroughOffered;
  }

  /** The tracking of the session; null: no headset is worn, or its first frame has not been read. */
  get tracking(): TrackedSession | null {
    return this.#session && this.#tracker.tracking;
  }

  /** The frame rate of the device [Hz]; null: it reports none, or there is no device. */
  get rateHz(): number | null {
    return this.#session?.xr.frameRate ?? (this.#emulator ? windowRateHz : null);
  }

  /** The rates that the headset offers [Hz], ascending; empty: it offers no choice, or none is worn. */
  get ratesHz(): readonly number[] {
    return this.#session?.rates.rates ?? [];
  }

  /** The reductions of picture quality that keep frames in time. */
  get savings(): Savings {
    return this.#session?.rates.savings ?? defaultSavings;
  }

  /** Counts a frame at this time [s] whose work took this long [s]; lets the headset draw at the rate that is held. */
  observeFrame(time: number, workSeconds: number): void {
    this.#session?.rates.observe(time, workSeconds);
  }

  /** The rate against which frame times are measured [Hz]. */
  get pictureRateHz(): number {
    return this.#session && !this.#emulator ? (this.#session.xr.frameRate ?? usualRateHz) : windowRateHz;
  }

  /** Why the device's own body is not there; null: it is, or no headset is worn. */
  get bodyComplaint(): string | null {
    if (!this.tracking) return null;
    const { bodyReader } = this.tracking;
    return bodyReader ? bodyReader.problem : 'the headset’s body tracking is off';
  }

  /** Asks the browser what there is; the emulator is loaded where it is wanted at once. */
  async prepare(): Promise<Readiness> {
    const { switches, settings } = this.#context;
    const support = await describeXrSupport();
    this.#real = support.kind === 'device' && !switches.emulate;
    this.#fault = support.kind === 'device' || switches.emulate ? null : support.fault;
    if (switches.emulate || !settings.actor) await this.ensureEmulator();
    // An emulator that takes the place of a missing headset has no camera: only who asks for it gets this from it.
    if (switches.emulate) this.#passthroughOffered = await isSessionOffered('immersive-ar');
    else this.#passthroughOffered = support.kind === 'device' && support.passthrough;
    return {
      real: this.#real,
      sentence: this.#fault ? support.sentence : null,
      passthrough: this.#passthroughOffered,
    };
  }

  /** The emulator where there is no headset, loaded when it is first needed; null and a notice where it fails. */
  async ensureEmulator(): Promise<Emulator | null> {
    if (this.#real || this.#emulator) return this.#emulator;
    this.#installing ??= this.#install();
    await this.#installing;
    return this.#emulator;
  }

  async #install(): Promise<void> {
    try {
      this.#emulator = await installEmulator();
    } catch (error) {
      this.#showError(`The emulated headset could not be loaded: ${firstLine(reasonOf(error))}`);
    }
    this.#installing = null;
    this.#listener?.emulatorChanged();
  }

  /** Lets the actor move the body, or the person who wears the headset: without a real one the emulated one. */
  setActor(on: boolean): void {
    this.#context.writer.change({ actor: on });
    this.#tracker.body.discontinuity();
    if (!on) void this.ensureEmulator().then((emulator) => emulator?.release());
  }

  /**
   * Enters a session; `passthrough`: one that shows the room around the user. Never rejects: what goes wrong becomes a
   * notice. Nothing happens in a session or on the way into one.
   */
  async enter(passthrough = false): Promise<void> {
    if (this.#entering || this.#session) return;
    this.#entering = true;
    await this.#enter(passthrough);
    this.#entering = false;
  }

  async #enter(passthrough: boolean): Promise<void> {
    try {
      if (!this.#real) {
        const emulator = await this.ensureEmulator();
        if (!emulator) return;
        await emulator.loadControls();
      }
      await this.#begin(passthrough);
    } catch (error) {
      this.#showError(
        `${passthrough ? 'Passthrough' : 'VR'} could not be entered: ${firstLine(reasonOf(error))}. You stay in the desktop view.`,
      );
      this.#listener?.refused();
      return;
    }
    this.#context.notices.withdraw('session');
    this.#listener?.entered();
  }

  exit(): void {
    if (this.#session) void endSession(this.#session.xr);
  }

  recentre(): void {
    this.tracking?.recentre();
  }

  /** What the devices ask of the page besides pointing; null: no headset is worn. */
  get commands(): DeviceCommands | null {
    return this.tracking?.inputs.pointing?.commands ?? null;
  }

  /** Turns the user where a stick, a thumb or the menu asked for it; returns whether one did. */
  turnIfAsked(): boolean {
    const asked = this.commands?.takeTurn() ?? 0;
    if (asked !== 0) this.tracking?.turn(asked * snapAngle);
    return asked !== 0;
  }

  /** How much higher the user stands than the device reports [m]. */
  get raised(): number {
    return this.tracking?.heightOffset ?? 0;
  }

  /** Overrides the user's height for this session: this much higher than the device reports [m]. */
  raise(height: number): void {
    this.tracking?.setHeightOffset(height);
  }

  buzz(pulses: readonly HapticPulse[]): void {
    if (this.#session) playPulses(this.#session.xr, pulses);
  }

  async #begin(passthrough: boolean): Promise<void> {
    const { deviceBody } = this.#context.settings;
    this.#tracker.deviceBody = deviceBody;
    const xr = await (passthrough ? requestPassthroughSession(deviceBody) : requestVrSession(deviceBody));
    const room = await drawSession(xr, this.#renderer.xr, () => {
      if (this.#emulator) reduceEmulatedResolution(this.#renderer, this.#quality);
      return readBoundary(xr);
    });
    this.#follow(xr, room, passthrough);
  }

  /** Remembers which controllers are held: the panel corrects their grip, also after the session. */
  #rememberGrip(): void {
    const { store, changes } = this.#context;
    store.remember({ gripDevices: { ...store.preferences.gripDevices, ...this.heldDevices } });
    changes.emit();
  }

  /** Follows the session until it ends. */
  #follow(xr: XRSession, room: BoundarySize | null, passthrough: boolean): void {
    // The emulator's rates are names alone: it draws when its window does.
    const rates = new FrameRateControl(this.#emulator ? {} : xr);
    this.#session = { xr, passthrough, room, rates };
    this.#emulator?.endOnEscape(xr);
    xr.addEventListener('end', () => {
      this.#session = null;
      this.#listener?.left();
    });
    xr.addEventListener('visibilitychange', () => {
      rates.restart();
      this.#listener?.visibilityChanged();
    });
    xr.addEventListener('frameratechange', () => this.#listener?.rateChanged());
    xr.addEventListener('inputsourceschange', ({ added, removed }) => {
      if ([...added, ...removed].some(isHeld)) this.#rememberGrip();
    });
    this.#rememberGrip();
    if (!this.#context.settings.actor) this.#emulator?.release();
  }

  #showError(sentence: string): void {
    this.#context.notices.show('error', sentence, 'session');
  }
}
