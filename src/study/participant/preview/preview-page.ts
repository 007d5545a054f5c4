import { reasonOf } from 'threepoint/core';
import {
  button,
  type Choice,
  chooser,
  element,
  type FileKind,
  fileField,
  fileNameOf,
  loadPreviewPlan,
  pageElement,
  pageFolder,
  readLimited,
} from 'threepoint-ui';
import { withdrawalLink } from '../../client/study-link';
import { languagesOf, participantsOf, readPlan, type StudyPlan, studyTitle } from '../../model/plan/plan';
import { durationOf } from '../../model/plan/plan-outline';
import { remarksOn } from '../../model/plan/plan-remarks';
import { createStudyCard } from '../forms/study-card';
import { createDrawnSheet } from './drawn-sheet';
import { PreviewWalk } from './preview-walk';

const planFile: FileKind = { what: 'a study file', megabytes: 1 };
const shipped = ['paper.json', 'latency.json', 'example.json'] as const;

/** The page that walks through every screen of a plan. */
class PreviewPage {
  readonly #bar = pageElement('bar', HTMLElement);
  readonly #list = pageElement('stops', HTMLElement);
  readonly #stage = pageElement('view', HTMLElement);
  readonly #messages = pageElement('said', HTMLElement);
  readonly #card = createStudyCard(this.#stage);
  readonly #sheet = createDrawnSheet();
  readonly #playing = element('p', { class: 'playing' });
  #name = '';
  #walk: PreviewWalk | null = null;
  /** The key of the form that is on the card. A form is not rebuilt while it is filled in. */
  #builtForm = '';

  async start(): Promise<void> {
    this.#stage.append(this.#sheet.node, this.#playing);
    document.addEventListener('dragover', (event) => event.preventDefault());
    document.addEventListener('drop', (event) => {
      event.preventDefault();
      const [file] = event.dataTransfer?.files ?? [];
      if (file) void this.#read(file);
    });
    document.addEventListener('keydown', (event) => this.#key(event));
    const address = new URLSearchParams(location.search).get('plan');
    const left = loadPreviewPlan();
    if (address !== null) await this.#read(address);
    else if (left !== null) this.#take('the study of the experimenter’s page', left);
    else this.#render();
  }

  async #read(source: string | File): Promise<void> {
    try {
      const bytes = await readLimited(source, planFile);
      this.#take(fileNameOf(source), new TextDecoder().decode(bytes));
    } catch (error) {
      this.#complain('', [reasonOf(error)]);
    }
  }

  #take(name: string, json: string): void {
    const read = readPlan(json, name);
    if ('faults' in read) {
      this.#complain(
        name,
        read.faults.map(({ message }) => message),
      );
      return;
    }
    this.#name = name;
    this.#begin(read.plan, participantsOf(read.plan)[0] as string);
  }

  #complain(name: string, complaints: readonly string[]): void {
    this.#name = name;
    this.#walk = null;
    this.#render(complaints);
  }

  #begin(plan: StudyPlan, participant: string): void {
    const before = this.#walk;
    this.#builtForm = '';
    const walk = new PreviewWalk({
      plan,
      participant,
      withdrawalPage: new URL(withdrawalLink(plan.id), `${pageFolder()}/`).href,
      onChange: () => this.#render(),
    });
    this.#walk = walk;
    // Another participant keeps the screen, if there is one with this id.
    if (before) walk.setLanguage(before.language);
    const asked = before?.stop.id ?? decodeURIComponent(location.hash.slice(1));
    walk.goTo(walk.stops.findIndex(({ id }) => id === asked));
  }

  /** Arrow keys move through the screens, unless the focused element needs them. */
  #key({ key, target }: KeyboardEvent): void {
    if (target instanceof HTMLElement && target.closest('input, textarea, select')) return;
    if (key === 'ArrowRight') this.#walk?.next();
    else if (key === 'ArrowLeft') this.#walk?.back();
  }

  #render(complaints: readonly string[] = []): void {
    const walk = this.#walk;
    this.#bar.replaceChildren(...this.#controls());
    this.#messages.replaceChildren(...this.#messageNodes(complaints));
    this.#list.replaceChildren(
      ...(walk ? walk.stops.map((stop, index) => this.#stopButton(walk, index, stop.label)) : []),
    );
    this.#list.querySelector('[aria-current]')?.scrollIntoView({ block: 'nearest' });
    this.#stage.hidden = !walk;
    if (walk) this.#showStop(walk);
  }

  #stopButton(walk: PreviewWalk, index: number, label: string): HTMLElement {
    const here = index === walk.index;
    const { at, kind } = walk.stops[index] as (typeof walk.stops)[number];
    const where = { desk: 'desk', headset: 'headset', either: 'desk or headset' }[at];
    return element(
      'li',
      { class: kind === 'question' ? 'question' : undefined },
      button(label, () => walk.goTo(index), { ...(here && { 'aria-current': 'step' }), title: `At: ${where}` }),
    );
  }

  #showStop(walk: PreviewWalk): void {
    history.replaceState(null, '', `#${walk.stop.id}`);
    const shown = walk.shown();
    const { place } = walk;
    this.#stage.dataset.place = place;
    this.#stage.dataset.stop = walk.stop.id;
    this.#playing.hidden = shown.kind !== 'playing';
    if (shown.kind === 'playing') this.#playing.textContent = shown.text;
    const screen = shown.kind === 'screen' ? shown.screen : null;
    this.#sheet.show(place === 'headset' ? screen : null);
    const form = shown.kind === 'form' ? `${walk.stop.id} ${walk.language}` : '';
    if (shown.kind !== 'form') this.#card.show(place === 'desk' ? screen : null);
    else if (form !== this.#builtForm) {
      // A form keeps its input while it is the same; another language makes it another form.
      this.#card.show(null);
      this.#card.ask(shown.form);
    }
    this.#builtForm = form;
  }

  #controls(): readonly Node[] {
    const walk = this.#walk;
    const source = [
      fileField(
        'Study file, or drop one here',
        'Study file',
        '.json,application/json',
        (file) => void this.#read(file),
      ),
      chooser('Shipped study', [{ id: '', label: 'Choose …' }, ...shipped.map(choiceOf)], '', (name) => {
        if (name) void this.#read(`${pageFolder()}/studies/${name}`);
      }),
    ];
    if (!walk) return source;
    const { plan } = walk;
    const at = (place: 'desk' | 'headset', label: string) =>
      button(label, () => walk.showAt(place), {
        'aria-pressed': String(walk.place === place),
        disabled: walk.stop.at !== 'either',
      });
    const languages = languagesOf(plan);
    return [
      ...source,
      chooser('Participant', participantsOf(plan).map(choiceOf), walk.participant, (participant) =>
        this.#begin(plan, participant),
      ),
      ...(languages.length > 1
        ? [chooser('Language', languages.map(choiceOf), walk.language, (language) => walk.setLanguage(language))]
        : []),
      element(
        'div',
        { class: 'places', role: 'group', 'aria-label': 'Shown' },
        at('headset', 'In the headset'),
        at('desk', 'At the desk'),
      ),
      element(
        'div',
        { class: 'steps' },
        button('Back', () => walk.back(), { disabled: walk.index === 0 }),
        element('span', {}, `${walk.index + 1} of ${walk.stops.length}`),
        button('Next', () => walk.next(), { class: 'primary', disabled: walk.index === walk.stops.length - 1 }),
      ),
    ];
  }

  #messageNodes(complaints: readonly string[]): readonly Node[] {
    if (complaints.length > 0) {
      const count = complaints.length === 1 ? 'One mistake' : `${complaints.length} mistakes`;
      const where = this.#name ? ` in ${this.#name}` : '';
      return [
        element('h2', {}, this.#name ? `${count}${where}` : 'The file cannot be read'),
        element('ul', { class: 'complaints', role: 'alert' }, ...complaints.map((text) => element('li', {}, text))),
      ];
    }
    if (!this.#walk) {
      return [
        element('p', {}, 'Choose or drop a study file: every screen of it is shown here. Nothing is recorded or sent.'),
      ];
    }
    const { plan } = this.#walk;
    const { played, rests, questionnaires } = durationOf(plan);
    const minutes = Math.round((played + rests + questionnaires) / 60);
    return [
      element('h2', {}, studyTitle(plan)),
      element(
        'p',
        {},
        `${plan.id}, from ${this.#name}: at most ${minutes} min for a participant. Nothing is recorded here.`,
      ),
      ...remarksOn(plan).map((remark) => element('p', { class: 'remark' }, remark)),
    ];
  }
}

/** Returns the entry of a list for a value that is its own label. */
const choiceOf = (value: string): Choice => ({ id: value, label: value });

void new PreviewPage().start();
