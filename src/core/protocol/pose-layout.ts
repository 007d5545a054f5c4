import type { Side } from '../math/side';
import { type BitReader, type BitWriter, createBitReader, createBitWriter } from './bits';
import { fingerFields } from './finger-steps';
import { longestPose, poseVersion } from './pose-packet';
import {
  type BodySteps,
  bodyBitsFor,
  directionBits,
  flexionBits,
  forearmBits,
  freeHandBits,
  handBits,
  headBits,
  heightBits,
  makePacketSteps,
  type PacketSteps,
  sides,
  stretchBits,
  swivelBits,
  type Tracking,
  trackedBits,
} from './pose-steps';
import { readDirection, readQuat, readStep, readVec, writeDirection, writeQuat, writeStep, writeVec } from './quantise';

const trackings: readonly Tracking[] = ['lost', 'emulated', 'tracked'];

const writer = createBitWriter();
const reader = createBitReader(new Uint8Array(0));

const writeFlag = (set: boolean): void => writer.write(set ? 1 : 0, 1);
const readFlag = (): boolean => reader.read(1) === 1;

/** The bytes of a packet. */
export function writePacket(packet: PacketSteps): Uint8Array {
  const { head, hands, fingers, body, hasBody } = packet;
  writer.clear();
  writer.write(poseVersion, 4);
  writeFlag(packet.jump);
  writeFlag(hasBody);
  writeFlag(packet.headTracking === 'tracked');
  for (const side of sides) writeFlag(fingers[side].known);
  for (const side of sides) writeFlag(hasBody && body.arms[side].free);
  for (const side of sides) writer.write(trackings.indexOf(hands[side].tracking), 2);
  writer.write(packet.timeMs, 16);
  writeStep(writer, head.position.x, headBits);
  writeStep(writer, head.position.y, heightBits);
  writeStep(writer, head.position.z, headBits);
  writeQuat(writer, head.orientation, trackedBits);
  for (const side of sides) {
    const { placed, at } = hands[side];
    if (!placed) continue;
    writeVec(writer, at.position, handBits);
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

/** Steps of no one, to see how long a packet with such flags is. */
const anyone = makePacketSteps();
/** By the eleven flags of a packet [bytes]; 0: there is no such packet. */
const lengths: (number | undefined)[] = [];

function lengthWith(flags: number): number {
  const flag = (bit: number): boolean => ((flags >> bit) & 1) === 1;
  const { hands, fingers, body } = anyone;
  const { left, right } = hands;
  anyone.hasBody = flag(9);
  [fingers.left.known, fingers.right.known] = [flag(7), flag(6)];
  [body.arms.left.free, body.arms.right.free] = [flag(5), flag(4)];
  const trackingOf = (bits: number): Tracking | undefined => trackings[bits & 3];
  const [tracking, other] = [trackingOf(flags >> 2), trackingOf(flags)];
  if (tracking === undefined || other === undefined) return 0;
  left.placed = anyone.hasBody || tracking !== 'lost';
  right.placed = anyone.hasBody || other !== 'lost';
  body.bits = bodyBitsFor(body.arms);
  return writePacket(anyone).length;
}

/** How long the packet that begins at this byte is, by its flags alone [bytes]; 0: no packet begins so. */
export function packetLengthAt(bytes: Uint8Array, at: number): number {
  const flags = (((bytes[at]! & 0x0f) << 8) | (bytes[at + 1] ?? 0)) >> 1;
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

/** Reads the numbers of a packet into `packet`; false for anything that `encodePose` never writes. */
export function readPacket(bytes: Uint8Array, packet: PacketSteps): boolean {
  if (bytes.length > longestPose) return false;
  reader.open(bytes);
  if (reader.read(4) !== poseVersion) return false;
  const { hands, fingers, body } = packet;
  packet.jump = readFlag();
  packet.hasBody = readFlag();
  packet.headTracking = readFlag() ? 'tracked' : 'emulated';
  for (const side of sides) fingers[side].known = readFlag();
  for (const side of sides) body.arms[side].free = readFlag();
  for (const side of sides) {
    const tracking = trackings[reader.read(2)];
    if (tracking === undefined) return false;
    hands[side].tracking = tracking;
  }
  packet.timeMs = reader.read(16);
  for (const side of sides) {
    const { free } = body.arms[side];
    if (free && !packet.hasBody) return false;
    if (fingers[side].known && (free || hands[side].tracking === 'lost')) return false;
  }
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

function readHand({ hands, hasBody }: PacketSteps, side: Side): boolean {
  const hand = hands[side];
  hand.placed = hand.tracking !== 'lost' || hasBody;
  if (!hand.placed) return true;
  const position = readVec(reader, handBits, hand.at.position);
  const orientation = readQuat(reader, trackedBits, hand.at.orientation);
  return position !== null && orientation !== null;
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
