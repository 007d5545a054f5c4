import { button, element } from './element';
import { pageFolder } from './page-folder';

/** Offers the address of a room: as a link to copy, and as a QR code for a device with a camera. */
export interface Invitation {
  /** Shows it for this room of this page's server. */
  open(room: string): void;
}

/** The address of a room of the ball game on this page's server. */
const roomAddress = (room: string): string => `${pageFolder()}/?play=ball&room=${encodeURIComponent(room)}`;

/** Whether other devices can open an address of this host. */
const onlyHere = (hostname: string): boolean => /^(localhost|.*\.localhost|127\..*|\[::1\])$/.test(hostname);

const svgNamespace = 'http://www.w3.org/2000/svg';
/** White around the code, without which cameras do not find it [modules]. */
const quiet = 4;

/** The QR code of a text. The encoder is loaded when the first one is drawn. */
async function qrCode(text: string): Promise<SVGSVGElement> {
  const { encode } = await import('uqr');
  const { data, size } = encode(text, { ecc: 'M', border: 0 });
  const side = size + 2 * quiet;
  const svg = document.createElementNS(svgNamespace, 'svg');
  svg.setAttribute('viewBox', `0 0 ${side} ${side}`);
  svg.setAttribute('role', 'img');
  svg.setAttribute('aria-label', 'QR code of the link');
  svg.setAttribute('shape-rendering', 'crispEdges');
  const path = document.createElementNS(svgNamespace, 'path');
  const modules = data.flatMap((row, y) =>
    row.flatMap((dark, x) => (dark ? [`M${x + quiet} ${y + quiet}h1v1h-1z`] : [])),
  );
  path.setAttribute('d', modules.join(''));
  svg.append(path);
  return svg;
}

export function createInvitation(): Invitation {
  const link = element('input', { type: 'text', readonly: true, 'aria-label': 'Link for the others' });
  const code = element('div', { class: 'qr' });
  const said = element('p', { class: 'hint', role: 'status' });
  const dialog = element(
    'dialog',
    { class: 'invitation', 'aria-labelledby': 'invitation-title' },
    element('h2', { id: 'invitation-title' }, 'Play with others'),
    element('p', {}, 'Up to three people play in this room. Send them the link, or let them scan the code.'),
    code,
    element(
      'div',
      { class: 'row' },
      link,
      button('Copy link', () => void copy(), { class: 'primary', autofocus: true }),
    ),
    said,
    element(
      'div',
      { class: 'row' },
      button('Close', () => dialog.close()),
    ),
  );
  document.body.append(dialog);
  link.addEventListener('focus', () => link.select());

  async function copy(): Promise<void> {
    link.select();
    try {
      await navigator.clipboard.writeText(link.value);
      said.textContent = 'The link is copied.';
    } catch {
      // reason: pages without a secure context and browsers that ask first have no clipboard; the link is selected instead.
      said.textContent = 'This browser does not let the page copy: the link is selected, copy it by hand.';
    }
  }

  return {
    open(room) {
      const address = roomAddress(room);
      link.value = address;
      said.textContent = onlyHere(location.hostname)
        ? 'This address works on this computer only. For other devices start the server with --lan and open the https:// address that it prints.'
        : '';
      code.replaceChildren();
      qrCode(address).then(
        (svg) => code.replaceChildren(svg),
        () => code.remove(),
      );
      if (!dialog.open) dialog.showModal();
    },
  };
}
