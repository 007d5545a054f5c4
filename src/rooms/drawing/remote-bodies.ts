import type { Object3D } from 'three';
import { type AvatarPose, type Calibration, type PersonalAvatar, type RemotePerson, reasonOf } from 'threepoint/core';
import { RemoteAvatars } from 'threepoint/internal/three';
import { copyVec3, fromAxisAngle, makeTransform, up, zero } from 'threepoint/math';
import { type Avatar, loadMannequin } from 'threepoint/three';
import type { PlaybackReport } from '../client/playback';
import {
  type RemoteEvents,
  type RemoteListener,
  type RemotePose,
  RemotePoses,
  type RemotePosesOptions,
} from '../peers/remote-poses';
import type { FloorPlacement } from '../protocol/pose-packet';
import { worldTransform } from './world-transform';

/**
 * Returns the avatar for the reference that a person sent; null: the person sent none. It must be an avatar that
 * nothing else draws.
 */
export type AvatarLoader = (reference: string | null, peer: string) => Promise<Avatar>;

/** A person changes the avatar at most this often [s]; further changes wait. */
const changeSeconds = 2;

export interface RemoteBodiesOptions extends RemotePosesOptions {
  /**
   * Loads the avatar for the reference that a person sent (null: none). Each call must return a new avatar. The
   * reference is untrusted text: load only what the page expects. Default: the mannequin.
   */
  readonly avatar?: AvatarLoader;
  /** Returns whether bodies breathe and shift their weight at rest; called in every frame. Default: false. */
  idles?(): boolean;
}

/**
 * Draws the bodies of other people in a three.js scene, from the packets of their `PoseSender`.
 *
 * @example
 * const others = new RemoteBodies();
 * scene.add(others.object);
 * channel.onmessage = ({ data }) => others.receive(performance.now(), 'ada', data);
 * channel.onclose = () => others.remove('ada');
 * renderer.setAnimationLoop((timeMs) => {
 *   others.update(timeMs);
 *   renderer.render(scene, camera);
 * });
 */
export class RemoteBodies {
  readonly #poses: RemotePoses;
  readonly #avatars: RemoteAvatars<PersonalAvatar, string>;
  /** The people who were drawn once, by peer. */
  readonly #people = new Map<string, DrawnPeer>();
  readonly #listed: DrawnPeer[] = [];

  constructor({ avatar: load = () => loadMannequin(), idles = () => false, ...options }: RemoteBodiesOptions = {}) {
    this.#avatars = new RemoteAvatars({
      load: (avatar) => loadedOrMannequin(load, avatar),
      idles,
      mouthOf: (peer) => this.#people.get(peer)?.mouth ?? 0,
      onRefused: ({ person }, error) =>
        console.warn(`threepoint-rooms: ${JSON.stringify(person)} has no body: ${reasonOf(error)}`),
      shadows: false,
    });
    this.object.name = 'others';
    this.#poses = new RemotePoses(options);
    this.addEventListener('peertimeout', ({ peer }) => this.#people.delete(peer));
  }

  addEventListener<Name extends keyof RemoteEvents>(type: Name, listener: RemoteListener<Name>): void {
    this.#poses.addEventListener(type, listener);
  }

  removeEventListener<Name extends keyof RemoteEvents>(type: Name, listener: RemoteListener<Name>): void {
    this.#poses.removeEventListener(type, listener);
  }

  /** The object to add to the scene; its origin is that of the scene in which the others move. */
  get object(): Object3D {
    return this.#avatars.object;
  }

  /**
   * Handles a packet of a peer that arrives at this time [ms] on the clock of `update`. `peer` identifies the sender
   * and must come from the transport, not from the packet. Returns whether the packet was accepted.
   */
  receive(timeMs: number, peer: string, bytes: Uint8Array | ArrayBuffer): boolean {
    return this.#poses.receive(timeMs, peer, bytes);
  }

  /** Draws the bodies at this time [ms] on the page's clock. Call it in every frame. Returns the people drawn. */
  update(timeMs: number): readonly RemotePose[] {
    const poses = this.#poses.update(timeMs);
    const time = timeMs / 1000;
    this.#people.forEach(hide);
    for (const pose of poses) {
      const person = this.#people.get(pose.peer) ?? new DrawnPeer(pose);
      this.#people.set(pose.peer, person);
      person.follow(pose, time);
    }
    this.#listed.length = 0;
    this.#people.forEach(this.#list);
    this.#avatars.show(this.#listed, time);
    return poses;
  }

  /** Removes a peer who has left, and disposes of the avatar. */
  remove(peer: string): void {
    this.#poses.remove(peer);
    this.#people.delete(peer);
  }

  /** Returns measurements of a peer's playback; null: an unknown peer. */
  report(peer: string): PlaybackReport | null {
    return this.#poses.report(peer);
  }

  /** Removes all bodies and takes the object out of the scene. */
  dispose(): void {
    this.#avatars.dispose();
  }

  readonly #list = (person: DrawnPeer): void => void this.#listed.push(person);
}

/** A person as drawn: a hidden one keeps the body. */
class DrawnPeer implements RemotePerson<PersonalAvatar, string> {
  readonly id: string;
  readonly palette = null;
  readonly placement = makeTransform<'floor', 'floor'>();
  avatar: PersonalAvatar;
  calibration: Calibration;
  pose: AvatarPose;
  mouth = 0;
  opacity = 0;
  #nextChange = Number.NEGATIVE_INFINITY;

  constructor({ peer, avatar, calibration, pose }: RemotePose) {
    this.id = peer;
    this.avatar = { person: peer, reference: avatar };
    this.calibration = calibration;
    this.pose = pose;
  }

  follow({ avatar, calibration, pose, mouth, opacity, placement }: RemotePose, time: number): void {
    this.calibration = calibration;
    this.pose = pose;
    this.mouth = mouth;
    this.opacity = opacity;
    copyVec3(placement?.position ?? zero, this.placement.position);
    fromAxisAngle(up, placement?.heading ?? 0, this.placement.orientation);
    if (avatar === this.avatar.reference || time < this.#nextChange) return;
    this.#nextChange = time + changeSeconds;
    this.avatar = { person: this.id, reference: avatar };
  }
}

const hide = (person: DrawnPeer): void => {
  person.opacity = 0;
};

async function loadedOrMannequin(load: AvatarLoader, { person, reference }: PersonalAvatar): Promise<Avatar> {
  try {
    return await load(reference, person);
  } catch (error) {
    console.warn(
      `threepoint-rooms: the avatar of ${JSON.stringify(person)} could not be loaded, the mannequin is drawn: ${reasonOf(error)}`,
    );
    return loadMannequin();
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
