import { Group, type Object3D } from 'three';
import { reasonOf } from 'threepoint/core';
import { type Avatar, loadMannequin, PlacedAvatar } from 'threepoint/three';
import type { RemotePose } from '../peers/remote-poses';

/**
 * Returns the avatar for the reference that a person sent; null: the person sent none. It must be an avatar that
 * nothing else draws.
 */
export type AvatarLoader = (reference: string | null, peer: string) => Promise<Avatar>;

/** What is drawn of a person. */
type DrawnPose = Omit<RemotePose, 'name' | 'joints'>;

/** A person changes the avatar at most this often [s]; further changes wait. */
const changeSeconds = 2;

/** The bodies of other people in a scene: an avatar for each, loaded when it is first drawn. */
export class DrawnBodies {
  readonly object: Object3D = new Group();
  readonly #load: AvatarLoader;
  readonly #bodies = new Map<string, DrawnBody>();
  readonly #current = new Set<string>();

  constructor(load: AvatarLoader = () => loadMannequin()) {
    this.object.name = 'others';
    this.#load = load;
  }

  /** Draws these people at this time [s]; bodies of others are hidden until they are drawn again or removed. */
  draw(poses: readonly DrawnPose[], time: number): void {
    this.#current.clear();
    for (let i = 0; i < poses.length; i++) {
      const pose = poses[i]!;
      this.#current.add(pose.peer);
      let body = this.#bodies.get(pose.peer);
      if (!body) {
        body = new DrawnBody(pose.peer, this.#load, this.object);
        this.#bodies.set(pose.peer, body);
      }
      body.draw(pose, time);
    }
    for (const body of this.#bodies.values()) if (!this.#current.has(body.peer)) body.hide();
  }

  remove(peer: string): void {
    this.#bodies.get(peer)?.dispose();
    this.#bodies.delete(peer);
  }

  dispose(): void {
    for (const body of this.#bodies.values()) body.dispose();
    this.#bodies.clear();
    this.object.removeFromParent();
  }
}

class DrawnBody {
  readonly peer: string;
  readonly #load: AvatarLoader;
  readonly #parent: Object3D;
  #placed: PlacedAvatar | null = null;
  /** The reference of the avatar that is drawn or on its way; undefined: none was requested yet. */
  #reference: string | null | undefined = undefined;
  #loading = false;
  #nextChange = Number.NEGATIVE_INFINITY;
  #disposed = false;

  constructor(peer: string, load: AvatarLoader, parent: Object3D) {
    this.peer = peer;
    this.#load = load;
    this.#parent = parent;
  }

  draw(person: DrawnPose, time: number): void {
    const { avatar: reference, mouth, placement } = person;
    if (reference !== this.#reference && !this.#loading && time >= this.#nextChange) {
      this.#nextChange = time + changeSeconds;
      void this.#change(reference);
    }
    if (!this.#placed) return;
    const { place } = this.#placed;
    if (placement) place.position.copy(placement.position);
    else place.position.set(0, 0, 0);
    place.rotation.set(0, placement?.heading ?? 0, 0);
    this.#placed.draw(person, mouth, time);
    place.visible = true;
  }

  hide(): void {
    if (this.#placed) this.#placed.place.visible = false;
  }

  dispose(): void {
    this.#disposed = true;
    this.#placed?.dispose();
    this.#placed = null;
  }

  /** Loads another avatar; the one before is drawn until it is there. */
  async #change(reference: string | null): Promise<void> {
    this.#reference = reference;
    this.#loading = true;
    try {
      this.#wear(await this.#loaded(reference));
    } catch (error) {
      console.warn(`threepoint-rooms: ${JSON.stringify(this.peer)} has no body: ${reasonOf(error)}`);
    } finally {
      this.#loading = false;
    }
  }

  /** Returns the avatar, or where it cannot be had the mannequin. */
  async #loaded(reference: string | null): Promise<Avatar> {
    try {
      return await this.#load(reference, this.peer);
    } catch (error) {
      console.warn(
        `threepoint-rooms: the avatar of ${JSON.stringify(this.peer)} could not be loaded, the mannequin is drawn: ${reasonOf(error)}`,
      );
      return loadMannequin();
    }
  }

  #wear(avatar: Avatar): void {
    if (this.#disposed) {
      avatar.dispose();
      return;
    }
    this.#placed?.dispose();
    this.#placed = new PlacedAvatar(avatar, false);
    this.#parent.add(this.#placed.place);
  }
}
