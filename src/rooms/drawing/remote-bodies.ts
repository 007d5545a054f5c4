import type { Object3D } from 'three';
import type { PlaybackReport } from '../client/playback';
import { type RemotePose, RemotePoses, type RemotePosesOptions } from '../peers/remote-poses';
import type { FloorPlacement } from '../protocol/pose-packet';
import { type AvatarLoader, DrawnBodies } from './drawn-bodies';
import { worldTransform } from './world-transform';

export interface RemoteBodiesOptions extends RemotePosesOptions {
  /**
   * Loads the avatar for the reference that a person sent (null: none). Each call must return a new avatar. The
   * reference is untrusted text: load only what the page expects. Default: the mannequin.
   */
  readonly avatar?: AvatarLoader;
}

/**
 * Draws the bodies of other people in a three.js scene, from the packets of their `PoseSender`.
 *
 * @example
 * const others = new RemoteBodies();
 * scene.add(others.object);
 * channel.onmessage = ({ data }) => others.receive('ada', data);
 * channel.onclose = () => others.remove('ada');
 * renderer.setAnimationLoop((timeMs) => {
 *   others.update(timeMs);
 *   renderer.render(scene, camera);
 * });
 */
export class RemoteBodies {
  readonly #poses: RemotePoses;
  readonly #drawn: DrawnBodies;

  constructor({ avatar, onPeerTimeout, ...options }: RemoteBodiesOptions = {}) {
    const drawn = new DrawnBodies(avatar);
    this.#drawn = drawn;
    this.#poses = new RemotePoses({
      ...options,
      onPeerTimeout(peer) {
        drawn.remove(peer);
        onPeerTimeout?.(peer);
      },
    });
  }

  /** The object to add to the scene; its origin is that of the scene in which the others move. */
  get object(): Object3D {
    return this.#drawn.object;
  }

  /**
   * Handles a packet of a peer. `peer` identifies the sender and must come from the transport, not from the packet.
   * `timeMs`: the time of arrival on the clock of `update`. Returns whether the packet was accepted.
   */
  receive(peer: string, bytes: Uint8Array | ArrayBuffer, timeMs: number = performance.now()): boolean {
    return this.#poses.receive(peer, bytes, timeMs);
  }

  /** Draws the bodies at this time [ms] on the page's clock. Call it in every frame. Returns the people drawn. */
  update(timeMs: number): readonly RemotePose[] {
    const poses = this.#poses.update(timeMs);
    this.#drawn.draw(poses, timeMs / 1000);
    return poses;
  }

  /** Removes a peer who has left, and disposes of the avatar. */
  remove(peer: string): void {
    this.#poses.remove(peer);
    this.#drawn.remove(peer);
  }

  /** Returns measurements of a peer's playback; null: an unknown peer. */
  report(peer: string): PlaybackReport | null {
    return this.#poses.report(peer);
  }

  /** Removes all bodies and takes the object out of the scene. */
  dispose(): void {
    this.#drawn.dispose();
  }
}

/**
 * Returns the pose of an object's floor in the scene, for the option `placement` of `PoseSender.update`. Pass
 * `tracker.avatar.object` if the page moves its user. The tilt of the object is ignored.
 */
export function placementOf(object: Object3D): FloorPlacement {
  const { position, orientation } = worldTransform(object);
  const { x, y, z } = position;
  return { position: { x, y, z }, heading: 2 * Math.atan2(orientation.y, orientation.w) };
}
