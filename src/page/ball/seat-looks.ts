/** The look of a seat in paint and words. Two throwers and the holder differ in hue, brightness and mark. */
interface SeatLook {
  readonly color: string;
  readonly ink: string;
  /** The mark on the floor and next to the name. */
  readonly mark: string;
  /** Colours of the avatar: one of `palettes` in src/threepoint/avatar. */
  readonly palette: string;
}

/** By station. */
export const seatLooks: readonly SeatLook[] = [
  { color: '#2a6fd6', ink: '#ffffff', mark: '1', palette: 'porcelain' },
  { color: '#f08a24', ink: '#241200', mark: '2', palette: 'ember' },
  { color: '#f3efe2', ink: '#1b2430', mark: '●', palette: 'violet' },
];

export const roleTexts = ['Thrower 1', 'Thrower 2', 'Basket holder'] as const;
