import { Group, type Object3D } from 'three';
import type { AvatarRef } from '../core/body/avatar-ref';
import { bodyOf, isBuiltInAvatar, skinToneOf } from '../core/body/built-in-bodies';
import { type Calibration, sameMeasures } from '../core/body/calibration';
import type { PersonalAvatar, RemotePerson } from '../core/body/remote-person';
import { TransientError } from '../core/errors/transient-error';
import { type MutableTransform, makeTransform, transformPoint } from '../core/math/pose';
import { copyQuat } from '../core/math/quat';
import { copyVec3, type Vec3, vec3 } from '../core/math/vec3';
import type { Avatar } from './avatar';
import { ContactShadow } from './contact-shadow';
import { GazeChoice, GazeTargets } from './gaze-targets';
import { meshesOf } from './scene-meshes';

interface RemoteAvatarsOptions<Wanted, Id> {
  /**
   * Loads a body that nothing else draws; called for each needed copy of an avatar. Rejects where it is unavailable;
   * after a TransientError it is called again some seconds later.
   */
  load(avatar: Wanted): Promise<Avatar>;
  /** The avatar drawn while another one loads or if it cannot be shown. Default: the person's previous one, or none. */
  readonly plain?: Wanted;
  /** Returns whether everybody is drawn in the plain avatar; called in every frame. Default: false. */
  onlyPlain?(): boolean;
  /** Returns whether bodies breathe and shift their weight at rest; called in every frame. Default: false. */
  idles?(): boolean;
  /** Returns the opening of a person's mouth: 0 shut to 1; called in every frame for each drawn person. */
  mouthOf(id: Id): number;
  /** Called once for each avatar that cannot be shown; not for an error that passes soon. */
  onRefused(avatar: Wanted, reason: unknown): void;
  /** Whether a soft shadow lies under each body. Default: true. */
  readonly shadows?: boolean;
  /**
   * What attracts the eyes of the bodies apart from each other, floor frame; the owner clears it in every frame, and
   * `show` adds the heads. Default: nothing.
   */
  readonly gazeTargets?: GazeTargets | undefined;
}

const head = vec3(0, 0, 0);

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

/** Returns for how long a body that nobody has stays for another person [s]. */
function spareSeconds(avatar: AvatarRef | PersonalAvatar): number {
  // The built-in bodies stay as long as the others do; a file's memory is released body by body.
  if (isBuiltInAvatar(avatar)) return Number.POSITIVE_INFINITY;
  return typeof avatar === 'string' ? 20 : 0;
}

/** Returns the queue of an avatar, of which one is loaded at a time: the built-in bodies, the files, or a person's. */
function queueOf(avatar: AvatarRef | PersonalAvatar): string {
  if (typeof avatar !== 'string') return `person ${avatar.person}`;
  return isBuiltInAvatar(avatar) ? 'built-in' : 'file';
}

function isAmong<Id>(people: readonly { readonly id: Id }[], id: Id | null): boolean {
  for (const person of people) if (person.id === id) return true;
  return false;
}

/**
 * Draws the bodies of other people, whose eyes turn to each other. Bodies are created when they are first needed, and
 * reused for later people unless they are personal. Copies of one built-in body share its graphics memory. Files are
 * loaded one at a time, a personal avatar independently of the others. A load with a transient error is repeated: a
 * person who was away for long names their file before it is in the store again.
 */
export class RemoteAvatars<Wanted extends AvatarRef | PersonalAvatar = AvatarRef, Id = number> {
  readonly object = new Group();
  readonly #options: RemoteAvatarsOptions<Wanted, Id>;
  readonly #gazeTargets: GazeTargets;
  readonly #bodies: RemoteBody<Wanted, Id>[] = [];
  /** The queues in which an avatar is loading. */
  readonly #loading = new Set<string>();
  readonly #refused = new Map<Wanted, Refusal>();
  #disposed = false;
  /** The time of the newest frame [s]. */
  #now = 0;
  /** The reason why the plain body could not be made; null: there is none. */
  #failed: unknown = null;

  constructor(options: RemoteAvatarsOptions<Wanted, Id>) {
    this.#options = options;
    this.#gazeTargets = options.gazeTargets ?? new GazeTargets();
    this.object.name = 'other people';
  }

  /** Draws these people and no others, at a time [s] on the clock of the frames. Opacity 0 hides a person's body. */
  show(people: readonly RemotePerson<Wanted, Id>[], time: number): void {
    this.#now = time;
    const { plain, onlyPlain, mouthOf, idles } = this.#options;
    const only = onlyPlain?.() === true;
    const idle = idles?.() === true;
    this.#addHeads(people);
    for (const person of people) {
      const { id, opacity } = person;
      const visible = opacity > 0;
      const body = visible ? this.#bodyFor(id, (only && plain) || person.avatar, people) : this.#bodyOf(id);
      if (!body) continue;
      body.usedAt = time;
      body.place.visible = visible;
      if (!visible) continue;
      body.look(person, this.#gazeTargets);
      body.avatar.setIdleMotion(idle);
      body.draw(person, mouthOf(id), time);
    }
    for (let i = this.#bodies.length - 1; i >= 0; i--) {
      const body = this.#bodies[i]!;
      if (isAmong(people, body.id)) continue;
      body.id = null;
      body.place.visible = false;
      if (time - body.usedAt > spareSeconds(body.of)) this.#drop(i);
    }
  }

  #addHeads(people: readonly RemotePerson<Wanted, Id>[]): void {
    const targets = this.#gazeTargets;
    if (!this.#options.gazeTargets) targets.clear();
    for (const { id, opacity, placement, pose } of people) {
      if (opacity > 0) targets.add(id, transformPoint(placement, pose.head.position, head));
    }
  }

  /** Returns a person's drawn joints, floor frame of this room [m]; null: no person with this number is drawn. */
  jointsOf(id: Id): Readonly<Record<string, Vec3>> | null {
    const body = this.#visibleBodyOf(id);
    if (!body) return null;
    const joints = Object.entries(body.avatar.jointPositions());
    return Object.fromEntries(joints.map(([joint, at]) => [joint, transformPoint(body.placement, at)]));
  }

  /** Returns the avatar that a person is drawn as; null: no person with this number is drawn. */
  drawnAs(id: Id): Wanted | null {
    return this.#visibleBodyOf(id)?.of ?? null;
  }

  dispose(): void {
    this.#disposed = true;
    this.object.removeFromParent();
    while (this.#bodies.length > 0) this.#drop(this.#bodies.length - 1);
  }

  #bodyOf(id: Id): RemoteBody<Wanted, Id> | null {
    for (const body of this.#bodies) if (body.id === id) return body;
    return null;
  }

  #visibleBodyOf(id: Id): RemoteBody<Wanted, Id> | null {
    const body = this.#bodyOf(id);
    return body?.place.visible ? body : null;
  }

  /** Returns the body of a person with this avatar, or the plain one; null while that is being made. */
  #bodyFor(id: Id, avatar: Wanted, people: readonly { readonly id: Id }[]): RemoteBody<Wanted, Id> | null {
    const { plain } = this.#options;
    const own = this.#bodyOf(id);
    const wanted = own?.of === avatar ? own : this.#freeBody(avatar, people);
    if (!wanted && avatar !== plain && this.#now >= (this.#refused.get(avatar)?.again ?? 0)) this.#make(avatar);
    const body = wanted ?? this.#plainBody(own, people);
    // Bodies stay unchanged until the plain one is loaded.
    if (!body || body === own) return own;
    if (own) own.id = null;
    body.id = id;
    return body;
  }

  /** Returns a plain body: a person's own one or a free one; null while it is being made, or if there is none. */
  #plainBody(
    own: RemoteBody<Wanted, Id> | null,
    people: readonly { readonly id: Id }[],
  ): RemoteBody<Wanted, Id> | null {
    const { plain } = this.#options;
    if (plain === undefined) return null;
    const body = own?.of === plain ? own : this.#freeBody(plain, people);
    if (!body && this.#failed) throw this.#failed;
    if (!body) this.#make(plain);
    return body;
  }

  #freeBody(avatar: Wanted, people: readonly { readonly id: Id }[]): RemoteBody<Wanted, Id> | null {
    for (const body of this.#bodies) {
      if (body.of === avatar && (body.id === null || !isAmong(people, body.id))) return body;
    }
    return null;
  }

  #make(avatar: Wanted): void {
    const queue = queueOf(avatar);
    if (this.#loading.has(queue)) return;
    this.#loading.add(queue);
    void this.#load(avatar).finally(() => this.#loading.delete(queue));
  }

  /**
   * Loads an avatar; never rejects: without it the plain body stays. Without the plain body the next frame throws the
   * reason.
   */
  async #load(avatar: Wanted): Promise<void> {
    try {
      const made = await this.#options.load(avatar);
      if (this.#disposed) made.dispose();
      else this.#add(made, avatar);
      this.#refused.delete(avatar);
    } catch (error) {
      if (avatar === this.#options.plain) this.#failed = error;
      this.#refuse(avatar, error);
    }
  }

  #refuse(avatar: Wanted, error: unknown): void {
    const before = this.#refused.get(avatar);
    const passes = error instanceof TransientError;
    const attempts = (before?.attempts ?? 0) + 1;
    const reports = !before?.reported && (!passes || attempts >= patientAttempts);
    const again = passes ? this.#now + againSeconds : Number.POSITIVE_INFINITY;
    this.#refused.set(avatar, { attempts, again, reported: reports || before?.reported === true });
    if (reports && !this.#disposed) this.#options.onRefused(avatar, error);
  }

  #add(avatar: Avatar, of: Wanted): void {
    if (isBuiltInAvatar(of)) {
      const first = this.#bodies.find((body) => isBuiltInAvatar(body.of) && bodyOf(body.of) === bodyOf(of));
      if (first) shareGeometry(first.avatar.object, avatar.object);
      avatar.setSkinTone(skinToneOf(of));
    }
    const body = new RemoteBody<Wanted, Id>(avatar, of, this.#now, this.#options.shadows ?? true);
    this.object.add(body.place);
    this.#bodies.push(body);
  }

  #drop(index: number): void {
    this.#bodies.splice(index, 1)[0]?.dispose();
  }
}

/** A body on the floor of its person. Measures, palette and opacity are set only when they change. */
class RemoteBody<Wanted, Id> {
  readonly avatar: Avatar;
  readonly of: Wanted;
  /** The person who has the body; null: nobody. */
  id: Id | null = null;
  /** The time at which a person had it last [s]. */
  usedAt: number;
  /** The person's floor, invisible at first. */
  readonly place = new Group();
  readonly placement: MutableTransform<'floor', 'floor'> = makeTransform();
  readonly #shadow: ContactShadow | null;
  readonly #gaze = new GazeChoice();
  #fitted: Calibration | null = null;
  #palette: string | null = null;
  #opacity = 1;

  constructor(avatar: Avatar, of: Wanted, usedAt: number, shadow: boolean) {
    this.avatar = avatar;
    this.of = of;
    this.usedAt = usedAt;
    this.#shadow = shadow ? new ContactShadow() : null;
    this.place.visible = false;
    this.place.add(avatar.object);
    if (this.#shadow) this.place.add(this.#shadow.object);
  }

  /** Turns the eyes to what the face points to. */
  look({ pose, placement }: RemotePerson<Wanted, Id>, targets: GazeTargets): void {
    this.avatar.setGaze(this.#gaze.choose(targets, pose.head, placement));
  }

  /** Poses the body at a time [s]. `mouth`: 0 shut to 1. */
  draw(
    { calibration, palette, placement, pose, opacity }: RemotePerson<Wanted, Id>,
    mouth: number,
    time: number,
  ): void {
    const { avatar, place } = this;
    if (isBuiltInAvatar(this.of) && this.#palette !== palette) {
      avatar.setPalette(palette);
      this.#palette = palette;
    }
    if (!this.#fitted || !sameMeasures(this.#fitted, calibration)) {
      this.#fitted = calibration;
      avatar.setCalibration(calibration);
    }
    if (opacity !== this.#opacity) {
      this.#opacity = opacity;
      avatar.setOpacity(opacity);
      if (this.#shadow) this.#shadow.object.visible = opacity > 0.5;
    }
    copyVec3(placement.position, this.placement.position);
    copyQuat(placement.orientation, this.placement.orientation);
    place.position.copy(placement.position);
    place.quaternion.copy(placement.orientation);
    avatar.setMouth(mouth);
    avatar.setPose(pose, time);
    this.#shadow?.follow(avatar.jointPositions());
  }

  dispose(): void {
    this.place.removeFromParent();
    this.avatar.dispose();
    this.#shadow?.dispose();
  }
}
