// npm run evaluate -- --recording FILE: every method against the body that the recording's device reported.
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { basename } from 'node:path';
import { reasonOf } from 'threepoint/core/errors/reasons';
import { parseRecording } from 'threepoint/core/tracking/recording';
import { type MeasuredRecording, measureRecording } from './device-truth';
import { loadRegressors } from './networks';
import { printReports } from './report-text';

const {
  recording: files,
  models,
  json,
} = JSON.parse(process.argv[2] ?? '') as {
  readonly recording: readonly string[];
  readonly models: string;
  readonly json?: string;
};
const regressors = await loadRegressors(models);
const measured: Record<string, MeasuredRecording> = {};
for (const file of files) {
  try {
    if (!existsSync(file)) throw new Error('there is no such file');
    const recording = parseRecording(readFileSync(file, 'utf8'));
    const result = await measureRecording(recording, regressors);
    measured[basename(file)] = result;
    const about = `${result.frames} frames, ${result.seconds.toFixed(1)} s of ${recording.device}`;
    printReports(`${basename(file)}: ${about}, against the device's own body`, result.estimators);
  } catch (error) {
    console.error(`${file}: ${reasonOf(error)}`);
    process.exitCode = 1;
  }
}
for (const regressor of regressors.values()) await regressor.dispose();
if (json) writeFileSync(json, `${JSON.stringify({ recordings: measured }, null, 2)}\n`);
