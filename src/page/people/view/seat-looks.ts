import { drawText } from 'threepoint-ui/vr';

/** The look of a station in paint and words. Looks differ in hue, brightness and mark. */
interface SeatLook {
  readonly color: string;
  readonly ink: string;
  /** The mark next to the name. */
  readonly mark: string;
  /** Colours of the avatar: one of `palettes` in src/threepoint/avatar. */
  readonly palette: string;
}

/** By station. */
export const seatLooks: readonly SeatLook[] = [
  { color: '#2a6fd6', ink: '#ffffff', mark: '1', palette: 'porcelain' },
  { color: '#f08a24', ink: '#241200', mark: '2', palette: 'ember' },
  { color: '#f3efe2', ink: '#1b2430', mark: '3', palette: 'violet' },
];

/** Paints the mark of a station on a disc in its colour, around this middle [pixels]. */
export function paintSeatMark(
  context: CanvasRenderingContext2D,
  station: number,
  [x, y]: readonly [number, number],
  radius: number,
): void {
  const look = seatLooks[station];
  if (!look) return;
  context.fillStyle = look.color;
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fill();
  const font = `800 ${Math.round((radius * 7) / 6)}px`;
  drawText(context, look.mark, [x, y + 3], { font, color: look.ink, align: 'center', baseline: 'middle' });
}
