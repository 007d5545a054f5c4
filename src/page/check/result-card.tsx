import { useState } from 'preact/hooks';
import { offerDownload } from 'threepoint-ui';
import { Button, Complaint } from 'threepoint-ui/controls';
import { type HeadsetReport, writeHeadsetReport } from './headset-report';
import { reportSections } from './report-sections';

const fileName = 'headset-check.json';
const fileType = 'application/json';

/** The buttons that download and share the file of a check. */
function FileActions({ report }: { readonly report: HeadsetReport }) {
  const [complaint, setComplaint] = useState<string | null>(null);
  const content = writeHeadsetReport(report);
  const files = [new File([content], fileName, { type: fileType })];
  const share = () =>
    navigator.share({ files, title: 'Headset check' }).catch((error: unknown) => {
      // A person who closes the dialog needs no message.
      if (error instanceof DOMException && error.name === 'AbortError') return;
      setComplaint('The file could not be shared. Download it instead.');
    });
  return (
    <>
      <p class="actions">
        <Button label="Download the file" onClick={() => offerDownload(fileName, fileType, content)} />
        {navigator.canShare?.({ files }) && <Button label="Share the file …" onClick={share} />}
      </p>
      <Complaint text={complaint} />
    </>
  );
}

/** The figures of a check, and its file. */
export const ResultCard = ({ report }: { readonly report: HeadsetReport }) => (
  <>
    <h2 id="result-title">{report.session.complete ? 'Your card' : 'Your card (incomplete)'}</h2>
    <p>
      Nothing has been sent. The file holds the figures below: no movement, no picture, no sound. Send it to the people
      who asked you for it.
    </p>
    <FileActions report={report} />
    {reportSections(report).map(({ title, lines, note }) => (
      <section>
        <h3>{title}</h3>
        <dl>
          {lines.map(({ label, value }) => (
            <>
              <dt>{label}</dt>
              <dd>{value}</dd>
            </>
          ))}
        </dl>
        {note && <p class="soft">{note}</p>}
      </section>
    ))}
  </>
);
