import { spawnSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { parseRecording, type Recording } from 'threepoint/core';
import { beforeAll, describe, expect, test } from 'vitest';
import type { StudyRecord } from '../../../../src/study/model/records/study-record';
import { bidsDataset } from '../../../../src/study/server/export/bids';
import { installed } from '../../../server/installed';
import { directoryWith } from '../../../temporary-directory';
import { completed, paperPlan } from '../../model/studies';
import { epoch, frameSeconds, playedRound, type RoundTroubles } from '../../participant/played-round';

const troubles: readonly RoundTroubles[] = [
  {},
  { paused: (second) => second > 9 && second < 29 },
  {
    handless: (second) => second < 0.5 || (second > 20 && second < 21),
    headless: (second) => second > 5 && second < 8,
  },
];

interface RecordedRound {
  readonly path: string;
  readonly recording: Recording;
  readonly landed: readonly number[];
  readonly began: number;
}

/**
 * Two participants who played archery with consent to motion, one block of P01 voided; everything of it in one data
 * set.
 */
function playedStudy() {
  const rounds: RecordedRound[] = [];
  const motion: { participant: string; trial: string; text: string }[] = [];
  const records = ['P01', 'P02'].flatMap((participant, person) => {
    let number = 0;
    return completed(participant, { motion: true }).map((record): StudyRecord => {
      if (record.kind !== 'trial' || record.body.condition === null || record.body.place.task !== 'archery')
        return record;
      const { outcome, recording, landed, began } = playedRound(
        troubles[(number + person) % 3] ?? {},
        100 * number + 45.6,
      );
      number += 1;
      if (recording === null) throw new Error('nothing was recorded');
      motion.push({ participant, trial: record.id, text: recording });
      const path = `sub-${participant}/motion/sub-${participant}_task-archery_tracksys-webxr_run-${number}`;
      rounds.push({ path, recording: parseRecording(recording), landed, began });
      return { ...record, body: { ...record.body, outcome } };
    });
  });
  return { records, motion, rounds };
}

const rowsOf = (text: string) =>
  text
    .trimEnd()
    .split('\n')
    .map((line) => line.split('\t'));

function tableOf(text: string): readonly Readonly<Record<string, string>>[] {
  const [header = [], ...rows] = rowsOf(text);
  return rows.map((row) => Object.fromEntries(header.map((name, i) => [name, row[i] ?? ''])));
}

describe('the motion of a study as BIDS', () => {
  let study: ReturnType<typeof playedStudy>;
  let files: Readonly<Record<string, string>>;
  beforeAll(() => {
    study = playedStudy();
    const content = { plan: paperPlan(), simulated: false, records: study.records, motion: study.motion };
    const dataset = bidsDataset(content);
    expect(dataset.leftOut).toEqual([]);
    files = dataset.files;
  });
  const read = (path: string): string => {
    const text = files[path];
    if (text === undefined) throw new Error(`the data set has no ${path}`);
    return text;
  };
  const channelsOf = (path: string) => tableOf(read(`${path}_channels.tsv`));

  test('has a run for every recording, its channels and rates beside it', () => {
    const runs = Object.keys(files).filter((path) => path.endsWith('_motion.tsv'));
    expect(runs.toSorted()).toEqual(study.rounds.map(({ path }) => `${path}_motion.tsv`).toSorted());
    for (const { path, recording } of study.rounds) {
      const sidecar = JSON.parse(read(`${path}_motion.json`));
      const channels = channelsOf(path);
      expect(sidecar).toMatchObject({
        TaskName: 'archery',
        SamplingFrequency: 72,
        TrackedPointsCount: 3,
        MissingValues: 'n/a',
      });
      expect(sidecar.MotionChannelCount).toBe(channels.length);
      for (const type of ['POS', 'ORNT', 'LATENCY', 'VEL'])
        expect(sidecar[`${type}ChannelCount`]).toBe(channels.filter((channel) => channel.type === type).length);
      const rows = rowsOf(read(`${path}_motion.tsv`));
      expect(rows).toHaveLength(recording.frames.length);
      for (const row of rows) expect(row).toHaveLength(channels.length);
    }
  });

  test('tells every frame as it was recorded, n/a where a hand was lost', () => {
    for (const { path, recording } of study.rounds) {
      const names = channelsOf(path).map(({ name }) => name);
      const first = recording.frames[0]?.time ?? Number.NaN;
      for (const [index, row] of rowsOf(read(`${path}_motion.tsv`)).entries()) {
        const frame = recording.frames[index];
        if (!frame) throw new Error('a row too many');
        const value = (name: string) => row[names.indexOf(name)] ?? '';
        expect(Number(value('latency'))).toBeCloseTo(frame.time - first, 6);
        for (const [point, pose] of [
          ['Head', frame.head],
          ['LeftWrist', frame.leftHand],
          ['RightWrist', frame.rightHand],
        ] as const) {
          const told = ['x', 'y', 'z', 'quat_x', 'quat_y', 'quat_z', 'quat_w'].map((part) => value(`${point}_${part}`));
          if (pose === null || (point !== 'Head' && pose.tracking !== 'tracked'))
            expect(told).toEqual(new Array(7).fill('n/a'));
          else {
            const { position, orientation } = pose;
            expect(told.map(Number)).toEqual(
              [position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, orientation.w].map(
                (of) => expect.closeTo(of, 5),
              ),
            );
          }
        }
      }
    }
    const lost = rowsOf(read(`${study.rounds[3]?.path}_motion.tsv`)).filter((row) => row.includes('n/a'));
    expect(lost.length / 72).toBeCloseTo(1.5, 0);
  });

  test('has each scored event at its frame, after pauses and losses of the head too', () => {
    for (const { path, recording, landed, began } of study.rounds) {
      const events = tableOf(read(`${path.replace('_tracksys-webxr', '')}_events.tsv`));
      const first = recording.frames[0]?.time ?? Number.NaN;
      const scored = events.filter(({ trial_type }) => trial_type === 'hit' || trial_type === 'miss');
      expect(scored.map(({ onset }) => Number(onset))).toEqual(landed.map((time) => expect.closeTo(time - first, 5)));
      expect(events.map(({ onset }) => Number(onset))).toEqual(
        events.map(({ onset }) => Number(onset)).toSorted((a, b) => a - b),
      );
      const trial = events.find(({ trial_type }) => trial_type === 'trial');
      expect(Number(trial?.onset)).toBeCloseTo(began - first, 5);
      const pauses = events.filter(({ trial_type }) => trial_type === 'pause');
      for (const { onset, duration } of pauses) {
        // Frames of a pause are not recorded: between them lies as much.
        const [from, to] = [first + Number(onset), first + Number(onset) + Number(duration)];
        const within = recording.frames.filter(({ time }) => time > from + 1e-5 && time < to - 1e-5);
        expect(within).toEqual([]);
        expect(recording.frames.some(({ time }) => Math.abs(time - to) < frameSeconds / 2)).toBe(true);
      }
    }
    const all = Object.entries(files).filter(([path]) => path.endsWith('_events.tsv'));
    expect(all.flatMap(([, text]) => tableOf(text)).filter(({ trial_type }) => trial_type === 'pause')).toHaveLength(2);
  });

  test('says of every recording when it began, under which condition, and whether it counts', () => {
    const scans = ['P01', 'P02'].flatMap((id) =>
      tableOf(read(`sub-${id}/sub-${id}_scans.tsv`)).map((row) => ({ id, ...row })),
    );
    expect(scans).toHaveLength(study.rounds.length);
    for (const [index, { path, recording }] of study.rounds.entries()) {
      const row = scans[index] as Record<string, string> | undefined;
      expect(`sub-${row?.id}/${row?.filename}`).toBe(`${path}_motion.tsv`);
      expect(Date.parse(row?.acq_time ?? '') / 1000).toBeCloseTo(epoch + (recording.frames[0]?.time ?? Number.NaN), 2);
      expect(paperPlan().conditions.map(({ id }) => id)).toContain(row?.condition);
      expect(row?.excluded).toBe('n/a');
    }
  });

  test('leaves out what is damaged or belongs to no trial, and says so', () => {
    const [good, ...rest] = study.motion;
    if (!good) throw new Error('nothing was recorded');
    const motion = [
      { ...good, text: good.text.replace('"frames":[', '"frames":[null,') },
      { ...good, trial: 'archery/9/trial-1@1.1:trial' },
      ...rest,
    ];
    const { files: some, leftOut } = bidsDataset({
      plan: paperPlan(),
      simulated: false,
      records: study.records,
      motion,
    });
    expect(leftOut).toEqual([
      expect.stringMatching(/^P01 archery\/9\/trial-1@1\.1:trial: There is no record of this trial/),
      expect.stringMatching(/^P01 archery\/1\/trial-1@1\.1:trial: Frame 1 of the recording is not/),
    ]);
    expect(Object.keys(some).filter((path) => path.endsWith('_motion.tsv'))).toHaveLength(rest.length);
    expect(bidsDataset({ plan: paperPlan(), simulated: false, records: study.records, motion: [] }).files).toEqual({});
  });

  const validator = installed('bids-validator-deno');
  interface Issue {
    readonly code: string;
    readonly severity: 'error' | 'warning';
    readonly location: string;
  }
  /** Returns the issues; the program ends with an error code when it finds any, and still prints them. */
  const issuesIn = (folder: string): readonly Issue[] =>
    JSON.parse(spawnSync(validator ?? '', ['--json', folder], { encoding: 'utf8' }).stdout).issues.issues;
  test.skipIf(validator === null)('is faultless to the BIDS validator', () => {
    const folder = directoryWith();
    for (const [path, text] of Object.entries(files)) {
      mkdirSync(dirname(join(folder, path)), { recursive: true });
      writeFileSync(join(folder, path), text);
    }
    const issues = issuesIn(folder);
    expect(issues.filter(({ severity }) => severity === 'error')).toEqual([]);
    // It recommends fields that the server does not know: the authors, the licence, the headset's maker.
    const open = issues.filter(({ code }) => !/^(TOO_FEW|NO)_AUTHORS$|_KEY_RECOMMENDED$/.test(code));
    expect(open).toEqual([]);

    // The validator finds a fault that is put in.
    writeFileSync(join(folder, 'participants.tsv'), 'participant_id\nsub-P77\n');
    expect(issuesIn(folder).map(({ code }) => code)).toContain('PARTICIPANT_ID_MISMATCH');
  });
});
