// "threepoint-ui/vr": panels, captions and pointers in a headset, drawn with three.
export type { TextStyle } from './canvas-drawing';
export { drawText, drawTextLines, fillRoundedRect, textWidth, vrColors, vrFont, wrapText } from './canvas-drawing';
export { createVrCaptions } from './vr-captions';
export { createVrPanel } from './vr-panel';
export { createVrPointers, type VrPointers } from './vr-pointers';
export { createPanelTouch, type PanelTarget } from './vr-touch';
