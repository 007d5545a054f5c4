import { type Calibration, writeRecording } from 'threepoint/core';
import type { Notice } from 'threepoint-ui';
import { describe, expect, test, vi } from 'vitest';
import { FileOpener } from '../../../../src/page/shell/input/file-opener';
import { AvatarStore } from '../../../../src/page/shell/stage/avatar-store';
import type { StageParts } from '../../../../src/page/shell/stage/stage-parts';
import { Recorder } from '../../../../src/page/studio/recorder';
import { headFrame } from '../../frames';
import { fake } from '../fake';

const person: Calibration = { eyeHeight: 1.72, armSpan: 1.7 };

/** A file of one second of this person. */
const recordingFile = (name = 'walk.json') =>
  new File(
    [
      writeRecording({
        device: 'a test',
        rateHz: 72,
        calibration: person,
        frames: [headFrame(1, 1.7), headFrame(2, 1.7)],
      }),
    ],
    name,
  );

/** A file of this size [MB]; whether its bytes were asked for. */
function largeFile(name: string, megabytes: number) {
  const file = new File(['{}'], name);
  const asked = { bytes: false };
  Object.defineProperties(file, {
    size: { value: megabytes * 2 ** 20 },
    arrayBuffer: {
      value: async () => {
        asked.bytes = true;
        return new ArrayBuffer(2);
      },
    },
  });
  return { file, asked };
}

/** A recording whose bytes come when `arrive` is called. */
function slowRecording(name: string) {
  const file = recordingFile(name);
  let arrive = (): void => undefined;
  const arrival = new Promise<void>((resolve) => {
    arrive = resolve;
  });
  const bytes = file.arrayBuffer();
  Object.defineProperty(file, 'arrayBuffer', { value: () => arrival.then(() => bytes) });
  return { file, arrive };
}

/** The part of a browser's Cache Storage that stores files, in memory. */
function cacheStorage(): CacheStorage {
  const caches = new Map<string, Map<string, Response>>();
  const open = async (name: string) => {
    const cache = caches.get(name) ?? new Map<string, Response>();
    caches.set(name, cache);
    return { put: async (address: string, response: Response) => void cache.set(address, response) };
  };
  const match = async (address: string, { cacheName = '' }: MultiCacheQueryOptions = {}) =>
    caches.get(cacheName)?.get(address)?.clone();
  return { open, match, delete: async (name: string) => caches.delete(name) } as unknown as CacheStorage;
}

/** The files of a page, with its real recorder; what they do to body and avatar is written down. */
function files(caches: CacheStorage | null = cacheStorage()) {
  const notices: Notice[] = [];
  const done: string[] = [];
  const opened: (string | File)[] = [];
  const mocap: (readonly (string | File)[])[] = [];
  const recorder = new Recorder();
  return {
    notices,
    done,
    opened,
    mocap,
    recorder,
    files: new FileOpener(
      fake<StageParts>({
        recorder,
        notices: {
          show: (level: Notice['level'], text: string) => void notices.push({ level, text }),
          withdraw: () => undefined,
        },
        avatar: {
          notes: ['no hand follows LowerArm.L: a joint was made where that arm ends'],
          name: 'robot.vrm',
          ownFile: { name: 'robot.vrm', file: new Blob(['robot']) },
          async open(source: string | File) {
            opened.push(source);
            return true;
          },
          openBuiltIn: async () => true,
          applyBones: async () => true,
          waiting: null,
        },
        mocap: { open: async (sources: readonly (string | File)[]) => void mocap.push(sources) },
        body: { discontinuity: () => void done.push(`the body begins anew while ${recorder.mode}`) },
        onChange: () => void done.push('shown'),
      }),
      new AvatarStore(caches),
    ),
  };
}

describe('a dropped file', () => {
  test('a recording of 300 MB is refused by a sentence before it is read', async () => {
    const { files: page, notices, recorder } = files();
    const { file, asked } = largeFile('walk.json', 300);
    await page.open(file);
    expect(notices).toEqual([
      {
        level: 'error',
        text: 'walk.json could not be replayed: larger than 100 MB, the limit for a recording',
      },
    ]);
    expect(asked.bytes).toBe(false);
    expect(recorder.mode).toBe('idle');
  });

  test('a recording is replayed at once, by the body of the person in it', async () => {
    const { files: page, notices, recorder, done } = files();
    await page.open(recordingFile());
    expect(notices).toEqual([]);
    expect(recorder.mode).toBe('replaying');
    expect(recorder.name).toBe('walk.json');
    expect(recorder.person).toEqual(person);
    expect(done).toEqual(['the body begins anew while replaying', 'shown']);
    recorder.stop();
    expect(recorder.person).toBeNull();
  });

  test('a file that is no recording leaves what was replayed as it was', async () => {
    const { files: page, notices, recorder } = files();
    await page.open(recordingFile('walk.json'));
    await page.open(new File(['{"frames": 3}'], 'other.JSON'));
    expect(notices).toHaveLength(1);
    expect(notices[0]?.text).toMatch(/^other\.JSON could not be replayed: /);
    expect(recorder.name).toBe('walk.json');
    expect(recorder.mode).toBe('replaying');
  });

  test('a recording leaves another that is being made as it is, and a sentence says so', async () => {
    const { files: page, notices, recorder } = files();
    recorder.record({ device: 'a test', rateHz: 72, calibration: person });
    recorder.observe(headFrame(1, 1.7));
    await page.open(recordingFile());
    recorder.observe(headFrame(2, 1.7));
    expect(notices).toEqual([
      { level: 'error', text: 'walk.json could not be replayed: a recording is in progress; stop it first' },
    ]);
    recorder.stop();
    expect([recorder.name, recorder.duration]).toEqual(['recording-1.json', 1]);
    await page.open(recordingFile());
    expect([recorder.name, recorder.mode]).toEqual(['walk.json', 'replaying']);
  });

  test('a recording read for longer than a later one comes too late, with a sentence', async () => {
    const { files: page, notices, recorder } = files();
    const { file, arrive } = slowRecording('slow.json');
    const slow = page.openRecording(file);
    await page.open(recordingFile('quick.json'));
    arrive();
    await slow;
    expect([recorder.name, recorder.mode]).toEqual(['quick.json', 'replaying']);
    expect(notices).toEqual([
      { level: 'error', text: 'slow.json could not be replayed: a newer recording was opened' },
    ]);
  });

  test('an earlier recording is replayed where the later file is no recording', async () => {
    const { files: page, recorder } = files();
    const { file, arrive } = slowRecording('slow.json');
    const slow = page.open(file);
    await page.open(new File(['{"frames": 3}'], 'broken.json'));
    arrive();
    await slow;
    expect([recorder.name, recorder.mode]).toEqual(['slow.json', 'replaying']);
  });

  test('another file is opened as an avatar; its name and assumptions are announced', async () => {
    const { files: page, notices, opened, recorder } = files();
    const file = new File(['glTF'], 'robot.vrm');
    await page.open(file);
    expect(opened).toEqual([file]);
    expect(recorder.mode).toBe('idle');
    const note = 'No hand follows LowerArm.L: a joint was made where that arm ends.';
    expect(notices).toEqual([{ level: 'info', text: `robot.vrm is your avatar now. ${note}` }]);
  });

  test('an opened avatar is shown again on later visits, until a built-in body is chosen', async () => {
    const caches = cacheStorage();
    await files(caches).files.open(new File(['glTF'], 'robot.vrm'));
    const next = files(caches);
    await next.files.openStoredAvatar();
    const stored = next.opened.filter((source) => source instanceof File);
    expect(stored.map(({ name }) => name)).toEqual(['robot.vrm']);
    expect(await stored[0]?.text()).toBe('robot');
    expect(next.notices).toEqual([]);

    vi.stubGlobal('location', { href: 'http://localhost/' });
    vi.stubGlobal('history', { replaceState: () => undefined });
    next.files.showBuiltInAvatar();
    const last = files(caches);
    await last.files.openStoredAvatar();
    expect(last.opened).toEqual([]);
  });

  test('an avatar that the browser does not store is announced with what to do', async () => {
    const full = async () => {
      throw new DOMException('no space is left', 'QuotaExceededError');
    };
    for (const caches of [null, { open: full, match: full } as unknown as CacheStorage]) {
      const { files: page, notices, opened } = files(caches);
      await page.openStoredAvatar();
      expect(opened).toEqual([]);
      await page.open(new File(['glTF'], 'robot.vrm'));
      expect(notices[0]?.text).toMatch(/ This browser cannot store it: open it again on your next visit\.$/);
    }
  });

  test.each([
    [
      'walk-ik.csv',
      'time,left_hand_seen,right_hand_seen,hips_x\n',
      /a table of joint positions, .* Open the recording/,
    ],
    ['trials.csv', '\uFEFF"simulated","participant","trial"\r\n', /a table of a study, for statistics, and holds no/],
    ['prices.tsv', 'year\tprice\n', /prices.tsv could not be opened: it is a table, for spreadsheets, and holds no/],
  ])('the table %s is refused by what it is and what it is for', async (name, text, sentence) => {
    const { files: page, notices, opened, mocap } = files();
    page.openAll([new File([text], name)], { asMotion: true });
    await expect.poll(() => notices.length).toBe(1);
    expect(notices[0]).toEqual({ level: 'error', text: expect.stringMatching(sentence) });
    expect([opened, mocap]).toEqual([[], []]);
  });

  test('motion capture goes with its skeleton, and a file that came with both is opened too', () => {
    const { files: page, opened, mocap } = files();
    const [motion, skeleton, robot] = ['01_02.AMC', '01.asf', 'robot.vrm'].map((name) => new File([''], name)) as [
      File,
      File,
      File,
    ];
    page.openAll([robot, motion, skeleton]);
    expect(mocap).toEqual([[motion, skeleton]]);
    expect(opened).toEqual([robot]);
  });

  test('takes JSON for a map beside motion and where it is one, else for a recording', async () => {
    const { files: page, mocap, recorder } = files();
    const [motion, map] = [new File(['HIERARCHY'], 'dance.bvh'), new File(['{"joints": {}}'], 'map.json')];
    page.openAll([map, motion]);
    expect(mocap).toEqual([[map, motion]]);
    await page.open(map);
    expect(mocap.at(-1)).toEqual([map]);
    await page.open(recordingFile());
    expect([mocap.length, recorder.name]).toEqual([2, 'walk.json']);
  });
});
