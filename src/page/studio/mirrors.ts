import { type Camera, Group, MeshStandardMaterial, type Scene, type WebGLRenderer } from 'three';
import { Mirror } from 'threepoint/internal/three';
import type { Side } from 'threepoint/math';
import type { Quality } from '../scene/renderer';

/** The user stands at the origin and looks along −Z, at the mirror on the wall [m]. */
export const wallDistance = 1.4;
/** The wide mirror [m] reaches further to the left: the menu has its place right of it, in sight of the user. */
const wide = { width: 3.1, height: 2.4, middle: -0.6 };
/** A mirror at the user's right is out of the way of what flies ahead [m, rad]. */
const aside = { x: 1.95, z: -0.1, turned: -1.3 };

/** The width of the reflection in the standing mirror [pixels]: it takes a small part of a picture. */
const standingResolution = 1280;

/** The wide mirror on the wall of the studio, and one that stands beside a game or in the user's own room. */
export class Mirrors {
  readonly object = new Group();
  readonly #wall: Mirror;
  readonly #standing: Mirror;
  readonly #standingHeight: number;
  #current: Mirror;

  constructor(quality: Quality) {
    const samples = quality === 'high' ? {} : { samples: 0 };
    const frame = new MeshStandardMaterial({ color: '#8a6140', roughness: 0.55 });
    this.#wall = new Mirror({ width: wide.width, height: wide.height, frame, ...samples });
    this.#wall.place(wide.middle, -wallDistance, 0);
    this.#standing = new Mirror({ resolution: standingResolution, ...samples });
    this.#standingHeight = this.#standing.object.position.y;
    this.#current = this.#wall;
    this.object.add(this.#wall.object, this.#standing.object);
    this.#standing.setVisible(false);
  }

  /** Places the mirror at this side of the user; null: on the wall of the studio. */
  place(side: Side | null): void {
    const sign = side === 'right' ? 1 : -1;
    if (side) this.stand(sign * aside.x, 0, aside.z, sign * aside.turned);
    else this.#use(this.#wall);
  }

  /** Stands the mirror on the floor at this height, its middle at (x, z) [m]; turned by 0 it faces +Z [rad]. */
  stand(x: number, floor: number, z: number, turned: number): void {
    this.#use(this.#standing);
    this.#standing.place(x, z, turned);
    this.#standing.object.position.y = this.#standingHeight + floor;
  }

  setVisible(visible: boolean): void {
    this.#current.setVisible(visible);
  }

  /** Returns whether a point, floor frame, is in front of the wall mirror, which hides people from behind. */
  isBeforeWall({ z }: { readonly z: number }): boolean {
    return z > 0.1 - wallDistance;
  }

  /** Sets the maximum rate of reflections in a session [Hz]; null: one in each frame. */
  setMaxRate(rateHz: number | null): void {
    for (const mirror of [this.#wall, this.#standing]) mirror.setMaxRate(rateHz);
  }

  /** Draws the reflection of the scene for this camera at this time [s]. Call it before the scene is drawn. */
  reflect(renderer: WebGLRenderer, scene: Scene, camera: Camera, time: number): void {
    // The hidden one frees its textures.
    for (const mirror of [this.#wall, this.#standing]) mirror.reflect(renderer, scene, camera, time);
  }

  #use(mirror: Mirror): void {
    const { visible } = this.#current.object;
    this.#current.setVisible(false);
    this.#current = mirror;
    mirror.setVisible(visible);
  }
}
