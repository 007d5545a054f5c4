// What one writes first with socket.io: every pose is emitted to the room as it comes. Its defaults, WebSocket only.
import { createServer } from 'node:http';
import type { AddressInfo } from 'node:net';
import { Server } from 'socket.io';
import { answerAsRelay } from './conversation';

const server = createServer();
const io = new Server(server, { path: '/relay', transports: ['websocket'], serveClient: false });
io.on('connection', (socket) => {
  const { room, seat } = socket.handshake.query;
  void socket.join(String(room));
  socket.on('pose', (bytes: Buffer) => {
    socket.to(String(room)).emit('pose', Number(seat), bytes);
  });
});
server.listen(0, '127.0.0.1', () => answerAsRelay((server.address() as AddressInfo).port));
