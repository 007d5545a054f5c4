// A server of Node with rooms next to an address of its own, and a person's packets without a page.
import { once } from 'node:events';
import { createServer } from 'node:http';
import { Body } from 'threepoint';
import { attachRooms } from 'threepoint-relay';
import { PoseSender, RemotePoses } from 'threepoint-rooms';

const server = createServer((_request, response) => response.end('my own page'));
const rooms = attachRooms(server, { logLevel: 'silent' });
await once(server.listen(0, '127.0.0.1'), 'listening');
const address = `http://127.0.0.1:${server.address().port}`;
console.log(`${await (await fetch(address)).text()}; ${await (await fetch(`${address}/api/rooms`)).text()}`);
const order = { method: 'POST', headers: { 'content-type': 'application/json' }, body: '{"room":"a","kind":"people"}' };
const { token } = await (await fetch(`${address}/api/rooms/token`, order)).json();
if (!token) throw new Error('The server issues no pass.');
await rooms.close();
server.close();

const body = new Body({ estimator: 'ik' });
const at = (x, y, z) => ({ position: { x, y, z }, orientation: { x: 0, y: 0, z: 0, w: 1 }, tracking: 'tracked' });
const poses = new RemotePoses();
const sender = new PoseSender((bytes) => poses.receive(0, 'ada', bytes), { name: 'Ada' });
body.update({ time: 0, head: at(0, 1.6, 0), leftHand: at(-0.25, 0.9, -0.3), rightHand: at(0.25, 0.9, -0.3) });
sender.update(0, body);
const [ada] = poses.update(100);
console.log(`The elbow of ${ada.name} is ${ada.joints.leftLowerArm.position.y.toFixed(2)} m above the floor.`);
