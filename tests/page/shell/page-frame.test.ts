import { GazeTargets } from 'threepoint/three';
import { expect, test } from 'vitest';
import type { InputParts } from '../../../src/page/shell/input/input-parts';
import { PageFrame } from '../../../src/page/shell/page-frame';
import type { Controls } from '../../../src/page/shell/panels/controls';
import type { PassthroughHost } from '../../../src/page/shell/stage/passthrough-host';
import { fake } from './fake';

/**
 * A page that draws nothing, frame by frame as its device asks for them: a window, or a session, which lets windows
 * rest.
 */
function page(draw: () => void = () => undefined): PageFrame {
  const parts = fake<InputParts>({
    settings: { mirror: false },
    headset: { visibility: 'visible', worn: true, commands: null, turnIfAsked: () => false },
    activities: { name: 'studio', current: null, show: () => undefined },
    study: { run: null },
    stage: { look: () => undefined, draw },
    tracker: { avatar: null },
    gazeTargets: new GazeTargets(),
    mocap: { aside: 0 },
  });
  return new PageFrame(parts, fake<Controls>({ point: () => undefined }), fake<PassthroughHost>({}));
}

test('a wait for the next picture waits for the device that draws it, and no longer', async () => {
  const frame = page();
  frame.render(1, null);
  const seen: number[] = [];
  const waiting = frame.nextPicture().then(() => seen.push(frame.count));
  await Promise.resolve();
  expect(seen).toEqual([]);
  frame.render(2, null);
  frame.render(3, null);
  await waiting;
  expect(seen).toHaveLength(1);
});

test('a picture that fails is waited for no longer either', async () => {
  const frame = page(() => {
    throw new Error('no graphics device');
  });
  const waiting = frame.nextPicture();
  expect(() => frame.render(1, null)).toThrow('no graphics device');
  await waiting;
});
