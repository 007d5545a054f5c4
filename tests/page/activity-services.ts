import { Group, Scene } from 'three';
import { createPageClock, defaultAvatar, defaultCalibration, MutablePointer } from 'threepoint/core';
import { GazeTargets } from 'threepoint/internal/three';
import { vec3 } from 'threepoint/math';
import type { StudyRun } from 'threepoint-study/participant';
import { type Notice, ServerPresence } from 'threepoint-ui';
import type { ActivityServices } from '../../src/page/activity/activity-context';
import type { Surroundings } from '../../src/page/scene/surroundings';
import type { Pointers } from '../../src/page/shell/input/pointers';
import type { PageStudy } from '../../src/page/shell/session/page-study';
import { createSettings, SettingsWriter, type StoredSettings } from '../../src/page/shell/session/settings';
import { readSwitches } from '../../src/page/shell/session/switches';
import { fetchBuiltInAvatar } from '../../src/page/shell/stage/avatar-loader';
import { fake } from './shell/fake';

const ahead = { x: 0, y: 0, z: 0, w: 1 };

/** The pointers of a page without a session. */
export const noPointers = fake<Pointers>({ follow: () => undefined, steering: null });

/** The tracker and the body of a page without a session, for the average user. */
export const noSession = {
  tracker: { tracking: null, read: () => null },
  body: { userCalibration: defaultCalibration },
};

/** A study in which a participant plays, unless `members` say otherwise; it does nothing. */
export const studyRun = (members: Partial<StudyRun> = {}): StudyRun => ({
  object: new Group() as never,
  idle: false,
  paused: false,
  frame: () => undefined,
  point: () => undefined,
  sessionChanged: () => undefined,
  probe: () => {
    throw new Error('not asked for here');
  },
  ...members,
});

/** The services of a page with this address, which draws nothing, and what activities did with them. */
export function activityServices(address = '?seed=5&quality=low') {
  const { switches } = readSwitches(address);
  const settings = createSettings({ ...switches, actor: false }, { preferences: { sound: false } }, null);
  const kept: StoredSettings[] = [];
  const writer = new SettingsWriter(
    settings,
    { remember: (part) => void kept.push(part as StoredSettings) },
    () => undefined,
  );
  const places: (Surroundings | null)[] = [];
  const notices: Notice[] = [];
  const captions: string[] = [];
  const headset = { worn: false, emulator: null };
  const aims = { enabled: false };
  const mouse = {
    x: 0,
    y: 0.1,
    pressed: false,
    cancelled: false,
    setEnabled(on: boolean) {
      aims.enabled = on;
    },
  };
  const mousePointer = new MutablePointer('mouse');
  mousePointer.setRay(vec3(0, 1.6, 0), vec3(0, 0, -1));
  const study: PageStudy = { run: null, runners: {} };
  const services = {
    quality: 'low',
    clock: createPageClock(() => 0),
    settings,
    writer,
    switches,
    stage: {
      studio: { scene: new Scene(), setSurroundings: (place: Surroundings | null) => void places.push(place) },
      view: {
        pose: { position: vec3(0, 1.6, 2), orientation: ahead },
        rayThrough: () => ({ origin: vec3(0, 1.6, 0), direction: vec3(0, 0, -1) }),
      },
    },
    pointer: () => (settings.mouse && !headset.worn ? mousePointer : null),
    headset,
    body: { calibration: defaultCalibration },
    avatar: { isBuiltIn: true, worn: defaultAvatar },
    fetchBuiltInAvatar,
    gazeTargets: new GazeTargets(),
    server: new ServerPresence('http://127.0.0.1:9', () => undefined),
    notices: { show: (level, text) => void notices.push({ level, text }), withdraw: () => undefined },
    calm: { matches: false },
    study,
    onCaption: (text) => void captions.push(text),
    onChange: () => undefined,
  } satisfies ActivityServices;
  return { services, mouse, settings, writer, headset, study, kept, places, notices, captions, aims };
}
