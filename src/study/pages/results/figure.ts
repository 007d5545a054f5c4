import { offerDownload } from 'threepoint-ui/downloads';
import { button, element } from 'threepoint-ui/element';
import { pngOf, svgText } from './charts';

/**
 * Returns a picture with its caption and buttons that save it as SVG and PNG; `file` is a name without its extension.
 */
export function figure(svg: SVGSVGElement, caption: string, file: string): HTMLElement {
  svg.setAttribute('role', 'img');
  svg.setAttribute('aria-label', caption);
  return element(
    'figure',
    {},
    svg,
    element(
      'div',
      { class: 'bar' },
      element('figcaption', { class: 'soft' }, caption),
      button('SVG', () => offerDownload(`${file}.svg`, 'image/svg+xml', svgText(svg)), { class: 'small' }),
      button('PNG', () => void pngOf(svg).then((blob) => offerDownload(`${file}.png`, 'image/png', blob)), {
        class: 'small',
      }),
    ),
  );
}
