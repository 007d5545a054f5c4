import { button, element } from './element';
import { pageFolder } from './page-folder';
import { qrCode, qrPicture } from './qr-code';

/** Whether other devices can open an address of this host. */
const onlyHere = (hostname: string): boolean => /^(localhost|.*\.localhost|127\..*|\[::1\])$/.test(hostname);

/** The link with which other people join a room. */
export interface RoomLink {
  readonly room: string;
  readonly address: string;
  /** A sentence about devices that cannot use the address, and what to do; null: all can. */
  readonly limit: string | null;
}

/** Returns the link to a room of a game on this page's server. */
export const linkTo = (game: string, room: string): RoomLink => ({
  room,
  address: `${pageFolder()}/?play=${game}&room=${encodeURIComponent(room)}`,
  limit: onlyHere(location.hostname)
    ? 'This address works only on this computer. For other devices, start the server with --lan and open the https:// address that it prints.'
    : null,
});

/** The link to a room of a game, to copy and as a QR code. `main`: copying is the primary action of the dialog. */
export function createRoomLink(game: string, { main }: { readonly main: boolean }) {
  // Two lines: a bar is too narrow for an address, and its end names the room.
  const link = element('textarea', { rows: 2, readonly: true, 'aria-label': 'Link for the others' });
  const code = element('div', { class: 'qr' });
  const status = element('p', { class: 'hint', role: 'status' });
  const copies = button('Copy link', () => void copy(), main ? { class: 'primary', autofocus: true } : {});
  const node = element('div', { class: 'room-link' }, code, element('div', { class: 'row' }, link, copies), status);
  link.addEventListener('focus', () => link.select());

  async function copy(): Promise<void> {
    link.select();
    try {
      await navigator.clipboard.writeText(link.value);
      status.textContent = 'The link is copied.';
    } catch {
      // reason: pages without a secure context and browsers that ask first have no clipboard; the link is selected
      // instead.
      status.textContent = 'This browser does not let the page copy. The link is selected: copy it by hand.';
    }
  }

  return {
    node,
    show(room: string): void {
      const { address, limit } = linkTo(game, room);
      link.value = address;
      status.textContent = limit;
      code.replaceChildren();
      qrCode(address).then(
        (made) => code.replaceChildren(qrPicture(made)),
        () => code.remove(),
      );
    },
  };
}

/**
 * Offers the address of a room for this number of players: as a link to copy, and as a QR code for a device with a
 * camera.
 */
export function createInvitation(game: string, players: number) {
  const link = createRoomLink(game, { main: true });
  const dialog = element(
    'dialog',
    { class: 'invitation', 'aria-labelledby': 'invitation-title' },
    element('h2', { id: 'invitation-title' }, 'Play with others'),
    element('p', {}, `Up to ${players} people play in this room. Send them the link, or let them scan the code.`),
    link.node,
    element(
      'div',
      { class: 'row' },
      button('Close', () => dialog.close()),
    ),
  );
  document.body.append(dialog);
  return {
    /** Shows it for this room of this page's server. */
    open(room: string): void {
      link.show(room);
      if (!dialog.open) dialog.showModal();
    },
  };
}

export type Invitation = ReturnType<typeof createInvitation>;
