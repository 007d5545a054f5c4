import { TokenBucket } from '../../room/token-bucket';

/**
 * The most frames of any kind that a connection may send [1/s], before and after it joins a room: messages, poses,
 * acknowledgements, pings and pongs. A page sends 40 poses, 20 messages and 20 signals a second (80 signals in a
 * burst), and after an outage what it queued for 5 s.
 */
const framesPerSecond = 300;

/**
 * Returns a function that counts a frame of one connection and returns whether to handle it. Once the limit is exceeded
 * no further frame is handled, and `onFlood` is called once. `now`: seconds, monotonic.
 */
export function createFloodLimiter(now: () => number, onFlood: () => void): () => boolean {
  const bucket = new TokenBucket(framesPerSecond);
  let isFlooded = false;
  return () => {
    if (isFlooded || bucket.take(now())) return !isFlooded;
    isFlooded = true;
    // Earlier packets are still on their way through socket.io, which takes a tick for each.
    setImmediate(onFlood);
    return false;
  };
}
