// The entries of threepoint-rooms for pages in TypeScript: compiled against the packed packages by `npm run test:full`.
import { createElement } from 'react';
import type { Scene, WebGLRenderer } from 'three';
import { type Avatar, BodyTracker, loadMannequin } from 'threepoint/three';
import { maxPeerPacketBytes, PoseSender, type RemotePose, RemotePoses } from 'threepoint-rooms';
import { RoomAvatars } from 'threepoint-rooms/react';
import { type JoinedRoom, joinRoom, placementOf, RemoteBodies } from 'threepoint-rooms/three';

/** A room of a server, with the wearer's body and those of the others. */
export async function inARoom(renderer: WebGLRenderer, scene: Scene): Promise<JoinedRoom> {
  const body = new BodyTracker(renderer, { avatar: await loadMannequin() });
  const avatar = (reference: string): Promise<Avatar> => {
    console.log(reference);
    return loadMannequin();
  };
  const room = await joinRoom('https://example.org', { name: 'Ada', body, room: 'lunch', circle: 2, avatar });
  scene.add(body.object, room.others.object);
  renderer.setAnimationLoop((timeMs, frame) => {
    body.update(timeMs, frame);
    room.update(timeMs);
    console.log(room.status.phase, room.seat, ...room.others.people.map(({ name, presence }) => `${name} ${presence}`));
  });
  return room;
}

/** Draws the others in react-three-fiber. */
export const othersOf = (body: BodyTracker) =>
  createElement(RoomAvatars, { url: 'https://example.org', name: 'Ada', body, ref: (room) => console.log(room?.seat) });

/** A transport of the page, with bodies in a scene. */
export function overAChannel(channel: RTCDataChannel, body: BodyTracker, scene: Scene): (timeMs: number) => void {
  const others = new RemoteBodies({ maxPeers: 1 });
  others.addEventListener('peertimeout', ({ peer }) => console.log(peer));
  scene.add(others.object);
  channel.onmessage = ({ data }: MessageEvent<ArrayBuffer>) => others.receive(performance.now(), 'peer', data);
  const sender = new PoseSender((bytes) => channel.send(bytes), { name: 'Ada', rateHz: 30 });
  return (timeMs) => {
    sender.update(timeMs, body, { placement: placementOf(body.avatar.object) });
    others.update(timeMs);
  };
}

/** Poses without three.js. */
export function elbowsOf(packets: readonly Uint8Array[], timeMs: number): (number | undefined)[] {
  const poses = new RemotePoses();
  poses.addEventListener('refused', ({ peer, reason }) => console.log(peer, reason));
  for (const bytes of packets) if (bytes.length <= maxPeerPacketBytes) poses.receive(timeMs, 'ada', bytes);
  return poses.update(timeMs).map(({ joints }: RemotePose) => joints?.leftLowerArm.position.y);
}
