import { describe, expect, test } from 'vitest';
import { FrameRateControl, type Savings } from '../../../src/threepoint/xr/frame-rate';

/**
 * A headset and a page in it, in simulated time. `fastest`: the rate [Hz] up to which the page draws every frame in
 * time; above it every tenth frame is late.
 */
class Wearing {
  supportedFrameRates: Float32Array | null = Float32Array.of(120, 72, 90, 80);
  frameRate: number;
  fastest = 120;
  /** Draws every frame in time with these savings, at any rate. */
  helps: (savings: Savings) => boolean = () => false;
  /** The share of frames that are late where they are: one in this many. */
  lateOneIn = 10;
  refuses: number | null = null;
  time = 0;
  readonly requestedRates: number[] = [];
  readonly control: FrameRateControl;

  constructor(startRate: number, rates?: null) {
    this.frameRate = startRate;
    if (rates === null) this.supportedFrameRates = null;
    this.control = new FrameRateControl(this);
  }

  async updateTargetFrameRate(rate: number): Promise<void> {
    this.requestedRates.push(rate);
    if (rate === this.refuses) throw new DOMException('not now', 'InvalidStateError');
    this.frameRate = rate;
  }

  /** Draws for this long [s]; the work of each frame takes this long [s]. Returns the share of late frames. */
  async draw(seconds: number, workSeconds = 0.003): Promise<number> {
    const end = this.time + seconds;
    let late = 0;
    let frames = 0;
    while (this.time < end) {
      frames += 1;
      const heavy = this.frameRate > this.fastest && !this.helps(this.control.savings);
      const missed = heavy && frames % this.lateOneIn === 0;
      if (missed) late += 1;
      this.time += (missed ? 2 : 1) / this.frameRate;
      this.control.observe(this.time, workSeconds);
      await Promise.resolve();
      await Promise.resolve();
    }
    return late / frames;
  }
}

describe('the frame rate of a headset', () => {
  test.each([72, 80, 90, 120])(
    'ends at %i Hz where that is the highest that the page holds, from any start',
    async (fastest) => {
      for (const start of [72, 90, 120]) {
        const worn = new Wearing(start);
        worn.fastest = fastest;
        await worn.draw(45);
        expect(worn.frameRate).toBe(fastest);
        // Held: fewer than 1 % late frames over ten seconds.
        expect(await worn.draw(10)).toBeLessThan(0.01);
      }
    },
  );

  test('is lowered within five seconds where a tenth of the frames are late with all savings', async () => {
    const worn = new Wearing(120);
    worn.fastest = 90;
    await worn.draw(5);
    expect(worn.frameRate).toBe(90);
  });

  test('is lowered where each frame takes a second', async () => {
    const worn = new Wearing(90);
    for (let i = 0; i < 40; i++) {
      worn.time += 1;
      worn.control.observe(worn.time, 0.9);
      await Promise.resolve();
      await Promise.resolve();
    }
    expect(worn.frameRate).toBeLessThan(90);
  });

  test('stays where one frame in two hundred is late', async () => {
    const worn = new Wearing(90);
    worn.refuses = 120;
    for (let i = 0; i < 30; i++) {
      await worn.draw(199 / 90);
      worn.time += 0.03;
    }
    expect(worn.frameRate).toBe(90);
    expect(worn.requestedRates).not.toContain(80);
  });

  test('is tried again after failures, ever later: at most five times in half an hour', async () => {
    const worn = new Wearing(90);
    worn.fastest = 90;
    await worn.draw(1800);
    const attempts = worn.requestedRates.filter((rate) => rate === 120).length;
    expect(attempts).toBeGreaterThanOrEqual(2);
    expect(attempts).toBeLessThanOrEqual(6);
    worn.fastest = 120;
    await worn.draw(1000);
    expect(worn.frameRate).toBe(120);
  });

  test('is not raised where the next rate would leave a frame’s work no time', async () => {
    const worn = new Wearing(72);
    await worn.draw(60, 0.009);
    expect(worn.frameRate).toBe(72);
    await worn.draw(60, 0.003);
    expect(worn.frameRate).toBe(120);
  });

  test('is not lowered for a pause of seconds now and then', async () => {
    const worn = new Wearing(90);
    worn.refuses = 120;
    for (let i = 0; i < 40; i++) {
      await worn.draw(2);
      // The system menu is opened: no frames.
      worn.time += 5;
    }
    expect(worn.frameRate).toBe(90);
    expect(worn.requestedRates).not.toContain(80);
  });

  test('is asked for once at a time, and a refused rate leaves it where it is', async () => {
    const worn = new Wearing(90);
    worn.refuses = 120;
    await worn.draw(60);
    expect(worn.frameRate).toBe(90);
    expect(worn.control.rate).toBe(90);
  });

  test('is left alone on a device without a choice', async () => {
    for (const session of [{}, { frameRate: 72 }, { frameRate: 72, supportedFrameRates: null }]) {
      const control = new FrameRateControl(session);
      expect(control.rates).toEqual([]);
      for (let i = 0; i < 2000; i++) control.observe(i / 20, 0.04);
      expect(control.rate).toBe('frameRate' in session ? 72 : null);
    }
  });
});

describe('the savings of a picture', () => {
  const none: Savings = { foveation: 0, mirrorRateHz: null };
  const all: Savings = { foveation: 1, mirrorRateHz: 36 };

  test('are none while frames are in time', async () => {
    const worn = new Wearing(72);
    for (let i = 0; i < 60; i++) {
      await worn.draw(1);
      expect(worn.control.savings).toEqual(none);
    }
  });

  test('are taken one by one where few frames are late, the edges of the picture first', async () => {
    const worn = new Wearing(72, null);
    worn.fastest = 60;
    worn.lateOneIn = 50;
    const seen: Savings[] = [worn.control.savings];
    for (let i = 0; i < 60; i++) {
      await worn.draw(1);
      if (worn.control.savings !== seen.at(-1)) seen.push(worn.control.savings);
    }
    expect(seen).toEqual([none, { ...none, foveation: 0.5 }, { ...none, foveation: 1 }, all]);
  });

  test('are all taken within three seconds where a tenth of the frames are late', async () => {
    const worn = new Wearing(72, null);
    worn.fastest = 60;
    await worn.draw(3);
    expect(worn.control.savings).toEqual(all);
  });

  test('hold a rate that would be lowered without them', async () => {
    const worn = new Wearing(90);
    worn.fastest = 72;
    worn.helps = ({ foveation, mirrorRateHz }) => foveation === 1 && mirrorRateHz === 36;
    await worn.draw(30);
    expect(worn.requestedRates).not.toContain(72);
    expect(worn.control.savings).toEqual(all);
  });

  test('end when the load has gone, step by step', async () => {
    const worn = new Wearing(72, null);
    worn.fastest = 60;
    await worn.draw(5);
    worn.fastest = 120;
    await worn.draw(200);
    expect(worn.control.savings).toEqual(none);
  });

  test('are tried without at most eight times in half an hour of constant load', async () => {
    const worn = new Wearing(72, null);
    worn.fastest = 60;
    worn.helps = ({ foveation }) => foveation === 1;
    let changes = 0;
    let last = worn.control.savings;
    for (let i = 0; i < 1800; i++) {
      await worn.draw(1);
      if (worn.control.savings.foveation < last.foveation) changes += 1;
      last = worn.control.savings;
    }
    expect(changes).toBeGreaterThan(0);
    expect(changes).toBeLessThanOrEqual(8);
  });

  test('are those of an unknown load on a device that reports no rate', () => {
    expect(new FrameRateControl({}).savings).toEqual({ foveation: 1, mirrorRateHz: null });
  });

  test('are taken back with a rate that held without them', async () => {
    const worn = new Wearing(72);
    worn.fastest = 72;
    await worn.draw(40);
    expect(worn.requestedRates).toContain(80);
    expect(worn.frameRate).toBe(72);
    expect(worn.control.savings).toEqual(none);
  });
});
