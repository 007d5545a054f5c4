import { useRef } from 'preact/hooks';
import {
  armSpanRange,
  fingertipSpanFromArmSpan,
  forearmRange,
  largestGripOffset,
  type MeasureRange,
  statureRange,
} from 'threepoint/core';
import { Button, Details, Toggle, TypedInput } from 'threepoint-ui/controls';
import { estimatorTexts, listedEstimators } from '../session/estimator-texts';
import type { PanelPageProps } from './panel-actions';
import type { GripCorrection } from './panel-state';

const methodDetails = Object.values(estimatorTexts).map(({ label, details }) => [label, details] as const);

const measureDetails = [
  ['Height', 'Gives the eye height. The offsets of trunk and head are proportional to it.'],
  ['Arm span', 'Gives the arm length from shoulder to wrist: half the span without shoulder girdle and hands.'],
  ['Forearm', 'Places the elbow half-way between this measure and the average share of the arm.'],
] as const;

/** Lets the user choose an estimator. An unavailable one gives the reason. */
const Estimators = ({ state: { estimator, unavailable, bodyComplaint }, actions }: PanelPageProps) => (
  <fieldset class="choices">
    <legend>How the body moves</legend>
    {listedEstimators.map((name) => {
      const { label, text } = estimatorTexts[name];
      const reason = unavailable[name];
      const missing = name === 'device' && bodyComplaint !== null ? `Learned is used instead: ${bodyComplaint}.` : null;
      return (
        <label class={reason === undefined ? 'choice' : 'choice unavailable'}>
          <input
            type="radio"
            name="estimator"
            value={name}
            aria-label={label}
            aria-describedby={`about-${name}`}
            checked={name === estimator}
            disabled={reason !== undefined}
            onChange={() => actions.chooseEstimator(name)}
          />
          <span>
            <b>{label}</b>
            <small id={`about-${name}`}>{reason ?? missing ?? text}</small>
          </span>
        </label>
      );
    })}
    <Details of="the methods" entries={methodDetails} />
  </fieldset>
);

interface MeasureProps {
  readonly label: string;
  /** The range of what can be typed [m]. */
  readonly range: MeasureRange;
  readonly centimetres: number | null;
  readonly apply: () => void;
}

const rounded = (centimetres: number): string => String(Math.round(centimetres));

/** A length to be typed, in whole centimetres. */
const Measure = ({ label, range: { min, max }, centimetres, apply }: MeasureProps) => (
  <label class="measure">
    <span>{label}</span>
    <TypedInput
      type="number"
      inputMode="numeric"
      min={rounded(100 * min)}
      max={rounded(100 * max)}
      step={1}
      aria-label={`${label} in centimetres`}
      value={centimetres === null ? '' : rounded(centimetres)}
      onChange={apply}
    />
    <i>cm</i>
  </label>
);

const fingertipSpanRange: MeasureRange = {
  min: fingertipSpanFromArmSpan(armSpanRange.min),
  max: fingertipSpanFromArmSpan(armSpanRange.max),
};

/** The measures of the person, typed or measured. */
function Measures({ state, actions }: PanelPageProps) {
  const row = useRef<HTMLDivElement>(null);
  const apply = () => {
    const inputs = [...row.current!.querySelectorAll('input')];
    const valid = inputs.every((input) => input.reportValidity());
    const [heightCm, armSpanCm, forearmCm] = inputs.map((input) => input.valueAsNumber) as [number, number, number];
    if (!valid || Number.isNaN(heightCm) || Number.isNaN(armSpanCm)) return;
    actions.setMeasures({ heightCm, armSpanCm, forearmCm: Number.isNaN(forearmCm) ? null : forearmCm });
  };
  return (
    <section class="calibration">
      <h2>Your measures</h2>
      <div class="row" ref={row}>
        <Measure label="Height" range={statureRange} centimetres={state.heightCm} apply={apply} />
        <Measure label="Arm span" range={fingertipSpanRange} centimetres={state.armSpanCm} apply={apply} />
        <Measure label="Forearm" range={forearmRange} centimetres={state.forearmCm} apply={apply} />
      </div>
      <small class="hint">
        Without shoes, fingertip to fingertip; the forearm, if you know it, from the tip of the bent elbow to the wrist.
        {` Eyes at ${rounded(state.eyeHeightCm)} cm, ${state.calibrationSource}.`}
      </small>
      <div class="row">
        <Button label="Calibrate" class="primary" onClick={() => actions.calibrate()} />
        <Button label="Reset" aria-label="Reset calibration" onClick={() => actions.resetCalibration()} />
      </div>
      <Details of="the measures" entries={measureDetails} />
    </section>
  );
}

interface SliderProps {
  readonly label: string;
  /** Returns a value in words. */
  readonly inWords: (value: number) => string;
  /** The largest value; the smallest is its negative. */
  readonly most: number;
  readonly value: number;
  readonly set: (value: number) => void;
}

/** A correction to both sides of 0, in whole units. */
const Slider = ({ label, inWords, most, value, set }: SliderProps) => (
  <label class="slider">
    <span>{label}</span>
    <span class="time">{inWords(value)}</span>
    <input
      type="range"
      min={-most}
      max={most}
      step={1}
      aria-label={label}
      aria-valuetext={inWords(value)}
      value={Math.round(value)}
      onInput={({ currentTarget }) => set(currentTarget.valueAsNumber)}
    />
  </label>
);

/** Returns the words for a value to either side of 0. */
const eitherSide =
  (unit: string, above: string, below: string) =>
  (value: number): string => {
    const size = `${rounded(Math.abs(value))}${unit}`;
    if (Math.round(value) === 0) return size;
    return `${size} ${value > 0 ? above : below}`;
  };

const wristDistance = eitherSide(' cm', 'further from the grip', 'nearer to the grip');
const wristAngle = eitherSide('°', 'towards the thumb', 'towards the little finger');

/** The parts of profile names whose spelling differs from a capitalised word. */
const brandWords: Readonly<Record<string, string>> = {
  htc: 'HTC',
  mx: 'MX',
  bytedance: 'ByteDance',
  galaxyxr: 'Galaxy XR',
};

/** Returns the name of a controller in words, from its profile name such as `meta-quest-touch-plus`. */
const controllerName = (profile: string): string =>
  profile
    .split('-')
    .map((word) => brandWords[word] ?? word.charAt(0).toUpperCase() + word.slice(1))
    .join(' ');

/** How the user holds the controllers that were used last. */
function Grip({ grip, actions }: { readonly grip: GripCorrection; readonly actions: PanelPageProps['actions'] }) {
  const correct = (change: Partial<GripCorrection>) => actions.correctGrip({ ...grip, ...change });
  return (
    <section>
      <h2>Your grip</h2>
      <p class="hint">
        If the drawn wrists are not at yours in VR, move them here. Both hands move. Stored for the controllers “
        {controllerName(grip.device)}”.
      </p>
      <Slider
        label="Wrist position"
        inWords={wristDistance}
        most={100 * largestGripOffset.ahead}
        value={grip.aheadCm}
        set={(aheadCm) => correct({ aheadCm })}
      />
      <Slider
        label="Wrist angle"
        inWords={wristAngle}
        most={60}
        value={grip.leanDegrees}
        set={(leanDegrees) => correct({ leanDegrees })}
      />
      <Button label="Reset" aria-label="Reset grip" onClick={() => correct({ aheadCm: 0, leanDegrees: 0 })} />
    </section>
  );
}

/** The estimator and the measurements of the body. */
export const BodyPage = ({ state, actions }: PanelPageProps) => (
  <>
    <Estimators state={state} actions={actions} />
    <section>
      <Toggle
        label="Use the headset’s body tracking"
        on={state.deviceBody}
        set={(deviceBody) => actions.change({ deviceBody })}
      />
      <p class="hint">
        Starts when you next enter VR, and lasts until you close the page. It is off by default, because it has crashed
        the browsers of some headsets.
      </p>
    </section>
    <Measures state={state} actions={actions} />
    {state.grip && <Grip grip={state.grip} actions={actions} />}
  </>
);
