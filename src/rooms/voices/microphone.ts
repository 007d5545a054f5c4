/** What a person may read who cannot be heard. */
const refusals: Readonly<Record<string, string>> = {
  NotAllowedError:
    'The browser does not let this page use the microphone: allow it beside the address, then join again.',
  NotFoundError: 'No microphone was found.',
  OverconstrainedError: 'No microphone was found.',
  NotReadableError: 'The microphone is in use by another program, or does not answer.',
  AbortError: 'The microphone is in use by another program, or does not answer.',
};

/** Why there is no microphone, in a sentence. */
export function refusalOf(error: unknown): string {
  const name = error instanceof DOMException ? error.name : '';
  return (
    refusals[name] ?? `The microphone could not be used (${error instanceof Error ? error.message : String(error)}).`
  );
}

/**
 * The echo of the others in one's own microphone is cancelled by the browser or the device. Babble and level are theirs to smooth too.
 */
const constraints: MediaStreamConstraints = {
  audio: { echoCancellation: true, noiseSuppression: true, autoGainControl: true },
};

/** How often a microphone that was lost is asked for again while the page is seen [ms]. */
const againMs = 2000;

/** The own microphone: opened once, and taken again where the device has ended it, as headsets do when they sleep. */
export class Microphone {
  readonly #changed: () => void;
  #stream: MediaStream | null = null;
  #wanted = false;
  #asking: Promise<void> | null = null;
  #complaint: string | null = null;
  #again: ReturnType<typeof setInterval> | null = null;

  /** `changed`: another track, or none any more. */
  constructor(changed: () => void) {
    this.#changed = changed;
  }

  /** Null: there is none now. */
  get track(): MediaStreamTrack | null {
    return this.#stream?.getAudioTracks()[0] ?? null;
  }

  /** Why there is none, in a sentence; null: there is, or none is wanted. */
  get complaint(): string | null {
    return this.#complaint;
  }

  /** Never rejects: what goes wrong is the complaint. */
  async open(): Promise<void> {
    this.#wanted = true;
    document.addEventListener('visibilitychange', this.#look);
    await this.#take();
  }

  close(): void {
    this.#wanted = false;
    this.#complaint = null;
    document.removeEventListener('visibilitychange', this.#look);
    this.#stopAsking();
    this.#release();
  }

  #take(): Promise<void> {
    this.#asking ??= this.#ask().finally(() => {
      this.#asking = null;
    });
    return this.#asking;
  }

  async #ask(): Promise<void> {
    try {
      // Pages without a secure context have no devices at all.
      if (!navigator.mediaDevices) throw new Error('this page is not served over https');
      const stream = await navigator.mediaDevices.getUserMedia(constraints);
      if (!this.#wanted) {
        for (const track of stream.getTracks()) track.stop();
        return;
      }
      this.#release();
      this.#stream = stream;
      this.#complaint = null;
      this.#stopAsking();
      stream.getAudioTracks()[0]?.addEventListener('ended', this.#lose, { once: true });
    } catch (error) {
      if (!this.#wanted) return;
      this.#complaint = refusalOf(error);
      // Who refuses is not asked again every two seconds: the page's own button does that.
      if (error instanceof DOMException && error.name === 'NotAllowedError') this.#stopAsking();
    }
    this.#changed();
  }

  /** The device has ended it: it sleeps, or was pulled out. */
  readonly #lose = (): void => {
    this.#stream = null;
    this.#complaint = 'The microphone was lost: it is being looked for.';
    this.#changed();
    this.#again ??= setInterval(this.#look, againMs);
    this.#look();
  };

  readonly #look = (): void => {
    if (this.#wanted && this.track === null && document.visibilityState === 'visible' && this.#again !== null)
      void this.#take();
  };

  #stopAsking(): void {
    if (this.#again !== null) clearInterval(this.#again);
    this.#again = null;
  }

  #release(): void {
    const track = this.track;
    this.#stream = null;
    track?.removeEventListener('ended', this.#lose);
    track?.stop();
  }
}
