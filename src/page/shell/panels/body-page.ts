import type { MeasureRange } from 'threepoint/core';
import { button, element, toggle } from 'threepoint-ui';
import { estimatorOrder, estimatorTexts } from '../session/estimator-texts';
import type { PanelActions } from './panel-actions';
import type { PanelPage, PanelState } from './panel-state';

/** What can be typed [cm]. */
export type MeasureRanges = Readonly<Record<'height' | 'armSpan' | 'forearm', MeasureRange>>;

/** Lets the user choose an estimator. An unavailable one gives the reason. */
function createEstimators(actions: PanelActions) {
  const choices = estimatorOrder.map((name) => {
    const { label, text } = estimatorTexts[name];
    const described = `about-${name}`;
    const attributes = { 'aria-label': label, 'aria-describedby': described };
    const input = element('input', { type: 'radio', name: 'estimator', value: name, ...attributes });
    input.addEventListener('change', () => {
      if (input.checked) actions.chooseEstimator(name);
    });
    const about = element('small', { id: described }, text);
    const node = element('label', { class: 'choice' }, input, element('span', {}, element('b', {}, label), about));
    return { name, input, about, node };
  });
  return {
    node: element(
      'fieldset',
      { class: 'choices' },
      element('legend', {}, 'How the body moves'),
      ...choices.map(({ node }) => node),
    ),
    show({ estimator, unavailable, bodyComplaint }: PanelState) {
      for (const { name, input, about, node } of choices) {
        const reason = unavailable[name];
        input.checked = name === estimator;
        input.disabled = reason !== undefined;
        node.classList.toggle('unavailable', reason !== undefined);
        const missing =
          name === 'device' && bodyComplaint !== null ? `Learned is used instead: ${bodyComplaint}.` : null;
        about.textContent = reason ?? missing ?? estimatorTexts[name].text;
      }
    },
  };
}

/** Whether the headset's body tracking is used. */
function createDeviceBody(actions: PanelActions) {
  const ask = toggle('Use the headset’s body tracking', (deviceBody) => actions.change({ deviceBody }));
  const about =
    'Starts when you next enter VR, and lasts until you close the page. It is off by default, because it has crashed the browsers of some headsets.';
  return {
    node: element('section', {}, ask.node, element('p', { class: 'hint' }, about)),
    show({ deviceBody }: PanelState) {
      ask.input.checked = deviceBody;
    },
  };
}

/** A length to be typed, in whole centimetres. */
function createMeasure(label: string, range: MeasureRange, onChange: () => void) {
  const input = element('input', {
    type: 'number',
    inputmode: 'numeric',
    min: Math.round(range.min),
    max: Math.round(range.max),
    step: 1,
    'aria-label': `${label} in centimetres`,
  });
  input.addEventListener('change', onChange);
  return {
    input,
    node: element('label', { class: 'measure' }, element('span', {}, label), input, element('i', {}, 'cm')),
    show(centimetres: number | null) {
      // A number that is being typed must not change under the fingers.
      if (document.activeElement === input) return;
      input.value = centimetres === null ? '' : String(Math.round(centimetres));
    },
  };
}

/** The measures of the person, typed or measured. */
function createMeasures(ranges: MeasureRanges, actions: PanelActions) {
  const apply = () => {
    const valid = [height, armSpan, forearm].every(({ input }) => input.reportValidity());
    const heightCm = height.input.valueAsNumber;
    const armSpanCm = armSpan.input.valueAsNumber;
    if (!valid || Number.isNaN(heightCm) || Number.isNaN(armSpanCm)) return;
    const forearmCm = forearm.input.value === '' ? null : forearm.input.valueAsNumber;
    actions.setMeasures({ heightCm, armSpanCm, forearmCm });
  };
  const height = createMeasure('Height', ranges.height, apply);
  const armSpan = createMeasure('Arm span', ranges.armSpan, apply);
  const forearm = createMeasure('Forearm', ranges.forearm, apply);
  const eyeHeight = element('small', { class: 'hint' });
  return {
    node: element(
      'section',
      { class: 'calibration' },
      element('h2', {}, 'Your measures'),
      element('div', { class: 'row' }, height.node, armSpan.node, forearm.node),
      eyeHeight,
      element(
        'div',
        { class: 'row' },
        button('Calibrate', () => actions.calibrate(), { class: 'primary' }),
        button('Reset', () => actions.resetCalibration(), { 'aria-label': 'Reset calibration' }),
      ),
    ),
    show({ heightCm, armSpanCm, forearmCm, eyeHeightCm, calibrationSource }: PanelState) {
      height.show(heightCm);
      armSpan.show(armSpanCm);
      forearm.show(forearmCm);
      const eyes = Math.round(eyeHeightCm);
      eyeHeight.textContent =
        'Without shoes, fingertip to fingertip; the forearm, if you know it, from the tip of the bent elbow to the ' +
        `wrist. Eyes at ${eyes} cm, ${calibrationSource}.`;
    },
  };
}

/** The estimator and the measurements of the body. */
export function createBodyPage(ranges: MeasureRanges, actions: PanelActions): PanelPage {
  const estimators = createEstimators(actions);
  const deviceBody = createDeviceBody(actions);
  const measures = createMeasures(ranges, actions);
  return {
    name: 'Body',
    content: [estimators.node, deviceBody.node, measures.node],
    show(state) {
      estimators.show(state);
      deviceBody.show(state);
      measures.show(state);
    },
  };
}
