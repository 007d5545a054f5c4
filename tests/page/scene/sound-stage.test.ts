import { describe, expect, test } from 'vitest';
import { createSoundStage, type Recipes } from '../../../src/page/scene/sound/sound-stage';

/** A gain, a limiter or a buffer of the browser's audio: takes what it is given. */
const node = () => ({
  gain: { value: 0, setTargetAtTime: () => undefined },
  connect: (next: unknown) => next,
  copyToChannel: () => undefined,
});

/** The browser's audio context, which the system may suspend. `allowed`: it may resume. */
class Context extends EventTarget {
  state = 'suspended';
  allowed = true;
  rendered = 0;
  readonly currentTime = 0;
  readonly sampleRate = 8000;
  readonly destination = {};
  createGain = node;
  createDynamicsCompressor = node;

  createBuffer() {
    this.rendered += 1;
    return node();
  }

  async resume(): Promise<void> {
    if (!this.allowed) throw new DOMException('not now', 'InvalidStateError');
    this.become('running');
  }

  async close(): Promise<void> {
    this.become('closed');
  }

  become(state: string): void {
    if (state === this.state) return;
    this.state = state;
    this.dispatchEvent(new Event('statechange'));
  }
}

const recipes: Recipes = new Map([['click', () => new Float32Array(8)]]);

function stageWithContext() {
  const context = new Context();
  return { context, stage: createSoundStage(recipes, () => context as unknown as AudioContext) };
}

describe('audio that the system suspends', () => {
  test('continues at once where it may', async () => {
    const { context, stage } = stageWithContext();
    await stage.unlock();
    context.become('suspended');
    expect(stage.player).not.toBeNull();
  });

  test('continues after an interruption is over', async () => {
    const { context, stage } = stageWithContext();
    await stage.unlock();
    context.allowed = false;
    context.become('interrupted');
    expect(stage.player).toBeNull();
    context.allowed = true;
    context.become('suspended');
    expect(stage.player).not.toBeNull();
  });

  test('continues with the next unlock if it may not by itself, and renders no sound again', async () => {
    const { context, stage } = stageWithContext();
    await stage.unlock();
    context.allowed = false;
    context.become('suspended');
    expect(stage.player).toBeNull();
    context.allowed = true;
    await stage.unlock();
    expect(stage.player).not.toBeNull();
    expect(context.rendered).toBe(1);
  });
});

test('a stage that is disposed while its audio starts leaves that audio closed and silent', async () => {
  const { context, stage } = stageWithContext();
  const unlocked = stage.unlock();
  stage.dispose();
  await unlocked;
  expect(context.state).toBe('closed');
  expect(stage.player).toBeNull();
});
