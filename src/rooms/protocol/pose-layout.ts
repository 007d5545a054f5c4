import { type Side, sides } from 'threepoint/math';
import { BitReader, BitWriter } from './bit-stream';
import { fingerFields } from './finger-steps';
import { maxPosePacketBytes, poseVersion } from './pose-packet';
import {
  type BodySteps,
  bodyBitsFor,
  directionBits,
  flexionBits,
  forearmBits,
  freeHandBits,
  headBits,
  heightBits,
  makePacketSteps,
  type PacketSteps,
  type RelativePoseSteps,
  stretchBits,
  swivelBits,
  type Tracking,
  trackedBits,
  twistBits,
} from './pose-steps';
import { readDirection, readQuat, readStep, writeDirection, writeQuat, writeStep } from './quantise';
import { readRelativePosition, writeRelativePosition } from './relative-position';

/** The state of a hand, by its three bits. A lost hand has no fingers, nor has one at which its arm does not end. */
interface HandState {
  readonly tracking: Tracking;
  readonly free: boolean;
  readonly fingers: boolean;
}
const lostStates = [false, true].map((free): HandState => ({ tracking: 'lost', free, fingers: false }));
const seenStates = (tracking: Tracking): readonly HandState[] => [
  { tracking, free: false, fingers: false },
  { tracking, free: true, fingers: false },
  { tracking, free: false, fingers: true },
];
const handStates: readonly HandState[] = [...lostStates, ...seenStates('emulated'), ...seenStates('tracked')];
const firstState = { lost: 0, emulated: 2, tracked: 5 } as const;
const stateBits = 3;
const timeBits = 14;
/** Bits that name what trackers pin: the back is bent, the left foot, the right foot. */
const pinBits = 3;

const writer = new BitWriter();
const reader = new BitReader(new Uint8Array(0));

const writeFlag = (set: boolean): void => writer.write(set ? 1 : 0, 1);
const readFlag = (): boolean => reader.read(1) === 1;

/**
 * Returns the bytes of a packet. Fields follow each other, most significant bit first; zeros fill the last byte. A
 * signed step of b bits lies in ±m, m = 2^(b−1) − 1, and is written as step + m; the code beyond is an error.
 *
 * | bits | field |
 * |---:|---|
 * | 4, 1, 1, 1 | version; jump (the sender's space was re-anchored); has a body; head tracked, else emulated |
 * | 3 + 3 | state of the left and right hand: the index in `handStates` |
 * | 14 | time of the frame [ms] by the sender's clock, modulo 16,384 |
 * | 1 | with a body: whether trackers bend its back or pin its feet |
 * | 1, 1, 1 | only then: the back is bent; the left, the right foot is pinned |
 * | 16, 14, 16 | head x, y, z: 0.25 mm; x, z ±8.19 m, y −1 to 3.095 m |
 * | 35 | head orientation: two bits name the largest of x, y, z, w (made positive), 11 bits for each other one |
 * | 40 + 35 | each hand with a position: `writeRelativePosition`, orientation. A lost hand with a body: its wrist |
 * | 33 | each hand with fingers: `fingerFields` |
 * | 3 × 32 | with a body: hips, upper chest, neck against the floor, smallest three of 10 bits |
 * | 6 + 6 | twist of the spine against the hips, of the chest against the upper chest, ±90° |
 * | 32 | a bent back, instead of the spine's twist: the spine against the floor, smallest three of 10 bits |
 * | 9 + 9 | each arm: swing of the clavicle, 1.3 · s · (1 + abs(s)) / 2 rad, s the share of the most steps |
 * | 11, 6 | swivel of the elbow from down and back, ±180°; twist of the forearm, ±90° |
 * | 4 | stretch: the wrist is this far beyond the hand, ±1.4 mm; only if the arm is not free |
 * | 19 + 7 + 20 | a free arm: direction of the wrist from the shoulder, flexion of the elbow, hand orientation |
 * | 40 + 35 | each pinned foot: the ankle from the hips as `writeRelativePosition`, orientation |
 *
 * An arm is free while its wrist is not at its hand. With one free arm the trunk has 9 bits a component; with both it
 * has 8, and the clavicles too.
 */
export function writePacket(packet: PacketSteps): Uint8Array {
  const { head, hands, fingers, body, feet, hasBody } = packet;
  writer.clear();
  writer.write(poseVersion, 4);
  writeFlag(packet.jump);
  writeFlag(hasBody);
  writeFlag(packet.headTracking === 'tracked');
  for (const side of sides) {
    const free = hasBody && body.arms[side].free;
    writer.write(firstState[hands[side].tracking] + (free ? 1 : fingers[side].known ? 2 : 0), stateBits);
  }
  writer.write(packet.timeMs, timeBits);
  if (hasBody) writePins(packet);
  writeStep(writer, head.position.x, headBits);
  writeStep(writer, head.position.y, heightBits);
  writeStep(writer, head.position.z, headBits);
  writeQuat(writer, head.orientation, trackedBits);
  for (const side of sides) {
    const { placed, at } = hands[side];
    if (placed) writeRelativePose(at);
  }
  for (const side of sides) {
    const { known, levels } = fingers[side];
    if (!known) continue;
    for (let i = 0; i < fingerFields.length; i++) writer.write(levels[i]!, fingerFields[i]!.bits);
  }
  if (hasBody) {
    writeBody(body);
    for (const side of sides) if (feet[side].pinned) writeRelativePose(feet[side].at);
  }
  return writer.bytes();
}

function writeRelativePose({ place, orientation }: RelativePoseSteps): void {
  writeRelativePosition(writer, place);
  writeQuat(writer, orientation, trackedBits);
}

function writePins({ body, feet }: PacketSteps): void {
  const { bent } = body.trunk;
  const pinned = bent || feet.left.pinned || feet.right.pinned;
  writeFlag(pinned);
  if (!pinned) return;
  writeFlag(bent);
  for (const side of sides) writeFlag(feet[side].pinned);
}

/** A buffer with which `lengthWith` measures packets. */
const template = makePacketSteps();
/** Lengths of packets by their nine flags, whether something is pinned, and what [bytes]; 0: invalid flags. */
const lengths: (number | undefined)[] = [];
const bodyFlag = 1 << 7;

function lengthWith(flags: number, pinned: boolean, pins: number): number {
  template.hasBody = (flags & bodyFlag) !== 0;
  if (!takeState(template, 'left', flags >> stateBits) || !takeState(template, 'right', flags)) return 0;
  if (!takePins(template, pinned, pins)) return 0;
  template.body.bits = bodyBitsFor(template.body.arms);
  return writePacket(template).length;
}

/** Applies the last three bits of `bits` to a hand. Returns false for a free arm without a body. */
function takeState({ hands, fingers, body, hasBody }: PacketSteps, side: Side, bits: number): boolean {
  const { tracking, free, fingers: known } = handStates[bits & 7]!;
  hands[side].tracking = tracking;
  hands[side].placed = tracking !== 'lost' || hasBody;
  fingers[side].known = known;
  body.arms[side].free = free;
  return hasBody || !free;
}

/** Applies what trackers pin. Returns false where something is pinned and nothing is named. */
function takePins({ body, feet }: PacketSteps, pinned: boolean, pins: number): boolean {
  body.trunk.bent = pinned && (pins & 4) !== 0;
  feet.left.pinned = pinned && (pins & 2) !== 0;
  feet.right.pinned = pinned && (pins & 1) !== 0;
  return !pinned || pins !== 0;
}

/** Returns the length of the packet that begins at this byte, by its flags alone [bytes]; 0: not a packet. */
export function packetLengthAt(bytes: Uint8Array, at: number): number {
  const flags = (((bytes[at]! & 0x0f) << 8) | (bytes[at + 1] ?? 0)) >> 3;
  // The flags of pinned joints follow the time: bits 27 to 30.
  const last = bytes[at + 3] ?? 0;
  const pinned = (flags & bodyFlag) !== 0 && (last & 0x10) !== 0;
  const pins = pinned ? (last >> 1) & 7 : 0;
  const key = (flags << (pinBits + 1)) | (pinned ? (1 << pinBits) | pins : 0);
  lengths[key] ??= lengthWith(flags, pinned, pins);
  return lengths[key];
}

function writeBody({ bits, trunk, arms }: BodySteps): void {
  writeQuat(writer, trunk.hips, bits.trunk);
  writeQuat(writer, trunk.upperChest, bits.trunk);
  writeQuat(writer, trunk.neck, bits.trunk);
  if (trunk.bent) writeQuat(writer, trunk.spine, bits.trunk);
  else writeStep(writer, trunk.spineTwist, twistBits);
  writeStep(writer, trunk.chestTwist, twistBits);
  for (const side of sides) {
    const { clavicleU, clavicleV, swivel, forearmTwist, stretch, free, direction, flexion, hand } = arms[side];
    writeStep(writer, clavicleU, bits.clavicle);
    writeStep(writer, clavicleV, bits.clavicle);
    writeStep(writer, swivel, swivelBits);
    writeStep(writer, forearmTwist, forearmBits);
    if (free) {
      writeDirection(writer, direction, directionBits);
      writer.write(flexion, flexionBits);
      writeQuat(writer, hand, freeHandBits);
    } else {
      writeStep(writer, stretch, stretchBits);
    }
  }
}

/** Reads a packet. Returns false for anything that `encodePose` never writes. */
export function readPacket(bytes: Uint8Array, packet: PacketSteps): boolean {
  if (bytes.length > maxPosePacketBytes) return false;
  reader.open(bytes);
  if (reader.read(4) !== poseVersion) return false;
  const { fingers, body, feet } = packet;
  packet.jump = readFlag();
  packet.hasBody = readFlag();
  packet.headTracking = readFlag() ? 'tracked' : 'emulated';
  for (const side of sides) if (!takeState(packet, side, reader.read(stateBits))) return false;
  packet.timeMs = reader.read(timeBits);
  const pinned = packet.hasBody && readFlag();
  if (!takePins(packet, pinned, pinned ? reader.read(pinBits) : 0)) return false;
  if (!readHead(packet) || !readHand(packet.hands.left) || !readHand(packet.hands.right)) return false;
  for (const side of sides) {
    const { known, levels } = fingers[side];
    if (!known) continue;
    for (let i = 0; i < fingerFields.length; i++) levels[i] = reader.read(fingerFields[i]!.bits);
  }
  if (packet.hasBody && !readBody(body)) return false;
  for (const side of sides) if (feet[side].pinned && !readRelativePose(feet[side].at)) return false;
  return reader.ended();
}

function readHead({ head: { position, orientation } }: PacketSteps): boolean {
  const x = readStep(reader, headBits);
  const y = readStep(reader, heightBits);
  const z = readStep(reader, headBits);
  const turned = readQuat(reader, trackedBits, orientation);
  if (x === null || y === null || z === null || turned === null) return false;
  position.x = x;
  position.y = y;
  position.z = z;
  return true;
}

const readHand = ({ placed, at }: PacketSteps['hands'][Side]): boolean => !placed || readRelativePose(at);

const readRelativePose = ({ place, orientation }: RelativePoseSteps): boolean =>
  readRelativePosition(reader, place) && readQuat(reader, trackedBits, orientation) !== null;

function readBody(body: BodySteps): boolean {
  const { trunk, arms } = body;
  const bits = bodyBitsFor(arms);
  body.bits = bits;
  const hips = readQuat(reader, bits.trunk, trunk.hips);
  const upperChest = readQuat(reader, bits.trunk, trunk.upperChest);
  const neck = readQuat(reader, bits.trunk, trunk.neck);
  const spine = trunk.bent ? readQuat(reader, bits.trunk, trunk.spine) : null;
  const spineTwist = trunk.bent ? 0 : readStep(reader, twistBits);
  const chestTwist = readStep(reader, twistBits);
  if (!hips || !upperChest || !neck || spineTwist === null || chestTwist === null) return false;
  if (trunk.bent && !spine) return false;
  trunk.spineTwist = spineTwist;
  trunk.chestTwist = chestTwist;
  return readArm(body, 'left') && readArm(body, 'right');
}

function readArm({ bits, arms }: BodySteps, side: Side): boolean {
  const arm = arms[side];
  const u = readStep(reader, bits.clavicle);
  const v = readStep(reader, bits.clavicle);
  const swivel = readStep(reader, swivelBits);
  const forearmTwist = readStep(reader, forearmBits);
  if (u === null || v === null || swivel === null || forearmTwist === null) return false;
  arm.clavicleU = u;
  arm.clavicleV = v;
  arm.swivel = swivel;
  arm.forearmTwist = forearmTwist;
  if (!arm.free) {
    const stretch = readStep(reader, stretchBits);
    if (stretch !== null) arm.stretch = stretch;
    return stretch !== null;
  }
  const direction = readDirection(reader, directionBits, arm.direction);
  arm.flexion = reader.read(flexionBits);
  const hand = readQuat(reader, freeHandBits, arm.hand);
  arm.stretch = 0;
  return direction !== null && hand !== null;
}
