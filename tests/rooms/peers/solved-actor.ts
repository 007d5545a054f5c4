import { Body } from 'threepoint';
import { actorFrame, defaultCalibration } from 'threepoint/core';
import type { PoseSource } from '../../../src/rooms/peers/pose-sender';

/** An actor whose body the library solves by inverse kinematics. */
export function solvedActor(): PoseSource & { moveTo(timeMs: number): void } {
  const body = new Body({
    estimator: 'ik',
    calibration: defaultCalibration,
    networks: () => Promise.reject(new Error('inverse kinematics needs no network')),
  });
  return {
    get pose() {
      return body.pose;
    },
    get calibration() {
      return body.calibration;
    },
    moveTo(timeMs) {
      body.update(actorFrame(timeMs / 1000, defaultCalibration));
    },
  };
}
