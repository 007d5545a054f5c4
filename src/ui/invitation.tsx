import { render } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { Button, openModal } from './controls';
import { pageFolder } from './page-folder';
import { type QrCode, qrCode } from './qr-code';

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

/** Draws a code without white of its own: the page's background is white. */
function QrPicture({ code: { side, isDark } }: { readonly code: QrCode }) {
  const modules: string[] = [];
  for (let y = 0; y < side; y++) {
    for (let x = 0; x < side; x++) if (isDark(x, y)) modules.push(`M${x} ${y}h1v1h-1z`);
  }
  return (
    <svg viewBox={`0 0 ${side} ${side}`} role="img" aria-label="QR code of the link" shape-rendering="crispEdges">
      <path d={modules.join('')} />
    </svg>
  );
}

interface RoomLinkCardProps {
  readonly game: string;
  readonly room: string;
  /** Copying is the primary action of the dialog. */
  readonly main?: boolean;
}

/** The link to a room of a game, to copy and as a QR code. A link to another room needs another key. */
export function RoomLinkCard({ game, room, main = false }: RoomLinkCardProps) {
  const { address, limit } = linkTo(game, room);
  const link = useRef<HTMLTextAreaElement>(null);
  const [status, setStatus] = useState(limit);
  /** undefined: it is being made. null: it could not be made. */
  const [code, setCode] = useState<QrCode | null>();
  useLayoutEffect(() => {
    qrCode(address).then(setCode, () => setCode(null));
  }, []);

  async function copy(): Promise<void> {
    link.current?.select();
    try {
      await navigator.clipboard.writeText(address);
      setStatus('The link is copied.');
    } catch {
      // reason: pages without a secure context and browsers that ask first have no clipboard; the link is selected
      // instead.
      setStatus('This browser does not let the page copy. The link is selected: copy it by hand.');
    }
  }

  return (
    <div class="room-link">
      {code !== null && <div class="qr">{code && <QrPicture code={code} />}</div>}
      <div class="row">
        {/* Two lines: a bar is too narrow for an address, and its end names the room. */}
        <textarea
          ref={link}
          rows={2}
          readonly
          aria-label="Link for the others"
          value={address}
          onFocus={({ currentTarget }) => currentTarget.select()}
        />
        <Button label="Copy link" class={main ? 'primary' : ''} autofocus={main} onClick={() => void copy()} />
      </div>
      <p class="hint" role="status">
        {status}
      </p>
    </div>
  );
}

/**
 * Shows the address of a room for this number of players: as a link to copy, and as a QR code for a device with a
 * camera.
 */
export function showInvitation(game: string, players: number, room: string): void {
  const place = document.body.appendChild(document.createElement('div'));
  const remove = () => {
    render(null, place);
    place.remove();
  };
  render(
    <dialog ref={openModal} class="invitation" aria-labelledby="invitation-title" onClose={remove}>
      <h2 id="invitation-title">Play with others</h2>
      <p>{`Up to ${players} people play in this room. Send them the link, or let them scan the code.`}</p>
      <RoomLinkCard game={game} room={room} main />
      <form method="dialog" class="row">
        <button type="submit">Close</button>
      </form>
    </dialog>,
    place,
  );
}
