import { forward, type Pose, rotate, up, type Vec3, vec3 } from 'threepoint/math';

/** Makes a sound's samples at a rate [1/s]. */
export type Recipe = (rate: number) => Float32Array<ArrayBuffer>;

export type Recipes = ReadonlyMap<string, Recipe>;

/** The part of a stage that the page controls. */
export type AudibleStage = Pick<SoundStage, 'unlock' | 'open' | 'setMuted'>;

/** The master gain, from 0 to 1. */
const volume = 0.8;
/** Seconds in which the sound fades to mute and back. */
const fadeSeconds = 0.03;

function createPlayer(context: AudioContext, recipes: Recipes) {
  const master = context.createGain();
  const limiter = context.createDynamicsCompressor();
  master.connect(limiter).connect(context.destination);
  const buffers = new Map<string, AudioBuffer>();

  /** Rendered once, at the context's own rate. */
  function buffer(name: string): AudioBuffer {
    const known = buffers.get(name);
    if (known) return known;
    const recipe = recipes.get(name);
    if (!recipe) throw new Error(`sound-stage: there is no sound ${name}`);
    const samples = recipe(context.sampleRate);
    const made = context.createBuffer(1, samples.length, context.sampleRate);
    made.copyToChannel(samples, 0);
    buffers.set(name, made);
    return made;
  }

  /** Renders everything, one sound at a time with the page's own work between, so that no frame of the match has to. */
  async function warm(): Promise<void> {
    for (const name of recipes.keys()) {
      if (buffers.has(name)) continue;
      buffer(name);
      await new Promise((resolve) => setTimeout(resolve));
    }
  }

  function start(name: string, at: Vec3, delay: number): { source: AudioBufferSourceNode; panner: PannerNode } {
    const source = context.createBufferSource();
    source.buffer = buffer(name);
    const panner = context.createPanner();
    panner.panningModel = 'HRTF';
    panner.distanceModel = 'inverse';
    panner.refDistance = 2;
    panner.rolloffFactor = 0.7;
    panner.positionX.value = at.x;
    panner.positionY.value = at.y;
    panner.positionZ.value = at.z;
    source.connect(panner).connect(master);
    source.addEventListener('ended', () => panner.disconnect());
    source.start(context.currentTime + delay);
    return { source, panner };
  }

  /** Starts a sound at a point of the floor frame, `delay` [s] from now. */
  function play(name: string, at: Vec3, delay = 0): void {
    start(name, at, delay);
  }

  /** Starts a sound that moves for this time [s]. `placeAfter`: its position after a number of seconds, floor frame. */
  function playAlong(name: string, seconds: number, placeAfter: (after: number) => Vec3): AudioBufferSourceNode {
    const { source, panner } = start(name, placeAfter(0), 0);
    for (let step = 1; step <= 4; step++) {
      const after = (step / 4) * seconds;
      const at = placeAfter(after);
      panner.positionX.linearRampToValueAtTime(at.x, context.currentTime + after);
      panner.positionY.linearRampToValueAtTime(at.y, context.currentTime + after);
      panner.positionZ.linearRampToValueAtTime(at.z, context.currentTime + after);
    }
    return source;
  }
  return { context, master, warm, play, playAlong };
}

/** What plays while the audio runs. */
export type SoundPlayer = ReturnType<typeof createPlayer>;

const ahead = vec3(0, 0, 0);
const upward = vec3(0, 0, 0);

function placeListener({ listener, currentTime }: AudioContext, head: Pose<'floor'>): void {
  const { x, y, z } = head.position;
  rotate(head.orientation, forward, ahead);
  rotate(head.orientation, up, upward);
  // Some browsers only have the older methods.
  if (!listener.positionX) {
    listener.setPosition(x, y, z);
    listener.setOrientation(ahead.x, ahead.y, ahead.z, upward.x, upward.y, upward.z);
    return;
  }
  listener.positionX.setValueAtTime(x, currentTime);
  listener.positionY.setValueAtTime(y, currentTime);
  listener.positionZ.setValueAtTime(z, currentTime);
  listener.forwardX.setValueAtTime(ahead.x, currentTime);
  listener.forwardY.setValueAtTime(ahead.y, currentTime);
  listener.forwardZ.setValueAtTime(ahead.z, currentTime);
  listener.upX.setValueAtTime(upward.x, currentTime);
  listener.upY.setValueAtTime(upward.y, currentTime);
  listener.upZ.setValueAtTime(upward.z, currentTime);
}

/** Sounds from where they happen, for ears that move; floor frame. */
export function createSoundStage(recipes: Recipes, createContext: () => AudioContext = () => new AudioContext()) {
  let player: SoundPlayer | null = null;
  let muted = false;
  function createAudio(): SoundPlayer {
    const context = createContext();
    const created = createPlayer(context, recipes);
    created.master.gain.value = muted ? 0 : volume;
    // The system suspends or interrupts audio for a call or another program: it continues when that is over.
    context.addEventListener('statechange', () => {
      // reason: a context that may not resume yet does so at the user's next touch, which `unlock` reports
      if (context.state === 'suspended') void context.resume().catch(() => undefined);
    });
    return created;
  }
  async function awaken(): Promise<SoundPlayer> {
    player ??= createAudio();
    // The stage may be disposed before the audio has started.
    const awakened = player;
    if (awakened.context.state !== 'running') await awakened.context.resume();
    return awakened;
  }
  return {
    /** null while the audio rests: it would keep everything and play it at once later. */
    get player(): SoundPlayer | null {
      return player?.context.state === 'running' ? player : null;
    },
    /**
     * Starts the audio, unless it runs; a browser allows it only within a user's gesture. Rejects where there is no
     * audio.
     */
    async unlock(): Promise<void> {
      await (await awaken()).warm();
    },
    /** Returns the running audio context without the sounds of the game, for other sounds with the same listener. */
    open: async (): Promise<AudioContext> => (await awaken()).context,
    setListener(head: Pose<'floor'>): void {
      if (player) placeListener(player.context, head);
    },
    setMuted(on: boolean): void {
      muted = on;
      if (player) player.master.gain.setTargetAtTime(on ? 0 : volume, player.context.currentTime, fadeSeconds);
    },
    dispose(): void {
      void player?.context.close();
      player = null;
    },
  };
}

export type SoundStage = ReturnType<typeof createSoundStage>;
