import type { UpperBodyPose } from 'threepoint/core/body/avatar-pose';
import { defaultCalibration } from 'threepoint/core/body/calibration';
import { forwardKinematics, type JointPoses, makeJointPoses } from 'threepoint/core/body/forward-kinematics';
import { type JointName, jointNames } from 'threepoint/core/body/joints';
import { skeletonFromCalibration } from 'threepoint/core/body/skeleton';
import { type MutableQuat, quat, slerp } from 'threepoint/core/math/quat';
import { lerp, type MutableVec3, vec3 } from 'threepoint/core/math/vec3';
import type { SentBody } from 'threepoint-rooms/peers/pose-sender';
import { PoseSender } from 'threepoint-rooms/peers/pose-sender';
import { RemotePoses } from 'threepoint-rooms/peers/remote-poses';

/** What one page draws of another, and by which time of the sender [ms]; null: nothing yet. */
export interface Drawn {
  readonly joints: JointPoses;
  readonly senderMs: number;
}

/** A way to send bodies: the sender of one person, and the receiver of any number of them. */
export interface BodyFormat {
  readonly name: string;
  /** Creates a sender; `send` gets the packets. */
  sender(send: (bytes: Uint8Array) => void): (timeMs: number, body: SentBody) => void;
  receiver(): {
    receive(peer: string, bytes: Uint8Array, timeMs: number): void;
    /** Computes what is drawn of all people at this time [ms]. */
    update(timeMs: number): void;
    drawn(peer: string): Drawn | null;
  };
}

const skeleton = skeletonFromCalibration(defaultCalibration);
/** Bones of a humanoid with fingers and legs, as people send them; what the body lacks stands still. */
const mostBones = 50;
const otherBones = mostBones - jointNames.length;
const packetMs = 1000 / 30;
/** The buffer of networked-aframe's interpolation [ms]. */
const bufferMs = 100;

type Bones = { readonly timeMs: number; readonly hips: MutableVec3; readonly rotations: MutableQuat[] };

const makeBones = (): Bones => ({
  timeMs: 0,
  hips: vec3(0, 0, 0),
  rotations: Array.from({ length: mostBones }, () => quat(0, 0, 0, 1)),
});

const bonesOf = (timeMs: number, { hipsPosition: { x, y, z }, localRotations }: UpperBodyPose): Bones => ({
  timeMs,
  hips: vec3(x, y, z),
  rotations: [
    ...jointNames.map((name) => ({ ...localRotations[name] })),
    ...Array.from({ length: otherBones }, () => quat(0, 0, 0, 1)),
  ],
});

/** Draws one person 100 ms late, with linear interpolation between the packets around that time. */
class BufferedBones {
  readonly #packets: Bones[] = [];
  readonly #shown = makeBones();
  readonly #joints = makeJointPoses();
  #offset = Number.POSITIVE_INFINITY;
  #drawn: Drawn | null = null;

  receive(bones: Bones, timeMs: number): void {
    const last = this.#packets.at(-1);
    if (last && bones.timeMs <= last.timeMs) return;
    // The fastest packet so far aligns the two clocks.
    this.#offset = Math.min(this.#offset, timeMs - bones.timeMs);
    this.#packets.push(bones);
  }

  update(timeMs: number): void {
    if (this.#packets.length === 0) return;
    const at = timeMs - this.#offset - bufferMs;
    while (this.#packets.length > 2 && this.#packets[1]!.timeMs <= at) this.#packets.shift();
    const [a, b = a] = this.#packets as [Bones, Bones?];
    const t = b === a ? 1 : Math.min(Math.max((at - a.timeMs) / (b.timeMs - a.timeMs), 0), 1);
    lerp(a.hips, b.hips, t, this.#shown.hips);
    for (let i = 0; i < mostBones; i++) slerp(a.rotations[i]!, b.rotations[i]!, t, this.#shown.rotations[i]!);
    const localRotations = rotationsByName(this.#shown.rotations);
    forwardKinematics(skeleton, { hipsPosition: this.#shown.hips, localRotations }, this.#joints);
    this.#drawn = { joints: this.#joints, senderMs: a.timeMs + t * (b.timeMs - a.timeMs) };
  }

  get drawn(): Drawn | null {
    return this.#drawn;
  }
}

const rotationsByName = (rotations: readonly MutableQuat[]) =>
  Object.fromEntries(jointNames.map((name, i) => [name, rotations[i]])) as Record<JointName, MutableQuat>;

/** A format that sends every bone, and is drawn 100 ms late. */
function bonesFormat(
  name: string,
  write: (bones: Bones) => Uint8Array,
  read: (bytes: Uint8Array) => Bones,
): BodyFormat {
  return {
    name,
    sender(send) {
      let next = 0;
      return (timeMs, { pose }) => {
        if (timeMs < next || !pose?.body) return;
        next = Math.max(next + packetMs, timeMs + packetMs / 2);
        send(write(bonesOf(timeMs, pose.body)));
      };
    },
    receiver() {
      const people = new Map<string, BufferedBones>();
      return {
        receive(peer, bytes, timeMs) {
          const person = people.get(peer) ?? new BufferedBones();
          people.set(peer, person);
          person.receive(read(bytes), timeMs);
        },
        update(timeMs) {
          for (const person of people.values()) person.update(timeMs);
        },
        drawn: (peer) => people.get(peer)?.drawn ?? null,
      };
    },
  };
}

const encoder = new TextEncoder();
const decoder = new TextDecoder();
const rounded = (value: number): number => Math.round(value * 1e4) / 1e4;

/** Four decimals each, which is shorter than the full numbers that most pages send. */
const json = bonesFormat(
  'all bones as JSON',
  ({ timeMs, hips, rotations }) =>
    encoder.encode(
      JSON.stringify({
        time: Math.round(timeMs),
        hips: [hips.x, hips.y, hips.z].map(rounded),
        bones: rotations.map(({ x, y, z, w }) => [x, y, z, w].map(rounded)),
      }),
    ),
  (bytes) => {
    const { time, hips, bones } = JSON.parse(decoder.decode(bytes)) as {
      time: number;
      hips: [number, number, number];
      bones: [number, number, number, number][];
    };
    return { timeMs: time, hips: vec3(...hips), rotations: bones.map((numbers) => quat(...numbers)) };
  },
);

const float32 = bonesFormat(
  'all bones as Float32',
  ({ timeMs, hips, rotations }) => {
    const numbers = [timeMs, hips.x, hips.y, hips.z, ...rotations.flatMap(({ x, y, z, w }) => [x, y, z, w])];
    return new Uint8Array(Float32Array.from(numbers).buffer);
  },
  (bytes) => {
    const n = new Float32Array(bytes.slice().buffer);
    return {
      timeMs: n[0]!,
      hips: vec3(n[1]!, n[2]!, n[3]!),
      rotations: Array.from({ length: mostBones }, (_, i) =>
        quat(n[4 + 4 * i]!, n[5 + 4 * i]!, n[6 + 4 * i]!, n[7 + 4 * i]!),
      ),
    };
  },
);

/** The joints of WebXR Body Tracking: position and orientation each. */
const deviceJoints = 83;
const jointNumbers = 7;

/** Sends positions, and draws them without a skeleton: limbs shorten between packets. */
const xrBody: BodyFormat = {
  name: 'XRBody joints as Float32',
  sender(send) {
    let next = 0;
    const joints = makeJointPoses();
    return (timeMs, { pose }) => {
      if (timeMs < next || !pose?.body) return;
      next = Math.max(next + packetMs, timeMs + packetMs / 2);
      forwardKinematics(skeleton, pose.body, joints);
      const numbers = new Float32Array(1 + deviceJoints * jointNumbers);
      numbers[0] = timeMs;
      for (const [i, name] of jointNames.entries()) {
        const { position, orientation } = joints[name];
        const { x, y, z, w } = orientation;
        numbers.set([position.x, position.y, position.z, x, y, z, w], 1 + i * jointNumbers);
      }
      send(new Uint8Array(numbers.buffer));
    };
  },
  receiver() {
    const people = new Map<string, BufferedJoints>();
    return {
      receive(peer, bytes, timeMs) {
        const person = people.get(peer) ?? new BufferedJoints();
        people.set(peer, person);
        person.receive(new Float32Array(bytes.slice().buffer), timeMs);
      },
      update(timeMs) {
        for (const person of people.values()) person.update(timeMs);
      },
      drawn: (peer) => people.get(peer)?.drawn ?? null,
    };
  },
};

class BufferedJoints {
  readonly #packets: Float32Array[] = [];
  readonly #joints = Array.from({ length: deviceJoints }, () => ({
    position: vec3(0, 0, 0),
    orientation: quat(0, 0, 0, 1),
  }));
  readonly #named = Object.fromEntries(jointNames.map((name, i) => [name, this.#joints[i]])) as unknown as JointPoses;
  #offset = Number.POSITIVE_INFINITY;
  #drawn: Drawn | null = null;

  receive(numbers: Float32Array, timeMs: number): void {
    const last = this.#packets.at(-1);
    if (last && numbers[0]! <= last[0]!) return;
    this.#offset = Math.min(this.#offset, timeMs - numbers[0]!);
    this.#packets.push(numbers);
  }

  update(timeMs: number): void {
    if (this.#packets.length === 0) return;
    const at = timeMs - this.#offset - bufferMs;
    while (this.#packets.length > 2 && this.#packets[1]![0]! <= at) this.#packets.shift();
    const [a, b = a] = this.#packets as [Float32Array, Float32Array?];
    const t = b === a ? 1 : Math.min(Math.max((at - a[0]!) / (b[0]! - a[0]!), 0), 1);
    for (let i = 0; i < deviceJoints; i++) {
      const k = 1 + i * jointNumbers;
      const joint = this.#joints[i]!;
      lerp(vec3(a[k]!, a[k + 1]!, a[k + 2]!), vec3(b[k]!, b[k + 1]!, b[k + 2]!), t, joint.position);
      const turn = (n: Float32Array) => quat(n[k + 3]!, n[k + 4]!, n[k + 5]!, n[k + 6]!);
      slerp(turn(a), turn(b), t, joint.orientation);
    }
    this.#drawn = { joints: this.#named, senderMs: a[0]! + t * (b[0]! - a[0]!) };
  }

  get drawn(): Drawn | null {
    return this.#drawn;
  }
}

const ours: BodyFormat = {
  name: 'threepoint-rooms',
  sender(send) {
    const sender = new PoseSender(send, { name: 'Ada' });
    return (timeMs, body) => sender.update(timeMs, body);
  },
  receiver() {
    const poses = new RemotePoses();
    let shown: ReturnType<RemotePoses['update']> = [];
    const joints = new Map<string, JointPoses>();
    return {
      receive(peer, bytes, timeMs) {
        poses.receive(peer, bytes, timeMs);
      },
      update(timeMs) {
        shown = poses.update(timeMs);
        for (const person of shown) if (person.joints) joints.set(person.peer, person.joints);
      },
      drawn(peer) {
        const known = joints.get(peer);
        const report = poses.report(peer);
        return known && report ? { joints: known, senderMs: report.shownTime * 1000 } : null;
      },
    };
  },
};

export const formats: readonly BodyFormat[] = [json, float32, xrBody, ours];
