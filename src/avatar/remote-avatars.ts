import { Group, type Mesh, type MeshBasicMaterial, type Object3D, type PlaneGeometry } from 'three';
import type { AvatarPose } from '../core/body/avatar-pose';
import type { Calibration } from '../core/body/calibration';
import type { Fingers } from '../core/body/hand-shape';
import { type MutableTransform, makeTransform, type Transform, transformPoint } from '../core/math/pose';
import { copyQuat } from '../core/math/quat';
import { copyVec3, type Vec3 } from '../core/math/vec3';
import { createBlobShadow } from '../scene/blob-shadow';
import { type Avatar, createAvatar } from './avatar';
import { parseAvatar } from './load-avatar';

/** Another person as they are to be drawn in this frame. */
export interface SeenPerson {
  /** Who it is, for as long as they are there: the same number is the same body. */
  readonly id: number;
  readonly calibration: Calibration;
  readonly palette: string;
  /** In their own floor's frame. */
  readonly pose: AvatarPose;
  /** Where their floor lies in this room. */
  readonly placement: Transform<'floor', 'floor'>;
  readonly fingers: Fingers;
  /** 1: live. Less: a ghost. */
  readonly opacity: number;
}

/** The bodies of other people: mannequins that share what the graphics device holds of one. */
export interface RemoteAvatars {
  readonly object: Group;
  /** Draws these people and no one else, at a time [s] on the clock of the frames. */
  show(people: readonly SeenPerson[], time: number): void;
  /** Where a person's joints are drawn, floor frame of this room [m]; null: no one of this number is drawn. */
  jointsOf(id: number): Readonly<Record<string, Vec3>> | null;
  dispose(): void;
}

interface Body {
  readonly avatar: Avatar;
  readonly place: Group;
  readonly shadow: Mesh<PlaneGeometry, MeshBasicMaterial>;
  id: number | null;
  fitted: Calibration | null;
  palette: string;
  opacity: number;
  readonly placement: MutableTransform<'floor', 'floor'>;
}

/** The second body draws from the first one's memory on the graphics device: only bones and colours are its own. */
function shareGeometry(from: Object3D, to: Object3D): void {
  const sources: Mesh[] = [];
  from.traverse((node) => {
    if ('isMesh' in node) sources.push(node as Mesh);
  });
  let next = 0;
  to.traverse((node) => {
    if (!('isMesh' in node)) return;
    const source = sources[next]?.geometry;
    next += 1;
    if (!source) throw new Error('avatar/remote-avatars: two bodies from one file differ');
    const { geometry } = node as Mesh;
    for (const name of Object.keys(source.attributes)) geometry.setAttribute(name, source.getAttribute(name));
    geometry.setIndex(source.index);
  });
}

function isAmong(people: readonly SeenPerson[], id: number): boolean {
  for (const person of people) if (person.id === id) return true;
  return false;
}

/** `bytes`: of the mannequin's file. Bodies are made when they are first needed, one after the other, and kept for the next person who comes. */
export const createRemoteAvatars = (bytes: ArrayBuffer, name: string): RemoteAvatars => new Mannequins(bytes, name);

class Mannequins implements RemoteAvatars {
  readonly object = new Group();
  readonly #bytes: ArrayBuffer;
  readonly #name: string;
  readonly #bodies: Body[] = [];
  #making = false;
  #disposed = false;
  /** Why a body could not be made; null: each could. */
  #failed: unknown = null;

  constructor(bytes: ArrayBuffer, name: string) {
    this.#bytes = bytes;
    this.#name = name;
    this.object.name = 'other people';
  }

  show(people: readonly SeenPerson[], time: number): void {
    for (const person of people) {
      const body = this.#bodyFor(person.id, people);
      if (body) draw(body, person, time);
    }
    for (const body of this.#bodies) {
      let there = false;
      for (const { id, opacity } of people) there ||= id === body.id && opacity > 0;
      body.place.visible = there;
      if (!there) body.id = null;
    }
  }

  jointsOf(id: number): Readonly<Record<string, Vec3>> | null {
    const body = this.#bodies.find((candidate) => candidate.id === id);
    if (!body) return null;
    const joints = Object.entries(body.avatar.jointPositions());
    return Object.fromEntries(joints.map(([joint, at]) => [joint, transformPoint(body.placement, at)]));
  }

  dispose(): void {
    this.#disposed = true;
    this.object.removeFromParent();
    for (const { avatar, shadow } of this.#bodies) {
      avatar.dispose();
      shadow.geometry.dispose();
      shadow.material.dispose();
    }
  }

  /** The body of this number, or a free one; null while one is being made. */
  #bodyFor(id: number, people: readonly SeenPerson[]): Body | null {
    for (const body of this.#bodies) if (body.id === id) return body;
    for (const body of this.#bodies) {
      if (body.id !== null && isAmong(people, body.id)) continue;
      body.id = id;
      body.fitted = null;
      return body;
    }
    if (this.#failed) throw this.#failed;
    if (!this.#making) void this.#make();
    return null;
  }

  /** Never rejects: the next frame that wants a body throws why there is none. */
  async #make(): Promise<void> {
    this.#making = true;
    try {
      const avatar = createAvatar(await parseAvatar(this.#bytes, this.#name));
      if (this.#disposed) avatar.dispose();
      else this.#add(avatar);
      this.#making = false;
    } catch (error) {
      this.#failed = error;
    }
  }

  #add(avatar: Avatar): void {
    const first = this.#bodies[0];
    if (first) shareGeometry(first.avatar.object, avatar.object);
    const place = new Group();
    const shadow = createBlobShadow();
    place.visible = false;
    place.add(avatar.object, shadow);
    this.object.add(place);
    const free = { id: null, fitted: null, palette: '', opacity: 1, placement: makeTransform<'floor', 'floor'>() };
    this.#bodies.push({ avatar, place, shadow, ...free });
  }
}

function draw(body: Body, person: SeenPerson, time: number): void {
  const { avatar, place, shadow } = body;
  const { calibration, palette, pose, placement, fingers, opacity } = person;
  if (body.fitted?.eyeHeight !== calibration.eyeHeight || body.fitted.armSpan !== calibration.armSpan) {
    avatar.fitTo(calibration);
    body.fitted = calibration;
  }
  if (body.palette !== palette) {
    avatar.setPalette(palette);
    body.palette = palette;
  }
  if (body.opacity !== opacity) {
    avatar.setOpacity(opacity);
    shadow.visible = opacity > 0.5;
    body.opacity = opacity;
  }
  copyVec3(placement.position, body.placement.position);
  copyQuat(placement.orientation, body.placement.orientation);
  place.position.copy(placement.position);
  place.quaternion.copy(placement.orientation);
  avatar.setFingers('left', fingers.left);
  avatar.setFingers('right', fingers.right);
  avatar.apply(pose, time);
  const { hips, head } = avatar.jointPositions();
  const over = hips ?? head;
  if (over) shadow.position.set(over.x, shadow.position.y, over.z);
}
