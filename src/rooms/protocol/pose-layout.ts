import { type Side, sides } from 'threepoint/core/math/side';
import { type BitReader, type BitWriter, createBitReader, createBitWriter } from './bits';
import { fingerFields } from './finger-steps';
import { readHandPlace, writeHandPlace } from './hand-place';
import { longestPose, poseVersion } from './pose-packet';
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
  stretchBits,
  swivelBits,
  type Tracking,
  trackedBits,
} from './pose-steps';
import { readDirection, readQuat, readStep, writeDirection, writeQuat, writeStep } from './quantise';

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

const writer = createBitWriter();
const reader = createBitReader(new Uint8Array(0));

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
 * | 16, 14, 16 | head x, y, z: 0.25 mm; x, z ±8.19 m, y −1 to 3.095 m |
 * | 35 | head orientation: two bits name the largest of x, y, z, w (made positive), 11 bits for each other one |
 * | 40 + 35 | each hand that has a place: `writeHandPlace`, orientation. A lost hand with a body: the body's wrist |
 * | 33 | each hand with fingers: `fingerFields` |
 * | 3 × 32 | with a body: hips, upper chest, neck against the floor, smallest three of 10 bits |
 * | 7 + 7 | twist of the spine against the hips, of the chest against the upper chest, ±180° |
 * | 9 + 9 | each arm: swing of the clavicle, 1.3 · s · (1 + abs(s)) / 2 rad, s the share of the most steps |
 * | 11, 6 | swivel of the elbow from down and back, ±180°; twist of the forearm, ±90° |
 * | 4 | stretch: the wrist is this far beyond the hand, ±1.4 mm; only if the arm is not free |
 * | 19 + 7 + 20 | a free arm: direction of the wrist from the shoulder, flexion of the elbow, hand orientation |
 *
 * An arm is free while its wrist is not at its hand. With one free arm the trunk has 9 bits a component and the twists
 * 6; with both it has 8 and 6, and the clavicles 8.
 */
export function writePacket(packet: PacketSteps): Uint8Array {
  const { head, hands, fingers, body, hasBody } = packet;
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
  writeStep(writer, head.position.x, headBits);
  writeStep(writer, head.position.y, heightBits);
  writeStep(writer, head.position.z, headBits);
  writeQuat(writer, head.orientation, trackedBits);
  for (const side of sides) {
    const { placed, at } = hands[side];
    if (!placed) continue;
    writeHandPlace(writer, at.place);
    writeQuat(writer, at.orientation, trackedBits);
  }
  for (const side of sides) {
    const { known, levels } = fingers[side];
    if (!known) continue;
    for (let i = 0; i < fingerFields.length; i++) writer.write(levels[i]!, fingerFields[i]!.bits);
  }
  if (hasBody) writeBody(writer, body);
  return writer.bytes();
}

/** A buffer with which `lengthWith` measures packets. */
const template = makePacketSteps();
/** Lengths of packets by their nine flags [bytes]; 0: invalid flags. */
const lengths: (number | undefined)[] = [];

function lengthWith(flags: number): number {
  const flag = (bit: number): boolean => ((flags >> bit) & 1) === 1;
  template.hasBody = flag(7);
  if (!takeState(template, 'left', flags >> stateBits) || !takeState(template, 'right', flags)) return 0;
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

/** Returns the length of the packet that begins at this byte, by its flags alone [bytes]; 0: not a packet. */
export function packetLengthAt(bytes: Uint8Array, at: number): number {
  const flags = (((bytes[at]! & 0x0f) << 8) | (bytes[at + 1] ?? 0)) >> 3;
  lengths[flags] ??= lengthWith(flags);
  return lengths[flags];
}

function writeBody(to: BitWriter, { bits, trunk, arms }: BodySteps): void {
  writeQuat(to, trunk.hips, bits.trunk);
  writeQuat(to, trunk.upperChest, bits.trunk);
  writeQuat(to, trunk.neck, bits.trunk);
  writeStep(to, trunk.spineTwist, bits.twist);
  writeStep(to, trunk.chestTwist, bits.twist);
  for (const side of sides) {
    const { clavicleU, clavicleV, swivel, forearmTwist, stretch, free, direction, flexion, hand } = arms[side];
    writeStep(to, clavicleU, bits.clavicle);
    writeStep(to, clavicleV, bits.clavicle);
    writeStep(to, swivel, swivelBits);
    writeStep(to, forearmTwist, forearmBits);
    if (free) {
      writeDirection(to, direction, directionBits);
      to.write(flexion, flexionBits);
      writeQuat(to, hand, freeHandBits);
    } else {
      writeStep(to, stretch, stretchBits);
    }
  }
}

/** Reads a packet. Returns false for anything that `encodePose` never writes. */
export function readPacket(bytes: Uint8Array, packet: PacketSteps): boolean {
  if (bytes.length > longestPose) return false;
  reader.open(bytes);
  if (reader.read(4) !== poseVersion) return false;
  const { fingers, body } = packet;
  packet.jump = readFlag();
  packet.hasBody = readFlag();
  packet.headTracking = readFlag() ? 'tracked' : 'emulated';
  for (const side of sides) if (!takeState(packet, side, reader.read(stateBits))) return false;
  packet.timeMs = reader.read(timeBits);
  if (!readHead(packet) || !readHand(packet, 'left') || !readHand(packet, 'right')) return false;
  for (const side of sides) {
    const { known, levels } = fingers[side];
    if (!known) continue;
    for (let i = 0; i < fingerFields.length; i++) levels[i] = reader.read(fingerFields[i]!.bits);
  }
  return (!packet.hasBody || readBody(reader, body)) && reader.ended();
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

function readHand({ hands }: PacketSteps, side: Side): boolean {
  const hand = hands[side];
  if (!hand.placed) return true;
  return readHandPlace(reader, hand.at.place) && readQuat(reader, trackedBits, hand.at.orientation) !== null;
}

function readBody(from: BitReader, body: BodySteps): boolean {
  const { trunk, arms } = body;
  const bits = bodyBitsFor(arms);
  body.bits = bits;
  const hips = readQuat(from, bits.trunk, trunk.hips);
  const upperChest = readQuat(from, bits.trunk, trunk.upperChest);
  const neck = readQuat(from, bits.trunk, trunk.neck);
  const spineTwist = readStep(from, bits.twist);
  const chestTwist = readStep(from, bits.twist);
  if (!hips || !upperChest || !neck || spineTwist === null || chestTwist === null) return false;
  trunk.spineTwist = spineTwist;
  trunk.chestTwist = chestTwist;
  return readArm(from, body, 'left') && readArm(from, body, 'right');
}

function readArm(from: BitReader, { bits, arms }: BodySteps, side: Side): boolean {
  const arm = arms[side];
  const u = readStep(from, bits.clavicle);
  const v = readStep(from, bits.clavicle);
  const swivel = readStep(from, swivelBits);
  const forearmTwist = readStep(from, forearmBits);
  if (u === null || v === null || swivel === null || forearmTwist === null) return false;
  arm.clavicleU = u;
  arm.clavicleV = v;
  arm.swivel = swivel;
  arm.forearmTwist = forearmTwist;
  if (!arm.free) {
    const stretch = readStep(from, stretchBits);
    if (stretch !== null) arm.stretch = stretch;
    return stretch !== null;
  }
  const direction = readDirection(from, directionBits, arm.direction);
  arm.flexion = from.read(flexionBits);
  const hand = readQuat(from, freeHandBits, arm.hand);
  arm.stretch = 0;
  return direction !== null && hand !== null;
}
