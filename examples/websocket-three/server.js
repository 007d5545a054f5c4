import express from 'express';
import { maxPeerPacketBytes } from 'threepoint-rooms';
import { WebSocket, WebSocketServer } from 'ws';

const app = express().use(express.static('dist'));
const sockets = new WebSocketServer({ server: app.listen(process.env.PORT ?? 8080), maxPayload: maxPeerPacketBytes });
let people = 0;

sockets.on('connection', (socket) => {
  // The server numbers the senders: no packet can claim to be another person's.
  const number = Buffer.alloc(4);
  number.writeUInt32BE(++people);
  const passOn = (packet) => {
    for (const other of sockets.clients) {
      if (other !== socket && other.readyState === WebSocket.OPEN) other.send(Buffer.concat([number, packet]));
    }
  };
  socket.on('message', passOn);
  socket.on('close', () => passOn(Buffer.alloc(0)));
  socket.on('error', console.warn);
});
