import { button, element, offerDownload } from 'threepoint-ui';
import { type HeadsetReport, writeHeadsetReport } from './headset-report';
import { reportSections } from './report-sections';

const fileName = 'headset-check.json';
const fileType = 'application/json';

/** Fills the region with the figures of a check, and buttons to download and share its file. */
export function showResultCard(region: HTMLElement, report: HeadsetReport): void {
  const content = writeHeadsetReport(report);
  const failed = element('p', { class: 'complaint', role: 'alert', hidden: true });
  const actions = element(
    'p',
    { class: 'actions' },
    button('Download the file', () => offerDownload(fileName, fileType, content)),
  );
  const file = new File([content], fileName, { type: fileType });
  if (navigator.canShare?.({ files: [file] })) {
    actions.append(
      button('Share the file …', () => {
        navigator.share({ files: [file], title: 'Headset check' }).catch((error: unknown) => {
          // A person who closes the dialog needs no message.
          if (error instanceof DOMException && error.name === 'AbortError') return;
          failed.textContent = 'The file could not be shared. Download it instead.';
          failed.hidden = false;
        });
      }),
    );
  }
  region.replaceChildren(
    element('h2', { id: 'result-title' }, report.session.complete ? 'Your card' : 'Your card (incomplete)'),
    element(
      'p',
      {},
      'Nothing has been sent. The file holds the figures below: no movement, no picture, no sound. Send it to the people ' +
        'who asked you for it.',
    ),
    actions,
    failed,
    ...reportSections(report).map(({ title, lines, note }) =>
      element(
        'section',
        {},
        element('h3', {}, title),
        lines.length > 0
          ? element(
              'dl',
              {},
              ...lines.flatMap(({ label, value }) => [element('dt', {}, label), element('dd', {}, value)]),
            )
          : element('p', {}, 'Not measured.'),
        ...(note ? [element('p', { class: 'soft' }, note)] : []),
      ),
    ),
  );
  region.hidden = false;
  region.focus();
}
