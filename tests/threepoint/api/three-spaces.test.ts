import { defaultCalibration } from 'threepoint/core';
import { distance, fromAxisAngle, identity, up } from 'threepoint/math';
import { describe, expect, test } from 'vitest';
import { movingPerson } from '../core/estimation/moving-person';
import { controller } from '../xr/fake-headset';
import { begin } from './three-session';

describe('a body in a session of three.js', () => {
  test('recentres: the head stands at the origin facing ahead, in the renderer’s space too', async () => {
    const { headset, tracker, run } = await begin({ calibration: defaultCalibration });
    headset.setHead({ position: { x: 2, y: 1.6, z: 1 }, orientation: fromAxisAngle(up, 1) });
    headset.putOn();
    run(2);
    const before = headset.xr.getReferenceSpace();
    tracker.recentre();
    expect(headset.xr.getReferenceSpace()).not.toBe(before);
    run(1);
    const { position, orientation } = tracker.pose!.head;
    expect(distance(position, { x: 0, y: 1.6, z: 0 })).toBeLessThan(1e-6);
    expect(orientation.w).toBeCloseTo(1);
  });

  test('lies where the page teleported its wearer, without a way, a jump or another pose', async () => {
    const { headset, tracker, run, reported, drawn } = await begin({ calibration: defaultCalibration });
    tracker.addEventListener('discontinuity', () => reported.push('jumped'));
    headset.putOn();
    run(30);
    const before = structuredClone(tracker.avatar.jointPositions());
    reported.length = 0;
    headset.moveFloorTo({ x: 5, y: 0, z: -2 }, 1);
    run(1);
    const { hips, leftHand } = tracker.avatar.jointPositions();
    expect(distance(hips!, before.hips!)).toBeLessThan(0.001);
    expect(distance(leftHand!, tracker.pose!.leftHand!.position)).toBeLessThan(0.001);
    expect(distance(drawn(tracker.pose!.head.position), headset.eyes())).toBeLessThan(1e-6);
    expect(drawn(hips!).x).toBeGreaterThan(4.5);
    expect(reported).toEqual([]);
  });

  test('moves under a page that glides its wearer as it does under one that does not', async () => {
    const [glides, stands] = [
      await begin({ calibration: defaultCalibration }),
      await begin({ calibration: defaultCalibration }),
    ];
    const person = movingPerson(3, defaultCalibration, { x: 0, z: 0, yaw: 0 });
    let jumps = 0;
    for (const { headset } of [glides, stands]) headset.putOn();
    glides.run(1);
    stands.run(1);
    glides.tracker.addEventListener('discontinuity', () => {
      jumps += 1;
    });
    for (let frame = 1; frame < 150; frame++) {
      const { head, leftHand, rightHand } = person(frame / 72);
      for (const { headset, run } of [glides, stands]) {
        headset.setHead(head);
        headset.setInputs(controller('left', leftHand), controller('right', rightHand));
        if (headset === glides.headset) headset.moveFloorTo({ x: frame / 72, y: 0, z: 0 }, frame / 144);
        run(1);
      }
      const [a, b] = [glides.tracker.avatar.jointPositions(), stands.tracker.avatar.jointPositions()];
      expect(distance(a.leftLowerArm!, b.leftLowerArm!)).toBeLessThan(1e-9);
      expect(distance(glides.drawn(head.position), glides.headset.eyes())).toBeLessThan(1e-6);
    }
    expect(jumps).toBe(0);
  });

  test.each([0.1, 3, -3])('stands on a floor that is %s m higher as on any other, without growing', async (height) => {
    const { headset, tracker, run, drawn } = await begin();
    headset.putOn();
    run(100);
    const { eyeHeight } = tracker.calibration;
    const before = structuredClone(tracker.avatar.jointPositions());
    headset.moveFloorTo({ x: 0, y: height, z: 0 });
    run(200);
    expect(tracker.calibration.eyeHeight).toBe(eyeHeight);
    const { hips, leftFoot } = tracker.avatar.jointPositions();
    expect(drawn(hips!).y - height).toBeCloseTo(before.hips!.y, 2);
    expect(drawn(leftFoot!).y - height).toBeCloseTo(before.leftFoot!.y, 2);
  });

  test('is as tall as its wearer even if the page raised them before', async () => {
    const { headset, tracker, run, drawn } = await begin();
    headset.putOn();
    headset.moveFloorTo({ x: 1, y: 3, z: 0 });
    run(100);
    expect(tracker.calibration.eyeHeight).toBeCloseTo(1.6);
    expect(distance(drawn(tracker.pose!.head.position), headset.eyes())).toBeLessThan(1e-6);
  });

  test('recentres on the height to which the page has raised its wearer', async () => {
    const { headset, tracker, run, drawn } = await begin({ calibration: defaultCalibration });
    headset.setHead({ position: { x: 2, y: 1.6, z: 1 }, orientation: fromAxisAngle(up, 1) });
    headset.putOn();
    headset.moveFloorTo({ x: 5, y: 3, z: 0 }, 2);
    run(2);
    tracker.recentre();
    run(1);
    expect(distance(tracker.pose!.head.position, { x: 0, y: 1.6, z: 0 })).toBeLessThan(1e-6);
    expect(distance(headset.eyes(), { x: 0, y: 4.6, z: 0 })).toBeLessThan(1e-6);
    expect(distance(drawn(tracker.pose!.head.position), headset.eyes())).toBeLessThan(1e-6);
  });

  test('gives a page its own space back when the device recentres after the wearer did', async () => {
    const { headset, tracker, run, reported } = await begin({ calibration: defaultCalibration });
    tracker.addEventListener('discontinuity', () => reported.push('jumped'));
    headset.putOn();
    headset.moveFloorTo({ x: 5, y: 3, z: 0 });
    const own = headset.xr.getReferenceSpace();
    run(2);
    tracker.recentre();
    tracker.recentre();
    run(1);
    reported.length = 0;
    headset.reset({ position: { x: 1, y: 0, z: 0 }, orientation: identity });
    expect(headset.xr.getReferenceSpace()).toBe(own);
    expect(reported).toEqual(['jumped']);
  });

  test('leaves the space of a page that moved its wearer to the page, through recentring too', async () => {
    const { headset, tracker, run } = await begin({ calibration: defaultCalibration });
    headset.putOn();
    run(2);
    tracker.recentre();
    run(1);
    const there = new XRRigidTransform({ x: -5, y: 0, z: 0, w: 1 }, { x: 0, y: 0, z: 0, w: 1 });
    const moved = headset.floor.getOffsetReferenceSpace(there);
    headset.xr.setReferenceSpace(moved);
    run(1);
    headset.reset({ position: { x: 1, y: 0, z: 0 }, orientation: identity });
    expect(headset.xr.getReferenceSpace()).toBe(moved);
  });

  test('knows no space of the session before: it reads from the first frame on', async () => {
    const { headset, tracker, run } = await begin({ calibration: defaultCalibration });
    headset.putOn();
    const { floor } = headset;
    const old = floor.getOffsetReferenceSpace(new XRRigidTransform({ x: 3 }, identity));
    const { getReferenceSpace } = headset.xr;
    headset.xr.getReferenceSpace = () => old;
    tracker.update(1001, undefined);
    headset.xr.getReferenceSpace = getReferenceSpace;
    run(1);
    expect(tracker.pose!.head.position.x).toBe(0);
  });
});
