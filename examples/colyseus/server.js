import { Room, Server } from '@colyseus/core';
import { WebSocketTransport } from '@colyseus/ws-transport';
import express from 'express';

class Bodies extends Room {
  maxClients = 16;

  onCreate() {
    this.onMessageBytes('body', (client, bytes) => {
      this.broadcast('body', [client.sessionId, bytes], { except: client });
    });
  }

  onLeave(client) {
    this.broadcast('left', client.sessionId);
  }
}

const server = new Server({
  transport: new WebSocketTransport(),
  express: (app) => app.use(express.static('dist')),
});
server.define('bodies', Bodies);
server.listen(Number(process.env.PORT ?? 8080));
