import { button, element } from '../../../ui/element';
import { estimatorOrder, estimatorTexts } from '../estimator-texts';
import type { BodyActions, PanelPage, PanelState } from './panel-state';

/** What can be typed [cm]. */
export interface MeasureRanges {
  readonly height: { readonly min: number; readonly max: number };
  readonly armSpan: { readonly min: number; readonly max: number };
}

/** The choice of the estimator; one that is not to be had says why. */
function createEstimators(actions: Pick<BodyActions, 'chooseEstimator'>) {
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
      element('legend', {}, 'Estimator'),
      ...choices.map(({ node }) => node),
    ),
    show({ estimator, unavailable }: PanelState) {
      for (const { name, input, about, node } of choices) {
        const reason = unavailable[name];
        input.checked = name === estimator;
        input.disabled = reason !== undefined;
        node.classList.toggle('unavailable', reason !== undefined);
        about.textContent = reason ?? estimatorTexts[name].text;
      }
    },
  };
}

/** A length to be typed, in whole centimetres. */
function createMeasure(label: string, range: { readonly min: number; readonly max: number }, onChange: () => void) {
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
    show(centimetres: number) {
      // A number that is being typed must not change under the fingers.
      if (document.activeElement !== input) input.value = String(Math.round(centimetres));
    },
  };
}

/** The measures of the person, typed or measured. */
function createMeasures(ranges: MeasureRanges, actions: BodyActions) {
  const apply = () => {
    const valid = [height.input, armSpan.input].every((input) => input.reportValidity() && input.value !== '');
    if (valid) actions.setMeasures({ heightCm: height.input.valueAsNumber, armSpanCm: armSpan.input.valueAsNumber });
  };
  const height = createMeasure('Height', ranges.height, apply);
  const armSpan = createMeasure('Arm span', ranges.armSpan, apply);
  const eyeHeight = element('small', { class: 'hint' });
  return {
    node: element(
      'section',
      { class: 'calibration' },
      element('h2', {}, 'Your measures'),
      element('div', { class: 'row' }, height.node, armSpan.node),
      eyeHeight,
      element(
        'div',
        { class: 'row' },
        button('Calibrate', () => actions.calibrate(), { class: 'primary' }),
        button('Reset', () => actions.resetCalibration(), { 'aria-label': 'Reset calibration' }),
      ),
    ),
    show({ heightCm, armSpanCm, eyeHeightCm, calibrationSource }: PanelState) {
      height.show(heightCm);
      armSpan.show(armSpanCm);
      const eyes = Math.round(eyeHeightCm);
      eyeHeight.textContent = `Without shoes, fingertip to fingertip. Eyes at ${eyes} cm, ${calibrationSource}.`;
    },
  };
}

/** What the body is estimated by, and whose it is. */
export function createBodyPage(ranges: MeasureRanges, actions: BodyActions): PanelPage {
  const estimators = createEstimators(actions);
  const measures = createMeasures(ranges, actions);
  return {
    name: 'Body',
    content: [estimators.node, measures.node],
    show(state) {
      estimators.show(state);
      measures.show(state);
    },
  };
}
