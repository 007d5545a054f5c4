/** What is written in the world is set in the type of the page. */
export const signFont = 'Inter, "Segoe UI", system-ui, Roboto, sans-serif';

export const ink = {
  text: '#f4f7fb',
  soft: '#b9c6d6',
  board: '#17222c',
  boardLift: '#24333f',
  line: 'rgba(200, 216, 236, 0.24)',
  /** Light on dark and dark on light alike: what the eye should find first. */
  accent: '#ffc861',
  accentInk: '#2a1a02',
  good: '#8fe3c0',
  warning: '#ffab5c',
} as const;
