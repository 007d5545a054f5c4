import { type BuiltInBody, type EstimatorName, TrackingDegradation } from 'threepoint/core';
import { describe, expect, test } from 'vitest';
import type { Settings } from '../../../../src/page/shell/session/settings';
import { embody } from '../../../../src/page/shell/stage/join-study';
import type { StageParts } from '../../../../src/page/shell/stage/stage-parts';
import { headFrame } from '../../frames';
import { fake } from '../fake';

/** A page without a device to draw on; `missing`: what it cannot load. */
function pageOf(missing: readonly string[] = []) {
  const settings: Partial<Settings> = {};
  const degradation = new TrackingDegradation();
  let worn: BuiltInBody = 'mannequin';
  let drawn: EstimatorName = 'ik';
  const parts = fake<StageParts>({
    writer: { change: (part: Partial<Settings>) => void Object.assign(settings, part) },
    degradation,
    avatar: {
      get builtInBody() {
        return worn;
      },
      async openBuiltIn() {
        const { builtInBody = 'mannequin' } = settings;
        if (missing.includes(builtInBody)) return false;
        worn = builtInBody;
        return true;
      },
    },
    body: {
      get estimator() {
        return drawn;
      },
      async setEstimator(name: EstimatorName) {
        drawn = missing.includes(name) ? 'ik' : name;
      },
    },
  });
  return { parts, settings, degradation, worn: () => worn, drawn: () => drawn };
}

describe('the body of a round', () => {
  test('is all that its condition says, and what it does not say stays', async () => {
    const page = pageOf();
    await embody(page.parts, { estimator: 'learned', avatar: 'stout', mirror: false, upperBodyOnly: true }, 1);
    expect(page.settings).toEqual({ mirror: false, upperBodyOnly: true, builtInBody: 'stout' });
    expect([page.worn(), page.drawn()]).toEqual(['stout', 'learned']);
    await embody(page.parts, { estimator: 'ik' }, 1);
    expect([page.settings.mirror, page.worn(), page.drawn()]).toEqual([false, 'stout', 'ik']);
  });

  test('is impaired for as long as a condition says so', async () => {
    const { parts, degradation } = pageOf();
    await embody(parts, { estimator: 'ik', latencyMs: 100 }, 1);
    degradation.apply(headFrame(1, 1.6));
    expect(degradation.apply(headFrame(1.05, 1.7)).head.position.y).toBe(1.6);
    await embody(parts, { estimator: 'ik' }, 1);
    degradation.apply(headFrame(1.1, 1.7));
    expect(degradation.apply(headFrame(1.15, 1.8)).head.position.y).toBe(1.8);
  });

  test.each(['paper', 'child'])('is refused where "%s" cannot be had', async (missing) => {
    const page = pageOf([missing]);
    await expect(embody(page.parts, { estimator: 'paper', avatar: 'child' }, 1)).rejects.toThrow(
      'The body of this round could not be loaded.',
    );
  });
});
