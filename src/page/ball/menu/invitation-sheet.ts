import type { RoomLink } from 'threepoint-ui/invitation';
import { drawQrCode, type QrCode } from 'threepoint-ui/qr-code';
import { vrColors, vrFont, wrap } from 'threepoint-ui/vr-panel';
import { bottomButton, fullWidth, type MenuSheet, menuMargin } from '../../activity/activity-menu';

/** The link to a room with its QR code. */
export interface ShownInvitation extends RoomLink {
  readonly code: QrCode | 'loading' | 'failed';
}

/** Code and address fill the width: people read them from a screen that mirrors the headset. */
function drawInvitation(context: CanvasRenderingContext2D, { room, address, limit, code }: ShownInvitation): void {
  if (typeof code === 'object') drawQrCode(context, code, [menuMargin, 116, fullWidth]);
  else {
    context.fillStyle = vrColors.inkSoft;
    context.font = `500 34px ${vrFont}`;
    const text = code === 'loading' ? 'The code is loading.' : 'The code could not be loaded. Use the address.';
    for (const [index, line] of wrap(context, text, fullWidth).entries())
      context.fillText(line, menuMargin, 300 + index * 44);
  }
  context.fillStyle = vrColors.ink;
  context.font = `650 52px ${vrFont}`;
  context.fillText(`Room ${room}`, menuMargin, 732, fullWidth);
  context.font = `500 34px ${vrFont}`;
  context.fillStyle = vrColors.ink;
  // An address has no spaces: it is broken before its query.
  const [place = address, query] = address.split(/(?=\?)/);
  const lines = query === undefined ? [place] : [place, query];
  for (const [index, line] of lines.entries()) context.fillText(line, menuMargin, 794 + index * 46, fullWidth);
  if (limit === null) return;
  context.fillStyle = vrColors.inkSoft;
  context.font = `400 22px ${vrFont}`;
  for (const [index, line] of wrap(context, limit, fullWidth).slice(0, 3).entries())
    context.fillText(line, menuMargin, 888 + index * 28);
}

/** Shows other people how to join the room, in the headset. */
export const invitationSheet = (invitation: ShownInvitation, close: () => void): MenuSheet => ({
  heading: 'Invite others',
  content: { ...invitation, code: typeof invitation.code === 'object' ? 'ready' : invitation.code },
  buttons: [bottomButton('close', 'Close', close)],
  draw: (context) => drawInvitation(context, invitation),
});
