import { clamp, damp, type Vec3 } from 'threepoint/math';

/** At this distance [m] a voice is as loud as it was spoken; with each doubling beyond, it loses 6 dB at most. */
const near = 1;
const rolloff = 0.8;
/** The loudness of level 0 and of level 1 [dB of full scale]. */
const quiet = -55;
const loud = -15;
/** Samples that a level is read from: 21 ms at 48 kHz. */
const window = 1024;
/** The window for tools [samples]: a third of a second, longer than a syllable. */
const longWindow = 16_384;
/** The half-life of a falling level [s], which keeps a mark from flickering between syllables. */
const fallHalfLife = 0.06;

/** Returns the root mean square of an analyser's current signal [1: full scale]. */
function rmsOf(analyser: AnalyserNode, samples: Float32Array<ArrayBuffer>): number {
  analyser.getFloatTimeDomainData(samples);
  let sum = 0;
  for (let i = 0; i < samples.length; i++) sum += samples[i]! * samples[i]!;
  return Math.sqrt(sum / samples.length);
}

const decibels = (rms: number): number => 20 * Math.log10(Math.max(rms, 1e-6));

/** How loud it is at a meter of long windows [dB of full scale]; −120: silent. */
const loudnessAt = (meter: AnalyserNode): number => decibels(rmsOf(meter, new Float32Array(longWindow)));

/** How loud a voice is as it is drawn, and when that was read [s of the context]. */
interface Level {
  readonly analyser: AnalyserNode;
  value: number;
  readAt: number;
}

interface RemoteVoice {
  readonly stream: MediaStream;
  /** A stream of another page stays silent unless an element plays it too (Chromium issue 933677). */
  readonly element: HTMLAudioElement;
  readonly source: MediaStreamAudioSourceNode;
  readonly level: Level;
  readonly gain: GainNode;
  readonly panner: PannerNode;
}

function pull(element: HTMLAudioElement, stream: MediaStream): void {
  element.srcObject = stream;
  // Muted, it needs no gesture; an element that was removed before it played rejects.
  void element.play().catch(() => undefined);
}

/**
 * The voices of others from where their heads are, for the ears of the stage that the context belongs to; floor frame.
 */
export class VoiceSound {
  readonly #context: AudioContext;
  readonly #voices = new Map<string, RemoteVoice>();
  readonly #bus: GainNode;
  readonly #meter: AnalyserNode;
  readonly #spokenMeter: AnalyserNode;
  readonly #samples = new Float32Array(window);
  #own: {
    readonly track: MediaStreamTrack;
    readonly source: MediaStreamAudioSourceNode;
    readonly level: Level;
  } | null = null;
  #ownOn = false;

  /** Volume and mute of the game's own sounds do not touch voices. */
  constructor(context: AudioContext) {
    this.#context = context;
    this.#bus = context.createGain();
    this.#meter = this.#analyser(longWindow);
    this.#spokenMeter = this.#analyser(longWindow);
    this.#bus.connect(this.#meter).connect(context.destination);
  }

  add(id: string, stream: MediaStream): void {
    this.remove(id);
    const context = this.#context;
    const element = new Audio();
    element.muted = true;
    pull(element, stream);
    const source = context.createMediaStreamSource(stream);
    const level = this.#level();
    const gain = context.createGain();
    const panner = context.createPanner();
    panner.panningModel = 'HRTF';
    panner.distanceModel = 'inverse';
    panner.refDistance = near;
    panner.rolloffFactor = rolloff;
    source.connect(level.analyser).connect(gain).connect(panner).connect(this.#bus);
    gain.connect(this.#spokenMeter);
    this.#voices.set(id, { stream, element, source, level, gain, panner });
  }

  remove(id: string): void {
    const heard = this.#voices.get(id);
    if (!heard) return;
    this.#voices.delete(id);
    heard.source.disconnect();
    heard.gain.disconnect();
    heard.panner.disconnect();
    heard.element.srcObject = null;
  }

  /**
   * Restarts failed audio elements. Call it often: elements fail when the device's audio output restarts, which would
   * silence their voices.
   */
  restartFailed(): void {
    for (const { element, stream } of this.#voices.values()) if (element.error) pull(element, stream);
  }

  /** Places a voice, floor frame. */
  place(id: string, { x, y, z }: Vec3): void {
    const panner = this.#voices.get(id)?.panner;
    if (!panner) return;
    panner.positionX.value = x;
    panner.positionY.value = y;
    panner.positionZ.value = z;
  }

  setSilent(id: string, silent: boolean): void {
    const heard = this.#voices.get(id);
    if (heard) heard.gain.gain.value = silent ? 0 : 1;
  }

  /** Returns the level of a voice before distance attenuates it, from 0 to 1. */
  level(id: string): number {
    const heard = this.#voices.get(id);
    return heard ? this.#read(heard.level) : 0;
  }

  /**
   * The own microphone's track, for its level alone; null: nothing of it is sent. A track's source is kept for when it
   * is sent again: Chromium lets go of none before its context is closed, however often it was disconnected (tried with
   * Chromium 156).
   */
  setOwn(track: MediaStreamTrack | null): void {
    this.#ownOn = track !== null;
    if (!track || track === this.#own?.track) return;
    this.#own?.source.disconnect();
    const source = this.#context.createMediaStreamSource(new MediaStream([track]));
    const level = this.#level();
    source.connect(level.analyser);
    this.#own = { track, source, level };
  }

  ownLevel(): number {
    return this.#own && this.#ownOn ? this.#read(this.#own.level) : 0;
  }

  /** Returns the loudness of all voices at the ears [dB of full scale], for tools; −120: silence. */
  loudness(): number {
    return loudnessAt(this.#meter);
  }

  /**
   * Returns the loudness before distance and direction change it [dB of full scale]. The difference from `loudness` is
   * their effect, whatever the level of the microphone.
   */
  spokenLoudness(): number {
    return loudnessAt(this.#spokenMeter);
  }

  dispose(): void {
    for (const id of [...this.#voices.keys()]) this.remove(id);
    this.#own?.source.disconnect();
    this.#own = null;
    this.#bus.disconnect();
    this.#meter.disconnect();
  }

  #analyser(samples = window): AnalyserNode {
    const analyser = this.#context.createAnalyser();
    analyser.fftSize = samples;
    return analyser;
  }

  #level(): Level {
    return { analyser: this.#analyser(), value: 0, readAt: this.#context.currentTime };
  }

  /** A level as it is drawn: up at once, down slowly. */
  #read(level: Level): number {
    const { currentTime } = this.#context;
    const now = clamp((decibels(rmsOf(level.analyser, this.#samples)) - quiet) / (loud - quiet), 0, 1);
    level.value = Math.max(now, damp(level.value, 0, fallHalfLife, currentTime - level.readAt));
    level.readAt = currentTime;
    return level.value;
  }
}
