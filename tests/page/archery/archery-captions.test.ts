import { fromAxisAngle, identity, up, type Vec3, vec3 } from 'threepoint/math';
import { type Arrow, archeryRules, type Landing, type Target } from 'threepoint-games/archery';
import { describe, expect, it } from 'vitest';
import { eventCaption } from '../../../src/page/archery/sound/archery-captions';
import { ArcherySounds } from '../../../src/page/archery/sound/archery-sounds';
import { directionText } from '../../../src/page/scene/direction-text';

const target = (x: number, z: number, points: number): Target => ({
  centre: vec3(x, 1.4, z),
  normal: vec3(0, 0, 1),
  radius: 0.45,
  distance: Math.hypot(x, z),
  points,
});
const targets = [target(-2, -4, 5), target(2, -6.2, 10), target(-1.2, -8.4, 15), target(1, -10.4, 20)];
const head = { position: vec3(0, 1.6, 0), orientation: identity };

const landed = (on: Landing['on'], position: Vec3, hit: number | null, points: number) => {
  const landing: Landing = { time: 1, position, direction: vec3(0, 0, -1), on, target: hit, points };
  const arrow: Arrow = {
    id: 0,
    release: { time: 0.5, position: vec3(0, 1.5, -0.8), velocity: vec3(0, 0, -30) },
    landing,
  };
  return { type: 'landed', arrow, landing } as const;
};
const say = (event: Parameters<typeof eventCaption>[0]) => eventCaption(event, { targets, seconds: 70, head });

describe('captions', () => {
  it('say which target was hit and what it gave', () => {
    expect(say(landed('target', vec3(-1.2, 1.4, -8.4), 2, 15))).toBe('Hit: target 3, 15 points');
    expect(say(landed('target', vec3(-1.2, 1.4, -8.4), 2, 0))).toBe('Hit: target 3, which had scored before');
  });

  it('say on which side of which target a miss fell', () => {
    expect(say(landed('ground', vec3(1.1, 0, -6.4), null, 0))).toBe('Arrow in the grass, left of target 2');
    expect(say(landed('ground', vec3(3, 0, -6), null, 0))).toBe('Arrow in the grass, right of target 2');
    expect(say(landed('ground', vec3(0.8, 0, -8.8), null, 0))).toBe('Arrow in the grass, short of target 4');
    expect(say(landed('ground', vec3(1.2, 0, -12), null, 0))).toBe('Arrow in the grass, beyond target 4');
    expect(say(landed('wall', vec3(5, 2, -5), null, 0))).toBe('Arrow in the net, ahead to the right');
  });

  it('say where things are for the head as it is turned', () => {
    const turnedLeft = { ...head, orientation: fromAxisAngle(up, Math.PI / 2) };
    expect(directionText(head, vec3(0, 0, -5))).toBe('ahead');
    expect(directionText(head, vec3(-5, 0, 0))).toBe('to the left');
    expect(directionText(turnedLeft, vec3(-5, 0, 0))).toBe('ahead');
    expect(directionText(turnedLeft, vec3(0, 0, -5))).toBe('to the right');
    expect(directionText(head, vec3(0.1, 0, 5))).toBe('behind you');
  });

  it('say where the deck is for an archer who left it', () => {
    const away = { position: vec3(1, 1.6, 0), orientation: identity };
    expect(eventCaption({ type: 'left-zone' }, { targets, seconds: 70, head: away })).toBe(
      'You left the deck: it is to the left',
    );
  });

  it('say how the round ended', () => {
    expect(say({ type: 'ended', end: 'time', score: 35 })).toBe('Bell: time is up, 35 points');
  });
});

describe('sounds before the browser allows any', () => {
  it('are captions all the same, a creaking bow only once in a draw', () => {
    const captions: string[] = [];
    const sounds = new ArcherySounds(
      (text) => captions.push(text),
      () => {
        throw new Error('the audio was never unlocked');
      },
    );
    const state = archeryRules.start([], 1);
    const cue = (type: 'creak' | 'nocked') =>
      ({ type, side: 'left', position: vec3(0, 1.4, -0.6), draw: 0.2 }) as const;
    sounds.playEvents(state, [], [cue('nocked'), cue('creak'), cue('creak')]);
    sounds.playEvents(state, [{ type: 'started' }], [cue('creak')]);
    expect(captions).toEqual(['Arrow nocked', 'The bow creaks', 'The clock runs: 70 seconds']);
  });

  it('have the direction from the head of the newest frame', () => {
    const captions: string[] = [];
    const sounds = new ArcherySounds((text) => captions.push(text));
    // One metre to the right of the deck, turned to it.
    sounds.setListener({ position: vec3(1, 1.6, 0), orientation: fromAxisAngle(up, Math.PI / 2) });
    sounds.playEvents(archeryRules.start([], 1), [{ type: 'left-zone' }], []);
    expect(captions).toEqual(['You left the deck: it is ahead']);
  });
});
