import type { MatchScenes } from '../people/match/match-camera';

/** The views of the court at the desktop. */
export const courtScenes: MatchScenes = {
  player: {
    'third-person': {
      // High enough that the basket is above the head of the player, who stands before the camera.
      offset: { x: 0, y: 1.4, z: 3.5 },
      aim: { x: 0, y: 0.3, z: -2.4 },
      fovDegrees: 50,
      headroom: 0.5,
    },
    front: { offset: { x: -1.9, y: 0.6, z: -3.1 }, aim: { x: 0, y: 0, z: 0 }, fovDegrees: 50 },
  },
  spectator: {
    'third-person': { offset: { x: 4.6, y: 2.1, z: 4.6 }, aim: { x: 0.4, y: 0.15, z: 0 }, fovDegrees: 54 },
    front: { offset: { x: -4.6, y: 1.7, z: -3.6 }, aim: { x: 0, y: -0.1, z: 0 }, fovDegrees: 50 },
    maxDistance: 14,
    free: true,
  },
  middle: { x: 0, y: 1, z: -2.4 },
};
