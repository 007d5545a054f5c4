// "threepoint/react": components of react-three-fiber for the user's body and for the bodies of others.
import { useFrame, useThree } from '@react-three/fiber';
import {
  createElement,
  type ReactElement,
  type Ref,
  type RefObject,
  useEffect,
  useImperativeHandle,
  useRef,
  useState,
} from 'react';
import type { Avatar } from '../avatar/avatar';
import type { AvatarPose } from '../core/body/avatar-pose';
import { type Calibration, defaultCalibration } from '../core/body/calibration';
import type { BoneMap } from '../core/humanoid/bones';
import { type AvatarSource, loadAvatar } from './avatar-source';
import type { BodyEvent, BodyEvents } from './body-events';
import { BodyTracker, type BodyTrackerOptions } from './body-tracker';

/** The prop that receives each event of a tracker. */
const callbackNames = {
  calibrated: 'onCalibrated',
  heightmismatch: 'onHeightMismatch',
  fallback: 'onFallback',
  estimatorchange: 'onEstimatorChange',
  discontinuity: 'onDiscontinuity',
  trackinglost: 'onTrackingLost',
  trackingfound: 'onTrackingFound',
  trackermismatch: 'onTrackerMismatch',
  sessionstart: 'onSessionStart',
  sessionend: 'onSessionEnd',
} as const satisfies Record<keyof BodyEvents, string>;

type EventName = keyof typeof callbackNames;

/** Callbacks of a tracker's events; the newest props are called. With `onFallback` the console has no warning. */
export type SelfAvatarCallbacks = {
  readonly [Name in EventName as (typeof callbackNames)[Name]]?: (event: BodyEvent<Name>) => void;
};

export interface LoadedAvatarProps {
  /** The avatar's URL, file or bytes, as in `loadAvatar`. A change loads another avatar. */
  readonly avatar: AvatarSource;
  /** The names of the nodes for a humanoid's bones, as in `loadAvatar`; read when the avatar is loaded. */
  readonly bones?: BoneMap;
}

/**
 * Props of `SelfAvatar`: the avatar, the options of a BodyTracker and callbacks. `estimator` and `calibration` may
 * change at any time; the other options are read when the avatar has loaded.
 */
export interface SelfAvatarProps extends LoadedAvatarProps, Omit<BodyTrackerOptions, 'avatar'>, SelfAvatarCallbacks {
  /**
   * Called after each frame of a session that has a pose, floor frame [m]. The next frame overwrites the pose: keep it
   * with `copyAvatarPose`, or send it at once.
   */
  readonly onPose?: (pose: AvatarPose) => void;
  /** Receives the tracker once the avatar has loaded; null before and afterwards. */
  readonly ref?: Ref<BodyTracker>;
}

export interface RemoteAvatarProps extends LoadedAvatarProps {
  /**
   * The pose to draw, floor frame [m], with its fingers if it has any; null hides the body. A ref is read in each
   * frame, so that a new pose does not render the component.
   */
  readonly pose: AvatarPose | null | RefObject<AvatarPose | null>;
  /** The measures of the person behind the pose [m]: `tracker.calibration` of their page. Default: an average adult. */
  readonly calibration?: Calibration;
  /** Receives the avatar once it has loaded; null before and afterwards. */
  readonly ref?: Ref<Avatar>;
}

interface Disposable {
  dispose(): unknown;
}

interface Loaded<Made> {
  /** The object for rendering. */
  readonly made: Made | null;
  /** The object for frames and effects; null as soon as it is disposed of. */
  readonly live: RefObject<Made | null>;
  /** Throws an error in the next rendering: an error boundary receives it. */
  readonly fail: (error: unknown) => void;
}

/**
 * Loads an avatar and creates an object from it, which is disposed of when the component unmounts or the source
 * changes. An error of loading is thrown while rendering.
 */
function useLoaded<Made extends Disposable>(
  { avatar: source, bones }: LoadedAvatarProps,
  owner: object,
  make: (avatar: Avatar) => Made,
): Loaded<Made> {
  const [made, setMade] = useState<Made | null>(null);
  const [fault, setFault] = useState<unknown>(null);
  const live = useRef<Made | null>(null);
  const newest = useRef({ bones, make });
  useEffect(() => {
    newest.current = { bones, make };
  });
  // biome-ignore lint/correctness/useExhaustiveDependencies: reason: the owner, a renderer, is what `make` binds
  useEffect(() => {
    let mounted = true;
    const finish = (avatar: Avatar): void => {
      if (!mounted) {
        avatar.dispose();
        return;
      }
      try {
        live.current = newest.current.make(avatar);
      } catch (error) {
        avatar.dispose();
        throw error;
      }
      setMade(live.current);
    };
    const options = newest.current.bones ? { bones: newest.current.bones } : {};
    loadAvatar(source, options)
      .then(finish)
      .catch((error: unknown) => mounted && setFault(error));
    return () => {
      mounted = false;
      const gone = live.current;
      live.current = null;
      setMade(null);
      gone?.dispose();
    };
  }, [source, owner]);
  if (fault !== null) throw fault;
  return { made, live, fail: setFault };
}

/**
 * Draws the user's body in a Canvas of react-three-fiber, also within `<XR>` of @react-three/xr. It is hidden without a
 * session. Place it where the camera is: in the scene, or in the `<XROrigin>` that moves the user. If the avatar cannot
 * be loaded or an option is invalid, the error is thrown to the nearest error boundary.
 *
 * @example
 * <Canvas>
 *   <XR store={store}>
 *     <SelfAvatar avatar="/avatars/me.vrm" onPose={send} onSessionEnd={() => send(null)} />
 *   </XR>
 * </Canvas>
 */
export function SelfAvatar(props: SelfAvatarProps): ReactElement | null {
  const renderer = useThree(({ gl }) => gl);
  const newest = useRef(props);
  useEffect(() => {
    newest.current = props;
  });
  const {
    made: tracker,
    live,
    fail,
  } = useLoaded(props, renderer, (avatar) => {
    const created = new BodyTracker(renderer, { ...optionsOf(newest.current), avatar });
    listen(created, newest);
    return created;
  });
  const { estimator = 'learned', calibration = 'auto' } = props;
  // Equal measures in another object are no change.
  const measures = JSON.stringify(calibration);
  useEffect(() => {
    const current = tracker && live.current;
    if (current && current.body.selectedEstimator !== estimator) current.setEstimator(estimator).catch(fail);
  }, [tracker, live, fail, estimator]);
  const given = useRef(measures);
  // biome-ignore lint/correctness/useExhaustiveDependencies: reason: `measures` stands for the calibration
  useEffect(() => {
    if (tracker && given.current !== measures) live.current?.calibrate(calibration);
    given.current = measures;
  }, [tracker, measures]);
  useImperativeHandle(props.ref, () => tracker as BodyTracker, [tracker]);
  useFrame((_state, _delta, frame) => {
    const current = live.current;
    if (!current) return;
    current.update(performance.now(), frame);
    if (frame && current.pose) newest.current.onPose?.(current.pose);
  });
  return tracker && createElement('primitive', { object: tracker.object });
}

/** Returns the props that are options of a tracker. */
function optionsOf(props: SelfAvatarProps): Omit<BodyTrackerOptions, 'avatar'> {
  const { avatar: _, bones: __, ref: ___, onPose: ____, ...others } = props;
  const callbacks: readonly string[] = Object.values(callbackNames);
  return Object.fromEntries(Object.entries(others).filter(([name]) => !callbacks.includes(name)));
}

/** Passes the tracker's events to the newest callbacks. */
function listen(tracker: BodyTracker, props: RefObject<SelfAvatarProps>): void {
  for (const type of Object.keys(callbackNames) as EventName[]) {
    tracker.addEventListener(type, (event) => {
      const callback = props.current[callbackNames[type]] as ((event: Event) => void) | undefined;
      if (callback) event.preventDefault();
      callback?.(event);
    });
  }
}

/**
 * Draws the body of another person from a pose that their page sent, in the frame of the component's parent. The avatar
 * is scaled to `calibration`. If it cannot be loaded, the error is thrown to the nearest error boundary.
 *
 * @example
 * const pose = useRef(null);
 * useEffect(() => socket.on('pose', (received) => { pose.current = received; }), []);
 * return <RemoteAvatar avatar="/avatars/them.vrm" pose={pose} calibration={theirs} />;
 */
export function RemoteAvatar(props: RemoteAvatarProps): ReactElement | null {
  const newest = useRef(props);
  useEffect(() => {
    newest.current = props;
  });
  const { made: avatar, live } = useLoaded(props, RemoteAvatar, (loaded) => {
    loaded.object.visible = false;
    return loaded;
  });
  const measures = JSON.stringify(props.calibration);
  // biome-ignore lint/correctness/useExhaustiveDependencies: reason: `measures` stands for the calibration
  useEffect(() => {
    if (avatar) live.current?.setCalibration(props.calibration ?? defaultCalibration);
  }, [avatar, measures]);
  useImperativeHandle(props.ref, () => avatar as Avatar, [avatar]);
  useFrame(() => {
    const current = live.current;
    if (!current) return;
    const { pose } = newest.current;
    const shown = pose && 'current' in pose ? pose.current : pose;
    current.object.visible = Boolean(shown);
    if (shown) current.setPose(shown, performance.now() / 1000);
  });
  return avatar && createElement('primitive', { object: avatar.object });
}
