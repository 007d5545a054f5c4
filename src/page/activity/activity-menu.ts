/** A button of the menu in the headset. */
export interface MenuEntry {
  readonly id: string;
  readonly label: string;
  readonly act: () => void;
}

/** A button with its place on the menu. */
export interface MenuButton extends MenuEntry {
  /** Left, top, width and height [pixels]. */
  readonly at: readonly [number, number, number, number];
  readonly look: 'plain' | 'chosen' | 'off';
}

/** A page that replaces the menu until it is closed. */
export interface MenuSheet {
  readonly heading: string;
  readonly buttons: readonly MenuButton[];
  /** Plain data that changes whenever `draw` would draw something else. */
  readonly content: unknown;
  /** Draws everything except heading and buttons. */
  draw(context: CanvasRenderingContext2D): void;
}

/** The part of the menu in the headset that belongs to an activity. */
export interface ActivityMenu {
  readonly entries: readonly MenuEntry[];
  /** null: the menu itself is shown. */
  readonly sheet: MenuSheet | null;
  /** A sentence that takes precedence over the page's notices; null: none. */
  readonly notice: string | null;
  /** A sentence that is shown while there is no notice; null: none. */
  readonly hint: string | null;
}

/** Size of the menu, and the margin at its edges [pixels]. */
export const menuWidth = 640;
export const menuHeight = 1112;
export const menuMargin = 36;
/** Width of a button that takes a row of its own, and of one of two in a row, with the gap between them [pixels]. */
export const fullWidth = menuWidth - 2 * menuMargin;
export const buttonGap = 16;
export const halfWidth = (fullWidth - buttonGap) / 2;

/** Returns the only button of a page that replaces the menu, at its lower edge. */
export const bottomButton = (id: string, label: string, act: () => void): MenuButton => ({
  id,
  label,
  at: [menuMargin, menuHeight - menuMargin - 96, fullWidth, 96],
  look: 'plain',
  act,
});

/** Lays out buttons in two columns; `top`: of the first row, `rowHeight`: from row to row [pixels]. */
export const inColumns = (entries: readonly MenuEntry[], top: number, rowHeight: number): readonly MenuButton[] =>
  entries.map((entry, index) => {
    const x = menuMargin + (index % 2) * (halfWidth + buttonGap);
    const y = top + Math.floor(index / 2) * rowHeight;
    return { ...entry, at: [x, y, halfWidth, rowHeight - buttonGap], look: 'plain' };
  });
