import { nothingPressed } from 'threepoint/core';
import { add, distance, type Pose, type Side, type TrackedPose, vec3 } from 'threepoint/math';
import { createBallLoopbackHost } from 'threepoint-games/ball';
import { expect, test } from 'vitest';
import { holding, opening, shownAt, visitor } from '../../rooms/client/people';
import { ballPage } from '../playing';

type Wrists = Readonly<Record<Side, Pose<'arena'> | null>>;

/** The holder's own page; how far the basket that it draws is from that of the rules [m]. */
function holder() {
  const host = createBallLoopbackHost();
  const play = ballPage(host, { name: 'Cal', seat: 2 });
  const connection = host.connect(visitor('Ann', { seat: 0 }), 10);
  let time = 10;
  return {
    /**
     * Shows half a second with the wrists there, tracked or only guessed by the device; `aside`: the distance of the
     * head from the mark [m].
     */
    show(wrists: Wrists, tracking: TrackedPose['tracking'] = 'tracked', aside = 0) {
      for (let i = 0; i < 36; i++) {
        time += 1 / 72;
        connection.update(time);
        play.begin(time);
        const shown = shownAt(connection, 2, wrists);
        const told = (hand: TrackedPose | null) => hand && { ...hand, tracking };
        const { leftHand, rightHand } = shown.pose;
        const head = { ...shown.pose.head, position: add(shown.pose.head.position, vec3(aside, 0, 0)) };
        const frame = { time, head, leftHand: told(leftHand), rightHand: told(rightHand) };
        play.follow(time, frame, nothingPressed);
        const pose = { ...shown.pose, head, leftHand: frame.leftHand, rightHand: frame.rightHand };
        play.sendPose(frame.time, pose, shown.fingers);
      }
    },
    apart() {
      const seen = play.newest!;
      return distance((seen.opening ?? seen.state.basket).position, host.room.match.basket.position);
    },
  };
}

const aside = add(opening, vec3(0.5, 0.3, 0));

test('the basket is drawn where the rules have it, even while no holder’s hand is seen', () => {
  const { show, apart } = holder();
  show(holding(aside));
  expect(apart()).toBeLessThan(0.01);
  show({ left: null, right: null });
  expect(apart()).toBeLessThan(0.01);
});

test('the basket follows no hands whose places the device only guesses', () => {
  const { show, apart } = holder();
  show(holding(aside));
  show(holding(opening), 'emulated');
  expect(apart()).toBeLessThan(0.01);
  show(holding(opening));
  expect(apart()).toBeLessThan(0.01);
});

test('the basket follows no holder who has left their mark', () => {
  const { show, apart } = holder();
  show(holding(aside));
  show(holding(opening), 'tracked', 1.3);
  expect(apart()).toBeLessThan(0.01);
});
