import { Group } from 'three';
import type { EstimatorName } from '../../core/estimation/pose-estimator';
import { type CalibrationStep, calibrationHeadline, calibrationInstruction } from '../../ui/calibration-dialog';
import { type FrameReport, milliseconds, missedFrames } from '../../ui/overlay';
import { createVrPanel, fillRounded, vrColors, vrFont, wrap } from '../../ui/vr-panel';
import type { Pointer } from '../../ui/vr-pointers';
import { createPanelTouch } from '../../ui/vr-touch';
import { estimatorOrder, estimatorTexts } from './estimator-texts';
import type { ActivityName } from './play-bar';

/** What the menu in the headset shows. */
export interface VrMenuState {
  readonly estimator: EstimatorName;
  readonly unavailable: Partial<Readonly<Record<EstimatorName, string>>>;
  readonly calibration: CalibrationStep | null;
  readonly overlay: boolean;
  readonly activity: ActivityName;
  readonly bowSide: 'left' | 'right';
  readonly roundOver: boolean;
  /** In the ball game, before and after a match: whether one is ready; null: not asked. */
  readonly ready: boolean | null;
  /** A sentence to be read in the headset; null: none. */
  readonly notice: string | null;
}

export interface VrMenuActions {
  chooseEstimator(name: EstimatorName): void;
  calibrate(): void;
  cancelCalibration(): void;
  recentre(): void;
  setOverlay(on: boolean): void;
  goTo(activity: ActivityName): void;
  setBowSide(side: 'left' | 'right'): void;
  restart(): void;
  ready(on: boolean): void;
  exit(): void;
}

export interface VrMenu {
  readonly object: Group;
  setVisible(visible: boolean): void;
  show(state: VrMenuState): void;
  showReport(report: FrameReport): void;
  /** Follows the hands' rays and finger tips; a press or a touch on a button is its action. */
  point(pointers: readonly Pointer[]): void;
}

interface MenuButton {
  readonly id: string;
  readonly label: string;
  readonly at: readonly [number, number, number, number];
  readonly look: 'plain' | 'chosen' | 'off';
  readonly act: () => void;
}

const width = 640;
const height = 1000;
const margin = 36;
/** The menu right of the mirror and the frame times left of it; targets as big as a palm. */
export function createVrMenu(actions: VrMenuActions): VrMenu {
  const menu = createVrPanel(width, height, 1000);
  const report = createVrPanel(520, 460, 1000);
  const object = new Group();
  menu.mesh.position.set(1.1, 1.3, -1.15);
  menu.mesh.rotation.y = -0.74;
  report.mesh.position.set(-1.1, 1.35, -1.15);
  report.mesh.rotation.y = 0.74;
  object.add(menu.mesh, report.mesh);
  object.visible = false;

  let buttons: readonly MenuButton[] = [];
  let state: VrMenuState | null = null;
  let hovered: string | null = null;
  let drawn = '';
  const touch = createPanelTouch(menu);

  function buttonsOf(shown: VrMenuState): readonly MenuButton[] {
    const full = width - 2 * margin;
    const half = (full - 16) / 2;
    if (shown.calibration) {
      const over = shown.calibration.kind === 'done' || shown.calibration.kind === 'failed';
      const look = 'plain';
      return [
        {
          id: 'cancel',
          label: over ? 'Close' : 'Cancel',
          at: [margin, height - margin - 96, full, 96],
          look,
          act: actions.cancelCalibration,
        },
      ];
    }
    const choices = estimatorOrder.map((name, index): MenuButton => {
      const off = shown.unavailable[name] !== undefined;
      return {
        id: name,
        label: estimatorTexts[name].label,
        at: [margin, 116 + index * 104, full, 92],
        look: off ? 'off' : name === shown.estimator ? 'chosen' : 'plain',
        act: () => actions.chooseEstimator(name),
      };
    });
    type Row = readonly [id: string, label: string, act: () => void];
    const other = shown.bowSide === 'left' ? 'right' : 'left';
    const play: readonly Row[] =
      shown.activity === 'studio'
        ? [
            ['archery', 'Archery', () => actions.goTo('archery')],
            ['ball', 'Ball game', () => actions.goTo('ball')],
          ]
        : shown.activity === 'ball'
          ? [
              ['studio', 'To the mirror', () => actions.goTo('studio')],
              ...(shown.ready === null
                ? []
                : ([['ready', shown.ready ? 'Wait for me' : 'Ready', () => actions.ready(!shown.ready)]] as const)),
            ]
          : [
              ['studio', 'To the mirror', () => actions.goTo('studio')],
              shown.roundOver
                ? ['restart', 'New round', actions.restart]
                : ['bow', `Bow: ${shown.bowSide} hand`, () => actions.setBowSide(other)],
            ];
    const rest: readonly Row[] = [
      ['calibrate', 'Calibrate', actions.calibrate],
      ['recentre', 'Recentre', actions.recentre],
      ['overlay', shown.overlay ? 'Hide frame times' : 'Frame times', () => actions.setOverlay(!shown.overlay)],
      ['exit', 'Exit VR', actions.exit],
      ...play,
    ];
    return [
      ...choices,
      ...rest.map(([id, label, act], index): MenuButton => {
        const x = margin + (index % 2) * (half + 16);
        const y = 560 + Math.floor(index / 2) * 112;
        return { id, label, at: [x, y, half, 96], look: 'plain', act };
      }),
    ];
  }

  function paint(context: CanvasRenderingContext2D, shown: VrMenuState): void {
    fillRounded(context, [2, 2, width - 4, height - 4], 40, vrColors.glass, vrColors.line);
    context.textBaseline = 'middle';
    context.textAlign = 'left';
    context.fillStyle = vrColors.inkSoft;
    context.font = `600 30px ${vrFont}`;
    context.fillText(shown.calibration ? 'Calibrate' : 'Estimator', margin + 4, 72);
    if (shown.calibration) {
      const { calibration } = shown;
      const over = calibration.kind === 'done' || calibration.kind === 'failed';
      context.textAlign = 'center';
      context.fillStyle = vrColors.ink;
      context.font = `500 40px ${vrFont}`;
      const lines = wrap(context, over ? calibration.text : calibrationInstruction, width - 2 * margin);
      for (const [index, line] of lines.entries()) context.fillText(line, width / 2, 170 + index * 54);
      context.fillStyle = vrColors.accent;
      context.font = `650 ${calibration.kind === 'countdown' ? 180 : 84}px ${vrFont}`;
      context.fillText(calibrationHeadline(calibration), width / 2, 480);
      if (calibration.kind === 'measuring') {
        fillRounded(context, [margin, 620, width - 2 * margin, 20], 10, vrColors.lift);
        fillRounded(context, [margin, 620, (width - 2 * margin) * calibration.part, 20], 10, vrColors.accent);
      }
    }
    for (const { id, label, at, look } of buttons) {
      const [x, y, w, h] = at;
      const hover = id === hovered && look !== 'off';
      fillRounded(
        context,
        [x, y, w, h],
        22,
        look === 'chosen' ? vrColors.accent : hover ? vrColors.liftMore : vrColors.lift,
      );
      context.globalAlpha = look === 'off' ? 0.45 : 1;
      context.fillStyle = look === 'chosen' ? vrColors.accentInk : vrColors.ink;
      context.font = `600 ${w > 300 ? 38 : 30}px ${vrFont}`;
      context.textAlign = 'center';
      context.fillText(label, x + w / 2, y + h / 2 + 2, w - 24);
      context.globalAlpha = 1;
    }
    if (shown.notice && !shown.calibration) {
      context.textAlign = 'left';
      context.fillStyle = vrColors.inkSoft;
      context.font = `400 22px ${vrFont}`;
      const lines = wrap(context, shown.notice, width - 2 * margin).slice(0, 3);
      for (const [index, line] of lines.entries()) context.fillText(line, margin, 908 + index * 28);
    }
  }

  function redraw(): void {
    if (!state) return;
    // Tenths of the measuring are as fine as a hand-held bar needs; every texture upload costs.
    const key = JSON.stringify([state, hovered], (_, value) =>
      typeof value === 'number' ? Math.ceil(value * 20) / 20 : value,
    );
    if (key === drawn) return;
    drawn = key;
    const shown = state;
    buttons = buttonsOf(shown);
    menu.draw((context) => paint(context, shown));
  }

  return {
    object,
    setVisible(visible) {
      object.visible = visible;
    },
    show(next) {
      state = next;
      report.mesh.visible = next.overlay;
      redraw();
    },
    showReport(frame) {
      if (!object.visible || !report.mesh.visible) return;
      report.draw((context) => {
        fillRounded(context, [2, 2, report.width - 4, report.height - 4], 32, vrColors.glass, vrColors.line);
        context.textBaseline = 'middle';
        const row = (y: number, label: string, p50: string, p95: string, color: string, font: string) => {
          context.font = font;
          context.fillStyle = color;
          context.textAlign = 'left';
          context.fillText(label, 32, y);
          context.textAlign = 'right';
          context.fillText(p50, 380, y);
          context.fillText(p95, 488, y);
        };
        row(48, 'ms per frame', 'p50', 'p95', vrColors.inkSoft, `500 26px ${vrFont}`);
        row(92, 'frame', milliseconds(frame.p50Ms), milliseconds(frame.p95Ms), vrColors.accent, `650 34px ${vrFont}`);
        for (const [index, { name, p50Ms, p95Ms }] of frame.stages.entries()) {
          row(140 + index * 40, name, milliseconds(p50Ms), milliseconds(p95Ms), vrColors.ink, `500 28px ${vrFont}`);
        }
        context.textAlign = 'left';
        context.fillStyle = vrColors.inkSoft;
        context.font = `500 25px ${vrFont}`;
        context.fillText(missedFrames(frame), 32, 386, 456);
        context.fillText(`${frame.estimator} · ${frame.provider}`, 32, 424, 456);
      });
    },
    point(pointers) {
      if (!object.visible) {
        for (const pointer of pointers) pointer.showRay(null);
        return;
      }
      const usable = buttons.filter(({ look }) => look !== 'off');
      const { pointedAt, pressed } = touch.follow(pointers, usable);
      hovered = pointedAt?.id ?? null;
      for (const { act } of pressed) act();
      redraw();
    },
  };
}
