import { render } from 'preact';
import { firstLine, reasonOf } from 'threepoint/core';
import { installTrustedTypesPolicy, pageElement } from 'threepoint-ui';
import { Complaint } from 'threepoint-ui/controls';
// The text of the module that runs below.
import source from './body.ts?raw';

installTrustedTypesPolicy();
pageElement('source', HTMLElement).textContent = source.trim();

import('./body').catch((error: unknown) => {
  const text = `The body could not be shown: ${firstLine(reasonOf(error))}. Reload the page to try again.`;
  render(<Complaint text={text} />, pageElement('fault', HTMLElement));
});
