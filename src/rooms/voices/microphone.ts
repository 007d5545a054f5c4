/** The messages to a user whose microphone does not work, by the name of the error. */
const rejections: Readonly<Record<string, string>> = {
  NotAllowedError: 'The browser blocks the microphone. Allow it next to the address, then join again.',
  NotFoundError: 'No microphone was found.',
  OverconstrainedError: 'No microphone was found.',
  NotReadableError: 'The microphone does not answer. Close other programs that use it, then join again.',
  AbortError: 'The microphone does not answer. Close other programs that use it, then join again.',
};

/** Returns the message for an error of getUserMedia. */
function microphoneErrorOf(error: unknown): string {
  const name = error instanceof DOMException ? error.name : '';
  return (
    rejections[name] ?? `The microphone could not be used (${error instanceof Error ? error.message : String(error)}).`
  );
}

/** The browser or the device cancels echo, suppresses noise and controls the gain. */
const constraints: MediaStreamConstraints = {
  audio: { echoCancellation: true, noiseSuppression: true, autoGainControl: true },
};

const mutedBySystem = 'The system mutes the microphone. Switch it on in the device’s settings.';

/** Interval at which a lost microphone is requested again while the page is visible [ms]. */
const retryMs = 2000;

/** The user's microphone. It is requested again when the device ends it, as headsets do when they sleep. */
export class Microphone {
  readonly #changed: () => void;
  #stream: MediaStream | null = null;
  #wanted = false;
  #request: Promise<void> | null = null;
  #errorMessage: string | null = null;
  #retryTimer: ReturnType<typeof setInterval> | null = null;

  /** `changed` is called when the track or the error message changes. */
  constructor(changed: () => void) {
    this.#changed = changed;
  }

  /** The audio track; null: there is none now, or the system mutes it. */
  get track(): MediaStreamTrack | null {
    const open = this.#openTrack;
    return open?.muted ? null : open;
  }

  /** Why there is no track, in a sentence; null: there is one, or none is wanted. */
  get errorMessage(): string | null {
    return this.#openTrack?.muted ? mutedBySystem : this.#errorMessage;
  }

  get #openTrack(): MediaStreamTrack | null {
    return this.#stream?.getAudioTracks()[0] ?? null;
  }

  /** Requests the microphone. Never rejects: a failure becomes `errorMessage`. */
  async open(): Promise<void> {
    this.#wanted = true;
    document.addEventListener('visibilitychange', this.#retry);
    await this.#take();
  }

  close(): void {
    this.#wanted = false;
    this.#errorMessage = null;
    document.removeEventListener('visibilitychange', this.#retry);
    this.#stopRetrying();
    this.#release();
  }

  #take(): Promise<void> {
    this.#request ??= this.#ask().finally(() => {
      this.#request = null;
    });
    return this.#request;
  }

  async #ask(): Promise<void> {
    try {
      // Pages without a secure context have no mediaDevices.
      if (!navigator.mediaDevices) throw new Error('this page is not served over https');
      const stream = await navigator.mediaDevices.getUserMedia(constraints);
      if (!this.#wanted) {
        for (const track of stream.getTracks()) track.stop();
        return;
      }
      this.#release();
      this.#stream = stream;
      this.#errorMessage = null;
      this.#stopRetrying();
      const track = this.#openTrack;
      track?.addEventListener('ended', this.#lose, { once: true });
      track?.addEventListener('mute', this.#changed);
      track?.addEventListener('unmute', this.#changed);
    } catch (error) {
      if (!this.#wanted) return;
      this.#errorMessage = microphoneErrorOf(error);
      // A refused permission is not requested again; the user presses the page's button.
      if (error instanceof DOMException && error.name === 'NotAllowedError') this.#stopRetrying();
    }
    this.#changed();
  }

  /** Handles the end of the track: the device sleeps or was unplugged. */
  readonly #lose = (): void => {
    this.#stream = null;
    this.#errorMessage = 'The microphone was disconnected. Connect it again; the page is looking for it.';
    this.#changed();
    this.#retryTimer ??= setInterval(this.#retry, retryMs);
    this.#retry();
  };

  readonly #retry = (): void => {
    if (this.#wanted && this.#stream === null && document.visibilityState === 'visible' && this.#retryTimer !== null)
      void this.#take();
  };

  #stopRetrying(): void {
    if (this.#retryTimer !== null) clearInterval(this.#retryTimer);
    this.#retryTimer = null;
  }

  #release(): void {
    const track = this.#openTrack;
    this.#stream = null;
    track?.removeEventListener('ended', this.#lose);
    track?.removeEventListener('mute', this.#changed);
    track?.removeEventListener('unmute', this.#changed);
    track?.stop();
  }
}
