import { Group, Vector3 } from 'three';
import { createVrPanel, fillRounded, vrColors, vrFont, wrap } from '../../ui/vr-panel';
import type { Pointer } from '../../ui/vr-pointers';
import { createPanelTouch, type PanelTarget } from '../../ui/vr-touch';
import type { ScreenButton, StudyScreen } from './study-screen';

/** The study in the headset: one sheet at arm's length and a bit, with targets as big as a palm. */
export interface VrStudyPanel {
  readonly object: Group;
  /** null hides it. */
  show(screen: StudyScreen | null): void;
  /** Puts the sheet where somebody with this head (floor frame) looks; call it with every frame. */
  follow(head: {
    readonly position: { x: number; y: number; z: number };
    readonly forward: { x: number; z: number };
  }): void;
  point(pointers: readonly Pointer[]): void;
  /** What a hand points at; null: nothing that can be pressed. */
  readonly pointedAt: string | null;
  /** Where the middle of each target is, in the world [m]. */
  targets(): readonly { readonly id: string; readonly at: readonly [number, number, number] }[];
}

const width = 1200;
const height = 880;
const margin = 60;
const inner = width - 2 * margin;
/** How far before the eyes the sheet stands, how far below them its middle lies [m]. */
const reach = 1.25;
const below = 0.12;
/** Whoever turns away further than this [rad] or steps away further than this [m] gets the sheet anew. */
const mostTurn = 0.7;
const mostStep = 0.8;

interface Target extends PanelTarget {
  readonly kind: 'button' | 'scale' | 'dot';
  readonly label: string;
  readonly look: ScreenButton['look'] | 'chosen' | 'answered' | 'open' | 'missing' | 'here';
  act(): void;
}

function targetsOf({ question, buttons }: StudyScreen): readonly Target[] {
  const targets: Target[] = [];
  if (question) {
    const step = 52;
    const left = width - margin - question.all.length * step;
    for (const [index, { id, state }] of question.all.entries()) {
      targets.push({
        kind: 'dot',
        id: `go-${id}`,
        label: String(index + 1),
        look: index + 1 === question.number ? 'here' : state,
        at: [left + index * step, 40, 44, 44],
        act: () => question.goTo(index),
      });
    }
    const gap = 18;
    const wide = (inner - gap * (question.scale.length - 1)) / question.scale.length;
    for (const [index, { value, label }] of question.scale.entries()) {
      targets.push({
        kind: 'scale',
        id: `answer-${value}`,
        label,
        look: question.answer === value ? 'chosen' : 'plain',
        at: [margin + index * (wide + gap), 410, wide, 190],
        act: () => question.choose(value),
      });
    }
  }
  const gap = 24;
  const wide = buttons.length === 1 ? 560 : (inner - gap * (buttons.length - 1)) / Math.max(1, buttons.length);
  const left = buttons.length === 1 ? (width - wide) / 2 : margin;
  for (const [index, { id, label, look, act }] of buttons.entries()) {
    targets.push({ kind: 'button', id, label, look, at: [left + index * (wide + gap), 692, wide, 116], act });
  }
  return targets;
}

const fillOf = (look: Target['look'], hovered: boolean): string => {
  if (look === 'chosen') return vrColors.accent;
  if (look === 'primary') return hovered ? '#ffc98e' : vrColors.accent;
  if (look === 'answered') return 'rgba(255, 180, 104, 0.42)';
  return hovered || look === 'here' ? vrColors.liftMore : vrColors.lift;
};

export function createVrStudyPanel(): VrStudyPanel {
  const panel = createVrPanel(width, height, 1000);
  const object = new Group();
  object.add(panel.mesh);
  object.visible = false;
  const touch = createPanelTouch(panel);
  let screen: StudyScreen | null = null;
  let targets: readonly Target[] = [];
  let hovered: string | null = null;
  let drawn = '';
  let placed = false;

  function paint(context: CanvasRenderingContext2D, shown: StudyScreen): void {
    fillRounded(context, [2, 2, width - 4, height - 4], 48, 'rgba(18, 24, 35, 0.96)', vrColors.line);
    context.textBaseline = 'middle';
    context.textAlign = 'left';
    context.fillStyle = shown.trouble ? '#ff8f7d' : vrColors.inkSoft;
    context.font = `600 32px ${vrFont}`;
    context.fillText(shown.kicker, margin, 64, shown.question ? 560 : inner);

    context.fillStyle = vrColors.ink;
    const { question } = shown;
    if (question) {
      context.font = `600 50px ${vrFont}`;
      const lines = wrap(context, question.text, inner);
      for (const [index, line] of lines.entries()) context.fillText(line, margin, 180 + index * 66);
    } else {
      context.font = `650 60px ${vrFont}`;
      context.fillText(shown.title, margin, 150, inner);
      context.font = `400 38px ${vrFont}`;
      let y = 236;
      for (const paragraph of shown.text) {
        for (const line of wrap(context, paragraph, inner)) {
          context.fillText(line, margin, y);
          y += 52;
        }
        y += 14;
      }
      if (shown.figure !== null) {
        context.textAlign = 'center';
        context.fillStyle = vrColors.accent;
        context.font = `650 ${shown.figure.length > 6 ? 84 : 170}px ${vrFont}`;
        context.fillText(shown.figure, width / 2, Math.max(y + 90, 500));
      }
      if (shown.part !== null) {
        fillRounded(context, [margin, 632, inner, 22], 11, vrColors.lift);
        if (shown.part > 0)
          fillRounded(context, [margin, 632, Math.max(22, inner * shown.part), 22], 11, vrColors.accent);
      }
    }

    context.textAlign = 'center';
    for (const target of targets) {
      const [x, y, w, h] = target.at;
      const { kind, look, label } = target;
      const over = target.id === hovered && look !== 'off';
      fillRounded(
        context,
        [x, y, w, h],
        kind === 'dot' ? 22 : 28,
        fillOf(look, over),
        look === 'missing' ? vrColors.accent : over ? vrColors.ink : undefined,
      );
      context.globalAlpha = look === 'off' ? 0.4 : 1;
      context.fillStyle = look === 'chosen' || look === 'primary' ? vrColors.accentInk : vrColors.ink;
      if (kind === 'scale') {
        context.font = `650 72px ${vrFont}`;
        context.fillText(target.id.replace('answer-', ''), x + w / 2, y + 76);
        context.font = `500 34px ${vrFont}`;
        context.fillText(label, x + w / 2, y + 148, w - 16);
      } else {
        context.font = `600 ${kind === 'dot' ? 24 : 44}px ${vrFont}`;
        context.fillText(label, x + w / 2, y + h / 2 + 2, w - 20);
      }
      context.globalAlpha = 1;
    }
    if (shown.hint !== null) {
      context.fillStyle = vrColors.accent;
      context.font = `500 34px ${vrFont}`;
      context.textAlign = 'left';
      context.fillText(shown.hint, margin, 650, inner);
    }
    context.textAlign = 'left';
    context.fillStyle = vrColors.inkSoft;
    context.font = `400 26px ${vrFont}`;
    context.fillText(shown.footnote, margin, 842, inner);
  }

  function redraw(): void {
    if (!screen) return;
    const shown = screen;
    // A bar moves in hundredths: every upload of the texture costs.
    const key = JSON.stringify([shown, hovered], (_, value) =>
      typeof value === 'number' ? Math.round(value * 100) / 100 : value,
    );
    if (key === drawn) return;
    drawn = key;
    panel.draw((context) => paint(context, shown));
  }

  const centre = new Vector3();
  return {
    object,
    show(next) {
      if (!next) {
        object.visible = false;
        placed = false;
        screen = null;
        targets = [];
        return;
      }
      screen = next;
      targets = targetsOf(next);
      object.visible = placed;
      redraw();
    },
    follow({ position, forward }) {
      if (!screen) return;
      const yaw = Math.atan2(-forward.x, -forward.z);
      const turned = Math.abs(Math.atan2(Math.sin(yaw - object.rotation.y), Math.cos(yaw - object.rotation.y)));
      const facing = new Vector3(-Math.sin(object.rotation.y), 0, -Math.cos(object.rotation.y));
      const stood = object.position.clone().addScaledVector(facing, -reach);
      const stepped = Math.hypot(stood.x - position.x, stood.z - position.z);
      if (placed && turned < mostTurn && stepped < mostStep) return;
      object.rotation.y = yaw;
      object.position.set(position.x - reach * Math.sin(yaw), position.y - below, position.z - reach * Math.cos(yaw));
      placed = true;
      object.visible = true;
    },
    point(pointers) {
      if (!object.visible) {
        for (const pointer of pointers) pointer.showRay(null);
        return;
      }
      const { pointedAt, pressed } = touch.follow(
        pointers,
        targets.filter(({ look }) => look !== 'off'),
      );
      hovered = pointedAt?.id ?? null;
      // One press, one action: the first may have changed the screen.
      pressed[0]?.act();
      redraw();
    },
    get pointedAt() {
      return hovered;
    },
    targets() {
      if (!object.visible) return [];
      panel.mesh.updateWorldMatrix(true, false);
      return targets
        .filter(({ look }) => look !== 'off')
        .map(({ id, at: [x, y, w, h] }) => {
          centre.set((x + w / 2 - width / 2) / 1000, (height / 2 - y - h / 2) / 1000, 0);
          panel.mesh.localToWorld(centre);
          return { id, at: [centre.x, centre.y, centre.z] as const };
        });
    },
  };
}
