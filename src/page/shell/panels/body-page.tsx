import { useRef } from 'preact/hooks';
import { armSpanRange, fingertipSpanFromArmSpan, forearmRange, type MeasureRange, statureRange } from 'threepoint/core';
import { Button, Details, Group, Toggle, TypedInput } from 'threepoint-ui/controls';
import { estimatorTexts, listedEstimators } from '../session/estimator-texts';
import { type GripControl, type GripState, gripHands, gripKinds, handLabels } from './grip-control';
import type { PanelPageProps } from './panel-actions';

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

/** How the user holds their controllers. */
function Grip({ grip, control }: { readonly grip: GripState; readonly control: GripControl }) {
  return (
    <section>
      <h2>Your grip</h2>
      <p class="hint">
        If the drawn hands are not at yours, move them here or by “My grip” in the headset’s menu. Stored for the
        controllers “{grip.device}”.
      </p>
      <Group label="Hands" class="segments">
        {gripHands.map((hands) => (
          <Button
            label={handLabels[hands]}
            aria-pressed={hands === grip.hands}
            onClick={() => control.chooseHands(hands)}
          />
        ))}
      </Group>
      {(['Move', 'Turn'] as const).map((kind) => (
        <>
          <small class="hint">{gripKinds[kind]}</small>
          {grip.rows
            .filter((row) => row.kind === kind)
            .map((row) => (
              <Group label={`${kind}: ${row.less}, ${row.more}`} class="steps">
                <Button label={row.less} disabled={row.atLeast} onClick={() => control.step(row, -1)} />
                <output>{row.value}</output>
                <Button label={row.more} disabled={row.atMost} onClick={() => control.step(row, 1)} />
              </Group>
            ))}
        </>
      ))}
      <Button label="Reset" aria-label="Reset grip" onClick={() => control.reset()} />
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
    {state.grip && <Grip grip={state.grip} control={actions.grip} />}
  </>
);
