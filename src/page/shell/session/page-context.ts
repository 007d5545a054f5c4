import type { Notices } from 'threepoint-ui';
import { Emitter } from './emitter';
import { browserStorage, createPreferenceStore, type PreferenceStore } from './preferences';
import { createSettings, type Settings, SettingsWriter } from './settings';
import { readSwitches, type Switches } from './switches';

/** The switches of the address, the settings that this browser has stored, and the page's notices. */
export interface PageContext {
  readonly switches: Switches;
  readonly store: PreferenceStore;
  readonly settings: Settings;
  readonly writer: SettingsWriter;
  readonly notices: Notices;
  /** Something changed that is on the screen. */
  readonly changes: Emitter;
}

/** Reads address and storage; what they say that this page does not understand becomes a notice. */
export function readPageContext(notices: Notices): PageContext {
  const { switches, complaints } = readSwitches(location.search);
  const store = createPreferenceStore(browserStorage('localStorage'), (sentence) => notices.show('warning', sentence));
  for (const complaint of [...complaints, store.complaint]) if (complaint) notices.show('warning', complaint);
  const settings = createSettings(switches, store, browserStorage('sessionStorage'));
  const changes = new Emitter();
  return { switches, store, settings, changes, notices, writer: new SettingsWriter(settings, store, changes.emit) };
}
