// "threepoint-rooms/react": a component of react-three-fiber for the other people of a room.
import { useFrame } from '@react-three/fiber';
import { createElement, type ReactElement, type Ref, useEffect, useImperativeHandle, useRef, useState } from 'react';
import { type JoinedRoom, type JoinRoomOptions, joinRoom } from '../drawing/join-room';

/**
 * Props of `RoomAvatars`: the options of `joinRoom` and the server's address. A change of `url`, `room`, `name` or
 * `body` leaves the room and joins again; the other options are read on joining.
 */
export interface RoomAvatarsProps extends JoinRoomOptions {
  /** The server's address, with the path of `attachRooms` if it has one. */
  readonly url: string | URL;
  /** Receives the room once it is joined; null before and afterwards. */
  readonly ref?: Ref<JoinedRoom>;
}

/**
 * Joins a room and draws its other people in a Canvas of react-three-fiber; leaves it when unmounted. Place it in the
 * scene. A room that cannot be joined throws to the nearest error boundary.
 *
 * @example
 * const [tracker, setTracker] = useState(null);
 * return (
 *   <Canvas>
 *     <SelfAvatar avatar="/avatars/me.vrm" ref={setTracker} />
 *     {tracker && <RoomAvatars url="https://example.org" name="Ada" body={tracker} />}
 *   </Canvas>
 * );
 */
export function RoomAvatars(props: RoomAvatarsProps): ReactElement | null {
  const { room, name, body } = props;
  const url = String(props.url);
  const [joined, setJoined] = useState<JoinedRoom | null>(null);
  const [error, setError] = useState<unknown>(null);
  const live = useRef<JoinedRoom | null>(null);
  const newest = useRef(props);
  /** Resolves when the room before was left: two connections of one page would compete for its seat. */
  const before = useRef(Promise.resolve());
  useEffect(() => {
    newest.current = props;
  });
  // biome-ignore lint/correctness/useExhaustiveDependencies: reason: `room`, `name` and `body` are read from `newest`
  useEffect(() => {
    let mounted = true;
    const join = async (): Promise<void> => {
      if (!mounted) return;
      const { url: _, ref: __, ...options } = newest.current;
      const entered = await joinRoom(url, options);
      if (!mounted) {
        entered.leave();
        return;
      }
      live.current = entered;
      setJoined(entered);
    };
    before.current = before.current.then(join).catch((error: unknown) => {
      if (mounted) setError(error);
    });
    return () => {
      mounted = false;
      live.current?.leave();
      live.current = null;
      setJoined(null);
    };
  }, [url, room, name, body]);
  if (error !== null) throw error;
  useImperativeHandle(props.ref, () => joined as JoinedRoom, [joined]);
  useFrame(() => live.current?.update(performance.now()));
  return joined && createElement('primitive', { object: joined.others.object });
}
