import type { StudyForm } from './study-form';

export type FormOf<Kind extends StudyForm['kind']> = Extract<StudyForm, { kind: Kind }>;

interface HeadingProps {
  readonly kicker: string;
  readonly title: string;
  /** Something went wrong. */
  readonly trouble?: boolean;
}

/** The heading of a form below the line that says where it belongs. */
export const Heading = ({ kicker, title, trouble = false }: HeadingProps) => (
  <>
    <p class={trouble ? 'kicker trouble' : 'kicker'}>{kicker}</p>
    <h1>{title}</h1>
  </>
);

interface LanguageChoiceProps {
  /** The word for "language". */
  readonly label: string;
  readonly languages: readonly string[];
  readonly chosen: string;
  readonly choose: (language: string) => void;
}

const nameOf = (language: string) => new Intl.DisplayNames([language], { type: 'language' }).of(language) ?? language;

/** A choice of languages, each in its own name; nothing for a single one. */
export const LanguageChoice = ({ label, languages, chosen, choose }: LanguageChoiceProps) =>
  languages.length > 1 && (
    <label class="field">
      <span>{label}</span>
      <select name="language" value={chosen} onChange={({ currentTarget }) => choose(currentTarget.value)}>
        {languages.map((language) => (
          <option key={language} value={language} lang={language}>
            {nameOf(language)}
          </option>
        ))}
      </select>
    </label>
  );
