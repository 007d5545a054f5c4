import { drawQrCode, type QrCode, type RoomLink } from 'threepoint-ui';
import { drawText, drawTextLines, vrColors } from 'threepoint-ui/vr';
import { bottomButton, fullWidth, type MenuSheet, menuMargin } from '../../activity/activity-menu';

/** The link to a room with its QR code. */
export interface ShownInvitation extends RoomLink {
  readonly code: QrCode | 'loading' | 'failed';
}

/** Code and address fill the width: people read them from a screen that mirrors the headset. */
function drawInvitation(context: CanvasRenderingContext2D, { room, address, limit, code }: ShownInvitation): void {
  const { ink, inkSoft } = vrColors;
  const baseline = 'middle';
  if (typeof code === 'object') drawQrCode(context, code, [menuMargin, 116, fullWidth]);
  else {
    const text = code === 'loading' ? 'The code is loading.' : 'The code could not be loaded. Use the address.';
    drawTextLines(context, text, [menuMargin, 300, fullWidth], 44, { font: '500 34px', color: inkSoft, baseline });
  }
  drawText(context, `Room ${room}`, [menuMargin, 732], { font: '650 52px', color: ink, baseline, maxWidth: fullWidth });
  // An address has no spaces: it is broken before its query.
  const [page = address, query] = address.split(/(?=\?)/);
  for (const [index, line] of [page, query ?? ''].entries()) {
    const at = [menuMargin, 794 + index * 46] as const;
    drawText(context, line, at, { font: '500 34px', color: ink, baseline, maxWidth: fullWidth });
  }
  if (limit === null) return;
  const small = { font: '400 22px', color: inkSoft, baseline } as const;
  drawTextLines(context, limit, [menuMargin, 888, fullWidth], 28, small, 3);
}

/** Shows other people how to join the room, in the headset. */
export const invitationSheet = (invitation: ShownInvitation, close: () => void): MenuSheet => ({
  heading: 'Invite others',
  content: { ...invitation, code: typeof invitation.code === 'object' ? 'ready' : invitation.code },
  buttons: [bottomButton('close', 'Close', close)],
  draw: (context) => drawInvitation(context, invitation),
});
