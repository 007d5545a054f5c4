export const arrowLength = 0.88;
export const braceHeight = 0.16;
