import type { SkinTone } from '../core/body/built-in-bodies';

/** Colours of the mannequin's materials (docs/avatar.md), one palette per player. CSS colours. */
interface Palette {
  readonly name: string;
  readonly label: string;
  /** The accent colour that represents the palette in menus. */
  readonly color: string;
  readonly suit: string;
  readonly head: string;
  readonly visor: string;
}

/** The palettes, which differ in lightness as well as in hue. */
export const palettes: readonly Palette[] = [
  { name: 'porcelain', label: 'Blue', color: '#2f7de1', suit: '#c9ced6', head: '#e6e3de', visor: '#10141b' },
  { name: 'ember', label: 'Orange', color: '#e2572b', suit: '#4a4d55', head: '#d8cfc6', visor: '#15100e' },
  { name: 'moss', label: 'Green', color: '#3f9a63', suit: '#d6d3c7', head: '#e7e2d3', visor: '#0e1712' },
  { name: 'violet', label: 'Violet', color: '#8a63d6', suit: '#2f3242', head: '#cfcbd9', visor: '#0f0d18' },
  { name: 'sand', label: 'Gold', color: '#c79a3b', suit: '#8d8577', head: '#eadfca', visor: '#17130c' },
  { name: 'ink', label: 'Turquoise', color: '#35b6c9', suit: '#20252e', head: '#9aa4b1', visor: '#070a0e' },
];

/** The skin colours of the project's own people (docs/avatar.md), as CSS colours. */
export const skinColors: Readonly<Record<SkinTone, string>> = {
  fair: '#f0c9ac',
  light: '#e0ac86',
  beige: '#d39a72',
  tan: '#b9805c',
  brown: '#7a4e35',
  dark: '#4b3023',
};
