import {
  createJointPoses,
  defaultCalibration,
  forwardKinematics,
  type JointPoses,
  jointNames,
  recordOf,
  skeletonFromCalibration,
  type UpperBodyPose,
} from 'threepoint/core';
import { copyQuat, copyVec3, lerp, type MutableQuat, type MutableVec3, quat, slerp, vec3 } from 'threepoint/math';
import { PoseSender, type PoseSource } from '../../src/rooms/peers/pose-sender';
import { RemotePoses } from '../../src/rooms/peers/remote-poses';

/** What one page draws of another, and by which time of the sender [ms]; null: nothing yet. */
export interface Drawn {
  readonly joints: JointPoses;
  readonly senderMs: number;
}

/** A way to send bodies: the sender of one person, and the receiver of any number of them. */
export interface BodyFormat {
  readonly name: string;
  /** Creates a sender; `send` gets the packets. */
  sender(send: (bytes: Uint8Array) => void): (timeMs: number, body: PoseSource) => void;
  receiver(): {
    receive(peer: string, bytes: Uint8Array, timeMs: number): void;
    /** Computes what is drawn of all people at this time [ms]. */
    update(timeMs: number): void;
    drawn(peer: string): Drawn | null;
  };
}

const skeleton = skeletonFromCalibration(defaultCalibration);
/** Bones of a humanoid with fingers and legs, as people send them. */
const boneCount = 50;
/** The joints of WebXR Body Tracking. */
const deviceJointCount = 83;
const packetMs = 1000 / 30;
/** The buffer of networked-aframe's interpolation [ms]. */
const bufferMs = 100;

/** What a packet of the buffered formats says; how many of each is the format's. */
interface Packet {
  readonly timeMs: number;
  readonly positions: readonly MutableVec3[];
  readonly rotations: readonly MutableQuat[];
}

interface BufferedFormat {
  readonly name: string;
  readonly packetOf: (timeMs: number, body: UpperBodyPose) => Packet;
  readonly write: (packet: Packet) => Uint8Array<ArrayBuffer>;
  readonly read: (bytes: Uint8Array) => Packet;
  /** Places the joints as a packet, or what lies between two, says. */
  readonly place: (packet: Packet, joints: JointPoses) => void;
}

/** Draws one person 100 ms late, with linear interpolation between the packets around that time. */
class BufferedPerson {
  readonly #place: BufferedFormat['place'];
  readonly #packets: Packet[] = [];
  readonly #joints = createJointPoses();
  #shown: Packet | null = null;
  #offset = Number.POSITIVE_INFINITY;
  /** What was drawn at the last update; null: no packet has arrived. */
  drawn: Drawn | null = null;

  constructor(place: BufferedFormat['place']) {
    this.#place = place;
  }

  receive(packet: Packet, timeMs: number): void {
    const last = this.#packets.at(-1);
    if (last && packet.timeMs <= last.timeMs) return;
    // The fastest packet so far aligns the two clocks.
    this.#offset = Math.min(this.#offset, timeMs - packet.timeMs);
    this.#packets.push(packet);
  }

  update(timeMs: number): void {
    if (this.#packets.length === 0) return;
    const at = timeMs - this.#offset - bufferMs;
    while (this.#packets.length > 2 && this.#packets[1]!.timeMs <= at) this.#packets.shift();
    const [a, b = a] = this.#packets as [Packet, Packet?];
    const t = b === a ? 1 : Math.min(Math.max((at - a.timeMs) / (b.timeMs - a.timeMs), 0), 1);
    this.#shown ??= structuredClone(a);
    for (const [i, shown] of this.#shown.positions.entries()) lerp(a.positions[i]!, b.positions[i]!, t, shown);
    for (const [i, shown] of this.#shown.rotations.entries()) slerp(a.rotations[i]!, b.rotations[i]!, t, shown);
    this.#place(this.#shown, this.#joints);
    this.drawn = { joints: this.#joints, senderMs: a.timeMs + t * (b.timeMs - a.timeMs) };
  }
}

/** A format that sends the body 30 times per second, and draws it 100 ms late. */
const buffered = ({ name, packetOf, write, read, place }: BufferedFormat): BodyFormat => ({
  name,
  sender(send) {
    let next = 0;
    return (timeMs, { pose }) => {
      if (timeMs < next || !pose?.body) return;
      next = Math.max(next + packetMs, timeMs + packetMs / 2);
      send(write(packetOf(timeMs, pose.body)));
    };
  },
  receiver() {
    const people = new Map<string, BufferedPerson>();
    return {
      receive(peer, bytes, timeMs) {
        const person = people.get(peer) ?? new BufferedPerson(place);
        people.set(peer, person);
        person.receive(read(bytes), timeMs);
      },
      update(timeMs) {
        for (const person of people.values()) person.update(timeMs);
      },
      drawn: (peer) => people.get(peer)?.drawn ?? null,
    };
  },
});

/** Adds what the body lacks, which stands still. */
const filled = <T>(items: readonly T[], count: number, still: T): T[] => [
  ...items,
  ...Array<T>(count - items.length).fill(still),
];

/** Numbers of a packet in full: its time, its positions, its rotations. */
const asFloat32 = (positionCount: number, rotationCount: number): Pick<BufferedFormat, 'write' | 'read'> => ({
  write({ timeMs, positions, rotations }) {
    const numbers = [...positions.map(({ x, y, z }) => [x, y, z]), ...rotations.map(({ x, y, z, w }) => [x, y, z, w])];
    return new Uint8Array(Float32Array.from([timeMs, ...numbers.flat()]).buffer);
  },
  read(bytes) {
    const numbers = new Float32Array(bytes.slice().buffer);
    let at = 0;
    const next = () => numbers[at++]!;
    return {
      timeMs: next(),
      positions: Array.from({ length: positionCount }, () => vec3(next(), next(), next())),
      rotations: Array.from({ length: rotationCount }, () => quat(next(), next(), next(), next())),
    };
  },
});

/** The hips' position and the rotation of every bone. */
const bones: Pick<BufferedFormat, 'packetOf' | 'place'> = {
  packetOf(timeMs, { hipsPosition: { x, y, z }, localRotations }) {
    const rotations = jointNames.map((name) => ({ ...localRotations[name] }));
    return { timeMs, positions: [vec3(x, y, z)], rotations: filled(rotations, boneCount, quat(0, 0, 0, 1)) };
  },
  place({ positions, rotations }, joints) {
    const localRotations = recordOf(jointNames, (_, i) => rotations[i]!);
    forwardKinematics(skeleton, { hipsPosition: positions[0]!, localRotations }, joints);
  },
};

const encoder = new TextEncoder();
const decoder = new TextDecoder();
const rounded = (value: number): number => Math.round(value * 1e4) / 1e4;

/** Four decimals each, which is shorter than the full numbers that most pages send. */
const json = buffered({
  name: 'all bones as JSON',
  ...bones,
  write: ({ timeMs, positions: [hips], rotations }) =>
    encoder.encode(
      JSON.stringify({
        time: Math.round(timeMs),
        hips: [hips!.x, hips!.y, hips!.z].map(rounded),
        bones: rotations.map(({ x, y, z, w }) => [x, y, z, w].map(rounded)),
      }),
    ),
  read(bytes) {
    const { time, hips, bones } = JSON.parse(decoder.decode(bytes)) as {
      time: number;
      hips: [number, number, number];
      bones: [number, number, number, number][];
    };
    return { timeMs: time, positions: [vec3(...hips)], rotations: bones.map((numbers) => quat(...numbers)) };
  },
});

const float32 = buffered({ name: 'all bones as Float32', ...bones, ...asFloat32(1, boneCount) });

/** Sends position and orientation of each joint, and draws them without a skeleton: limbs shorten between packets. */
const xrBody = buffered({
  name: 'XRBody joints as Float32',
  packetOf(timeMs, body) {
    const joints = Object.values(forwardKinematics(skeleton, body));
    const positions = joints.map(({ position }) => position);
    const rotations = joints.map(({ orientation }) => orientation);
    return {
      timeMs,
      positions: filled(positions, deviceJointCount, vec3(0, 0, 0)),
      rotations: filled(rotations, deviceJointCount, quat(0, 0, 0, 1)),
    };
  },
  place({ positions, rotations }, joints) {
    for (const [i, name] of jointNames.entries()) {
      copyVec3(positions[i]!, joints[name].position);
      copyQuat(rotations[i]!, joints[name].orientation);
    }
  },
  ...asFloat32(deviceJointCount, deviceJointCount),
});

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
