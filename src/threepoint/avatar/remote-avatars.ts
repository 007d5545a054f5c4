import { Group, type Object3D } from 'three';
import { type AvatarRef, isAvatarHash } from '../core/body/avatar-ref';
import { bodyOf, defaultAvatar, isBuiltInAvatar, skinToneOf } from '../core/body/built-in-bodies';
import type { RemotePerson } from '../core/body/remote-person';
import { TransientError } from '../core/errors/transient-error';
import { type MutableTransform, makeTransform, transformPoint } from '../core/math/pose';
import { copyQuat } from '../core/math/quat';
import { copyVec3, type Vec3 } from '../core/math/vec3';
import type { Avatar } from './avatar';
import { gazeTargetOf } from './gaze-targets';
import { PlacedAvatar } from './placed-avatar';
import { meshesOf } from './scene-meshes';

interface RemoteAvatarsOptions {
  /**
   * Loads the body of an avatar: once for a file, and for each needed copy of a built-in body. Rejects
   * where it is unavailable; after a TransientError it is called again some seconds later.
   */
  load(avatar: AvatarRef): Promise<Avatar>;
  /** Returns whether everybody is drawn as the plain body; called in every frame. */
  plain(): boolean;
  /** Returns the opening of a person's mouth: 0 shut to 1; called in every frame for each drawn person. */
  mouthOf(id: number): number;
  /**
   * Called once for each avatar that cannot be shown, so that the plain one stays; not for a fault that passes soon.
   */
  onRefused(avatar: AvatarRef, reason: unknown): void;
  /** Whether a soft shadow lies under each body. Default: true. */
  readonly shadows?: boolean;
}

interface Body {
  readonly placed: PlacedAvatar;
  readonly of: AvatarRef;
  /** Whether the body is from a file and not one of the project's own. */
  readonly fromFile: boolean;
  id: number | null;
  /** The time at which it was drawn last [s]. */
  drawnAt: number;
  palette: string;
  readonly placement: MutableTransform<'floor', 'floor'>;
}

/** The time [s] after which an unused body from a file is released. */
const keptSeconds = 20;

/** The time [s] after which a failed load is repeated. */
const againSeconds = 5;
/** The number of attempts after which a passing fault is reported. */
const patientAttempts = 3;

/** The reason why an avatar is not shown. */
interface Refusal {
  readonly attempts: number;
  /** The time of the next attempt [s]; Infinity: never. */
  readonly again: number;
  readonly reported: boolean;
}

/** Makes the second body use the geometry of the first in graphics memory: only its bones and colours are separate. */
function shareGeometry(from: Object3D, to: Object3D): void {
  const sources = meshesOf(from);
  for (const [index, { geometry }] of meshesOf(to).entries()) {
    const source = sources[index]?.geometry;
    if (!source) throw new Error('avatar/remote-avatars: two bodies from one file differ');
    for (const name of Object.keys(source.attributes)) geometry.setAttribute(name, source.getAttribute(name));
    geometry.setIndex(source.index);
  }
}

function isAmong(people: readonly RemotePerson[], id: number): boolean {
  for (const person of people) if (person.id === id) return true;
  return false;
}

/**
 * Draws the bodies of other people, whose eyes turn to each other. Copies of one body share its graphics memory. Bodies
 * are created when they are first needed and reused for later people. Files are loaded one at a time; while a file
 * loads, or if it is refused, the plain body is drawn. A load with a transient fault is repeated: a person who was away
 * for long names their file before it is in the store again.
 */
export class RemoteAvatars {
  readonly object = new Group();
  readonly #options: RemoteAvatarsOptions;
  readonly #bodies: Body[] = [];
  /** The bodies in preparation: one of each built-in body and of each file. */
  readonly #making: { own: boolean; file: boolean } = { own: false, file: false };
  readonly #refused = new Map<AvatarRef, Refusal>();
  #disposed = false;
  /** The time of the newest frame [s]. */
  #now = 0;
  /** The reason why the plain body could not be made; null: there is none. */
  #failed: unknown = null;

  constructor(options: RemoteAvatarsOptions) {
    this.#options = options;
    this.object.name = 'other people';
  }

  /** Draws these people and no others, at a time [s] on the clock of the frames. */
  show(people: readonly RemotePerson[], time: number): void {
    this.#now = time;
    const plain = this.#options.plain();
    for (const person of people) {
      const body = this.#bodyFor(person, plain ? defaultAvatar : person.avatar, people);
      if (!body) continue;
      body.drawnAt = time;
      body.placed.avatar.setGaze(gazeTargetOf(person, people));
      draw(body, person, this.#options.mouthOf(person.id), time);
    }
    for (let i = this.#bodies.length - 1; i >= 0; i--) {
      const body = this.#bodies[i]!;
      let there = false;
      for (const { id, opacity } of people) there ||= id === body.id && opacity > 0;
      body.placed.place.visible = there;
      if (!there) body.id = null;
      if (body.id === null && body.fromFile && time - body.drawnAt > keptSeconds) this.#drop(i);
    }
  }

  /** Returns a person's drawn joints, floor frame of this room [m]; null: no person with this number is drawn. */
  jointsOf(id: number): Readonly<Record<string, Vec3>> | null {
    const body = this.#bodyOf(id);
    if (!body) return null;
    const joints = Object.entries(body.placed.avatar.jointPositions());
    return Object.fromEntries(joints.map(([joint, at]) => [joint, transformPoint(body.placement, at)]));
  }

  /** Returns the avatar that a person is drawn as; null: no person with this number is drawn. */
  drawnAs(id: number): AvatarRef | null {
    return this.#bodyOf(id)?.of ?? null;
  }

  dispose(): void {
    this.#disposed = true;
    this.object.removeFromParent();
    while (this.#bodies.length > 0) this.#drop(this.#bodies.length - 1);
  }

  #bodyOf(id: number): Body | null {
    for (const body of this.#bodies) if (body.id === id) return body;
    return null;
  }

  /** Returns the body of a person with this avatar, or the plain one; null while that is being made. */
  #bodyFor({ id }: RemotePerson, avatar: AvatarRef, people: readonly RemotePerson[]): Body | null {
    const own = this.#bodyOf(id);
    const wanted = own?.of === avatar ? own : this.#freeBody(avatar, people);
    if (!wanted && avatar !== defaultAvatar && this.#now >= (this.#refused.get(avatar)?.again ?? 0)) this.#make(avatar);
    const body = wanted ?? (own?.of === defaultAvatar ? own : this.#freeBody(defaultAvatar, people));
    if (!body) {
      if (this.#failed) throw this.#failed;
      this.#make(defaultAvatar);
      // Bodies stay unchanged until the plain one is loaded.
      return own;
    }
    if (body === own) return own;
    if (own) own.id = null;
    body.id = id;
    return body;
  }

  #freeBody(avatar: AvatarRef, people: readonly RemotePerson[]): Body | null {
    for (const body of this.#bodies) {
      if (body.of === avatar && (body.id === null || !isAmong(people, body.id))) return body;
    }
    return null;
  }

  #make(avatar: AvatarRef): void {
    const lane = isAvatarHash(avatar) ? 'file' : 'own';
    if (this.#making[lane]) return;
    this.#making[lane] = true;
    void this.#load(avatar).finally(() => {
      this.#making[lane] = false;
    });
  }

  /**
   * Loads an avatar; never rejects: without it the plain body stays. Without the plain body the next frame throws the
   * reason.
   */
  async #load(avatar: AvatarRef): Promise<void> {
    try {
      const made = await this.#options.load(avatar);
      if (this.#disposed) made.dispose();
      else this.#add(made, avatar);
      this.#refused.delete(avatar);
    } catch (error) {
      if (avatar === defaultAvatar) this.#failed = error;
      this.#refuse(avatar, error);
    }
  }

  #refuse(avatar: AvatarRef, error: unknown): void {
    const before = this.#refused.get(avatar);
    const passes = error instanceof TransientError;
    const attempts = (before?.attempts ?? 0) + 1;
    const reports = !before?.reported && (!passes || attempts >= patientAttempts);
    const again = passes ? this.#now + againSeconds : Number.POSITIVE_INFINITY;
    this.#refused.set(avatar, { attempts, again, reported: reports || before?.reported === true });
    if (reports && !this.#disposed) this.#options.onRefused(avatar, error);
  }

  #add(avatar: Avatar, of: AvatarRef): void {
    const fromFile = isAvatarHash(of);
    // The built-in bodies stay as long as the others do; a file's memory is released body by body.
    if (isBuiltInAvatar(of)) {
      const first = this.#bodies.find((body) => isBuiltInAvatar(body.of) && bodyOf(body.of) === bodyOf(of));
      if (first) shareGeometry(first.placed.avatar.object, avatar.object);
      avatar.setSkinTone(skinToneOf(of));
    }
    const placed = new PlacedAvatar(avatar, this.#options.shadows ?? true);
    this.object.add(placed.place);
    const free = { id: null, palette: '', placement: makeTransform<'floor', 'floor'>() };
    this.#bodies.push({ placed, of, fromFile, drawnAt: this.#now, ...free });
  }

  #drop(index: number): void {
    this.#bodies.splice(index, 1)[0]?.placed.dispose();
  }
}

function draw(body: Body, person: RemotePerson, mouth: number, time: number): void {
  const { avatar, place } = body.placed;
  const { palette, placement, fingers } = person;
  if (!body.fromFile && palette !== null && body.palette !== palette) {
    avatar.setPalette(palette);
    body.palette = palette;
  }
  copyVec3(placement.position, body.placement.position);
  copyQuat(placement.orientation, body.placement.orientation);
  place.position.copy(placement.position);
  place.quaternion.copy(placement.orientation);
  avatar.setFingers('left', fingers.left);
  avatar.setFingers('right', fingers.right);
  body.placed.draw(person, mouth, time);
}
