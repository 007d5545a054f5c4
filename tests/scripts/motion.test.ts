import { spawnSync } from 'node:child_process';
import { copyFileSync, readdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { actorFrame, defaultCalibration, writeRecording } from 'threepoint/core';
import { describe, expect, onTestFinished, test } from 'vitest';
import { exportFile, writeWhole } from '../../scripts/motion/export-file';
import { FileReaderProcess } from '../../scripts/motion/reader-process';
import { directoryWith } from '../temporary-directory';
import { builtFbx } from '../threepoint/avatar/built-fbx';
import { fbxBinary, fbxText } from '../threepoint/avatar/fbx-file';
import { partsOf } from '../threepoint/avatar/glb';
import { mixamo } from '../threepoint/avatar/rig-namings';
import { madeBvh } from '../threepoint/core/mocap/made-bvh';

const recorded = (seconds: number): string =>
  writeRecording({
    device: 'actor',
    rateHz: 60,
    calibration: defaultCalibration,
    frames: Array.from({ length: 60 * seconds }, (_, i) => actorFrame(i / 60, defaultCalibration)),
  });

/** Creates a folder with a recording. */
function folderWith(seconds: number) {
  const folder = directoryWith({ 'mine.json': recorded(seconds) });
  return { folder, file: join(folder, 'mine.json') };
}

describe('npm run tool -- motion', () => {
  test.each(['--help', '-h'])('%s prints how it is used, and is no error', (flag) => {
    const { status, stdout } = spawnSync(process.execPath, ['scripts/tool.mjs', 'motion', flag], {
      encoding: 'utf8',
    });
    expect(stdout).toMatch(/^npm run tool -- motion FILE --to bvh\|csv\|vrma\|glb /);
    expect(status).toBe(0);
  });

  test.each([
    ['bvh', 'learned'],
    ['csv', 'ik'],
    ['vrma', 'paper'],
    ['glb', 'learned'],
  ])('writes a recording as %s beside it, as %s draws it', async (to, estimator) => {
    const { folder, file } = folderWith(1);
    expect(await exportFile({ file, to, estimator })).toBe(join(folder, `mine-${estimator}.${to}`));
    expect(readdirSync(folder).sort()).toEqual([`mine-${estimator}.${to}`, 'mine.json']);
    expect(readFileSync(join(folder, `mine-${estimator}.${to}`)).length).toBeGreaterThan(20_000);
  });

  test('writes motion capture in FBX as it would be recorded, on an avatar in FBX', { tags: ['full'] }, async () => {
    const every = (angle: (frame: number) => number) =>
      Array.from({ length: 60 }, (_, frame) => [0, 0, angle(frame)] as const);
    const nameOf = mixamo('mixamorig:');
    const turns = { leftUpperArm: every(() => -60), rightUpperArm: every((frame) => 30 * Math.sin(frame / 9)) };
    const folder = directoryWith({});
    const [file, avatar] = [join(folder, 'wave.fbx'), join(folder, 'soldier.fbx')];
    writeFileSync(file, new Uint8Array(fbxBinary(builtFbx({ nameOf, turns, bare: true }))));
    writeFileSync(avatar, new Uint8Array(fbxText(builtFbx({ nameOf }))));
    const made = await exportFile({ file, to: 'glb', estimator: 'ik', avatar });
    expect(made).toBe(join(folder, 'wave-ik.glb'));
    const { animations } = partsOf(readFileSync(made)).json as { animations?: object[] };
    expect(animations).toHaveLength(1);
    await expect(exportFile({ file: made, to: 'glb', estimator: 'ik', out: made })).rejects.toThrow(
      'would be overwritten',
    );
  });

  test('takes unit, rate and place', async () => {
    const { folder, file } = folderWith(1);
    const out = join(folder, 'other.txt');
    await exportFile({ file, to: 'bvh', estimator: 'ik', unit: 'cm', rate: '30', out });
    const text = readFileSync(out, 'utf8');
    expect(text).toMatch(/^Frames: 30$/m);
    expect(Number(/JOINT leftLowerArm\s+\{\s+OFFSET (\S+)/.exec(text)?.[1])).toBeGreaterThan(20);
  });

  test.each([
    ['an unknown format', { to: 'fbx' }, /--to: “fbx” is none of bvh, csv, vrma, glb/],
    ['an unknown method', { to: 'bvh', estimator: 'magic' }, /--estimator: “magic” is none of/],
    ['a method without a body', { to: 'bvh', estimator: 'hands-only' }, /estimates no body/],
    ['an unknown unit', { to: 'bvh', unit: 'ft' }, /--unit: “ft” is none of m, cm/],
    ['no rate', { to: 'bvh', rate: 'often' }, /--rate: “often” is no rate/],
    ['an avatar where none is wanted', { to: 'bvh', avatar: 'me.vrm' }, /--avatar is for --to glb alone/],
    ['an avatar that is not there', { to: 'glb', avatar: '/nowhere/me.vrm' }, /--avatar: there is no file/],
    ['a folder that is not there', { to: 'csv', estimator: 'ik', out: '/nowhere/x.csv' }, /x.csv could not be written/],
  ])('refuses %s in a sentence, and writes nothing', async (_, request, sentence) => {
    const { folder, file } = folderWith(1);
    await expect(exportFile({ file, ...request })).rejects.toThrow(sentence);
    expect(readdirSync(folder)).toEqual(['mine.json']);
  });

  test('refuses a table by what it is, the one that it wrote and any other', async () => {
    const { folder, file } = folderWith(1);
    const table = await exportFile({ file, to: 'csv', estimator: 'ik' });
    await expect(exportFile({ file: table, to: 'bvh' })).rejects.toThrow(
      /^mine-ik.csv: it is a table of joint positions, for spreadsheets and statistics/,
    );
    const other = join(folder, 'trials.csv');
    writeFileSync(other, 'simulated,participant,trial\n');
    await expect(exportFile({ file: other, to: 'bvh' })).rejects.toThrow(/^trials.csv: it is a table of a study/);
  });

  test('never writes over the motion or the avatar that it reads, by any path to them', async () => {
    const { folder, file } = folderWith(1);
    const link = `${folder}-link`;
    symlinkSync(folder, link);
    onTestFinished(() => rmSync(link));
    const avatar = join(folder, 'mine-ik.glb');
    copyFileSync('public/avatars/mannequin.vrm', avatar);
    const before = readFileSync(avatar);
    const motion = { file, estimator: 'ik' };
    await expect(exportFile({ ...motion, to: 'bvh', out: join(link, 'mine.json') })).rejects.toThrow('overwritten');
    await expect(exportFile({ ...motion, to: 'glb', avatar })).rejects.toThrow(`${avatar} would be overwritten`);
    expect(readFileSync(file, 'utf8')).toBe(recorded(1));
    expect(readFileSync(avatar).equals(before)).toBe(true);
  });

  test('refuses a damaged recording with the line', async () => {
    const { folder, file } = folderWith(1);
    writeFileSync(file, recorded(1).slice(0, 3000));
    await expect(exportFile({ file, to: 'bvh' })).rejects.toThrow(/^mine.json: The recording is not valid JSON/);
    expect(readdirSync(folder)).toEqual(['mine.json']);
  });

  test('leaves the earlier file when it is given up', async () => {
    const { folder, file } = folderWith(20);
    const out = join(folder, 'mine.bvh');
    writeFileSync(out, 'of yesterday');
    const giveUp = new AbortController();
    const onProgress = () => giveUp.abort(new Error('enough'));
    const work = exportFile({ file, to: 'bvh', estimator: 'ik' }, { signal: giveUp.signal, onProgress });
    await expect(work).rejects.toThrow('enough');
    expect(readdirSync(folder).sort()).toEqual(['mine.bvh', 'mine.json']);
    expect(readFileSync(out, 'utf8')).toBe('of yesterday');
  });

  test('leaves the earlier file when it fails half-way', () => {
    const { folder } = folderWith(1);
    const out = join(folder, 'mine.csv');
    writeFileSync(out, 'of yesterday');
    function* failing() {
      yield 'some of today';
      throw new Error('the disk is full');
    }
    expect(() => writeWhole(out, failing())).toThrow('the disk is full');
    expect(readdirSync(folder).sort()).toEqual(['mine.csv', 'mine.json']);
    expect(readFileSync(out, 'utf8')).toBe('of yesterday');
  });
});

test('a file that needs more memory than its process is refused; the next is read', async () => {
  using reader = new FileReaderProcess(100);
  const bytes = (text: string) => new TextEncoder().encode(text).buffer as ArrayBuffer;
  const large = { name: 'large.gltf', bytes: bytes(`{"nodes":[${'{"a":[]},'.repeat(3e6)}{}]}`) };
  await expect(reader.read('clips', large)).rejects.toThrow(
    'large.gltf: needs more than 100 MB of memory; open a smaller file',
  );
  expect(await reader.read('clips', { name: 'wave.bvh', bytes: bytes(madeBvh({ frames: 40 })) })).toHaveLength(1);
});

test('npm run tool -- motion:try prints a line for every file of motion of a folder', () => {
  const folder = directoryWith({ 'cut.bvh': 'HIERARCHY\nROOT Hips\n{', 'notes.txt': '', 'wave.bvh': madeBvh() });
  const { status, stdout } = spawnSync(process.execPath, ['scripts/tool.mjs', 'motion:try', folder], {
    encoding: 'utf8',
  });
  const [cut, wave, ...more] = stdout.trim().split('\n');
  expect(cut).toMatch(/^REFUSED cut\.bvh: line \d/);
  expect(wave).toBe('wave.bvh: 1.0 s at 59.9 Hz, eyes at 1.62 m, arm span 1.40 m');
  expect(more).toEqual([]);
  expect(status).toBe(0);
});
