import { Button, FileButton, Group, ReplayTimeline, StatusLine, Toggle } from 'threepoint-ui/controls';
import type { PanelPageProps } from './panel-actions';
import type { ExportChoice, ExportState, RecorderState } from './panel-state';

const seconds = (value: number): string => `${value.toFixed(1)} s`;

/** What the recorder is doing, in words, and how long it has. */
export function recorderText({ mode, name, seconds: passed, duration }: RecorderState): readonly [string, string] {
  if (mode === 'recording') return ['Recording', `, ${seconds(passed)}`];
  if (mode === 'replaying') return [`Replaying ${name ?? ''}`, ''];
  return [name ? `${name}, ${seconds(duration)}` : 'Nothing recorded yet.', ''];
}

function RecorderSection({ state, actions }: PanelPageProps) {
  const { mode, name, paused, seconds: passed, duration, loop } = state.recorder;
  const nothingToPlay = mode === 'recording' || name === null;
  const [words, figures] = recorderText(state.recorder);
  return (
    <section>
      <h2>Recorder</h2>
      <p class="hint">
        Records your head and hands on this device. Every method can replay every recording. Motion capture (BVH, ASF
        with AMC, VRM Animation) is shown with its ground truth.
      </p>
      <div class="row">
        <Button label="Record" class="record" disabled={mode === 'recording'} onClick={() => actions.record()} />
        <Button label="Stop" disabled={mode === 'idle'} onClick={() => actions.stop()} />
        <Button label="Replay" disabled={nothingToPlay} onClick={() => actions.replay()} />
        <Button label="Download" disabled={nothingToPlay} onClick={() => actions.download()} />
      </div>
      <StatusLine class="recorder-text" words={words} figures={figures} />
      {mode === 'replaying' && (
        <ReplayTimeline
          name="Time of the recording in seconds"
          paused={paused}
          seconds={passed}
          duration={duration}
          setPaused={(on) => actions.setPaused(on)}
          seek={(seconds) => actions.seek(seconds)}
        />
      )}
      <Toggle label="Loop" on={loop} set={(on) => actions.setLoop(on)} />
      <div class="row">
        <FileButton label="Open recording" accept=".json,application/json" open={(files) => actions.openFiles(files)} />
        <FileButton
          label="Open motion capture"
          accept=".bvh,.asf,.amc,.vrma,.fbx,.glb,.gltf,.json"
          multiple
          open={(files) => actions.openMotion(files)}
        />
      </div>
    </section>
  );
}

const exportChoices: readonly (readonly [ExportChoice, label: string, title: string])[] = [
  ['bvh', 'BVH', 'For Blender, MotionBuilder and others, in metres'],
  ['bvh-cm', 'BVH in cm', 'The same file in centimetres'],
  ['vrma', 'VRM Animation', 'A .vrma, for any VRM avatar'],
  ['glb', 'Avatar (GLB)', 'The current avatar, animated'],
  ['csv', 'Table (CSV)', 'The position of every joint [m], a row per frame'],
];

/** How far a file is, in words. */
const exportText = ({ name, method, fraction, secondsLeft }: ExportState): string => {
  const left = secondsLeft === null ? '' : `, ${Math.ceil(secondsLeft)} s left`;
  return `${name} as drawn by ${method}: ${Math.floor(100 * fraction)}\u00a0%${left}`;
};

/** Files for other programs. */
const ExportSection = ({ state: { recorder, exporting }, actions }: PanelPageProps) => (
  <section>
    <h2>Export</h2>
    <p class="hint">
      Exports the current recording with the body that the chosen method estimates, including fingers. Legs are not
      measured.
    </p>
    <Group label="Export as" class="row">
      {exportChoices.map(([choice, label, title]) => (
        <Button
          label={label}
          title={title}
          disabled={recorder.mode === 'recording' || recorder.name === null || exporting !== null}
          onClick={() => actions.exportMotion(choice)}
        />
      ))}
    </Group>
    {exporting && (
      <>
        <p class="recorder-text">{exportText(exporting)}</p>
        <progress max={1} value={exporting.fraction} aria-label="Progress of the export" />
        <Button label="Cancel export" onClick={() => actions.cancelExport()} />
      </>
    )}
  </section>
);

/** Recordings, and what moves the body instead of a person. */
export const RecordingPage = ({ state, actions }: PanelPageProps) => (
  <>
    <RecorderSection state={state} actions={actions} />
    <ExportSection state={state} actions={actions} />
    <section>
      <h2>Who moves</h2>
      <Toggle label="Actor moves the body" on={state.actor} set={(on) => actions.setActor(on)} />
      {state.emulated && (
        <Toggle label="Emulator controls" on={state.emulatorPanel} set={(on) => actions.setEmulatorPanel(on)} />
      )}
    </section>
  </>
);
