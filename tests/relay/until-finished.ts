import { onTestFinished } from 'vitest';
import { WebSocket } from 'ws';
import { arrive, rawGuest, startRelay } from './running-relay';

/** Starts a relay that is closed at the end of the test. */
export async function relayOfTest(environment?: Record<string, string>) {
  const relay = await startRelay(environment);
  onTestFinished(() => relay.close());
  return relay;
}

/** Joins a room over a raw socket, which is disconnected at the end of the test. */
export async function guestOfTest(...parameters: Parameters<typeof rawGuest>) {
  const guest = await rawGuest(...parameters);
  onTestFinished(() => void guest.socket.disconnect());
  return guest;
}

/** Connects a person, who leaves at the end of the test. */
export function personOfTest(...parameters: Parameters<typeof arrive>) {
  const person = arrive(...parameters);
  onTestFinished(() => person.stop());
  return person;
}

/** Opens a WebSocket of the relay, which is terminated at the end of the test; `query` begins with an ampersand. */
export function socketOfTest(url: string, query = ''): WebSocket {
  const socket = new WebSocket(`${url.replace('http', 'ws')}/relay/?EIO=4&transport=websocket${query}`);
  onTestFinished(() => socket.terminate());
  return socket;
}
