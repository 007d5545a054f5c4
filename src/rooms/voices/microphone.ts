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
export function microphoneErrorOf(error: unknown): string {
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
  #errorMessage: string | null = null;
  #retryTimer: ReturnType<typeof setInterval> | null = null;

  /** `changed`: another track, or none any more. */
  constructor(changed: () => void) {
    this.#changed = changed;
  }

  /** Null: there is none now. */
  get track(): MediaStreamTrack | null {
    return this.#stream?.getAudioTracks()[0] ?? null;
  }

  /** Why there is none, in a sentence; null: there is, or none is wanted. */
  get errorMessage(): string | null {
    return this.#errorMessage;
  }

  /** Never rejects: what goes wrong is the complaint. */
  async open(): Promise<void> {
    this.#wanted = true;
    document.addEventListener('visibilitychange', this.#retry);
    await this.#take();
  }

  close(): void {
    this.#wanted = false;
    this.#errorMessage = null;
    document.removeEventListener('visibilitychange', this.#retry);
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
      this.#errorMessage = null;
      this.#stopAsking();
      stream.getAudioTracks()[0]?.addEventListener('ended', this.#lose, { once: true });
    } catch (error) {
      if (!this.#wanted) return;
      this.#errorMessage = microphoneErrorOf(error);
      // Who refuses is not asked again every two seconds: the page's own button does that.
      if (error instanceof DOMException && error.name === 'NotAllowedError') this.#stopAsking();
    }
    this.#changed();
  }

  /** The device has ended it: it sleeps, or was pulled out. */
  readonly #lose = (): void => {
    this.#stream = null;
    this.#errorMessage = 'The microphone was lost: it is being looked for.';
    this.#changed();
    this.#retryTimer ??= setInterval(this.#retry, againMs);
    this.#retry();
  };

  readonly #retry = (): void => {
    if (this.#wanted && this.track === null && document.visibilityState === 'visible' && this.#retryTimer !== null)
      void this.#take();
  };

  #stopAsking(): void {
    if (this.#retryTimer !== null) clearInterval(this.#retryTimer);
    this.#retryTimer = null;
  }

  #release(): void {
    const track = this.track;
    this.#stream = null;
    track?.removeEventListener('ended', this.#lose);
    track?.stop();
  }
}
